/* What the sieve of every machine is made of: some pairs at a time, LANES of them, a divisor of sixteen, in vectors
 *that the machine holds whole; MACHINE is the attribute of its functions. Then come the machine's own steps, by these
 *names, some of which may be those of engine/sieve_vectors.inl:
 *
 *	fetch          shadows, turned over: field by field
 *	root
 *	near_root      from tiny to huge: within 2^-11 of itself,
 *	near_inverse   and so is this: many times quicker than root and quotient
 *	mask           the type of a comparison's outcome
 *	less, pick     a comparison, and what is chosen by it
 *	any            whether any word is not 0
 *	behind         which lanes are behind the last of `count`
 *	bits           a mask as a bit for each lane
 *	larger         of each two, or the second where the first is no number,
 *	smaller        and so is this
 *	minimum        of all
 *	pack           what is wanted, close together: from a place to the same or an earlier one; how many
 *	limits_of      the entries of pairs, 0 behind the last of them, and their limits
 *	cast           of a shadow
 *
 * and at last engine/sieve_passes.inl, which makes of them what engine/sieve.h promises. */
#include "engine/sieve.h"

#include <float.h>
#include <math.h>
#include <string.h>

#include "engine/cells.h"

enum { FIELDS = sizeof(struct shadow) / sizeof(float) };
typedef float lanes __attribute__((vector_size(LANES * sizeof(float))));
typedef int32_t whole_lanes __attribute__((vector_size(LANES * sizeof(int32_t))));
typedef uint32_t flags; /* a bit for each lane */

#define INLINE MACHINE static inline __attribute__((always_inline))

static const flags all_lanes = (1u << LANES) - 1;
static const float u = 0x1p-24f, tiny = 0x1p-120f, huge = 0x1p120f;

INLINE lanes all(float x)
{
	return x - (lanes){0}; /* 0 + x would have to be added up, for the sake of -0 */
}

/* Of the lanes, from 0. */
INLINE whole_lanes numbers(void)
{
	whole_lanes number;
	for (int lane = 0; lane < LANES; lane++) number[lane] = lane;
	return number;
}
