/* How far from a distance two particles are, from the exact sums of doubles that touchstone_separation() gives. */
#ifndef VERIFY_SEPARATION_H
#define VERIFY_SEPARATION_H

#include "touchstone.h"

/* |r| - distance in double-double: relative error below 2^-95 of the distance as long as no term is many times larger
 * than it, and it is one double. */
double separation_excess_twin(double terms[3][3 * TOUCHSTONE_MOST_TERMS], int count, double distance);

/* The same, exact but for the last rounding, so that its sign is exact: sums and squares of doubles of any size are
 * held whole. */
double separation_excess_exact(double terms[3][3 * TOUCHSTONE_MOST_TERMS], int count,
							   const double distance[TOUCHSTONE_MOST_TERMS]);

/* During an observer's call: whether the pair whose event or test it is stands within its distance, exactly; at it, it
 * does not. `bits` are those of the engine's arithmetic. */
bool separation_within(const struct touchstone_engine *engine, int bits);

#endif
