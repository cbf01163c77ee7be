/* Impact separation (design, section 5.1; 2014 paper, fig. 3): how far from contact particles are when they collide,
 * counted in representable numbers of the working arithmetic from the contact distance: as the arithmetic itself
 * computes the distance, and as it truly is at the same working positions. */
#ifndef VERIFY_IMPACT_H
#define VERIFY_IMPACT_H

#include "touchstone.h"

enum {
	IMPACT_REACH = 256, /* separations further off are counted at the ends */
	IMPACT_DOUBLINGS = 64
};

/* One of the two ways of knowing the separation. */
struct impact_histogram {
	uint64_t bar[2 * IMPACT_REACH + 1]; /* [IMPACT_REACH]: at the contact distance itself */
	uint64_t below, above;              /* strictly, whatever the bar */
	uint64_t doubling[2]
					 [IMPACT_DOUBLINGS]; /* below contact, and at or above it: by less than 1 ulp, 1 to 2, 2 to 4 ... */
	double sum, sum_of_squares;          /* of the separation less contact, in units of ulp above contact */
	double least, most;
};

struct impact {
	int bits;       /* of the working arithmetic */
	uint64_t count; /* contacts seen */
	struct impact_histogram measured, exact;
	uint64_t forced; /* of the exact ones, how many the fast path could not settle */
};

/* An empty measurement for an arithmetic of so many significand bits. */
void impact_begin(struct impact *impact, int bits);

/* Observes an event; pass to touchstone_run with a struct impact as the context. */
void impact_see(void *impact, struct touchstone_engine *engine, const struct touchstone_event *event);

void impact_merge(struct impact *into, const struct impact *from);

double impact_mean(const struct impact_histogram *histogram, uint64_t count);
double impact_deviation(const struct impact_histogram *histogram, uint64_t count);
int impact_mode(const struct impact_histogram *histogram); /* bars from contact */

#endif
