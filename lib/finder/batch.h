/* Many pairs of balls at once, in binary64: the parts of `rounded` and `compensated` that have no branches. */
#ifndef FINDER_BATCH_H
#define FINDER_BATCH_H

#include <stdbool.h>
#include <stddef.h>

#include "touchstone.h"

/* Times at which balls meet or, if `part`, part; NaN for those that the method must look at once more, one by one. The
 * numbers of a question are in the order of touchstone.h. The same on every machine, to the last bit. */
typedef void batch(bool part, const double (*numbers)[TOUCHSTONE_MOST_NUMBERS], size_t count, double *times);

batch batch_rounded, batch_compensated;

#endif
