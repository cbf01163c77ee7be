/* The course of a run: slices of it are the whole, and equilibration is elastic. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <stdio.h>
#include <stdlib.h>

#include "measure/conservation.h"
#include "measure/course.h"
#include "scene/scene.h"
#include "test/gas.h"

enum { SEED = 20140902 };

static bool brief; /* under sanitizers, where everything takes ten times longer */

static struct touchstone_engine *make_gas(struct touchstone_scene *scene, double restitution)
{
	struct scene_recipe recipe = gas(3, 256, 0.4);
	recipe.restitution.coefficient = restitution;
	struct scene_error complaint;
	char error[160] = "";
	if (!scene_build(&recipe, SEED, scene, &complaint)) fail_msg("%s %s", complaint.key, complaint.text);
	struct touchstone_engine *engine = touchstone_create(scene, "binary64", "stable", error);
	if (!engine) fail_msg("%s", error);
	return engine;
}

static struct touchstone_status status_of(const struct touchstone_engine *engine)
{
	struct touchstone_status status;
	touchstone_status(engine, &status);
	return status;
}

/* What a watch is told; it may pull the plug after so many slices. */
struct told {
	uint64_t events, slices, stop_after;
	volatile int stop;
};

static void tell(void *context, uint64_t more, const struct touchstone_status *now)
{
	struct told *told = context;
	told->events += more;
	assert_int_equal(now->events, told->events);
	if (++told->slices == told->stop_after) told->stop = 1;
}

static void slices_do_not_matter(void **state)
{
	(void)state;
	struct touchstone_scene scene[2];
	struct touchstone_limits limits = {.events = brief ? 20000 : 300000, .time = INFINITY};
	struct touchstone_engine *whole = make_gas(&scene[0], 0.99), *sliced = make_gas(&scene[1], 0.99);
	touchstone_run(whole, &limits, NULL);
	struct told told = {.stop_after = 3};
	struct watch watch = {&told.stop, tell, &told};
	assert_false(course_run(sliced, &limits, NULL, &watch)); /* stopped on the way */
	assert_int_equal(told.slices, 3);
	uint64_t events = status_of(sliced).events;
	assert_in_range(events, 1, limits.events - 1);
	assert_false(course_run(sliced, &limits, NULL, &watch)); /* and before it began */
	assert_int_equal(status_of(sliced).events, events);
	told.stop = 0;
	limits.events -= events;
	assert_true(course_run(sliced, &limits, NULL, &watch));
	assert_int_equal(told.events, status_of(whole).events);
	assert_int_equal(status_of(sliced).digest, status_of(whole).digest);
	limits.time = status_of(whole).time + 0.5;
	assert_true(course_run(sliced, &limits, NULL, NULL));
	assert_true(status_of(sliced).time == limits.time);
	touchstone_destroy(whole);
	touchstone_destroy(sliced);
	for (int i = 0; i < 2; i++) scene_free(&scene[i]);
}

/* Elastic whatever the scene says, then not any more; what was counted is forgotten. */
static void equilibration_is_elastic(void **state)
{
	(void)state;
	struct touchstone_scene scene;
	struct touchstone_engine *engine = make_gas(&scene, 0.8);
	struct told told = {0};
	struct watch watch = {&told.stop, tell, &told};
	struct conservation before = conservation_of(&scene, engine);
	assert_true(course_equilibrate(engine, 25, &watch));
	assert_int_equal(told.events, 25 * 256 / 2);
	assert_int_equal(course_events(1, 3), 2); /* two share one, and a half is a whole */
	assert_int_equal(status_of(engine).events, 0);
	struct conservation after = conservation_of(&scene, engine);
	assert_true(fabs(conservation_energy_drift(&before, &after)) < 1e-14);
	assert_true(conservation_momentum_drift(&before, &after) < 1e-14);

	struct touchstone_limits limits = {.events = 1000, .time = INFINITY};
	assert_true(course_run(engine, &limits, NULL, NULL));
	struct conservation later = conservation_of(&scene, engine);
	assert_true(conservation_energy_drift(&after, &later) < -0.1);
	assert_int_equal(status_of(engine).events, 1000);

	told = (struct told){.stop = 1};
	assert_false(course_equilibrate(engine, 25, &watch));
	assert_int_equal(told.events, 0);
	touchstone_destroy(engine);
	scene_free(&scene);
}

int main(void)
{
	brief = getenv("TOUCHSTONE_BRIEF");
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(slices_do_not_matter),
		cmocka_unit_test(equilibration_is_elastic),
	};
	return cmocka_run_group_tests(tests, NULL, NULL);
}
