/* Intervals against their definition, and against each other where one formula takes over from another. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <gsl/gsl_cdf.h>

#include "measure/interval.h"

/* At each end of an exact interval the tail beyond what was seen has probability 0.025. */
static void ends_have_the_stated_tails(void **state)
{
	(void)state;
	static const uint64_t counts[] = {0, 1, 2, 7, 40, 350, 4000, 9000};
	for (size_t i = 0; i < sizeof counts / sizeof *counts; i++) {
		uint64_t k = counts[i];
		struct interval rate = interval_of_rate(k, 2);
		if (k) assert_float_equal(gsl_cdf_poisson_Q((unsigned)k - 1, 2 * rate.low), 0.025, 1e-6);
		assert_float_equal(gsl_cdf_poisson_P((unsigned)k, 2 * rate.high), 0.025, 1e-6);
		for (uint64_t n = k ? k : 1; n < 100 * k + 1000; n = 3 * n + 1) {
			struct interval part = interval_of_proportion(k, n);
			assert_true(part.low <= (double)k / (double)n && (double)k / (double)n <= part.high);
			if (n > 4000) continue;
			if (k) assert_float_equal(gsl_cdf_binomial_Q((unsigned)k - 1, part.low, (unsigned)n), 0.025, 1e-6);
			if (k < n) assert_float_equal(gsl_cdf_binomial_P((unsigned)k, part.high, (unsigned)n), 0.025, 1e-6);
		}
	}
}

static void formulas_meet(void **state)
{
	(void)state;
	struct interval a = interval_of_rate(10000, 1), b = interval_of_rate(10001, 1);
	assert_float_equal(b.low - a.low, 1, 0.6);
	assert_float_equal(b.high - a.high, 1, 0.6);
	for (uint64_t n = 25000; n < 100000; n += 25000) {
		struct interval exact = interval_of_proportion(10000, n), wilson = interval_of_proportion(10001, n);
		double width = exact.high - exact.low;
		assert_true(fabs(wilson.low - exact.low - 1.0 / (double)n) < 0.005 * width);
		assert_true(fabs(wilson.high - exact.high - 1.0 / (double)n) < 0.005 * width);
	}
	struct interval huge = interval_of_proportion(UINT64_C(6751333), UINT64_C(13500000));
	assert_true(fabs(huge.high - huge.low - 2 * 1.96 * 0.5 / sqrt(13.5e6)) < 1e-7);
}

static void lines_are_fitted(void **state)
{
	(void)state;
	double x[] = {1, 2, 4, 8}, y[4];
	for (int i = 0; i < 4; i++) y[i] = 3 - 0.5 * x[i];
	struct line_fit fit = fit_line(x, y, 4);
	assert_true(fabs(fit.slope + 0.5) < 1e-12);
	assert_true(fabs(fit.intercept - 3) < 1e-12);
	assert_true(fit.slope_error < 1e-7);
}

int main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(ends_have_the_stated_tails),
		cmocka_unit_test(formulas_meet),
		cmocka_unit_test(lines_are_fitted),
	};
	return cmocka_run_group_tests(tests, NULL, NULL);
}
