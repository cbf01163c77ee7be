#include "measure/frontier.h"

#include <math.h>

static bool beats(const struct frontier_point *one, const struct frontier_point *other)
{
	return one->cost <= other->cost && one->worth >= other->worth &&
		   (one->cost < other->cost || one->worth > other->worth);
}

void frontier_find(struct frontier_point *points, size_t count)
{
	for (size_t p = 0; p < count; p++) {
		points[p].best = !isnan(points[p].cost) && !isnan(points[p].worth);
		for (size_t q = 0; q < count && points[p].best; q++) points[p].best = !beats(&points[q], &points[p]);
	}
}
