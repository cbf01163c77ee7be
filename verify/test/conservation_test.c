/* Energy and momentum of a configuration against sums of any length; elastic runs keep them, others do not. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#include <cmocka.h>
#include <mpfr.h>

#include "measure/conservation.h"
#include "scene/random.h"
#include "scene/scene.h"

static const uint64_t seed = 1959;

enum { COUNT = 40, BITS = 3000 };

/* A box of two sorts of discs without order in size: what is summed cancels for the most part. */
struct box {
	struct touchstone_particle particles[COUNT];
	struct touchstone_species species[2];
	struct touchstone_scene scene;
};

static void fill(struct box *box, struct random_state *random)
{
	*box = (struct box){.species = {{0.5, 1 + random_uniform(random)}, {0.25, 0x1p-20 * random_uniform(random)}}};
	for (int p = 0; p < COUNT; p++) {
		struct touchstone_particle *particle = &box->particles[p];
		particle->position[0] = p - COUNT / 2 + 0.25 * random_uniform(random);
		particle->position[1] = 4 * random_uniform(random) - 2;
		particle->species = (uint32_t)(p % 2);
		for (int axis = 0; axis < 2; axis++)
			particle->velocity[axis] = ldexp(random_uniform(random) - 0.5, (int)random_below(random, 30));
	}
	box->scene = (struct touchstone_scene){.dimensions = 2,
										   .particle_count = COUNT,
										   .particles = box->particles,
										   .species_count = 2,
										   .species = box->species,
										   .box = {2 * COUNT, 8},
										   .acceleration = {0, -random_uniform(random)},
										   .form = TOUCHSTONE_ABSOLUTE,
										   .restitution = {TOUCHSTONE_CONSTANT, 1}};
}

/* Adds a product of up to four factors, exactly. */
static void add_product(mpfr_t sum, double a, double b, double c, double d)
{
	mpfr_t product;
	mpfr_init2(product, BITS);
	mpfr_set_d(product, a, MPFR_RNDN);
	mpfr_mul_d(product, product, b, MPFR_RNDN);
	mpfr_mul_d(product, product, c, MPFR_RNDN);
	mpfr_mul_d(product, product, d, MPFR_RNDN);
	mpfr_add(sum, sum, product, MPFR_RNDN);
	mpfr_clear(product);
}

/* |parts - exact| is at most 2^-95 of the scale: double-double, and sixteen bits for a few dozen roundings. */
static void assert_near(const double parts[2], mpfr_t exact, double scale)
{
	mpfr_sub_d(exact, exact, parts[0], MPFR_RNDN);
	mpfr_sub_d(exact, exact, parts[1], MPFR_RNDN);
	double error = fabs(mpfr_get_d(exact, MPFR_RNDN));
	if (!(error <= 0x1p-95 * scale)) fail_msg("off by %g of %g", error, scale);
}

static void sums_are_right(void **state)
{
	(void)state;
	print_message("seed %llu\n", (unsigned long long)seed);
	struct random_state random = random_seed(seed);
	mpfr_t energy, momentum[2];
	mpfr_inits2(BITS, energy, momentum[0], momentum[1], (mpfr_ptr)0);
	for (int trial = 0; trial < 50; trial++) {
		struct box box;
		char error[160];
		fill(&box, &random);
		struct touchstone_engine *engine = touchstone_create(&box.scene, "binary64", "stable", error);
		if (!engine) fail_msg("%s", error);
		struct conservation conservation = conservation_of(&box.scene, engine);
		mpfr_set_zero(energy, 1);
		double kinetic = 0, potential = 0, moving = 0;
		for (int axis = 0; axis < 2; axis++) mpfr_set_zero(momentum[axis], 1);
		for (uint32_t p = 0; p < COUNT; p++) {
			double position[3], velocity[3], mass = box.species[p % 2].mass;
			touchstone_state(engine, p, position, velocity);
			for (int axis = 0; axis < 2; axis++) {
				add_product(energy, 0.5, mass, velocity[axis], velocity[axis]);
				add_product(momentum[axis], mass, velocity[axis], 1, 1);
				kinetic += 0.5 * mass * velocity[axis] * velocity[axis];
			}
			add_product(energy, -mass, box.scene.acceleration[1], position[1], 1);
			potential += fabs(mass * box.scene.acceleration[1] * position[1]);
			moving += mass * hypot(velocity[0], velocity[1]);
		}
		assert_near(conservation.energy, energy, kinetic + potential);
		for (int axis = 0; axis < 2; axis++) assert_near(conservation.momentum[axis], momentum[axis], moving);
		assert_true(fabs(conservation.energy_scale / (kinetic + potential) - 1) < 1e-12);
		assert_true(fabs(conservation.momentum_scale / moving - 1) < 1e-12);
		touchstone_destroy(engine);
	}
	mpfr_clears(energy, momentum[0], momentum[1], (mpfr_ptr)0);
}

static void drifts_are_relative(void **state)
{
	(void)state;
	const struct conservation begin = {.energy = {4, 0x1p-60}, .energy_scale = 8, .momentum_scale = 2};
	struct conservation end = begin, rest = {0};
	end.energy[1] = 0x1p-59;
	end.momentum[0][0] = 3 * 0x1p-70;
	end.momentum[2][0] = 4 * 0x1p-70;
	assert_true(conservation_energy_drift(&begin, &end) == 0x1p-63);
	assert_true(conservation_energy_drift(&end, &begin) == -0x1p-63);
	assert_true(conservation_momentum_drift(&begin, &end) == 2.5 * 0x1p-70);
	assert_true(isnan(conservation_energy_drift(&rest, &begin)) && isnan(conservation_momentum_drift(&rest, &begin)));
}

/* Drifts of a gas over some thousand collisions. */
static void drifts_of(double restitution, double *energy, double *momentum)
{
	static const struct scene_species spheres = {1, {1, 1}};
	const struct scene_recipe recipe = {.dimensions = 3,
										.particle_count = 100,
										.density = 0.5,
										.species_count = 1,
										.species = &spheres,
										.restitution = {TOUCHSTONE_CONSTANT, restitution},
										.temperature = 1};
	struct touchstone_scene scene;
	struct scene_error problem;
	char error[160];
	assert_true(scene_build(&recipe, seed, &scene, &problem));
	struct touchstone_engine *engine = touchstone_create(&scene, "binary64", "stable", error);
	assert_non_null(engine);
	struct conservation begin = conservation_of(&scene, engine);
	touchstone_run(engine, &(struct touchstone_limits){5000, INFINITY, NULL}, NULL);
	struct conservation end = conservation_of(&scene, engine);
	*energy = conservation_energy_drift(&begin, &end);
	*momentum = conservation_momentum_drift(&begin, &end);
	touchstone_destroy(engine);
	scene_free(&scene);
}

static void only_elastic_runs_keep_energy(void **state)
{
	(void)state;
	double energy, momentum;
	drifts_of(1, &energy, &momentum);
	assert_true(fabs(energy) < 1e-13 && momentum < 1e-13);
	drifts_of(0.9, &energy, &momentum);
	assert_true(energy < -0.5 && energy > -1 && momentum < 1e-13);
}

int main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(sums_are_right),
		cmocka_unit_test(drifts_are_relative),
		cmocka_unit_test(only_elastic_runs_keep_energy),
	};
	return cmocka_run_group_tests(tests, NULL, NULL);
}
