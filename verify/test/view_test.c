/* What the live page draws: ghosts across seams, spheres from far to near, what overlaps last, lines between captured
 * pairs, and bounds where there is no box. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <stdio.h>

#include "live/view.h"
#include "scene/random.h"
#include "scene/scene.h"

enum { SEED = 20261122, MANY = 300 };
static const double box[3] = {12, 7, 9};
static const struct touchstone_species sizes[] = {{1, 1}, {0.3, 1}};

static struct touchstone_particle particles[MANY];
static float warmth[MANY], depth[MANY];

/* Places anywhere in the box: they may overlap, for nothing but drawing is asked of them. */
static struct touchstone_scene drawn_scene(struct random_state *random, int dimensions, bool periodic_x,
										   bool periodic_y)
{
	for (int p = 0; p < MANY; p++) {
		particles[p] = (struct touchstone_particle){.species = (uint32_t)random_below(random, 2)};
		for (int axis = 0; axis < dimensions; axis++)
			particles[p].position[axis] = (random_uniform(random) - 0.5) * box[axis];
		warmth[p] = (float)random_uniform(random);
		depth[p] = random_below(random, 10) ? 0 : 0.1F;
	}
	return (struct touchstone_scene){.dimensions = dimensions,
									 .particle_count = MANY,
									 .particles = particles,
									 .species_count = 2,
									 .species = sizes,
									 .periodic = {periodic_x, periodic_y, true},
									 .box = {box[0], box[1], box[2]}};
}

/* Whether a disc of the view stands for the particle: at its place, or a box away along periodic axes. */
static bool stands_for(const struct touchstone_scene *scene, const float *disc, uint32_t p)
{
	for (int axis = 0; axis < 2; axis++) {
		double off = fabs(disc[axis] - particles[p].position[axis]);
		if (off > 1e-5 && !(scene->periodic[axis] && fabs(off - box[axis]) < 1e-5)) return false;
	}
	return disc[3] == warmth[p];
}

/* Each particle is drawn once, and once more for each seam that it reaches across, and for both at once. */
static void ghosts_are_drawn_across_seams(void **state)
{
	(void)state;
	struct random_state random = random_seed(SEED);
	const bool none[3] = {0};
	size_t ghosts = 0;
	for (int trial = 0; trial < 40; trial++) {
		struct touchstone_scene scene = drawn_scene(&random, 2, trial & 1, trial & 2);
		struct view view;
		assert_true(view_begin(&view, &scene, none));
		assert_true(view_discs(&view, warmth, depth));
		size_t expected = 0;
		for (uint32_t p = 0; p < MANY; p++) {
			size_t copies = 1, found = 0;
			double reach = sizes[particles[p].species].diameter / 2 * (depth[p] > 0 ? 1.6 : 1);
			for (int axis = 0; axis < 2; axis++)
				if (scene.periodic[axis] && fabs(particles[p].position[axis]) + reach > box[axis] / 2) copies *= 2;
			for (size_t d = 0; d < view.discs; d++) found += stands_for(&scene, view.disc + d * VIEW_PER_DISC, p);
			assert_int_equal(found, copies);
			expected += copies;
		}
		assert_int_equal(view.discs, expected);
		ghosts += expected - MANY;
		view_end(&view);
	}
	print_message("seed %d: %zu ghosts\n", SEED, ghosts);
	assert_true(ghosts > 500);
}

static void spheres_are_drawn_from_far_to_near(void **state)
{
	(void)state;
	struct random_state random = random_seed(SEED);
	struct touchstone_scene scene = drawn_scene(&random, 3, true, true);
	struct view view;
	assert_true(view_begin(&view, &scene, (const bool[3]){0}));
	assert_true(view_discs(&view, warmth, depth));
	float fade = 1;
	bool marked = false;
	size_t rims = 0, faces = 0;
	for (size_t d = 0; d < view.discs; d++) {
		const float *disc = view.disc + d * VIEW_PER_DISC;
		assert_true(!marked || disc[4] > 0); /* once they begin, nothing else comes */
		marked = disc[4] > 0;
		if (marked) {
			assert_true(disc[5] == 0);
			continue;
		}
		if (disc[5] == 1) {
			rims++;
			continue;
		}
		faces++;
		assert_true(disc[5] <= fade && disc[5] >= 0);
		fade = disc[5];
	}
	assert_true(marked && rims >= faces &&
				faces > MANY / 2); /* a rim may reach across a seam where its face does not */
	view_end(&view);
}

/* Two in a well of width 2 on either side of the seam, and one that is far from both. */
static void captured_pairs_are_joined(void **state)
{
	(void)state;
	const struct touchstone_step step = {2, -1};
	const struct touchstone_potential well = {.core = 1, .step_count = 1, .steps = &step};
	const struct touchstone_particle three[] = {
		{.position = {-5.6, 1}}, {.position = {5.6, 2}, .velocity = {0.1}}, {.position = {0, -2}}};
	const struct touchstone_scene scene = {.dimensions = 2,
										   .particle_count = 3,
										   .particles = three,
										   .species_count = 1,
										   .species = sizes,
										   .restitution = {TOUCHSTONE_CONSTANT, 1},
										   .potential_count = 1,
										   .potentials = &well,
										   .periodic = {true, true},
										   .box = {12, 7}};
	char error[160];
	struct touchstone_engine *engine = touchstone_create(&scene, "binary64", "stable", error);
	struct view view;
	assert_non_null(engine);
	assert_true(view_begin(&view, &scene, (const bool[3]){0}));
	assert_true(view_lines(&view, engine));
	assert_int_equal(view.lines, 2);
	for (size_t l = 0; l < 2; l++) {
		const float *line = view.line + l * VIEW_PER_LINE;
		assert_float_equal(hypotf(line[2] - line[0], line[3] - line[1]), hypot(0.8, 1), 1e-5);
		assert_true(fabsf(line[2]) > 6); /* leads out of the box */
	}
	assert_true(view_ring(&view) == 1);
	view_end(&view);
	touchstone_destroy(engine);
}

/* A ball far from the origin, over a slope: bounds are told from where it starts, and take in the ground below it. */
static void ground_is_within_the_bounds(void **state)
{
	(void)state;
	struct touchstone_particle ball = {.position = {10000, 10003}};
	const struct touchstone_wall slope = {{10000, 10000}, {0.6, 0.8, 0}, {TOUCHSTONE_CONSTANT, 1}};
	const struct touchstone_scene scene = {.dimensions = 2,
										   .particle_count = 1,
										   .particles = &ball,
										   .species_count = 1,
										   .species = sizes,
										   .wall_count = 1,
										   .walls = &slope};
	struct view view;
	double wall[4];
	assert_true(view_begin(&view, &scene, (const bool[3]){true, true}));
	ball.position[1] = 10002; /* it has fallen by 1: its foot is 1.6 down the normal */
	assert_true(view_discs(&view, warmth, (const float[]){0}));
	const double expected[] = {-0.96, 0.5, -2.28, -0.5};
	for (int k = 0; k < 4; k++) assert_float_equal(view.bounds[k], expected[k], 1e-9);
	assert_true(view_wall(&view, 0, wall));
	assert_true(wall[0] == 0 && wall[1] == -3 && wall[2] == 0.6 && wall[3] == 0.8);
	ball.position[1] = NAN;
	assert_true(view_discs(&view, warmth, (const float[]){0}));
	assert_false(isnan(view.bounds[2]));
	view_end(&view);
}

int main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(ghosts_are_drawn_across_seams),
		cmocka_unit_test(spheres_are_drawn_from_far_to_near),
		cmocka_unit_test(captured_pairs_are_joined),
		cmocka_unit_test(ground_is_within_the_bounds),
	};
	return cmocka_run_group_tests(tests, NULL, NULL);
}
