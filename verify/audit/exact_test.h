/* Whether two things differ, exactly: the chance that they come out at least that far apart, that way, though nothing
 * differs. Nothing is assumed of sizes; `WORSE_EITHER` doubles the smaller of both chances. */
#ifndef VERIFY_AUDIT_EXACT_TEST_H
#define VERIFY_AUDIT_EXACT_TEST_H

#include <stddef.h>

#include "audit/measurement.h"

/* Two proportions, given all hits together: the hypergeometric law (Fisher 1935). Up to 2^53 trials. */
double test_proportions(double hits, double trials, double reference_hits, double reference_trials,
						enum measure_worse worse);

/* Two rates of Poisson counts, given all hits together: the binomial law (Przyborowski and Wilenski 1940). */
double test_rates(double hits, double exposure, double reference_hits, double reference_exposure,
				  enum measure_worse worse);

/* Two sets of values, of whatever law, by their ranks, ties and all (Wilcoxon 1945). The law of the rank sum is counted
 * out; where nothing is to be seen, within one standard deviation, the normal law has to do. 1 when there is no memory.
 */
double test_ranks(const double *values, size_t count, const double *reference, size_t reference_count,
				  enum measure_worse worse);

#endif
