/* Time and place keep their precision (design, section 4): in the relative form the impact separations are as narrow at
 * t = 10^9 as at 0, and in a box of 1000 diameters as in one of 10; in the absolute form they widen with both. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <stdio.h>
#include <stdlib.h>

#include "measure/impact.h"
#include "scene/scene.h"

enum { SEED = 20140913 };

/* The standard deviation of the exact separation at impact, in ulp of the contact distance, of a gas at density 0.5 in
 * a periodic box that is `length` diameters long and 6 wide, over so many contacts. */
static double spread(enum touchstone_form form, double clock, double length, uint64_t contacts)
{
	static const struct scene_species ball[] = {{1, {1, 1}}};
	struct scene_recipe recipe = {
		.dimensions = 3,
		.particle_count = (size_t)(0.5 * length * 6 * 6),
		.box = {length, 6, 6},
		.boundary_restitution = {TOUCHSTONE_CONSTANT, 1},
		.species_count = 1,
		.species = ball,
		.restitution = {TOUCHSTONE_CONSTANT, 1},
		.velocities = SCENE_MAXWELL,
		.temperature = 1,
		.form = form,
		.clock = clock,
	};
	struct touchstone_scene scene;
	struct scene_error complaint;
	char error[160];
	assert_true(scene_build(&recipe, SEED, &scene, &complaint));
	struct touchstone_engine *engine = touchstone_create(&scene, "binary64", "stable", error);
	assert_non_null(engine);
	struct impact impact;
	impact_begin(&impact, 53);
	struct touchstone_observer observer = {impact_see, &impact};
	struct touchstone_limits limits = {.events = contacts, .time = INFINITY};
	assert_int_equal(touchstone_run(engine, &limits, &observer), TOUCHSTONE_DONE);
	assert_int_equal(impact.count, limits.events);
	struct touchstone_status status;
	touchstone_status(engine, &status);
	assert_true(status.time >= clock);
	double deviation = impact_deviation(&impact.exact, impact.count);
	print_message("%s form, clock %g, length %g: deviation %.3g ulp, mean %.3g\n",
				  form == TOUCHSTONE_RELATIVE ? "relative" : "absolute", clock, length, deviation,
				  impact_mean(&impact.exact, impact.count));
	touchstone_destroy(engine);
	scene_free(&scene);
	return deviation;
}

static void time_keeps_its_precision(void **state)
{
	(void)state;
	uint64_t contacts = getenv("TOUCHSTONE_BRIEF") ? 5000 : 50000;
	double young = spread(TOUCHSTONE_RELATIVE, 0, 10, contacts),
		   absolute = spread(TOUCHSTONE_ABSOLUTE, 0, 10, contacts);
	for (double clock = 1e3; clock <= 1e9; clock *= 1e3) {
		double aged = spread(TOUCHSTONE_RELATIVE, clock + 0.3, 10, contacts);
		assert_true(aged < 1.1 * young && aged > 0.9 * young);
		/* an error in time of half an ulp, at relative speeds of the order of 1 */
		double lost = spread(TOUCHSTONE_ABSOLUTE, clock + 0.3, 10, contacts);
		assert_true(lost > 0.2 * clock && lost < clock + 10 * absolute);
	}
}

static void place_keeps_its_precision(void **state)
{
	(void)state;
	const double few = 1; /* contacts per particle, so that time is too short to matter */
	double spreads[2][2];
	for (int form = 0; form < 2; form++)
		for (int large = 0; large < 2; large++) {
			double length = large ? 1000 : 10, particles = 0.5 * length * 6 * 6;
			enum touchstone_form which = form ? TOUCHSTONE_ABSOLUTE : TOUCHSTONE_RELATIVE;
			spreads[form][large] = spread(which, 0, length, (uint64_t)(few * particles / 2));
		}
	assert_true(spreads[0][1] < 1.3 * spreads[0][0] && spreads[0][1] > 0.7 * spreads[0][0]); /* of only 90 contacts */
	assert_true(spreads[1][1] > 10 * spreads[1][0]);
}

int main(void)
{
	print_message("seed %d\n", SEED);
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(time_keeps_its_precision),
		cmocka_unit_test(place_keeps_its_precision),
	};
	return cmocka_run_group_tests(tests, NULL, NULL);
}
