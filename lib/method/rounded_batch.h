/* The fast path of `rounded` for many pairs of balls at once. */
#ifndef METHOD_ROUNDED_BATCH_H
#define METHOD_ROUNDED_BATCH_H

#include <stdbool.h>
#include <stddef.h>

#include "touchstone.h"

/* Times at which balls meet or, if `part`, part; NaN for those that the fast path leaves to the exact one. The numbers
 * of a question are in the order of touchstone.h. The same on every machine, to the last bit. */
void rounded_batch(bool part, const double (*numbers)[TOUCHSTONE_MOST_NUMBERS], size_t count, double *times);

#endif
