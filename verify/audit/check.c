#include "audit/check.h"

#include <math.h>
#include <stdlib.h>

#include "command/progress.h"

static const double tried = 0.02; /* share of a check that tells how long it takes */

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

double check_estimate(const struct suite_check *check, uint64_t seed, int threads)
{
	char error[STORE_ERROR];
	struct check_value *values = calloc(check->measure_count, sizeof *values);
	double began = progress_clock();
	bool known = values && check->kind != CHECK_FIGURE && check_run(check, seed, tried, threads, values, error);
	double seconds = progress_clock() - began;
	free(values);
	return known ? seconds / tried * (double)check->seeds : NAN;
}
