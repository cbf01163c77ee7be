/* Exact intervals: a rate is never printed without one. */
#ifndef VERIFY_INTERVAL_H
#define VERIFY_INTERVAL_H

#include <stddef.h>
#include <stdint.h>

struct interval {
	double low, high;
};

/* Of a proportion, `hits` of `trials`, with 95 % confidence (Clopper and Pearson 1934). */
struct interval interval_of_proportion(uint64_t hits, uint64_t trials);

/* Of a rate per unit, `hits` in `exposure` units, with 95 % confidence (Garwood 1936: exact for Poisson counts). */
struct interval interval_of_rate(uint64_t hits, double exposure);

/* A straight line y = intercept + slope x through points, by least squares, and the standard error of the slope. */
struct line_fit {
	double slope, intercept, slope_error;
};
struct line_fit fit_line(const double *x, const double *y, size_t count);

#endif
