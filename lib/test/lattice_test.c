/* Lattices: enough sites, as far apart as claimed, and close packing reached where it can be. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

#include <cmocka.h>

#include "scene/lattice.h"
#include "scene/random.h"

static const uint64_t seed = 7;

static struct lattice_box cube(int dimensions, double side)
{
	struct lattice_box box = {.dimensions = dimensions, .diameter = 1};
	for (int axis = 0; axis < dimensions; axis++) box.extent[axis] = side, box.periodic[axis] = true;
	return box;
}

/* Least distance between any two particles or their images, found by looking at all of them. */
static double least_distance(const struct lattice_box *box, const struct touchstone_particle *particles, size_t count)
{
	double least = INFINITY;
	for (size_t a = 0; a < count; a++)
		for (size_t b = 0; b < a; b++) {
			double squared = 0;
			for (int axis = 0; axis < box->dimensions; axis++) {
				double apart = fabs(particles[a].position[axis] - particles[b].position[axis]);
				if (box->periodic[axis] && apart > box->extent[axis] / 2) apart = box->extent[axis] - apart;
				squared += apart * apart;
			}
			least = fmin(least, squared);
		}
	return sqrt(least);
}

/* Any box, any number: the particles stand within the box, off the walls, and no closer than the lattice says. */
static void sites_are_apart(void **state)
{
	(void)state;
	struct random_state random = random_seed(seed);
	for (int trial = 0; trial < 600; trial++) {
		struct lattice_box box = {.dimensions = 1 + (int)random_below(&random, 3), .diameter = 1};
		for (int axis = 0; axis < box.dimensions; axis++) {
			box.extent[axis] = 1 + 20 * random_uniform(&random);
			box.periodic[axis] = random_below(&random, 2);
			box.walled[axis] = !box.periodic[axis] && random_below(&random, 2);
		}
		bool centred = random_below(&random, 2);
		size_t count = 1 + random_below(&random, 300);
		struct lattice lattice = lattice_fit(&box, centred, count);
		if (lattice.distance < 1) continue;
		assert_true(lattice.sites >= count);
		struct touchstone_particle *particles = calloc(count, sizeof *particles);
		lattice_place(&lattice, particles, count);
		assert_true(least_distance(&box, particles, count) >= lattice.distance * (1 - 1e-13));
		for (size_t p = 0; p < count; p++)
			for (int axis = 0; axis < box.dimensions; axis++) {
				double margin = box.walled[axis] ? 0.5 : 0;
				assert_true(fabs(particles[p].position[axis]) <= box.extent[axis] / 2 - margin + 1e-13);
			}
		free(particles);
	}
}

/* A full lattice attains the distance it claims. */
static void claim_is_attained(void **state)
{
	(void)state;
	for (int dimensions = 1; dimensions <= 3; dimensions++)
		for (size_t count = 2; count < 200; count += 9)
			for (int centred = 0; centred <= 1; centred++) {
				struct lattice_box box = cube(dimensions, 10);
				struct lattice lattice = lattice_fit(&box, centred, count);
				struct touchstone_particle *particles = calloc(lattice.sites, sizeof *particles);
				lattice_place(&lattice, particles, lattice.sites);
				double least = fmin(least_distance(&box, particles, lattice.sites), 10);
				assert_true(fabs(least - lattice.distance) < 1e-12);
				free(particles);
			}
}

static void close_packing_is_reached(void **state)
{
	(void)state;
	for (size_t cells = 1; cells <= 12; cells++) { /* 4 n^3 spheres in a cube of n sqrt(2) */
		struct lattice_box box = cube(3, (double)cells * sqrt(2));
		struct lattice lattice = lattice_fit(&box, true, 4 * cells * cells * cells);
		assert_true(lattice.sites == 4 * cells * cells * cells);
		assert_true(fabs(lattice.distance - 1) < 1e-14);
		assert_true(lattice.spacing[0] == lattice.spacing[1] && lattice.spacing[1] == lattice.spacing[2]);
	}
	for (size_t rows = 2; rows <= 20; rows += 2) { /* triangular: rows sqrt(3)/2 apart */
		struct lattice_box box = cube(2, (double)rows);
		box.extent[1] = (double)rows * sqrt(3) / 2;
		struct lattice lattice = lattice_fit(&box, true, rows * rows);
		assert_true(lattice.sites == rows * rows);
		assert_true(fabs(lattice.distance - 1) < 1e-14);
	}
	for (size_t count = 1; count <= 100; count++) {
		struct lattice_box box = cube(1, (double)count);
		assert_true(lattice_fit(&box, true, count).distance == 1);
	}
	for (size_t side = 1; side <= 20; side++) {
		struct lattice_box box = cube(3, (double)side);
		struct lattice lattice = lattice_fit(&box, false, side * side * side);
		assert_true(lattice.sites == side * side * side && lattice.distance == 1);
	}
}

/* Between walls a row of touching spheres fits to the last place, and nothing fits where half a diameter is missing. */
static void walls_are_kept_off(void **state)
{
	(void)state;
	struct lattice_box box = cube(3, 5);
	for (int axis = 0; axis < 3; axis++) box.periodic[axis] = false, box.walled[axis] = true;
	assert_true(lattice_fit(&box, false, 125).distance == 1);
	assert_true(lattice_fit(&box, false, 126).distance < 1);
	box.extent[2] = 0.99;
	assert_true(lattice_fit(&box, false, 1).sites == 0);
}

/* Vacancies are spread: no stretch of a row with every other site empty holds more than its share. */
static void vacancies_are_spread(void **state)
{
	(void)state;
	struct lattice_box box = cube(1, 100);
	struct lattice lattice = lattice_fit(&box, false, 100);
	struct touchstone_particle particles[40] = {0};
	lattice_place(&lattice, particles, 40);
	for (int p = 1; p < 40; p++) {
		double gap = particles[p].position[0] - particles[p - 1].position[0];
		assert_true(gap > 1.5 && gap < 3.5);
	}
}

int main(void)
{
	printf("seed %llu\n", (unsigned long long)seed);
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(sites_are_apart),      cmocka_unit_test(claim_is_attained),
		cmocka_unit_test(walls_are_kept_off),   cmocka_unit_test(close_packing_is_reached),
		cmocka_unit_test(vacancies_are_spread),
	};
	return cmocka_run_group_tests(tests, NULL, NULL);
}
