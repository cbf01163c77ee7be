/* Rivals of the stable rule for hard bodies (lib/method/{rewind,skip,search,shrink,tc}.inl): each does what its file
 * says, alike in every arithmetic of the same precision and however the particles are searched. */
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
#include "touchstone.h"

enum { SEED = 20050405 };
static const char *const rivals[] = {"rewind", "skip", "search", "shrink", "tc"};
enum { RIVALS = sizeof rivals / sizeof *rivals };

/* What an observer has seen. */
struct seen {
	uint64_t contacts, below; /* of these: nearer than contact in the working arithmetic */
	double back, latest;      /* how far the clock has gone back at most; the latest time */
};

static void see(void *context, struct touchstone_engine *engine, const struct touchstone_event *event)
{
	(void)engine;
	struct seen *seen = context;
	seen->contacts++;
	seen->below += event->steps < 0;
	seen->back = fmax(seen->back, seen->latest - event->time);
	seen->latest = fmax(seen->latest, event->time);
}

static struct touchstone_status run(const struct scene_recipe *recipe, const char *arithmetic, const char *method,
									uint64_t events, struct seen *seen)
{
	struct touchstone_scene scene;
	struct scene_error complaint;
	char error[160] = "";
	if (!scene_build(recipe, SEED, &scene, &complaint)) fail_msg("%s %s", complaint.key, complaint.text);
	struct touchstone_engine *engine = touchstone_create(&scene, arithmetic, method, error);
	if (!engine) fail_msg("%s", error);
	const struct touchstone_observer observer = {see, seen};
	*seen = (struct seen){.latest = -INFINITY};
	touchstone_run(engine, &(struct touchstone_limits){events, INFINITY, NULL}, &observer);
	struct touchstone_status status;
	touchstone_status(engine, &status);
	touchstone_destroy(engine);
	scene_free(&scene);
	return status;
}

/* Scenes in which coarse numbers make many overlaps: with and without images, walls and gravity. */
static struct scene_recipe scene_number(int number, size_t particles)
{
	struct scene_recipe recipe = number < 2 ? gas(3, particles, 0.5) : gas(2, 60, 0.5);
	double restitution = number == 0 ? 1 : number == 1 ? 0.5 : 0.9;
	recipe.restitution.coefficient = recipe.boundary_restitution.coefficient = restitution;
	if (number < 2) return recipe;
	recipe.boundary[0] = SCENE_WALLS;
	recipe.acceleration[0] = -1;
	recipe.form = TOUCHSTONE_ABSOLUTE;
	return recipe;
}
enum { SCENES = 3, GASES = 60 };

static void cells_change_nothing(void **state)
{
	(void)state;
	static const char *const arithmetics[] = {"short:8", "short:11", "binary32", "binary64"};
	double back = 0;
	for (int k = 0; k < SCENES * RIVALS * 4; k++) {
		struct scene_recipe recipe = scene_number(k / 4 / RIVALS, 108);
		struct seen seen;
		const char *arithmetic = arithmetics[k % 4], *method = rivals[k / 4 % RIVALS];
		struct touchstone_status cells = run(&recipe, arithmetic, method, 200, &seen);
		recipe.search = TOUCHSTONE_ALL;
		struct touchstone_status all = run(&recipe, arithmetic, method, 200, &seen);
		if (cells.events != all.events || cells.digest != all.digest || cells.verdict != all.verdict)
			fail_msg("scene %d, %s, %s: %llu events %016llx by cells, %llu events %016llx by all pairs", k / 4 / RIVALS,
					 arithmetic, method, (unsigned long long)cells.events, (unsigned long long)cells.digest,
					 (unsigned long long)all.events, (unsigned long long)all.digest);
		if (strcmp(method, "rewind") == 0) back = fmax(back, seen.back);
	}
	print_message("seed %d: the clock went back by %g at most\n", SEED, back);
	assert_true(back > 0.01); /* or nothing was tried */
}

/* Random gases in few bits, where overlaps and going back are frequent. */
static struct scene_recipe random_gas(struct random_state *random, char arithmetic[20])
{
	int dimensions = 2 + (int)random_below(random, 2), bits = 6 + (int)random_below(random, 20);
	struct scene_recipe recipe = gas(dimensions, 30 + random_below(random, 170), 0.05 + 0.7 * random_uniform(random));
	recipe.restitution.coefficient = random_below(random, 2) ? 1 : 0.5 + 0.5 * random_uniform(random);
	recipe.form = random_below(random, 2) ? TOUCHSTONE_ABSOLUTE : TOUCHSTONE_RELATIVE;
	if (random_below(random, 4) == 0) recipe.clock = random_below(random, 100);
	snprintf(arithmetic, 20, "short:%d", bits);
	return recipe;
}

/* By rewind and search a pair is rejected in binary32 only where the method, asked of it, would have found nothing. */
static void the_sieve_changes_nothing(void **state)
{
	(void)state;
	static const char *const sieved[] = {"rewind", "search"};
	const char *given = getenv("TOUCHSTONE_SEED");
	const uint64_t seed = given ? strtoull(given, NULL, 10) : SEED;
	const int gases = getenv("TOUCHSTONE_BRIEF") ? GASES / 10 : GASES;
	struct random_state random = random_seed(seed);
	double back = 0;
	print_message("seed %llu (TOUCHSTONE_SEED=S: another)\n", (unsigned long long)seed);
	for (int k = 0; k < gases; k++) {
		char arithmetic[20];
		struct seen seen;
		struct scene_recipe recipe = random_gas(&random, arithmetic);
		const char *method = sieved[k % 2];
		uint64_t events = 200 + random_below(&random, 1800);
		struct touchstone_status with = run(&recipe, arithmetic, method, events, &seen);
		back = fmax(back, seen.back);
		recipe.search = TOUCHSTONE_UNSIEVED;
		struct touchstone_status without = run(&recipe, arithmetic, method, events, &seen);
		if (with.events != without.events || with.digest != without.digest || with.verdict != without.verdict)
			fail_msg("gas %d, %s, %s, %d dimensions, %zu particles, density %g, restitution %g, %llu events: %016llx "
					 "with the sieve, %016llx without",
					 k, arithmetic, method, recipe.dimensions, recipe.particle_count, recipe.density,
					 recipe.restitution.coefficient, (unsigned long long)events, (unsigned long long)with.digest,
					 (unsigned long long)without.digest);
	}
	print_message("the clock went back by %g at most\n", back);
	assert_true(back > 0.01);
}

static void equal_precision_means_equal_events(void **state)
{
	(void)state;
	static const char *const pairs[][2] = {{"short:8", "mpfr:8"}, {"short:17", "mpfr:17"}, {"binary64", "mpfr:53"}};
	const uint64_t events = getenv("TOUCHSTONE_BRIEF") ? 16 : 80; /* under sanitizers all takes ten times longer */
	for (int k = 0; k < SCENES * RIVALS * 3; k++) {
		struct scene_recipe recipe = scene_number(k / 3 / RIVALS, 32);
		struct seen seen;
		const char *method = rivals[k / 3 % RIVALS];
		struct touchstone_status one = run(&recipe, pairs[k % 3][0], method, events, &seen);
		struct touchstone_status other = run(&recipe, pairs[k % 3][1], method, events, &seen);
		if (one.events != other.events || one.digest != other.digest)
			fail_msg("scene %d, %s: %016llx in %s, %016llx in %s", k / 3 / RIVALS, method,
					 (unsigned long long)one.digest, pairs[k % 3][0], (unsigned long long)other.digest,
					 pairs[k % 3][1]);
	}
}

/* About half of all contacts are below contact by the stable rule; none are where they are prevented. */
static void search_and_shrink_prevent_overlaps(void **state)
{
	(void)state;
	struct scene_recipe recipe = gas(3, 32, 0.3);
	struct seen seen;
	run(&recipe, "binary64", "stable", 1000, &seen);
	assert_in_range(seen.below, 300, 700);
	run(&recipe, "binary64", "search", 1000, &seen);
	assert_true(seen.contacts == 1000 && seen.below == 0);
	run(&recipe, "binary64", "shrink", 1000, &seen);
	assert_true(seen.contacts == 1000 && seen.below == 0);
}

/* Two balls on a line; the first runs into the second, which rests inside it by 2^-10 or touches it. */
static struct touchstone_status two_balls(double gap, const char *method, double contact_time, struct seen *seen,
										  double velocity[2])
{
	const struct touchstone_particle ball[2] = {{.velocity = {1}}, {.position = {1 + gap}}};
	const struct touchstone_species species = {1, 1};
	const struct touchstone_scene scene = {.dimensions = 1,
										   .particle_count = 2,
										   .particles = ball,
										   .species_count = 1,
										   .species = &species,
										   .box = {8},
										   .restitution = {TOUCHSTONE_CONSTANT, 0.5},
										   .contact_time = contact_time};
	char error[160];
	struct touchstone_status status;
	struct touchstone_engine *engine = touchstone_create(&scene, "binary64", method, error);
	assert_non_null(engine);
	*seen = (struct seen){.latest = 0};
	touchstone_run(engine, &(struct touchstone_limits){5, 10, NULL}, &(struct touchstone_observer){see, seen});
	touchstone_status(engine, &status);
	for (uint32_t i = 0; i < 2; i++) {
		double position[3], speed[3];
		touchstone_state(engine, i, position, speed);
		velocity[i] = speed[0];
	}
	touchstone_destroy(engine);
	return status;
}

static void an_overlap_is_met_as_each_file_says(void **state)
{
	(void)state;
	struct seen seen;
	double velocity[2];
	struct touchstone_status status = two_balls(-0x1p-10, "rewind", 0, &seen, velocity);
	assert_true(status.events == 1 && seen.back == 0x1p-10 && velocity[1] == 0.75);
	status = two_balls(-0x1p-10, "skip", 0, &seen, velocity);
	assert_true(status.events == 0 && velocity[0] == 1);
	status = two_balls(-0x1p-10, "tc", 0, &seen, velocity);
	assert_true(status.events == 1 && status.verdict == TOUCHSTONE_DONE);
	assert_int_equal(two_balls(-0x1p-10, "search", 0, &seen, velocity).verdict, TOUCHSTONE_HALTED);
	assert_int_equal(two_balls(-0x1p-10, "shrink", 0, &seen, velocity).verdict, TOUCHSTONE_HALTED);
}

/* The start counts as a collision; what comes later than the contact time loses its energy. */
static void tc_is_elastic_for_the_contact_time(void **state)
{
	(void)state;
	struct seen seen;
	double velocity[2];
	two_balls(0.25, "tc", 0.5, &seen, velocity);
	assert_true(seen.contacts == 1 && velocity[0] == 0 && velocity[1] == 1);
	two_balls(0.25, "tc", 0.125, &seen, velocity);
	assert_true(seen.contacts == 1 && velocity[0] == 0.25 && velocity[1] == 0.75);
}

static void steps_and_virtual_walls_are_refused(void **state)
{
	(void)state;
	const struct touchstone_virtual_wall wall = {{0}, {1}};
	struct scene_recipe recipe = gas(1, 4, 0.5);
	recipe.virtual_walls = &wall, recipe.virtual_wall_count = 1;
	struct touchstone_scene scene;
	struct scene_error complaint;
	char error[160];
	assert_true(scene_build(&recipe, SEED, &scene, &complaint));
	for (int m = 0; m < RIVALS; m++) {
		assert_null(touchstone_create(&scene, "binary64", rivals[m], error));
		assert_non_null(strstr(error, rivals[m]));
	}
	scene_free(&scene);
}

int main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(an_overlap_is_met_as_each_file_says),
		cmocka_unit_test(tc_is_elastic_for_the_contact_time),
		cmocka_unit_test(search_and_shrink_prevent_overlaps),
		cmocka_unit_test(steps_and_virtual_walls_are_refused),
		cmocka_unit_test(cells_change_nothing),
		cmocka_unit_test(the_sieve_changes_nothing),
		cmocka_unit_test(equal_precision_means_equal_events),
	};
	return cmocka_run_group_tests(tests, NULL, NULL);
}
