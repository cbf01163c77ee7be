/* The Pareto frontier: of many points, each with a cost and a worth, those that no other beats. */
#ifndef VERIFY_FRONTIER_H
#define VERIFY_FRONTIER_H

#include <stdbool.h>
#include <stddef.h>

struct frontier_point {
	double cost, worth;
	bool best; /* found: no other point costs no more and is worth no less, and does better in one of the two */
};

/* Finds which are best. Points of equal cost and worth are so together; NaN is beaten by everything and beats nothing.
 */
void frontier_find(struct frontier_point *points, size_t count);

#endif
