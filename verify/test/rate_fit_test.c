/* Lines through Poisson counts, drawn from lines that are known. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <gsl/gsl_randist.h>
#include <gsl/gsl_rng.h>
#include <stdio.h>

#include "measure/rate_fit.h"

enum { SEED = 20140902, RUNGS = 8, TRIALS = 2000 };

/* Draws counts on a line, each independent event showing in `burst` counts; returns the line through them. */
static struct rate_fit draw(gsl_rng *random, double exponent, double intercept, unsigned burst)
{
	struct rung_count rung[RUNGS];
	for (int r = 0; r < RUNGS; r++) {
		double bits = 8 + 2 * r, events = 2000 * exp2(0.8 * r);
		double mean = events * exp2(intercept - exponent * bits) / burst;
		rung[r] = (struct rung_count){bits, events, (uint64_t)burst * gsl_ran_poisson(random, mean)};
	}
	return rate_fit(rung, RUNGS, burst);
}

static void lines_come_back(void **state)
{
	(void)state;
	gsl_rng *random = gsl_rng_alloc(gsl_rng_mt19937);
	gsl_rng_set(random, SEED);
	for (unsigned burst = 1; burst <= 3; burst += 2) {
		int held = 0;
		double off = 0, square = 0, error = 0;
		for (int trial = 0; trial < TRIALS; trial++) {
			struct rate_fit fit = draw(random, 1, 2.5, burst);
			struct interval interval;
			double rate = rate_fit_at(&fit, 53, &interval), truth = exp2(2.5 - 53);
			assert_true(interval.low < rate && rate < interval.high);
			held += interval.low <= truth && truth <= interval.high;
			off += (fit.exponent - 1) / TRIALS;
			square += (fit.exponent - 1) * (fit.exponent - 1) / TRIALS;
			error += rate_fit_exponent_error(&fit) / TRIALS;
		}
		print_message("seed %d, bursts of %u: exponent off by %.4f on average and %.4f in spread, %.4f by its own "
					  "account; %.1f %% of the intervals at 53 bits hold\n",
					  SEED, burst, off, sqrt(square), error, 100.0 * held / TRIALS);
		assert_true(fabs(off) < 0.3 * sqrt(square));
		assert_true(error > 0.9 * sqrt(square) && error < 1.5 * sqrt(square));
		assert_true(held > 0.93 * TRIALS);
	}
	gsl_rng_free(random);
}

/* Without scatter the line is the one that was asked for. */
static void exact_counts_give_the_exact_line(void **state)
{
	(void)state;
	const struct rung_count rung[] = {{10, 1024e3, 1000}, {11, 2048e3, 1000}, {14, 16384e3, 1000}, {20, 0, 0}};
	struct rate_fit fit = rate_fit(rung, 4, 1);
	assert_true(fabs(fit.exponent - 1) < 1e-12 && fabs(fit.intercept) < 1e-10);
	assert_int_equal(fit.rungs, 3);
	assert_true(fit.dispersion == 1);
	struct interval interval;
	assert_true(fabs(rate_fit_at(&fit, 20, &interval) * 0x1p20 - 1) < 1e-10);
}

/* A rung on which nothing was seen counts as well. */
static void empty_rungs_pull_the_line_down(void **state)
{
	(void)state;
	const struct rung_count rung[] = {{8, 1000, 100}, {10, 1000, 30}, {24, 1e9, 0}};
	struct rate_fit without = rate_fit(rung, 2, 1), with = rate_fit(rung, 3, 1);
	assert_true(with.exponent > without.exponent);
	assert_true(isnan(rate_fit(rung, 1, 1).exponent));
	assert_true(isnan(rate_fit(rung, 0, 1).exponent));
}

/* Counts that no line fits have errors to match. */
static void scatter_widens_the_errors(void **state)
{
	(void)state;
	const struct rung_count good[] = {{10, 1e5, 1000}, {11, 1e5, 500}, {12, 1e5, 250}, {13, 1e5, 125}};
	const struct rung_count bad[] = {{10, 1e5, 1000}, {11, 1e5, 800}, {12, 1e5, 50}, {13, 1e5, 200}};
	struct rate_fit straight = rate_fit(good, 4, 1), crooked = rate_fit(bad, 4, 1);
	assert_true(straight.dispersion == 1 && crooked.dispersion > 20);
	assert_true(rate_fit_exponent_error(&crooked) > 4 * rate_fit_exponent_error(&straight));
}

int main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(lines_come_back),
		cmocka_unit_test(exact_counts_give_the_exact_line),
		cmocka_unit_test(empty_rungs_pull_the_line_down),
		cmocka_unit_test(scatter_widens_the_errors),
	};
	return cmocka_run_group_tests(tests, NULL, NULL);
}
