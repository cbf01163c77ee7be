/* Makes a failure simple enough to be understood: fewer set bits, exponents near zero, components zero or one, while it
 * stays the same failure at the same branch. */
#ifndef VERIFY_FUZZ_SHRINK_H
#define VERIFY_FUZZ_SHRINK_H

#include "fuzz/failure.h"

/* Significant bits from the first to the last that is set: 1 for a power of two, 0 for zero. */
unsigned fuzz_bits(double number);

/* Those of a case's numbers together. */
unsigned fuzz_case_bits(enum touchstone_shape shape, const struct fuzz_case *one);

/* Tries at most `tries` simpler cases, each in the same order; returns how many it tried. `stop`, if not NULL, ends it
 * early, with what has been reached. */
unsigned fuzz_shrink(const struct fuzz_subject *subject, struct oracle *oracle, struct fuzz_case *failed,
					 unsigned tries, const volatile int *stop);

#endif
