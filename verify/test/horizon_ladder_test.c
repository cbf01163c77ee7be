/* The slope of the horizon against tangent vectors. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <stdlib.h>
#include <string.h>

#include "measure/horizon_ladder.h"
#include "measure/start_state.h"
#include "scene/random.h"

enum { SEED = 19961101, SPHERES = 32, MOST_STARTS = 12 };

static bool brief; /* under sanitizers, where everything takes ten times longer */
static char error[160];

static struct touchstone_scene gas(uint64_t seed, double box)
{
	struct touchstone_scene scene;
	struct scene_recipe recipe = start_spheres(SPHERES, 0);
	for (int axis = 0; axis < 3; axis++) recipe.box[axis] = box;
	if (!start_scene(&recipe, seed, 20, NULL, &scene, error)) fail_msg("%s", error);
	return scene;
}

/* Each bit is good for ln 2 / lambda events per particle: lambda from there, and from tangent vectors in the same gas,
 * must be one number. Four standard errors are passed once in 16 000 tries; the seed is fixed. */
static void the_slope_is_the_lyapunov_exponent(void **state)
{
	(void)state;
	static const char *const names[] = {"mpfr:30", "mpfr:40", "binary64", "mpfr:70", "mpfr:90", "binary128"};
	enum { RUNGS = sizeof names / sizeof *names };
	const struct horizon_ladder ladder = {RUNGS, names, "mpfr:200"};
	const struct touchstone_limits limits = {.events = UINT64_MAX, .time = INFINITY};
	double bits[RUNGS], slope[MOST_STARTS], grown[MOST_STARTS];
	size_t starts = brief ? 4 : MOST_STARTS;
	for (int rung = 0; rung < RUNGS; rung++) bits[rung] = horizon_bits(names[rung], error);
	for (size_t s = 0; s < starts; s++) {
		struct touchstone_scene scene = gas(SEED + s, 4);
		struct horizon horizon[RUNGS];
		struct tangent_growth growth;
		double events[RUNGS];
		if (!horizon_ladder_climb(&ladder, &scene, &limits, NULL, horizon, error)) fail_msg("%s", error);
		for (int rung = 0; rung < RUNGS; rung++) {
			assert_true(horizon[rung].differ);
			events[rung] = horizon[rung].per_particle;
		}
		slope[s] = fit_line(bits, events, RUNGS).slope;
		assert_true(tangent_grow(&scene, SEED + s, 30, 300, NULL, &growth, error));
		assert_true(fabs(growth.per_particle - 300) < 1);
		grown[s] = growth.growth / growth.per_particle;
		scene_free(&scene);
	}
	struct estimate one = estimate_exponent(estimate_mean(slope, starts)), other = estimate_mean(grown, starts);
	print_message("from the slope %.4f +- %.4f, from tangent vectors %.4f +- %.4f\n", one.value, one.error, other.value,
				  other.error);
	assert_true(fabs(one.value - other.value) < 4 * hypot(one.error, other.error));
	assert_true(one.error < 0.1 * one.value && other.error < 0.1 * other.value);
}

/* In which direction a tangent vector begins is soon forgotten. */
static void its_first_direction_does_not_matter(void **state)
{
	(void)state;
	struct touchstone_scene scene = gas(SEED, 5);
	struct tangent_growth growth[2];
	for (uint64_t k = 0; k < 2; k++) assert_true(tangent_grow(&scene, SEED + k, 60, 60, NULL, &growth[k], error));
	assert_true(growth[0].time == growth[1].time);
	assert_true(fabs(growth[0].growth - growth[1].growth) < 1e-3 * growth[0].growth);
	scene_free(&scene);
}

static void estimates_have_the_errors_they_should(void **state)
{
	(void)state;
	struct random_state random = random_seed(SEED);
	enum { TRIALS = 2000, VALUES = 16 };
	double values[VALUES];
	int within = 0;
	for (int trial = 0; trial < TRIALS; trial++) {
		for (int k = 0; k < VALUES; k++) values[k] = 3 + random_normal(&random);
		struct estimate estimate = estimate_mean(values, VALUES);
		within += fabs(estimate.value - 3) < 2.131 * estimate.error; /* Student's law, 15 degrees of freedom: 95 % */
		struct estimate exponent = estimate_exponent(estimate);
		assert_true(fabs(exponent.value * estimate.value - log(2)) < 1e-14);
		assert_true(fabs(exponent.error / exponent.value - estimate.error / estimate.value) < 1e-14);
	}
	assert_true(abs(within - TRIALS * 95 / 100) < 5 * sqrt(TRIALS * 0.95 * 0.05));
	assert_true(isnan(estimate_mean(values, 1).error) && isnan(estimate_mean(values, 0).value));
}

static void a_watch_stops_it(void **state)
{
	(void)state;
	static const char *const names[] = {"binary32"};
	const volatile int stop = 1;
	const struct watch watch = {.stop = &stop};
	const struct touchstone_limits limits = {.events = 1000, .time = INFINITY};
	struct touchstone_scene scene = gas(SEED, 4);
	struct horizon horizon;
	struct tangent_growth growth;
	const struct horizon_ladder ladder = {1, names, "binary64"}, wrong = {1, names, "short:12"};
	assert_true(horizon_ladder_climb(&ladder, &scene, &limits, &watch, &horizon, error));
	assert_true(horizon.stopped);
	assert_false(tangent_grow(&scene, SEED, 10, 10, &watch, &growth, error));
	assert_string_equal(error, "");
	assert_false(horizon_ladder_climb(&wrong, &scene, &limits, NULL, &horizon, error));
	assert_non_null(strstr(error, "short:12 carries 12 bits"));
	scene_free(&scene);
}

int main(void)
{
	brief = getenv("TOUCHSTONE_BRIEF");
	print_message("seed %d\n", SEED);
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(the_slope_is_the_lyapunov_exponent),
		cmocka_unit_test(its_first_direction_does_not_matter),
		cmocka_unit_test(estimates_have_the_errors_they_should),
		cmocka_unit_test(a_watch_stops_it),
	};
	return cmocka_run_group_tests(tests, NULL, NULL);
}
