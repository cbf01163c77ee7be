#include "measure/interval.h"

#include <gsl/gsl_cdf.h>
#include <gsl/gsl_fit.h>
#include <math.h>

static const double tail = 0.025, quantile = 1.959963984540054; /* of the normal law, at 1 - tail */

/* Counts from which the inverse of the exact law, which then converges slowly or not at all, is replaced by its limit;
 * the ends differ by less than a thousandth of the width. */
static const uint64_t many = 10000;

/* The x between 0 and `most` at which a law has `below` to its left, by bisection: GSL's own inverses fail for large
 * counts, in silence or not at all politely. */
static double quantile_of(double (*law)(double x, double a, double b), double a, double b, double below, double most)
{
	double low = 0, high = most;
	for (int step = 0; step < 200; step++) {
		double middle = low > 0 ? sqrt(low * high) : high / 1024; /* small ones to all their digits */
		if (middle <= low || middle >= high) break;
		if (law(middle, a, b) < below)
			low = middle;
		else
			high = middle;
	}
	return high;
}

struct interval interval_of_proportion(uint64_t hits, uint64_t trials)
{
	double k = (double)hits, n = (double)trials;
	if (trials == 0) return (struct interval){0, 1};
	if (hits > many && trials - hits > many) { /* Wilson's score interval */
		double p = k / n, z = quantile * quantile / n, middle = (p + z / 2) / (1 + z);
		double half = sqrt(p * (1 - p) * z + z * z / 4) / (1 + z);
		return (struct interval){middle - half, middle + half};
	}
	return (struct interval){
		hits == 0 ? 0 : quantile_of(gsl_cdf_beta_P, k, n - k + 1, tail, 1),
		hits == trials ? 1 : quantile_of(gsl_cdf_beta_P, k + 1, n - k, 1 - tail, 1),
	};
}

struct interval interval_of_rate(uint64_t hits, double exposure)
{
	double k = (double)hits;
	if (hits > many) { /* the cube of a nearly normal variable (Wilson and Hilferty 1931) */
		double low = 1 - 1 / (9 * k) - quantile / (3 * sqrt(k));
		double high = 1 - 1 / (9 * (k + 1)) + quantile / (3 * sqrt(k + 1));
		return (struct interval){k * low * low * low / exposure, (k + 1) * high * high * high / exposure};
	}
	return (struct interval){
		hits == 0 ? 0 : quantile_of(gsl_cdf_gamma_P, k, 1, tail, k + 1) / exposure,
		quantile_of(gsl_cdf_gamma_P, k + 1, 1, 1 - tail, 2 * k + 20) / exposure,
	};
}

struct line_fit fit_line(const double *x, const double *y, size_t count)
{
	double intercept, slope, c00, c01, c11, squares;
	gsl_fit_linear(x, 1, y, 1, count, &intercept, &slope, &c00, &c01, &c11, &squares);
	return (struct line_fit){slope, intercept, sqrt(c11)};
}
