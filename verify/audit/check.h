/* Measuring what one check of a suite asks for. */
#ifndef VERIFY_AUDIT_CHECK_H
#define VERIFY_AUDIT_CHECK_H

#include "audit/suite.h"

/* What was found of one measure; `other` is its digest in the arithmetic of same_in, "" where there is none. */
struct check_value {
	struct measurement measured;
	char other[MEASURE_WORDS];
};

/* The first seed a check runs with in an audit of this seed: two audits with different seeds have none in common. */
uint64_t check_seed(const struct suite_check *check, uint64_t audit_seed);

/* Measures: one value for each measure of the check. `share` of it only, when it is to be known how long it takes:
 * then with one seed, and the values are good for nothing. False when it was interrupted, with `error` empty, or could
 * not be done. */
bool check_run(const struct suite_check *check, uint64_t seed, double share, int threads, struct check_value *values,
			   char error[STORE_ERROR]);

/* How many seconds a check is going to take, by trying a small part of it; NaN when that cannot be tried. */
double check_estimate(const struct suite_check *check, uint64_t seed, int threads);

/* For each kind, see above. */
bool check_scene(const struct suite_check *check, uint64_t seed, double share, int threads, struct check_value *values,
				 char error[STORE_ERROR]);
bool check_grade(const struct suite_check *check, uint64_t seed, double share, int threads, struct check_value *values,
				 char error[STORE_ERROR]);
bool check_figure(const struct suite_check *check, uint64_t seed, int threads, struct check_value *values,
				  char error[STORE_ERROR]);

#endif
