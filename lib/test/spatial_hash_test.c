/* Overlaps found by hashing are those found by looking at every pair. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#include <cmocka.h>

#include "scene/random.h"
#include "scene/spatial_hash.h"

enum { MOST = 60, KINDS = 4 };
static const uint64_t seed = 11;

static double depth_of_pair(const struct touchstone_scene *scene, size_t a, size_t b)
{
	const struct touchstone_particle *first = &scene->particles[a], *second = &scene->particles[b];
	double squared = 0;
	for (int axis = 0; axis < scene->dimensions; axis++) {
		double apart = fabs(first->position[axis] - second->position[axis]);
		if (scene->periodic[axis] && apart > scene->box[axis] / 2) apart = scene->box[axis] - apart;
		squared += apart * apart;
	}
	return (scene->species[first->species].diameter + scene->species[second->species].diameter) / 2 - sqrt(squared);
}

/* A scene of any dimensions, boundaries and sizes (diameters over nine powers of two), clustered or not. */
static void draw_scene(struct random_state *random, struct touchstone_scene *scene,
					   struct touchstone_particle particles[MOST], struct touchstone_species species[KINDS])
{
	*scene = (struct touchstone_scene){.particles = particles, .species = species};
	scene->dimensions = 1 + (int)random_below(random, 3);
	scene->particle_count = 2 + random_below(random, MOST - 1);
	scene->species_count = 1 + random_below(random, KINDS);
	double widest = 0;
	for (size_t s = 0; s < scene->species_count; s++) {
		double size = 1 + random_uniform(random);
		size /= (double)(1 << random_below(random, 9));
		species[s] = (struct touchstone_species){size, 1};
		widest = fmax(widest, size);
	}
	for (int axis = 0; axis < scene->dimensions; axis++) {
		scene->box[axis] = widest * (1 + 6 * random_uniform(random));
		scene->periodic[axis] = random_below(random, 2);
	}
	double spread = random_below(random, 2) ? 1 : 0.05;
	for (size_t p = 0; p < scene->particle_count; p++) {
		particles[p] = (struct touchstone_particle){.species = (uint32_t)random_below(random, scene->species_count)};
		for (int axis = 0; axis < scene->dimensions; axis++) {
			double reach = scene->periodic[axis] ? 1 : 3; /* on an open axis also outside the box */
			particles[p].position[axis] = (random_uniform(random) - 0.5) * scene->box[axis] * spread * reach;
		}
	}
}

static void finds_the_deepest(void **state)
{
	(void)state;
	struct random_state random = random_seed(seed);
	int overlapping = 0;
	for (int trial = 0; trial < 5000; trial++) {
		struct touchstone_scene scene;
		struct touchstone_particle particles[MOST];
		struct touchstone_species species[KINDS];
		draw_scene(&random, &scene, particles, species);
		double expected = 0, found = 0;
		for (size_t a = 0; a < scene.particle_count; a++)
			for (size_t b = 0; b < a; b++) expected = fmax(expected, depth_of_pair(&scene, a, b));

		struct spatial_hash hash;
		assert_true(spatial_hash_create(&hash, &scene));
		for (int level = 0; level < SPATIAL_HASH_LEVELS; level++)
			for (uint32_t p = 0; p < scene.particle_count; p++) {
				if (hash.level[particles[p].species] != level) continue;
				uint32_t other = p;
				double depth = spatial_hash_depth(&hash, p, INFINITY, &other);
				if (depth > 0) assert_true(other != p && fabs(depth_of_pair(&scene, p, other) - depth) < 1e-12);
				found = fmax(found, depth);
				spatial_hash_insert(&hash, p);
			}
		spatial_hash_destroy(&hash);
		assert_true(fabs(found - expected) < 1e-12);
		overlapping += expected > 0;
	}
	assert_true(overlapping > 500 && overlapping < 5000);
}

/* Coordinates as far out as doubles go do no harm on an open axis. */
static void far_out(void **state)
{
	(void)state;
	struct touchstone_species one = {1, 1};
	struct touchstone_particle particles[] = {
		{.position = {1e300}}, {.position = {-1e300}}, {.position = {0x1p52}}, {.position = {0x1p52}}};
	struct touchstone_scene scene = {.dimensions = 2,
									 .particle_count = 4,
									 .particles = particles,
									 .species_count = 1,
									 .species = &one,
									 .box = {10, 10}};
	struct spatial_hash hash;
	assert_true(spatial_hash_create(&hash, &scene));
	uint32_t other = 0;
	for (uint32_t p = 0; p < 4; p++) {
		double depth = spatial_hash_depth(&hash, p, INFINITY, &other);
		assert_true(depth == (p == 3 ? 1 : 0));
		spatial_hash_insert(&hash, p);
	}
	assert_int_equal(other, 2);
	spatial_hash_destroy(&hash);
}

int main(void)
{
	printf("seed %llu\n", (unsigned long long)seed);
	const struct CMUnitTest tests[] = {cmocka_unit_test(finds_the_deepest), cmocka_unit_test(far_out)};
	return cmocka_run_group_tests(tests, NULL, NULL);
}
