/* The sieve: which of many pairs may be the next to meet, found in binary32 with a proven bound on what that leaves
 * out. It spares the working arithmetic nearly all of its work and changes no result: whatever may be the earliest
 * meeting, by the working arithmetic's own rounded numbers, passes.
 *
 * Every particle casts a shadow: where it is and how it moves, rounded to binary32, in units of the scene's own scale.
 * The bound, for a pair at the time of the search, with u = 2^-24, n the roundoff of the working arithmetic, and
 * 1-norms (they are cheap and never less than the Euclidean ones):
 *
 *     S    sum of both speeds                    R    distance; `far` = R + S age, the distance at the two last events
 *     h    error of a component of r: u (4 boxes + 4 (|x_i| + |x_j|) + 8 S span) + S drift; each position, speed and
 *          time is rounded once (u of itself), the flight to now twice more, the difference and the image's shift
 *          twice; a time is at most `span`, and `drift` is what the working arithmetic's own flights since the last
 *          events err by, as a time
 *     E_c  error of c = r.r - s^2:  q = 4 h (R + h) + 32 u (R^2 + s^2) + 32 n (far^2 + s^2)
 *     E_b  error of b = r.v:        S (2 h + 12 u R + 16 n far)
 *     E_D  error of b^2 - a c:      2 S^2 q
 *
 * The terms in n bound the working arithmetic's polynomial, formed at the later of the two last events (coefficients
 * within 4 n S^2, 6 n far S, 8 n (far^2 + s^2)) and shifted to now. First-order sums of these give half of the figures
 * above or less; the other half pays for second orders, for the rounding of the bounds and for subnormal numbers.
 *
 * A pair is left out when it surely parts (b > E_b: what it may have met is in the past), surely misses (D < -E_D), or
 * surely meets later than some other pair surely meets. A comparison with a NaN leaves nothing out. */
#ifndef TOUCHSTONE_SIEVE_H
#define TOUCHSTONE_SIEVE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

struct shadow {              /* half a cache line */
	float position[3], time; /* where it was at a time not later than the search's */
	float velocity[3], radius;
};

struct sieve {
	float box[3];   /* extent of the periodic axes */
	float boxes;    /* their sum */
	float now;      /* time of the search */
	float span;     /* no time is larger: `now` itself */
	float age;      /* no particle's last event is longer ago */
	float roundoff; /* of the working arithmetic: n */
	float drift;    /* error of its flights, as a time */
	float latest;   /* meetings surely later are of no interest; INFINITY for none */
	bool by_order;  /* whether pairs may be left out for another that meets earlier */
};

/* Goes through `count` entries (engine/cells.h) that particle `self` may meet, whose own shadow is as of now, and
 * leaves in `entry` those that may be met first. Returns how many. `entry` is filled up with
 * particles that exist to a multiple of 16, and has room for 16 more; `bounds` has room for 2 (count + 16). */
typedef size_t sieve_pass(const struct sieve *sieve, const struct shadow *shadow, uint32_t self, uint32_t *entry,
						  size_t count, float *bounds);

/* The fastest there is on this machine; and each of them, for tests: NULL after the last. */
sieve_pass *sieve_choose(void);
sieve_pass *sieve_number(size_t number, const char **name);

#endif
