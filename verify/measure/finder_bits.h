/* How many bits of a finder's answers are right, whatever the arithmetic: its unrounded answers are held against the
 * exact ones, computed to 64 bits more than the arithmetic carries.
 *
 *     bits = -log2(|got - exact| / the larger of the two)
 *
 * An exact answer has infinitely many; one that is not even of the right size, or later than an event that is now, has
 * none. Only events that are found have bits (finder_class.h); faults are counted elsewhere. Times of less than 2^-562
 * are left out, since answers are told in doubles, which hold up to 512 bits only of what is larger. The questions are
 * exact as doubles: what a coarser arithmetic loses in reading them counts against it. */
#ifndef VERIFY_FINDER_BITS_H
#define VERIFY_FINDER_BITS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "oracle/oracle.h"
#include "touchstone.h"

/* Questions of one shape with their exact answers. */
struct finder_truth;

/* Room for so many questions, for arithmetics of up to so many bits, 512 at most; NULL when out of memory. */
struct finder_truth *finder_truth_create(size_t room, int bits);
void finder_truth_destroy(struct finder_truth *truth); /* NULL is fine */

/* Takes questions, at most as many as there is room for. `numbers` must last as long as they are asked. */
void finder_truth_solve(struct finder_truth *truth, struct oracle *oracle, enum touchstone_shape shape,
						const double (*numbers)[TOUCHSTONE_MOST_NUMBERS], size_t count);

/* How many answers have so many bits, to a sixteenth of a bit; more than the last level has are in it. */
enum { FINDER_BITS_STEP = 16, FINDER_BITS_MOST = 1100, FINDER_BITS_LEVELS = FINDER_BITS_STEP * FINDER_BITS_MOST + 1 };
struct finder_bits {
	uint32_t count[FINDER_BITS_LEVELS];
	uint64_t found;
	double least; /* bits, unrounded; infinite when there is no answer */
};

void finder_bits_begin(struct finder_bits *bits);

/* Asks all questions of `truth` and adds the answers' bits. False with one line in `error` as touchstone_find(). */
bool finder_bits_add(struct finder_bits *bits, struct finder_truth *truth, struct oracle *oracle,
					 const char *arithmetic, const char *method, char error[160]);

/* The bits that at least this share of the found answers has: 0.5 for the median, 0.999 for all but one in a thousand.
 * To a sixteenth at most too low; infinite when they are exact, NaN when none was found. */
double finder_bits_of_share(const struct finder_bits *bits, double share);

#endif
