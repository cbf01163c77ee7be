/* What repeated measurements say together. */
#ifndef VERIFY_SPREAD_H
#define VERIFY_SPREAD_H

#include <stddef.h>

enum { SAMPLE_MOST = 64 };

/* One value for each repetition; NaN where that one came to nothing. Begins as zeros. */
struct sample {
	size_t count;
	double value[SAMPLE_MOST];
};

/* Adds a value; beyond SAMPLE_MOST it is dropped. */
void sample_add(struct sample *sample, double value);

/* The median, and the first and third quartile: what a machine that is busy now and then does to a few repetitions does
 * not move them. All NaN when there is nothing. */
struct spread {
	double median, low, high;
};
struct spread spread_of(const struct sample *sample);

/* Of a number that is known without measuring twice. */
struct spread spread_exact(double value);

/* Of the quotients, repetition by repetition: whatever slowed the machine for a while slowed both. */
struct spread spread_of_ratio(const struct sample *over, const struct sample *under);

#endif
