/* Overlaps found along one axis are those found by looking at every pair and every wall. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "measure/deep_overlap.h"
#include "scene/random.h"

static const uint64_t seed = 1907;

enum { ROOMS = 3000, MOST = 40 };

/* A room of two sorts of balls, at places that know nothing of one another. */
struct room {
	struct touchstone_particle particles[MOST];
	struct touchstone_species species[2];
	struct touchstone_wall wall;
	struct touchstone_scene scene;
};

static void furnish(struct room *room, struct random_state *random)
{
	int dimensions = 1 + (int)random_below(random, 3);
	*room = (struct room){
		.species = {{1, 1}, {0.25 + random_uniform(random), 1}},
		.wall = {{0}, {0.6, dimensions > 1 ? 0.8 : 0}, {TOUCHSTONE_CONSTANT, 1}},
	};
	room->scene = (struct touchstone_scene){
		.dimensions = dimensions,
		.particle_count = 1 + random_below(random, MOST),
		.particles = room->particles,
		.species_count = 2,
		.species = room->species,
		.wall_count = random_below(random, 2),
		.walls = &room->wall,
	};
	for (int axis = 0; axis < dimensions; axis++) {
		room->scene.periodic[axis] = random_below(random, 2);
		room->scene.box[axis] = (dimensions == 1 ? 20 : 2) * (1 + random_uniform(random));
	}
	for (size_t p = 0; p < room->scene.particle_count; p++)
		room->particles[p].species = (uint32_t)random_below(random, 2);
}

/* Some stand a box or two away. */
static void scatter(const struct room *room, struct random_state *random, double (*position)[3])
{
	for (size_t p = 0; p < room->scene.particle_count; p++)
		for (int axis = 0; axis < 3; axis++)
			position[p][axis] = room->scene.box[axis] * (3 * random_uniform(random) - 1.5);
}

/* The least distance of an image over that of contact. */
static double nearest(const struct room *room, double (*position)[3], size_t p, size_t q)
{
	const struct touchstone_scene *scene = &room->scene;
	double square = 0;
	for (int axis = 0; axis < scene->dimensions; axis++) {
		double least = INFINITY;
		for (int image = -4; image <= 4; image++)
			if (image == 0 || scene->periodic[axis])
				least = fmin(least, fabs(position[p][axis] - position[q][axis] + image * scene->box[axis]));
		square += least * least;
	}
	return 2 * sqrt(square) /
		   (room->species[room->particles[p].species].diameter + room->species[room->particles[q].species].diameter);
}

static double deepest(const struct room *room, double (*position)[3])
{
	double least = INFINITY;
	for (size_t p = 0; p < room->scene.particle_count; p++) {
		for (size_t q = 0; q < p; q++) least = fmin(least, nearest(room, position, p, q));
		if (room->scene.wall_count == 0) continue;
		double height = 0.6 * position[p][0] + room->wall.normal[1] * position[p][1];
		least = fmin(least, 2 * height / room->species[room->particles[p].species].diameter);
	}
	return least;
}

static void the_deepest_is_found(void **state)
{
	(void)state;
	struct random_state random = random_seed(seed);
	int deep = 0, walls = 0;
	for (int k = 0; k < ROOMS; k++) {
		struct room room;
		struct deep_overlaps overlaps;
		struct deep_overlap found;
		furnish(&room, &random);
		assert_true(deep_overlaps_make(&overlaps, &room.scene));
		scatter(&room, &random, overlaps.position);
		double least = deepest(&room, overlaps.position), part = 0.02 + 0.98 * random_uniform(&random);
		bool is_deep = deep_overlaps_find(&overlaps, part, &found);
		assert_int_equal(is_deep, least < part);
		if (is_deep) {
			assert_true(fabs(found.depth - least) < 1e-12 * (1 + fabs(least)));
			assert_true(found.depth == deep_overlaps_depth(&overlaps, &found));
			assert_true(found.wall || found.first < found.second);
			walls += found.wall;
		}
		deep += is_deep;
		deep_overlaps_free(&overlaps);
	}
	print_message("seed %d: %d of %d rooms have a deep overlap, %d with a wall\n", (int)seed, deep, ROOMS, walls);
	assert_true(deep > ROOMS / 10 && deep < ROOMS && walls > 0 && walls < deep);
}

int main(void)
{
	const struct CMUnitTest tests[] = {cmocka_unit_test(the_deepest_is_found)};
	return cmocka_run_group_tests(tests, NULL, NULL);
}
