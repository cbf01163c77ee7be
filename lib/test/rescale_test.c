/* Another unit of time makes no difference: the same events of the same particles, at times that are the same but for
 * their exponent. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <stdio.h>
#include <stdlib.h>

#include "scene/random.h"
#include "scene/scene.h"
#include "touchstone.h"

enum { SEED = 20140902, MOST = 4000 };

static bool brief; /* under sanitizers, where everything takes ten times longer */

/* The events of a run. */
struct course {
	size_t count;
	uint32_t pair[MOST][2];
	double time[MOST];
};

static void see(void *context, struct touchstone_engine *engine, const struct touchstone_event *event)
{
	(void)engine;
	struct course *course = context;
	assert_true(course->count < MOST);
	course->pair[course->count][0] = event->first;
	course->pair[course->count][1] = event->second | (uint32_t)event->kind << 30;
	course->time[course->count++] = event->time;
}

static void go_on(struct touchstone_engine *engine, uint64_t events, struct course *course)
{
	struct touchstone_limits limits = {.events = events, .time = INFINITY};
	touchstone_run(engine, &limits, course ? &(struct touchstone_observer){see, course} : NULL);
}

static struct touchstone_engine *gas(const char *arithmetic, enum touchstone_form form, double restitution, bool walls)
{
	static const struct scene_species sizes[] = {{0.5, {1, 1}}, {0.5, {0.75, 0.5}}};
	struct scene_recipe recipe = {
		.dimensions = 3,
		.particle_count = 108,
		.density = 0.5,
		.boundary = {walls ? SCENE_WALLS : SCENE_PERIODIC},
		.boundary_restitution = {TOUCHSTONE_CONSTANT, 1},
		.species_count = 2,
		.species = sizes,
		.restitution = {TOUCHSTONE_CONSTANT, restitution},
		.positions = SCENE_LATTICE,
		.velocities = SCENE_MAXWELL,
		.temperature = 1,
		.form = form,
		.clock = form == TOUCHSTONE_ABSOLUTE ? 0 : 1000,
	};
	struct touchstone_scene scene;
	struct scene_error complaint;
	char error[160];
	if (!scene_build(&recipe, SEED, &scene, &complaint)) fail_msg("%s %s", complaint.key, complaint.text);
	struct touchstone_engine *engine = touchstone_create(&scene, arithmetic, "stable", error);
	if (!engine) fail_msg("%s", error);
	scene_free(&scene);
	return engine;
}

/* Runs a gas that cools with and without changes of the unit on the way; both must take the same course, to the last
 * bit where `exact`, and otherwise so that times err by a relative `error`. */
static void assert_same_course(const char *arithmetic, enum touchstone_form form, bool walls, bool exact, double error)
{
	struct random_state random = random_seed(SEED);
	struct touchstone_engine *plain = gas(arithmetic, form, 0.8, walls), *scaled = gas(arithmetic, form, 0.8, walls);
	struct course *course = calloc(2, sizeof *course);
	assert_non_null(course);
	int unit = 0;
	for (int leg = 0; leg < 8; leg++) {
		uint64_t events = (brief ? 20 : 300) + random_below(&random, 50);
		course[0].count = course[1].count = 0;
		go_on(plain, events, &course[0]);
		go_on(scaled, events, &course[1]);
		assert_int_equal(course[0].count, events);
		assert_int_equal(course[1].count, events);
		for (size_t e = 0; e < events; e++) {
			assert_memory_equal(course[0].pair[e], course[1].pair[e], sizeof course[0].pair[e]);
			double expected = ldexp(course[0].time[e], -unit), off = fabs(course[1].time[e] - expected);
			if (exact ? off != 0 : !(off <= error * expected))
				fail_msg("%s, leg %d, event %zu: at %a, not %a", arithmetic, leg, e, course[1].time[e], expected);
		}
		int change = (int)random_below(&random, 5) - 1; /* mostly down, as gases cool */
		assert_true(touchstone_rescale(scaled, change));
		unit += change;
	}
	print_message("%s, %s, seed %d: the same course in units of time from 1 to 2^%d\n", arithmetic,
				  form == TOUCHSTONE_ABSOLUTE ? "absolute" : "relative", SEED, unit);
	free(course);
	touchstone_destroy(plain);
	touchstone_destroy(scaled);
}

static void absolute_gas_takes_the_same_course(void **state)
{
	(void)state;
	static const char *const arithmetics[] = {"binary64", "binary32", "short:14", "twin", "mpfr:77", "extended"};
	for (size_t a = 0; a < sizeof arithmetics / sizeof *arithmetics; a++)
		assert_same_course(arithmetics[a], TOUCHSTONE_ABSOLUTE, a % 2, true, 0);
}

/* Where pages keep their length, times are rounded elsewhere; with bits enough nothing comes of that. */
static void relative_gas_takes_the_same_course(void **state)
{
	(void)state;
	assert_same_course("mpfr:900", TOUCHSTONE_RELATIVE, false, false, 0x1p-40);
	assert_same_course("mpfr:900", TOUCHSTONE_RELATIVE, true, false, 0x1p-40);
}

/* There and back again is no change at all: no number was rounded. */
static void change_is_exact(void **state)
{
	(void)state;
	static const char *const arithmetics[] = {"binary64", "binary32", "short:11", "binary128"};
	for (size_t a = 0; a < sizeof arithmetics / sizeof *arithmetics; a++)
		for (int exponent = -9; exponent <= 9; exponent += 3) {
			struct touchstone_status plain, changed;
			struct touchstone_engine *engine[2];
			for (int which = 0; which < 2; which++) {
				engine[which] = gas(arithmetics[a], TOUCHSTONE_RELATIVE, 0.9, true);
				go_on(engine[which], 500, NULL);
			}
			touchstone_rescale(engine[1], exponent);
			for (uint32_t p = 0; p < 108; p++) {
				double position[2][3], velocity[2][3];
				for (int which = 0; which < 2; which++)
					touchstone_state(engine[which], p, position[which], velocity[which]);
				for (int axis = 0; axis < 3; axis++) {
					assert_true(position[1][axis] == position[0][axis]);
					assert_true(velocity[1][axis] == ldexp(velocity[0][axis], exponent));
				}
			}
			touchstone_rescale(engine[1], -exponent);
			for (int which = 0; which < 2; which++) go_on(engine[which], 500, NULL);
			touchstone_status(engine[0], &plain);
			touchstone_status(engine[1], &changed);
			assert_true(plain.digest == changed.digest);
			assert_true(plain.time == changed.time && plain.events == 1000);
			for (int which = 0; which < 2; which++) touchstone_destroy(engine[which]);
		}
}

/* A gas that cools for long. (Much longer, and its mean velocity, which collisions conserve but for rounding, would be
 * all that is left.) */
static void cold_gas_goes_on(void **state)
{
	(void)state;
	struct touchstone_engine *engine = gas("binary64", TOUCHSTONE_RELATIVE, 0.5, false);
	struct touchstone_status status;
	int cooled = 0;
	for (int leg = 0; leg < 60; leg++) {
		double position[3], velocity[3], square = 0;
		go_on(engine, 200, NULL);
		touchstone_status(engine, &status);
		assert_int_equal(status.verdict, TOUCHSTONE_DONE);
		for (uint32_t p = 0; p < 108; p++) {
			touchstone_state(engine, p, position, velocity);
			for (int axis = 0; axis < 3; axis++) square += velocity[axis] * velocity[axis] / (3 * 108);
		}
		for (; square < 0.25; square *= 4, cooled++) assert_true(touchstone_rescale(engine, 1));
	}
	assert_int_equal(status.events, 60 * 200);
	assert_true(cooled > 30);
	print_message("speeds fell by 2^%d, the clock stands at %g\n", cooled, status.time);
	touchstone_destroy(engine);
}

static void what_has_a_scale_is_refused(void **state)
{
	(void)state;
	static const struct touchstone_species ball = {1, 1};
	static const struct touchstone_step well = {1.5, -1};
	static const struct touchstone_potential potential = {{0, 0}, 1, {TOUCHSTONE_CONSTANT, 1}, 1, &well};
	static const struct touchstone_particle particles[2] = {{.position = {-1}}, {.position = {1}}};
	const struct touchstone_scene bare = {.dimensions = 1,
										  .particle_count = 2,
										  .particles = particles,
										  .species_count = 1,
										  .species = &ball,
										  .box = {8},
										  .restitution = {TOUCHSTONE_CONSTANT, 1}};
	struct touchstone_scene scenes[4] = {bare, bare, bare, bare};
	scenes[1].acceleration[0] = -1;
	scenes[2].restitution = (struct touchstone_restitution){TOUCHSTONE_VISCOELASTIC, 0.1};
	scenes[3].potential_count = 1, scenes[3].potentials = &potential;
	for (int s = 0; s < 4; s++) {
		char error[160];
		struct touchstone_engine *engine = touchstone_create(&scenes[s], "binary64", "stable", error);
		if (!engine) fail_msg("%s", error);
		assert_int_equal(touchstone_rescale(engine, 3), s == 0);
		assert_false(touchstone_rescale(engine, 65));
		assert_false(touchstone_rescale(engine, -65));
		touchstone_destroy(engine);
	}
}

int main(void)
{
	brief = getenv("TOUCHSTONE_BRIEF");
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(absolute_gas_takes_the_same_course),
		cmocka_unit_test(relative_gas_takes_the_same_course),
		cmocka_unit_test(change_is_exact),
		cmocka_unit_test(cold_gas_goes_on),
		cmocka_unit_test(what_has_a_scale_is_refused),
	};
	return cmocka_run_group_tests(tests, NULL, NULL);
}
