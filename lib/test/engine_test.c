/* One engine: the same scene gives the same events in every arithmetic of the same precision, however it is searched
 * and on however many threads; and what it does is what the physics says. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "scene/random.h"
#include "scene/scene.h"
#include "test/gas.h"
#include "test/long_double.h"
#include "touchstone.h"

enum { SEED = 20140902 };

static bool brief; /* under sanitizers, where everything takes ten times longer */

static const struct scene_species two_sizes[] = {{0.5, {1, 1}}, {0.5, {0.6, 0.3}}};

/* Runs a recipe; the caller looks at the status. */
static struct touchstone_status run(const struct scene_recipe *recipe, const char *arithmetic, const char *method,
									uint64_t events, double time)
{
	struct touchstone_scene scene;
	struct scene_error complaint;
	char error[160] = "";
	if (!scene_build(recipe, SEED, &scene, &complaint)) fail_msg("%s %s", complaint.key, complaint.text);
	struct touchstone_engine *engine = touchstone_create(&scene, arithmetic, method, error);
	if (!engine) fail_msg("%s", error);
	touchstone_run(engine, &(struct touchstone_limits){events, time, NULL}, NULL);
	struct touchstone_status status;
	touchstone_status(engine, &status);
	touchstone_destroy(engine);
	scene_free(&scene);
	return status;
}

static void assert_same_run(const struct scene_recipe *recipe, uint64_t events, const char *one, const char *other)
{
	struct touchstone_status a = run(recipe, one, "stable", events, INFINITY);
	struct touchstone_status b = run(recipe, other, "stable", events, INFINITY);
	print_message("%s and %s: %llu events to t = %.4f, digest %016llx\n", one, other, (unsigned long long)a.events,
				  a.time, (unsigned long long)a.digest);
	assert_int_equal(a.verdict, TOUCHSTONE_DONE);
	assert_int_equal(a.events, events);
	assert_int_equal(a.events, b.events);
	assert_int_equal(a.digest, b.digest);
}

/* The test that the engine really is one engine (design, section 2). */
static void equal_precision_means_equal_events(void **state)
{
	(void)state;
	/* each beside the one it must equal; the slow ones first */
	static const char *const arithmetics[] = {"mpfr:113", "binary128", "mpfr:64", "extended", "mpfr:53", "binary64",
											  "mpfr:11",  "short:11",  "mpfr:24", "short:24", "binary32"};
	enum { RUNS = sizeof arithmetics / sizeof *arithmetics };
	struct touchstone_status status[RUNS];
	struct scene_recipe recipe = gas(3, 256, 0.5);
	uint64_t events = brief ? 2000 : 100000;
#pragma omp parallel for schedule(dynamic, 1)
	for (int i = 0; i < RUNS; i++) {
		const char *bits = strchr(arithmetics[i], ':');
		bool coarse = bits && strcmp(bits, ":11") == 0; /* every pair must be looked at */
		uint64_t part = coarse ? 10 : i < 4 ? 5 : 1;    /* and the first ones are slow */
		status[i] = run(&recipe, arithmetics[i], "stable", events / part, INFINITY);
	}
	for (int i = 1; i < RUNS; i += i < RUNS - 2 ? 2 : 1) {
		if (!arithmetic_is_whole(arithmetics[i])) continue;
		print_message("%s and %s: %llu events to t = %.4f, digests %016llx and %016llx\n", arithmetics[i - 1],
					  arithmetics[i], (unsigned long long)status[i].events, status[i].time,
					  (unsigned long long)status[i - 1].digest, (unsigned long long)status[i].digest);
		assert_true(status[i].events >= events / 10 && status[i].events == status[i - 1].events);
		assert_int_equal(status[i].digest, status[i - 1].digest);
	}
}

/* And it is one in the corners: fewer dimensions, walls, gravity, several species, inelasticity, either form. */
static void equal_precision_in_other_scenes(void **state)
{
	(void)state;
	const uint64_t events = brief ? 300 : 4000;
	for (int form = TOUCHSTONE_RELATIVE; form <= TOUCHSTONE_ABSOLUTE; form++) {
		struct scene_recipe discs = gas(2, 100, 0.4);
		discs.boundary[0] = SCENE_WALLS;
		discs.form = form;
		assert_same_run(&discs, events, "mpfr:53", "binary64");
		discs.acceleration[0] = -0.125;
		assert_same_run(&discs, events, "mpfr:24", "binary32");
		assert_same_run(&discs, events, "mpfr:53", "binary64");
		struct scene_recipe rods = gas(1, 50, 0.5);
		rods.form = form;
		assert_same_run(&rods, events, "mpfr:53", "binary64");
		struct scene_recipe mixture = gas(3, 200, 0.3);
		mixture.species_count = 2;
		mixture.species = two_sizes;
		mixture.restitution = (struct touchstone_restitution){TOUCHSTONE_CONSTANT, 0.9};
		mixture.form = form;
		assert_same_run(&mixture, events, "mpfr:53", "binary64");
		mixture.restitution = (struct touchstone_restitution){TOUCHSTONE_VISCOELASTIC, 0.05};
		assert_same_run(&mixture, events, "mpfr:53", "binary64");
		assert_same_run(&mixture, events / 10, "mpfr:9", "short:9"); /* so coarse that every pair must be looked at */
	}
}

/* Bookkeeping never rounds (design, section 2): any cells, and none, with the sieve and without. */
static void search_does_not_matter(void **state)
{
	(void)state;
	static const char *const arithmetics[] = {"binary64", "short:11", "short:7", "twin"};
	static const char *const methods[] = {"stable", "rounded", "compensated"}; /* in binary64 */
	struct random_state random = random_seed(SEED);
	print_message("seed %d\n", SEED);
	for (int trial = 0; trial < (brief ? 20 : 36); trial++) {
		int dimensions = 1 + (int)(random_bits(&random) % 3);
		struct scene_recipe recipe =
			gas(dimensions, 20 + random_bits(&random) % 40, 0.1 + 0.5 * random_uniform(&random));
		recipe.form = random_bits(&random) % 2 ? TOUCHSTONE_ABSOLUTE : TOUCHSTONE_RELATIVE;
		for (int axis = 0; axis < dimensions; axis++)
			if (random_bits(&random) % 3 == 0) recipe.boundary[axis] = SCENE_WALLS;
		if (random_bits(&random) % 3 == 0) recipe.acceleration[dimensions - 1] = -0.1 * random_uniform(&random);
		if (random_bits(&random) % 2) recipe.species_count = 2, recipe.species = two_sizes, recipe.density *= 0.6;
		const char *arithmetic = trial < 12 ? arithmetics[trial % 4] : "binary64"; /* where it is quickest */
		const char *method = trial % 4 ? "stable" : methods[trial / 4 % 3];
		recipe.search = TOUCHSTONE_ALL;
		struct touchstone_status all = run(&recipe, arithmetic, method, 1500, INFINITY);
		for (int sizes = 0; sizes < 4; sizes++) {
			recipe.search = sizes < 3 ? TOUCHSTONE_CELLS : TOUCHSTONE_UNSIEVED;
			recipe.cell = sizes * (1 + random_uniform(&random));
			struct touchstone_status cells = run(&recipe, arithmetic, method, 1500, INFINITY);
			if (cells.digest != all.digest || cells.events != all.events)
				fail_msg("trial %d (%d dimensions, %s, %s, search %d, cells of %g): %016llx after %llu events, but "
						 "%016llx after %llu",
						 trial, dimensions, arithmetic, method, recipe.search, recipe.cell,
						 (unsigned long long)cells.digest, (unsigned long long)cells.events,
						 (unsigned long long)all.digest, (unsigned long long)all.events);
		}
	}
}

static void never_goes_back(void *context, struct touchstone_engine *engine, const struct touchstone_event *event)
{
	double *clock = context;
	(void)engine;
	assert_true(event->time >= *clock);
	*clock = event->time;
}

/* The same run, in which time never goes back, when its agenda is written anew between so many parts. */
static struct touchstone_status run_in_parts(const struct scene_recipe *recipe, uint64_t events, uint64_t parts)
{
	struct touchstone_scene scene;
	struct scene_error complaint;
	struct touchstone_snapshot snapshot;
	struct touchstone_status status;
	char error[160];
	double clock = 0;
	const struct touchstone_observer observer = {never_goes_back, &clock};
	assert_true(scene_build(recipe, SEED, &scene, &complaint));
	struct touchstone_engine *engine = touchstone_create(&scene, "binary64", "stable", error);
	for (uint64_t part = 0; part < parts; part++) {
		touchstone_run(engine, &(struct touchstone_limits){events / parts, INFINITY, NULL}, &observer);
		assert_true(touchstone_save(engine, &snapshot));
		touchstone_destroy(engine);
		engine = touchstone_restore(&scene, "binary64", "stable", &snapshot, error);
		touchstone_snapshot_free(&snapshot);
	}
	touchstone_status(engine, &status);
	touchstone_destroy(engine);
	scene_free(&scene);
	return status;
}

/* Of so many discs (engine/agenda.inl: `wide`) the days to come are fetched into the cache, and notes wait for theirs:
 * also after the search that rejects none of them beforehand, in cells of another size, and when the agenda is written
 * anew, the events are the same. */
static void many_particles_are_searched_alike(void **state)
{
	(void)state;
	struct scene_recipe recipe = gas(2, 66000, 0.5);
	uint64_t events = brief ? 1000 : 30000;
	struct touchstone_status cells = run(&recipe, "binary64", "stable", events, INFINITY);
	struct touchstone_status parts = run_in_parts(&recipe, events, 2);
	recipe.cell = 2.5;
	struct touchstone_status wider = run(&recipe, "binary64", "stable", events, INFINITY);
	recipe.search = TOUCHSTONE_UNSIEVED;
	struct touchstone_status unsieved = run(&recipe, "binary64", "stable", events, INFINITY);
	assert_int_equal(cells.events, events);
	assert_true(cells.lookups > wider.lookups);
	assert_int_equal(cells.digest, wider.digest);
	assert_int_equal(cells.digest, unsieved.digest);
	assert_int_equal(cells.digest, parts.digest);
}

/* Meetings whose time is asked for only when their turn comes (engine/defer.inl) are those that are found at once
 * without a sieve. */
static void deferring_does_not_matter(void **state)
{
	(void)state;
	static const char *const arithmetics[] = {"mpfr:53", "mpfr:113", "binary128"};
	struct random_state random = random_seed(SEED + 1);
	for (int trial = 0; trial < (brief ? 6 : 15); trial++) {
		struct scene_recipe recipe =
			gas(2 + trial % 2, 30 + random_bits(&random) % 100, 0.02 + 0.5 * random_uniform(&random));
		recipe.form = trial % 5 ? TOUCHSTONE_RELATIVE : TOUCHSTONE_ABSOLUTE;
		if (trial % 3 == 0) recipe.restitution.coefficient = 0.9;
		if (trial % 4 == 0) recipe.species_count = 2, recipe.species = two_sizes, recipe.density *= 0.6;
		const char *arithmetic = arithmetics[trial % 3];
		recipe.search = TOUCHSTONE_UNSIEVED;
		struct touchstone_status unsieved = run(&recipe, arithmetic, "stable", 1500, INFINITY);
		recipe.search = TOUCHSTONE_CELLS;
		struct touchstone_status deferred = run(&recipe, arithmetic, "stable", 1500, INFINITY);
		assert_int_equal(deferred.events, 1500);
		assert_int_equal(deferred.digest, unsieved.digest);
	}
}

static void threads_do_not_matter(void **state)
{
	(void)state;
	static const char *const arithmetics[] = {"binary64", "short:11", "mpfr:80", "short:20", "mpfr:300", "twin"};
	enum { RUNS = 6 };
	struct touchstone_status alone[RUNS], together[RUNS];
	struct scene_recipe recipe = gas(3, 64, 0.4);
	for (int i = 0; i < RUNS; i++) alone[i] = run(&recipe, arithmetics[i], "stable", 2000, INFINITY);
#pragma omp parallel for num_threads(2) schedule(dynamic, 1)
	for (int i = 0; i < RUNS; i++) together[i] = run(&recipe, arithmetics[i], "stable", 2000, INFINITY);
	for (int i = 0; i < RUNS; i++) assert_int_equal(alone[i].digest, together[i].digest);
}

/* A run cut into pieces is the run. */
static void pieces_do_not_matter(void **state)
{
	(void)state;
	struct scene_recipe recipe = gas(3, 100, 0.5);
	struct touchstone_status whole = run(&recipe, "binary64", "stable", 5000, INFINITY), status;
	struct touchstone_scene scene;
	struct scene_error complaint;
	char error[160];
	assert_true(scene_build(&recipe, SEED, &scene, &complaint));
	struct touchstone_engine *engine = touchstone_create(&scene, "binary64", "stable", error);
	assert_non_null(engine);
	struct random_state random = random_seed(SEED);
	for (uint64_t left = 5000; left;) {
		uint64_t piece = 1 + random_bits(&random) % 300;
		if (piece > left) piece = left;
		touchstone_status(engine, &status);
		touchstone_run(engine, &(struct touchstone_limits){UINT64_MAX, status.time, NULL}, NULL); /* ties may go on */
		touchstone_status(engine, &status);
		left = 5000 - status.events;
		if (piece > left) piece = left;
		touchstone_run(engine, &(struct touchstone_limits){piece, INFINITY, NULL}, NULL);
		left -= piece;
	}
	touchstone_status(engine, &status);
	assert_int_equal(status.digest, whole.digest);
	touchstone_destroy(engine);
	scene_free(&scene);
}

/* A gas that has cooled until its events are many pages apart has them in order still, and the same ones when its
 * agenda is written anew now and then. */
static void cold_gases_keep_their_order(void **state)
{
	(void)state;
	struct scene_recipe recipe = gas(3, 108, 0.5);
	recipe.restitution = (struct touchstone_restitution){TOUCHSTONE_VISCOELASTIC, 0.3};
	const uint64_t events = brief ? 20000 : 200000;
	struct touchstone_status whole = run(&recipe, "binary64", "stable", events, INFINITY);
	struct touchstone_status parts = run_in_parts(&recipe, events, 100);
	print_message("%llu events to t = %g\n", (unsigned long long)parts.events, parts.time);
	assert_int_equal(parts.events, events);
	assert_true(brief || parts.time / (double)events > 1000);
	assert_int_equal(parts.digest, whole.digest);
}

/* Equal balls on a line, elastic: velocities are handed on, and five touching balls pass one on at once. */
static void cradle_passes_one_ball_on(void **state)
{
	(void)state;
	struct touchstone_particle ball[6] = {{.position = {-4}, .velocity = {1}}};
	for (int i = 1; i < 6; i++) ball[i].position[0] = i - 2;
	struct touchstone_species species = {1, 1};
	struct touchstone_scene scene = {.dimensions = 1,
									 .particle_count = 6,
									 .particles = ball,
									 .species_count = 1,
									 .species = &species,
									 .box = {12},
									 .restitution = {TOUCHSTONE_CONSTANT, 1}};
	char error[160];
	static const char *const arithmetics[] = {"binary64", "short:8", "mpfr:200", "twin"};
	for (int a = 0; a < 4; a++) {
		struct touchstone_engine *engine = touchstone_create(&scene, arithmetics[a], "stable", error);
		assert_non_null(engine);
		assert_int_equal(touchstone_run(engine, &(struct touchstone_limits){1000, 10, NULL}, NULL), TOUCHSTONE_DONE);
		struct touchstone_status status;
		touchstone_status(engine, &status);
		assert_int_equal(status.collisions, 5);
		for (uint32_t i = 0; i < 6; i++) {
			double position[3], velocity[3];
			touchstone_state(engine, i, position, velocity);
			assert_true(velocity[0] == (i == 5));
		}
		touchstone_destroy(engine);
	}
}

/* A ball of diameter 1 dropped from one above the plate rests at t = sqrt(2)(1+e)/(1-e). */
static void ball_comes_to_rest(void **state)
{
	(void)state;
	struct random_state random = random_seed(SEED);
	for (int trial = 0; trial < 200; trial++) {
		double plate = trial ? random_uniform(&random) : 0;
		struct touchstone_particle ball = {.position = {plate + 1}};
		struct touchstone_species species = {1, 1};
		struct touchstone_wall wall = {{plate}, {1}, {TOUCHSTONE_CONSTANT, 0.5}};
		struct touchstone_scene scene = {.dimensions = 1,
										 .particle_count = 1,
										 .particles = &ball,
										 .species_count = 1,
										 .species = &species,
										 .wall_count = 1,
										 .walls = &wall,
										 .box = {8},
										 .acceleration = {-1},
										 .restitution = {TOUCHSTONE_CONSTANT, 1},
										 .form = trial % 2 ? TOUCHSTONE_ABSOLUTE : TOUCHSTONE_RELATIVE};
		char error[160];
		struct touchstone_engine *engine = touchstone_create(&scene, "binary64", "stable", error);
		assert_non_null(engine);
		struct touchstone_status status;
		assert_int_equal(touchstone_run(engine, &(struct touchstone_limits){100000, INFINITY, NULL}, NULL),
						 TOUCHSTONE_COLLAPSED);
		touchstone_status(engine, &status);
		assert_int_equal(status.particles[0], 0);
		assert_non_null(strstr(status.reason, "wall"));
		double error_of_time = fabs(status.time - sqrt(2 * (ball.position[0] - plate - 0.5)) * 3);
		if (!(error_of_time < 1e-7)) fail_msg("plate %a: rest time is off by %g", plate, error_of_time);
		touchstone_destroy(engine);
	}
}

static void naive_ball_halts_on_some_plates(void **state)
{
	(void)state;
	struct touchstone_drop drop[512] = {0};
	struct touchstone_landing landing[512];
	struct random_state random = random_seed(SEED);
	char error[160];
	for (int i = 0; i < 512; i++) drop[i] = (struct touchstone_drop){{random_uniform(&random)}, -1, 0.5, 0, 10000};
	assert_true(touchstone_drop("binary64", "naive", drop, 512, landing, NULL, NULL, error));
	int halted = 0;
	for (int i = 0; i < 512; i++) halted += landing[i].verdict == TOUCHSTONE_HALTED;
	assert_in_range(halted, 512 / 8, 512 / 2);
	assert_true(touchstone_drop("binary64", "stable", drop, 512, landing, NULL, NULL, error));
	for (int i = 0; i < 512; i++) assert_int_equal(landing[i].verdict, TOUCHSTONE_COLLAPSED);
}

/* A column of inelastic balls falls on a plate and collapses; the run says so and ends. */
static void column_collapses(void **state)
{
	(void)state;
	struct touchstone_particle ball[10] = {0};
	for (int i = 0; i < 10; i++) ball[i].position[0] = i * 1.25 - 5;
	struct touchstone_species species = {1, 1};
	struct touchstone_wall wall = {{-6}, {1}, {TOUCHSTONE_CONSTANT, 0.5}};
	struct touchstone_scene scene = {.dimensions = 1,
									 .particle_count = 10,
									 .particles = ball,
									 .species_count = 1,
									 .species = &species,
									 .wall_count = 1,
									 .walls = &wall,
									 .box = {16},
									 .acceleration = {-1},
									 .restitution = {TOUCHSTONE_CONSTANT, 0.5}};
	char error[160];
	struct touchstone_engine *engine = touchstone_create(&scene, "binary64", "stable", error);
	assert_non_null(engine);
	assert_int_equal(touchstone_run(engine, &(struct touchstone_limits){10000000, INFINITY, NULL}, NULL),
					 TOUCHSTONE_COLLAPSED);
	struct touchstone_status status;
	touchstone_status(engine, &status);
	print_message("%s\n", status.reason);
	assert_true(status.time > 1 && status.time < 20);
	touchstone_destroy(engine);
}

/* Two discs side by side at the same velocity never meet: a run ends all the same, at its time or out of patience. */
static void nothing_to_do_ends_a_run(void **state)
{
	(void)state;
	struct touchstone_particle disc[2] = {{.velocity = {1}}, {.position = {0, 3}, .velocity = {1}}};
	struct touchstone_species species = {1, 1};
	struct touchstone_scene scene = {.dimensions = 2,
									 .particle_count = 2,
									 .particles = disc,
									 .species_count = 1,
									 .species = &species,
									 .periodic = {true, true},
									 .box = {10, 10},
									 .restitution = {TOUCHSTONE_CONSTANT, 1}};
	char error[160];
	for (int limited = 1; limited >= brief; limited--) {
		struct touchstone_engine *engine = touchstone_create(&scene, "binary64", "stable", error);
		assert_non_null(engine);
		struct touchstone_limits limits = {.events = 5, .time = limited ? 1000 : INFINITY};
		assert_int_equal(touchstone_run(engine, &limits, NULL), TOUCHSTONE_DONE);
		struct touchstone_status status;
		touchstone_status(engine, &status);
		assert_int_equal(status.events, 0);
		if (limited) assert_true(status.time == 1000);
		touchstone_destroy(engine);
	}
}

static void bad_names_are_refused(void **state)
{
	(void)state;
	struct scene_recipe recipe = gas(3, 32, 0.3);
	struct touchstone_scene scene;
	struct scene_error complaint;
	assert_true(scene_build(&recipe, SEED, &scene, &complaint));
	static const char *const bad[] = {"binary65",
									  "short",
									  "short:3",
									  "short:26",
									  "mpfr:1",
									  "mpfr:1025",
									  "mpfr:-5",
									  "mpfr:",
									  "",
									  "mpfr:5x",
									  "twin:3",
									  "mpfr: 9",
									  "mpfr:99999999999999999999"};
	for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
		char error[160] = "";
		assert_null(touchstone_create(&scene, bad[i], "stable", error));
		assert_true(strlen(error) > 20);
	}
	char error[160] = "";
	assert_null(touchstone_create(&scene, "binary64", "stabel", error));
	assert_non_null(strstr(error, "stabel"));
	scene_free(&scene);
}

int main(void)
{
	brief = getenv("TOUCHSTONE_BRIEF");
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(search_does_not_matter),
		cmocka_unit_test(many_particles_are_searched_alike),
		cmocka_unit_test(pieces_do_not_matter),
		cmocka_unit_test(cold_gases_keep_their_order),
		cmocka_unit_test(deferring_does_not_matter),
		cmocka_unit_test(threads_do_not_matter),
		cmocka_unit_test(equal_precision_in_other_scenes),
		cmocka_unit_test(equal_precision_means_equal_events),
		cmocka_unit_test(cradle_passes_one_ball_on),
		cmocka_unit_test(ball_comes_to_rest),
		cmocka_unit_test(naive_ball_halts_on_some_plates),
		cmocka_unit_test(column_collapses),
		cmocka_unit_test(nothing_to_do_ends_a_run),
		cmocka_unit_test(bad_names_are_refused),
	};
	return cmocka_run_group_tests(tests, NULL, NULL);
}
