/* Repeated events and entangled pairs, gases kept warm, and points measured in pieces. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "figure/gas_points.h"
#include "measure/kept_gas.h"
#include "scene/random.h"
#include "scene/scene.h"
#include "test/folder.h"

enum { SEED = 20140902, BALLS = 5, MOST = 2000 };

static bool brief; /* under sanitizers, where everything takes ten times longer */

/* All events of a run, and what is counted of them. */
struct witness {
	struct mishaps seen;
	struct touchstone_event event[MOST];
	size_t count;
};

static void see(void *context, struct touchstone_engine *engine, const struct touchstone_event *event)
{
	struct witness *witness = context;
	assert_true(witness->count < MOST);
	witness->event[witness->count++] = *event;
	mishaps_see(&witness->seen, engine, event);
}

static bool takes_part(const struct touchstone_event *event, uint32_t particle)
{
	return event->first == particle || (event->kind == TOUCHSTONE_CONTACT && event->second == particle);
}

/* Whether the event before this one of either of its two was theirs. */
static bool repeats(const struct witness *witness, size_t number)
{
	const struct touchstone_event *event = &witness->event[number];
	if (event->kind != TOUCHSTONE_CONTACT) return false;
	while (number-- > 0) {
		const struct touchstone_event *before = &witness->event[number];
		bool first = takes_part(before, event->first), second = takes_part(before, event->second);
		if (first || second) return first && second;
	}
	return false;
}

/* Balls on a line between walls, where no image can be met. */
static void repeated_events_are_found(void **state)
{
	(void)state;
	struct random_state random = random_seed(SEED);
	struct witness *witness = calloc(1, sizeof *witness);
	assert_non_null(witness);
	uint64_t repeated = 0;
	for (int trial = 0; trial < 40; trial++) {
		static const struct touchstone_species ball = {1, 1};
		struct touchstone_wall walls[2] = {{{-4}, {1}, {TOUCHSTONE_CONSTANT, 1}},
										   {{4}, {-1}, {TOUCHSTONE_CONSTANT, 1}}};
		struct touchstone_particle particles[BALLS] = {{.position = {-3}}};
		for (int p = 0; p < BALLS; p++) {
			particles[p].position[0] = -3 + 1.5 * p;
			particles[p].velocity[0] = random_normal(&random);
		}
		struct touchstone_scene scene = {.dimensions = 1,
										 .particle_count = BALLS,
										 .particles = particles,
										 .species_count = 1,
										 .species = &ball,
										 .wall_count = 2,
										 .walls = walls,
										 .box = {8},
										 .restitution = {TOUCHSTONE_CONSTANT, 0}};
		char error[160];
		struct touchstone_engine *engine = touchstone_create(&scene, "short:6", "stable", error);
		if (!engine) fail_msg("%s", error);
		witness->count = 0;
		assert_true(mishaps_begin(&witness->seen, BALLS, 6));
		struct touchstone_limits limits = {.events = MOST, .time = INFINITY};
		touchstone_run(engine, &limits, &(struct touchstone_observer){see, witness});
		uint64_t expected = 0;
		for (size_t number = 0; number < witness->count; number++) expected += repeats(witness, number);
		assert_int_equal(witness->seen.repeated, expected);
		repeated += expected;
		mishaps_end(&witness->seen);
		touchstone_destroy(engine);
	}
	print_message("%d repeated events of %d balls on a line, seed %d\n", (int)repeated, BALLS, SEED);
	assert_true(repeated > 40);
	free(witness);
}

/* Two balls in a periodic box of their own meet again and again, by way of their images: nothing is wrong with that. */
static void images_are_no_repetition(void **state)
{
	(void)state;
	static const struct touchstone_species ball = {1, 1};
	static const struct touchstone_particle particles[2] = {{.position = {-1}, .velocity = {1}},
															{.position = {1}, .velocity = {-1}}};
	const struct touchstone_scene scene = {.dimensions = 1,
										   .particle_count = 2,
										   .particles = particles,
										   .species_count = 1,
										   .species = &ball,
										   .periodic = {true},
										   .box = {8},
										   .restitution = {TOUCHSTONE_CONSTANT, 1}};
	char error[160];
	struct touchstone_engine *engine = touchstone_create(&scene, "binary64", "stable", error);
	if (!engine) fail_msg("%s", error);
	struct mishaps seen;
	assert_true(mishaps_begin(&seen, 2, 53));
	struct touchstone_limits limits = {.events = 100, .time = INFINITY};
	touchstone_run(engine, &limits, &(struct touchstone_observer){mishaps_see, &seen});
	assert_int_equal(seen.three_body.contacts, 100);
	assert_int_equal(seen.repeated, 0);
	mishaps_end(&seen);
	touchstone_destroy(engine);
}

/* Of two pairs that overlap one is parting at a snail's pace. */
static void entangled_pairs_are_found(void **state)
{
	(void)state;
	static const struct touchstone_species ball = {1, 1};
	static const struct touchstone_particle particles[5] = {{.position = {-6.25}, .velocity = {-0x1p-20}},
															{.position = {-5.5}, .velocity = {0x1p-20}},
															{.position = {-0.375}, .velocity = {-0.25}},
															{.position = {0.375}, .velocity = {0.25}},
															{.position = {7}}};
	const struct touchstone_scene scene = {.dimensions = 1,
										   .particle_count = 5,
										   .particles = particles,
										   .species_count = 1,
										   .species = &ball,
										   .box = {32},
										   .restitution = {TOUCHSTONE_CONSTANT, 1}};
	char error[160];
	struct touchstone_engine *engine = touchstone_create(&scene, "binary64", "stable", error);
	if (!engine) fail_msg("%s", error);
	struct mishaps seen;
	assert_true(mishaps_begin(&seen, 5, 53));
	for (int look = 0; look < 4; look++) {
		mishaps_look(&seen, engine);
		assert_int_equal(seen.entangled, look);
		touchstone_run(engine, &(struct touchstone_limits){.events = 100, .time = look + 1}, NULL);
	}
	mishaps_end(&seen);
	touchstone_destroy(engine);
}

/* ------------------------------------------------------------------ gases kept warm */

static struct kept_setup gas(double restitution, double density, const char *arithmetic, uint64_t events)
{
	return (struct kept_setup){
		.particles = 108,
		.density = density,
		.restitution = restitution,
		.arithmetic = arithmetic,
		.method = "stable",
		.equilibrate = 5,
		.settle = 5,
		.events = events,
		.starts = 3,
		.halvings = 1,
		.seed = SEED,
	};
}

static void keep(const struct kept_setup *setup, struct kept_gas *kept)
{
	char error[320];
	if (!kept_gas_run(setup, NULL, kept, error)) fail_msg("%s", error);
	print_message("restitution %g, density %g, %s: %d contacts, %d of three, %d repeated, cooled by 2^%d, recentred %d "
				  "times, %d start states, %d collapsed\n",
				  setup->restitution, setup->density, setup->arithmetic, (int)kept->mishaps.three_body.contacts,
				  (int)kept->mishaps.three_body.events, (int)kept->mishaps.repeated, (int)kept->cooled,
				  (int)kept->recentred, (int)kept->starts, (int)kept->collapsed);
	kept_gas_free(kept);
}

/* A gas that does not cool is left alone: what is counted is what a plain run of it shows. */
static void elastic_gas_is_left_alone(void **state)
{
	(void)state;
	static const struct scene_species ball = {1, {1, 1}};
	struct kept_setup setup = gas(1, 0.5, "short:10", brief ? 1000 : 5000);
	struct kept_gas kept;
	setup.settle = 0;
	keep(&setup, &kept);
	const struct scene_recipe recipe = {.dimensions = 3,
										.particle_count = setup.particles,
										.density = setup.density,
										.boundary_restitution = {TOUCHSTONE_CONSTANT, 1},
										.species_count = 1,
										.species = &ball,
										.restitution = {TOUCHSTONE_CONSTANT, 1},
										.velocities = SCENE_MAXWELL,
										.temperature = 1};
	struct touchstone_scene scene;
	struct scene_error complaint;
	char error[160];
	if (!scene_build(&recipe, SEED, &scene, &complaint)) fail_msg("%s %s", complaint.key, complaint.text);
	struct touchstone_engine *engine = touchstone_create(&scene, setup.arithmetic, "stable", error);
	if (!engine) fail_msg("%s", error);
	course_equilibrate(engine, setup.equilibrate, NULL);
	struct three_body plain;
	assert_true(three_body_begin(&plain, setup.particles));
	struct conservation begin = conservation_of(&scene, engine);
	struct touchstone_limits limits = {.events = setup.events, .time = INFINITY};
	touchstone_run(engine, &limits, &(struct touchstone_observer){three_body_see, &plain});
	struct conservation end = conservation_of(&scene, engine);
	assert_int_equal(kept.recentred, 0);
	assert_int_equal(kept.mishaps.three_body.contacts, plain.contacts);
	assert_int_equal(kept.mishaps.three_body.overlapping, plain.overlapping);
	assert_int_equal(kept.mishaps.three_body.events, plain.events);
	assert_int_equal(kept.mishaps.three_body.encounters, plain.encounters);
	assert_true(plain.events > 0 && kept.mishaps.three_body.deepest == plain.deepest);
	double drift = conservation_energy_drift(&begin, &end); /* in one, and in many small parts */
	assert_true(fabs(log1p(drift) - kept.drift) < 0.1 * fabs(drift) + 1e-3);
	three_body_end(&plain);
	touchstone_destroy(engine);
	scene_free(&scene);
}

/* Far beyond where speeds would have left the range of binary32. */
static void inelastic_gas_goes_on(void **state)
{
	(void)state;
	struct kept_setup setup = gas(0.5, 0.1, "binary32", brief ? 5000 : 80000);
	struct kept_gas kept, again;
	keep(&setup, &kept);
	assert_int_equal(kept.mishaps.three_body.contacts, setup.events);
	assert_int_equal(kept.starts, 1);
	assert_true(kept.cooled > (brief ? 10 : 160) && (brief || kept.recentred > 0));
	keep(&setup, &again);
	kept.mishaps.three_body.trio = again.mishaps.three_body.trio = NULL;
	assert_memory_equal(&kept.mishaps.three_body, &again.mishaps.three_body, sizeof kept.mishaps.three_body);
	assert_int_equal(kept.cooled, again.cooled);
}

/* How often the unit of time changes has no say in the rate: the two counts differ by less than five times their
 * spread, events coming in bursts of two or so. */
static void unit_of_time_does_not_matter(void **state)
{
	(void)state;
	struct kept_setup setup = gas(0.5, 0.5, "short:12", brief ? 3000 : 60000);
	struct kept_gas often, seldom;
	keep(&setup, &often);
	setup.halvings = 5;
	keep(&setup, &seldom);
	double one = (double)often.mishaps.three_body.events, other = (double)seldom.mishaps.three_body.events;
	assert_true(one + other > (brief ? 0 : 100));
	assert_true(fabs(one - other) <= 5 * sqrt(2.5 * (one + other)));
}

static void collapse_is_left_out(void **state)
{
	(void)state;
	struct kept_setup setup = gas(0.1, 1, "binary32", 50000);
	struct kept_gas kept;
	keep(&setup, &kept);
	assert_int_equal(kept.starts, 3);
	assert_int_equal(kept.collapsed, 3);
	assert_true(kept.mishaps.three_body.contacts < setup.events && kept.halted + kept.diverged == 0);
}

static void what_cannot_be_is_refused(void **state)
{
	(void)state;
	struct kept_gas kept;
	char error[320];
	volatile int stop = 1;
	const struct watch watch = {.stop = &stop};
	struct kept_setup setup = gas(1, 0.5, "binary65", 1000);
	assert_false(kept_gas_run(&setup, NULL, &kept, error));
	assert_non_null(strstr(error, "binary65"));
	kept_gas_free(&kept);
	setup = gas(1, 3, "binary64", 1000);
	assert_false(kept_gas_run(&setup, NULL, &kept, error));
	assert_non_null(strstr(error, "density"));
	kept_gas_free(&kept);
	setup = gas(1, 0.5, "binary64", 1000000);
	assert_false(kept_gas_run(&setup, &watch, &kept, error));
	assert_string_equal(error, "");
	kept_gas_free(&kept);
}

/* ------------------------------------------------------------------ points in pieces */

/* Stops a campaign once half of it is done. */
struct stopper {
	volatile int stop;
};

static void stop_halfway(void *context, double part)
{
	struct stopper *stopper = context;
	if (part > 0.5) stopper->stop = 1;
}

static void points_do_not_depend_on_how(void **state)
{
	(void)state;
	enum { POINTS = 6 };
	struct gas_point points[POINTS];
	struct gas_tally plain[POINTS], other[POINTS];
	for (int p = 0; p < POINTS; p++)
		points[p] = (struct gas_point){.density = 0.2 + 0.1 * p,
									   .restitution = p % 2 ? 1 : 0.6,
									   .arithmetic = "short:12",
									   .bits = 12,
									   .particles = 108,
									   .events = p == 3 ? 0 : 2000};
	char error[512];
	char *folder = folder_new();
	bool stopped;
	struct stopper stopper = {0};
	struct figure_setup setup = {.seed = SEED, .threads = 1};
	assert_true(gas_points_measure("trial", &setup, points, POINTS, plain, &stopped, error));
	assert_false(stopped);
	assert_int_equal(plain[3].three_body.contacts, 0);
	setup = (struct figure_setup){.seed = SEED,
								  .threads = 2,
								  .folder = folder,
								  .stop = &stopper.stop,
								  .progress = stop_halfway,
								  .context = &stopper};
	assert_true(gas_points_measure("trial", &setup, points, POINTS, other, &stopped, error));
	assert_true(stopped);
	stopper.stop = 0;
	setup.progress = NULL;
	assert_true(gas_points_measure("trial", &setup, points, POINTS, other, &stopped, error));
	assert_false(stopped);
	for (int p = 0; p < POINTS; p++) {
		assert_true(p == 3 || gas_lasted(&other[p]));
		plain[p].seconds = other[p].seconds = 0;
		assert_memory_equal(&plain[p], &other[p], sizeof plain[p]);
	}
	folder_remove(folder);
}

int main(void)
{
	brief = getenv("TOUCHSTONE_BRIEF");
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(repeated_events_are_found),   cmocka_unit_test(images_are_no_repetition),
		cmocka_unit_test(entangled_pairs_are_found),   cmocka_unit_test(elastic_gas_is_left_alone),
		cmocka_unit_test(inelastic_gas_goes_on),       cmocka_unit_test(unit_of_time_does_not_matter),
		cmocka_unit_test(collapse_is_left_out),        cmocka_unit_test(what_cannot_be_is_refused),
		cmocka_unit_test(points_do_not_depend_on_how),
	};
	return cmocka_run_group_tests(tests, NULL, NULL);
}
