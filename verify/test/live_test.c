/* What the live page compares and counts: two sequences of events that come in any order, and discs inside one another.
 */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <stdio.h>
#include <stdlib.h>

#include "live/sequence.h"
#include "live/witness.h"
#include "scene/random.h"
#include "scene/scene.h"

enum { SEED = 20240816, MOST = 5000 };

static struct touchstone_event drawn_event(struct random_state *random)
{
	return (struct touchstone_event){
		.kind = random_below(random, 2) ? TOUCHSTONE_CONTACT : TOUCHSTONE_WALL,
		.first = (uint32_t)random_below(random, 1 << 26),
		.second = (uint32_t)random_below(random, 1 << 26),
	};
}

/* Two sequences with a beginning in common, entered a few at a time from either side: that beginning is what is found,
 * whichever is ahead. */
static void common_beginnings_are_found(void **state)
{
	(void)state;
	struct random_state random = random_seed(SEED);
	static struct touchstone_event event[2][MOST];
	uint64_t differing = 0, ended = 0;
	for (int trial = 0; trial < 300; trial++) {
		size_t common = random_below(&random, MOST - 1), length = common + 1 + random_below(&random, MOST - common);
		bool ends = random_below(&random, 3) == 0, same = random_below(&random, 4) == 0;
		for (size_t k = 0; k < length; k++) {
			event[0][k] = event[1][k] = drawn_event(&random);
			if (same || ends || k < common) continue;
			uint32_t *number = random_below(&random, 2) ? &event[1][k].first : &event[1][k].second;
			if (k == common || random_below(&random, 2)) *number ^= 1;
		}
		size_t entered[2] = {0}, last[2] = {length, ends && !same ? common : length};
		struct sequence sequence = {0};
		while (entered[0] < last[0] || entered[1] < last[1]) {
			int side = (int)random_below(&random, 2);
			for (uint64_t k = random_below(&random, 1500); k > 0 && entered[side] < last[side]; k--)
				sequence_enter(&sequence, side, &event[side][entered[side]++]);
			if (ends && !same && entered[1] == last[1] && !sequence.ended[1]) sequence_end(&sequence, 1);
		}
		if (ends && !same && !sequence.ended[1]) sequence_end(&sequence, 1);
		assert_int_equal(sequence.common, same ? length : common);
		assert_int_equal(sequence.differ, !same);
		differing += !same && !ends;
		ended += !same && ends;
		sequence_clear(&sequence);
	}
	print_message("seed %d: %llu pairs that differ, %llu of which one ends\n", SEED, (unsigned long long)differing,
				  (unsigned long long)ended);
	assert_true(differing > 50 && ended > 20);
}

/* Discs that touch or are apart, and one pair in `depth`. */
static void fill(struct touchstone_particle particles[4], double depth)
{
	const double x[4] = {-4, -3 - depth, 0, 3};
	for (int p = 0; p < 4; p++) particles[p] = (struct touchstone_particle){.position = {x[p], 0, 0}};
}

static void overlaps_are_counted(void **state)
{
	(void)state;
	struct touchstone_particle particles[4];
	const struct touchstone_species species = {1, 1};
	const struct touchstone_scene scene = {.dimensions = 2,
										   .particle_count = 4,
										   .particles = particles,
										   .species_count = 1,
										   .species = &species,
										   .periodic = {true, true},
										   .box = {16, 16}};
	struct witness witness;
	float depth[4];
	fill(particles, 0);
	assert_true(witness_begin(&witness, &scene, 24));
	assert_true(witness.rounding == 0x1p-18);
	fill(particles, 0x1p-19);
	assert_true(witness_look(&witness, &scene, 1, depth));
	assert_true(witness.overlapping == 0 && isnan(witness.first_failure) && depth[0] == 0);
	fill(particles, 0x1p-5);
	assert_true(witness_look(&witness, &scene, 2, depth));
	assert_true(witness.overlapping == 1 && witness.entangled == 0 && witness.dropped == 1);
	assert_true(witness.first_failure == 2 && isnan(witness.first_sight));
	assert_true(depth[0] == 0x1p-5f && depth[1] == 0x1p-5f && depth[2] == 0 && depth[3] == 0);
	fill(particles, 0.25);
	assert_true(witness_look(&witness, &scene, 3, depth));
	assert_true(witness.overlapping == 1 && witness.entangled == 1 && witness.dropped == 1);
	assert_true(witness.first_failure == 2 && witness.first_sight == 3 && witness.deepest == 0.25);
	fill(particles, 0);
	assert_true(witness_look(&witness, &scene, 4, depth));
	assert_true(witness.overlapping == 0 && witness.deepest == 0 && witness.deepest_ever == 0.25);
	fill(particles, 0x1p-5);
	assert_true(witness_look(&witness, &scene, 5, depth));
	assert_true(witness.dropped == 2 && witness.first_failure == 2);
	witness_end(&witness);
}

static void see(void *witness, struct touchstone_engine *engine, const struct touchstone_event *event)
{
	witness_see(witness, engine, event);
}

/* What a run without failures is seen as, and one that halts; a ball between two others meets them in turn, so that no
 * meeting is a repeated one. */
static void runs_are_seen(void **state)
{
	(void)state;
	static const struct scene_species unit[] = {{1, {1, 1}}};
	struct scene_recipe recipe = {.dimensions = 1,
								  .particle_count = 3,
								  .box = {10},
								  .boundary = {SCENE_WALLS},
								  .boundary_restitution = {TOUCHSTONE_CONSTANT, 1},
								  .species_count = 1,
								  .species = unit,
								  .restitution = {TOUCHSTONE_CONSTANT, 1},
								  .positions = SCENE_LATTICE,
								  .velocities = SCENE_UNIFORM};
	struct touchstone_scene scene;
	struct scene_error complaint;
	char error[160];
	assert_true(scene_build(&recipe, SEED, &scene, &complaint));
	struct touchstone_engine *engine = touchstone_create(&scene, "binary64", "stable", error);
	struct witness witness;
	assert_non_null(engine);
	assert_true(witness_begin(&witness, &scene, 53));
	struct touchstone_observer observer = {see, &witness};
	touchstone_run(engine, &(struct touchstone_limits){100, INFINITY, NULL}, &observer);
	assert_true(witness.seen == 100 && witness.repeated == 0 && witness.parting == 0 && witness.backwards == 0);
	assert_true(witness.three_body.events == 0 && isnan(witness.first_failure));
	witness_stop(&witness, 7);
	assert_true(witness.first_failure == 7 && witness.first_sight == 7);
	struct touchstone_event twice = {.kind = TOUCHSTONE_CONTACT, .first = 0, .second = 1, .approach = -1, .steps = 100};
	witness_see(&witness, engine, &twice);
	witness_see(&witness, engine, &twice);
	assert_true(witness.repeated >= 1 && witness.parting == 2 && witness.backwards == 1);
	witness_end(&witness);
	touchstone_destroy(engine);
	scene_free(&scene);
}

int main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(common_beginnings_are_found),
		cmocka_unit_test(overlaps_are_counted),
		cmocka_unit_test(runs_are_seen),
	};
	return cmocka_run_group_tests(tests, NULL, NULL);
}
