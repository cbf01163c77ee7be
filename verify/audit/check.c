#include "audit/check.h"

#include <math.h>
#include <stdlib.h>

#include "command/progress.h"

static const double tried[2] = {0.005, 0.02}; /* shares of a check that tell how long it takes */

uint64_t check_seed(const struct suite_check *check, uint64_t audit_seed)
{
	return check->own_seed ? check->seed : audit_seed * check->seeds;
}

bool check_run(const struct suite_check *check, uint64_t seed, double share, int threads, struct check_value *values,
			   char error[STORE_ERROR])
{
	*error = '\0';
	switch (check->kind) {
	case CHECK_SCENE:
		return check_scene(check, seed, share, threads, values, error);
	case CHECK_GRADE:
		return check_grade(check, seed, share, threads, values, error);
	default:
		return check_figure(check, seed, threads, values, error);
	}
}

/* Seconds that a share of the check takes; NaN when it cannot be tried. */
static double try(const struct suite_check *check, uint64_t seed, double share, int threads, struct check_value *values)
{
	char error[STORE_ERROR];
	double began = progress_clock();
	bool done = check_run(check, seed, share, threads, values, error);
	return done ? progress_clock() - began : NAN;
}

double check_estimate(const struct suite_check *check, uint64_t seed, int threads)
{
	struct check_value *values = calloc(check->measure_count, sizeof *values);
	double seconds = NAN;
	if (values && check->kind != CHECK_FIGURE) {
		double small = try(check, seed, tried[0], threads, values), large = try(check, seed, tried[1], threads, values);
		double whole =
			fmax(0, large - small) / (tried[1] - tried[0]); /* what grows with the share; the rest does not */
		seconds = (small + whole) * (double)check->seeds;
		if (isnan(large)) seconds = NAN;
	}
	free(values);
	return seconds;
}
