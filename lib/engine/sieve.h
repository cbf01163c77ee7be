/* The sieve: which of many pairs may be the next to meet, found in binary32 with a proven bound on what that leaves
 * out. It spares the working arithmetic nearly all of its work and changes no result: whatever may be the earliest
 * meeting, by the working arithmetic's own rounded numbers, passes.
 *
 * Every particle casts a shadow: where it is and how it moves, rounded to binary32, in units of the scene's own scale.
 * The bound, for a pair at the time of the search, with u = 2^-24, n the roundoff of the working arithmetic, and
 * 1-norms (they are cheap and never less than the Euclidean ones):
 *
 *     S    sum of both speeds                    R    distance
 *     h    error of a component of r: g + 4 u R with g = u (8 boxes + 8 |x_i| + 12 S span) + grain + S drift. Each
 *          position, speed and time is rounded once (u of itself), the flight to now twice more, the difference and the
 *          image's shift twice; |x_j| is at most |x_i| + R + S span and the shift; a time is at most `span`; `grain` is
 *          what the working arithmetic's own difference of two places errs by, and `drift` its flights since the last
 *          events, as a time
 *     E_c  error of c = r.r - s^2:  q = 4 h (R + h) + (32 u + 64 n) (R^2 + s^2) + 64 n (S age)^2
 *     E_b  error of b = r.v:        S (2 h + (12 u + 16 n) R + 16 n S age + S late)
 *     E_D  error of b^2 - a c:      2 S^2 q
 *
 * The terms in n bound the working arithmetic's polynomial, formed at the later of the two last events, when the
 * distance was at most F = R + S age (coefficients within 4 n S^2, 6 n F S, 8 n (F^2 + s^2)), and shifted to now.
 * `late` is what its event times err by, which says nothing of where anything is; but a meeting that was just before
 * now may by rounding be one of now, and two meetings may change places. First-order sums of these give half of the
 * figures above or less; the other half pays for second orders, for the rounding of the bounds and for subnormal
 * numbers. Whether products and sums are fused does not matter.
 *
 * What is reckoned with is linear in r.r, which is known last: R^2 is at most 3 r.r, and 2 R at most L + R^2 / L for
 * any length L, best for one as large as most R, so that
 *
 *     E_c  <=  g (2 L + 4 g) + (32 u + 64 n) s^2 + 64 n (S age)^2  +  r.r (6 g / L + 144 u + 192 n)
 *     E_b  <=  S (2 g + (10 u + 8 n) L + 16 n S age + S late)      +  r.r S (30 u + 24 n) / L
 *
 * A pair is left out when it surely parts (b > E_b: what it may have met is in the past), surely misses (D < -E_D), or
 * surely meets later than some other pair surely meets. A comparison with a NaN leaves nothing out. */
#ifndef TOUCHSTONE_SIEVE_H
#define TOUCHSTONE_SIEVE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "engine/pairs.h"

struct shadow {              /* half a cache line */
	float position[3], time; /* where it was at the time of a search: this one's, or one before */
	float velocity[3], radius;
};

struct sieve {
	float box[3];   /* extent of the periodic axes */
	float boxes;    /* their sum */
	float length;   /* about how far most pairs are: L */
	float now;      /* time of the search */
	float span;     /* no time is larger, of this search or of one before: `now` itself, unless time has gone back */
	float age;      /* no last event of a particle that searches is longer ago, and none is so long after now */
	float roundoff; /* of the working arithmetic: n */
	float grain;    /* error of its differences of places */
	float drift;    /* error of its flights, as a time */
	float late;     /* error of its event times */
	float heard;    /* pairs no farther apart than so many times their contact distance pass in any case; 0: none */
	bool by_order;  /* whether pairs may be left out for another that meets earlier */
	bool images;    /* whether any entry of a search, or of those looked over, may be an image */
	bool timed;     /* whether searches are told when the last that they keep meets */
};

/* One search: of the entries (engine/cells.h) that a particle may meet, those that it may meet first. */
struct sieve_search {
	uint32_t self;   /* its own shadow is as of now */
	uint32_t *entry; /* behind the last stand 16 more that name particles which exist */
	size_t count;
	float latest;   /* meetings surely later are of no interest; INFINITY for none */
	float from, by; /* when the last one kept meets, if it does: by INFINITY where it is not sure to */
};

/* Goes through one or two searches of one time, and leaves in each the entries that may be met first, and their count.
 */
typedef void sieve_pass(const struct sieve *sieve, const struct shadow *shadow, struct sieve_search *search,
						int searches);

/* Between which distances a pair is: it parts at the outer one, or meets at the inner one. 0: whatever is farther, or
 * nearer, nothing happens there. */
struct limits {
	float outer, inner;
};

/* Pairs and their limits, by columns: the arrays hold 16 more at their ends, entries that name particles which exist,
 * and any distances. */
struct held {
	const uint32_t *entry;
	const float *outer, *inner;
};

/* Looks over `count` pairs, where `outer` may be INFINITY: writes the numbers of those that are not surely nearer than
 * `outer` and farther than `inner`, in their order, to `kept`, which has room for 16 more, and returns how many there
 * are. Sure is |r.r - s^2| > E_c. */
typedef size_t sieve_check(const struct sieve *sieve, const struct shadow *shadow, uint32_t self,
						   const struct held *held, size_t count, uint32_t *kept);

/* One search of another kind: of `count` pairs, each of which is between the limits that its state is the number of,
 * when they may have their next event. */
struct sieve_outlook {
	uint32_t self;
	const struct pair_state *pair;
	const struct limits *limits;
	size_t count;
	float *soonest; /* has room for 16 more */
	size_t first;   /* the pair for which it is least */
};

/* Writes to each outlook, of one or two of one time, a time after now for each pair before which it has no event:
 * INFINITY where it has none.
 *
 * Where a pair surely meets, this is the lower bound that the sieve has. Where it surely does not, it parts: at the
 * larger root of a t^2 + 2 b t + c, which falls as any of a, b and c grows, so that their errors bound it: E_c, E_b,
 * and (16 u + 8 n) S^2 of a. */
typedef void sieve_hold(const struct sieve *sieve, const struct shadow *shadow, struct sieve_outlook *outlook,
						int outlooks);

/* Of so many times that it has written: writes the numbers of those not later than `latest`, nor INFINITY, in their
 * order, to `kept`, which has room for 16 more, and returns how many there are. `later` is the least of the others. */
typedef size_t sieve_sooner(const float *soonest, size_t count, float latest, uint32_t *kept, float *later);

/* Writes a shadow whole: what is written in pieces is slow to be read back whole. */
typedef void sieve_cast(struct shadow *shadow, double x, double y, double z, double time, double vx, double vy,
						double vz, double radius);

/* How a machine does it. Number 0 is the fastest there is on this one; the others are there to be compared: NULL after
 * the last. */
struct sieve_machine {
	const char *name;
	sieve_pass *pass;
	sieve_hold *hold;
	sieve_sooner *sooner;
	sieve_check *check;
	sieve_cast *cast;
};
const struct sieve_machine *sieve_machine(size_t number);

extern const struct sieve_machine sieve_any;
#ifdef __x86_64__
extern const struct sieve_machine sieve_avx2, sieve_avx512;
#endif

#endif
