/* Cells hide no neighbour, and the sieve leaves none out, where numbers are coarse: by a late clock in the absolute
 * form, in few bits, and under methods that have their events early or late, or go back in time. */
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

enum { SEED = 1963, DISCS = 400 };

static bool brief; /* under sanitizers, where everything takes ten times longer */

static struct touchstone_status run(const struct scene_recipe *recipe, const char *arithmetic, const char *method,
									uint64_t events)
{
	struct touchstone_scene scene;
	struct scene_error complaint;
	char error[160] = "";
	if (!scene_build(recipe, SEED, &scene, &complaint)) fail_msg("%s %s", complaint.key, complaint.text);
	struct touchstone_engine *engine = touchstone_create(&scene, arithmetic, method, error);
	if (!engine) fail_msg("%s", error);
	touchstone_run(engine, &(struct touchstone_limits){events, INFINITY, NULL}, NULL);
	struct touchstone_status status;
	touchstone_status(engine, &status);
	touchstone_destroy(engine);
	scene_free(&scene);
	return status;
}

static void assert_search_does_not_matter(struct scene_recipe recipe, const char *arithmetic, const char *method,
										  uint64_t events)
{
	recipe.search = TOUCHSTONE_ALL;
	struct touchstone_status all = run(&recipe, arithmetic, method, events);
	assert_true(all.events > 0);
	for (int sieved = 0; sieved < 2; sieved++) {
		recipe.search = sieved ? TOUCHSTONE_CELLS : TOUCHSTONE_UNSIEVED;
		struct touchstone_status cells = run(&recipe, arithmetic, method, events);
		if (cells.digest != all.digest || cells.events != all.events)
			fail_msg("%s, %s, clock %g, %s: %016llx after %llu events, but %016llx after %llu when all are looked at",
					 arithmetic, method, recipe.clock, sieved ? "sieved" : "unsieved", (unsigned long long)cells.digest,
					 (unsigned long long)cells.events, (unsigned long long)all.digest, (unsigned long long)all.events);
	}
}

static void late_clocks_hide_nobody(void **state)
{
	(void)state;
	static const double clocks[] = {10, 1e3, 1e6};
	static const char *const arithmetics[] = {"short:16", "short:20", "short:22", "short:25", "binary32"};
	static const char *const methods[] = {"stable", "naive", "tc"};
	for (size_t c = 0; c < sizeof clocks / sizeof *clocks; c++)
		for (size_t a = 0; a < sizeof arithmetics / sizeof *arithmetics; a++)
			for (size_t m = 0; m < sizeof methods / sizeof *methods; m++) {
				struct scene_recipe recipe = gas(3, 16, 0.4);
				recipe.form = TOUCHSTONE_ABSOLUTE;
				recipe.clock = clocks[c];
				assert_search_does_not_matter(recipe, arithmetics[a], methods[m], brief ? 100 : 400);
			}
}

static void shifted_events_hide_nobody(void **state)
{
	(void)state;
	static const char *const arithmetics[] = {"short:11", "short:12", "short:13"};
	struct scene_recipe recipe = gas(3, 32, 0.5);
	recipe.form = TOUCHSTONE_ABSOLUTE;
	for (size_t a = 0; a < sizeof arithmetics / sizeof *arithmetics; a++) {
		assert_search_does_not_matter(recipe, arithmetics[a], "stretch", brief ? 100 : 400);
		assert_search_does_not_matter(recipe, arithmetics[a], "last-event", brief ? 100 : 400);
	}
}

/* A stream of discs of which some overlap at the start, by so much: the clock goes back to where they met, and they are
 * then far from where they are looked for; but by less than a box, whose images are all that any search looks at. */
static struct touchstone_status run_overlapping(double depth, uint64_t seed, enum touchstone_search search)
{
	struct scene_recipe recipe = gas(2, DISCS, 0.4);
	struct touchstone_scene scene;
	struct scene_error complaint;
	struct random_state random = random_seed(seed);
	char error[160] = "";
	if (!scene_build(&recipe, seed, &scene, &complaint)) fail_msg("%s %s", complaint.key, complaint.text);
	struct touchstone_particle particles[DISCS];
	const struct touchstone_particle *as_built = scene.particles;
	memcpy(particles, as_built, sizeof particles);
	scene.particles = particles;
	scene.search = search;
	scene.cell = 1;
	for (size_t i = 0; i < DISCS; i++) {
		particles[i].velocity[0] += 2;
		if (i % 4) continue;
		double angle = 2 * acos(-1) * random_uniform(&random), *next = particles[i + 1].position;
		next[0] = particles[i].position[0] + (1 - depth) * cos(angle);
		next[1] = particles[i].position[1] + (1 - depth) * sin(angle);
	}
	struct touchstone_engine *engine = touchstone_create(&scene, "binary64", "rewind", error);
	if (!engine) fail_msg("%s", error);
	touchstone_run(engine, &(struct touchstone_limits){200, INFINITY, NULL}, NULL);
	struct touchstone_status status;
	touchstone_status(engine, &status);
	touchstone_destroy(engine);
	scene.particles = as_built;
	scene_free(&scene);
	return status;
}

static void times_gone_back_hide_nobody(void **state)
{
	(void)state;
	for (int bits = 6; bits < 16; bits++)
		for (uint64_t seed = SEED; seed < SEED + (brief ? 1 : 10); seed++) {
			struct touchstone_status all = run_overlapping(ldexp(1, -bits), seed, TOUCHSTONE_ALL);
			struct touchstone_status cells = run_overlapping(ldexp(1, -bits), seed, TOUCHSTONE_CELLS);
			if (cells.digest != all.digest || cells.events != all.events)
				fail_msg("overlaps of 2^-%d, seed %d: %016llx after %llu events, but %016llx after %llu when all are "
						 "looked at",
						 bits, (int)seed, (unsigned long long)cells.digest, (unsigned long long)cells.events,
						 (unsigned long long)all.digest, (unsigned long long)all.events);
		}
}

int main(void)
{
	brief = getenv("TOUCHSTONE_BRIEF");
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(late_clocks_hide_nobody),
		cmocka_unit_test(shifted_events_hide_nobody),
		cmocka_unit_test(times_gone_back_hide_nobody),
	};
	return cmocka_run_group_tests(tests, NULL, NULL);
}
