/* Start states: what a recipe asks for is what comes out, or one line says why not. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "scene/insertion.h"
#include "scene/random.h"
#include "scene/scene.h"
#include "test/gas.h"

static const uint64_t seed = 20160401;

static double temperature_of(const struct touchstone_scene *scene)
{
	double sum = 0;
	for (size_t p = 0; p < scene->particle_count; p++)
		for (int axis = 0; axis < 3; axis++)
			sum += scene->species[scene->particles[p].species].mass * scene->particles[p].velocity[axis] *
				   scene->particles[p].velocity[axis];
	return sum / (double)scene->dimensions / (double)scene->particle_count;
}

static double largest_momentum(const struct touchstone_scene *scene)
{
	double largest = 0;
	for (int axis = 0; axis < 3; axis++) {
		__float128 sum = 0; /* long double has no more bits than double where it is emulated */
		for (size_t p = 0; p < scene->particle_count; p++)
			sum += (__float128)scene->species[scene->particles[p].species].mass * scene->particles[p].velocity[axis];
		largest = fmax(largest, fabs((double)sum));
	}
	return largest;
}

/* Recipes of any dimensions, ends, sizes, masses and laws, none so dense that it cannot be. */
static void recipes_come_true(void **state)
{
	(void)state;
	struct random_state random = random_seed(seed);
	for (int trial = 0; trial < 400; trial++) {
		struct scene_species species[3];
		int dimensions = 1 + (int)random_below(&random, 3);
		struct scene_recipe recipe = gas(dimensions, 2 + random_below(&random, 400), 0);
		recipe.species = species;
		recipe.species_count = 1 + random_below(&random, 3);
		double content = 0;
		for (size_t s = 0; s < recipe.species_count; s++) {
			double diameter = 0.5 + random_uniform(&random), mass = 0.1 + 5 * random_uniform(&random);
			species[s] = (struct scene_species){1.0 / (double)recipe.species_count, {diameter, mass}};
		}
		recipe.density = 0.02 + 0.08 * random_uniform(&random);
		for (int axis = 0; axis < recipe.dimensions; axis++)
			recipe.boundary[axis] = (enum scene_boundary)random_below(&random, 3);
		recipe.positions = (enum scene_positions)random_below(&random, 3);
		recipe.velocities = (enum scene_velocities)random_below(&random, 3);
		recipe.temperature = 0.1 + random_uniform(&random);

		struct touchstone_scene scene;
		struct scene_error error;
		if (!scene_build(&recipe, random_bits(&random), &scene, &error)) fail_msg("%s: %s", error.key, error.text);
		double volume = 1;
		for (int axis = 0; axis < recipe.dimensions; axis++) volume *= scene.box[axis];
		for (size_t p = 0; p < scene.particle_count; p++)
			content += pow(scene.species[scene.particles[p].species].diameter, recipe.dimensions);
		assert_true(fabs(content / volume / recipe.density - 1) < 1e-12);
		if (recipe.velocities == SCENE_REST)
			assert_true(temperature_of(&scene) == 0);
		else
			assert_true(fabs(temperature_of(&scene) / recipe.temperature - 1) < 1e-13);
		assert_true(largest_momentum(&scene) < 1e-14);
		assert_true(scene_check(&scene, &error));
		scene_free(&scene);
	}
}

static void fractions_are_dealt(void **state)
{
	(void)state;
	const struct scene_species three[] = {{0.5, {1, 1}}, {0.3, {0.5, 2}}, {0.2, {0.25, 3}}};
	for (size_t count = 1; count < 60; count++) {
		struct scene_recipe recipe = gas(3, count, 0.05);
		recipe.species = three, recipe.species_count = 3;
		struct touchstone_scene scene;
		struct scene_error error;
		assert_true(scene_build(&recipe, count, &scene, &error));
		size_t number[3] = {0};
		for (size_t p = 0; p < count; p++) number[scene.particles[p].species]++;
		for (int s = 0; s < 3; s++) assert_true(fabs((double)number[s] - three[s].fraction * (double)count) < 1);
		scene_free(&scene);
	}
}

/* Each component's law: Maxwell's variance is kT/mass, and its fourth moment three times the square of it. */
static void maxwell_has_the_right_width(void **state)
{
	(void)state;
	const struct scene_species two[] = {{0.5, {1, 1}}, {0.5, {1, 4}}};
	struct scene_recipe recipe = gas(3, 40000, 0.3);
	recipe.species = two, recipe.species_count = 2, recipe.temperature = 2.5;
	struct touchstone_scene scene;
	struct scene_error error;
	assert_true(scene_build(&recipe, seed, &scene, &error));
	for (uint32_t s = 0; s < 2; s++) {
		double second = 0, fourth = 0, draws = 60000;
		for (size_t p = 0; p < scene.particle_count; p++)
			for (int axis = 0; axis < 3 && scene.particles[p].species == s; axis++) {
				double square = scene.particles[p].velocity[axis] * scene.particles[p].velocity[axis];
				second += square / draws, fourth += square * square / draws;
			}
		double variance = 2.5 / two[s].body.mass;
		assert_true(fabs(second / variance - 1) < 5 * sqrt(2 / draws));
		assert_true(fabs(fourth / (variance * variance) - 3) < 5 * sqrt(96 / draws));
	}
	scene_free(&scene);
}

static void random_placement_is_uniform(void **state)
{
	(void)state;
	struct scene_recipe recipe = gas(2, 20000, 0.4);
	recipe.positions = SCENE_RANDOM;
	struct touchstone_scene scene;
	struct scene_error error;
	assert_true(scene_build(&recipe, seed, &scene, &error));
	double mean[2] = {0};
	for (size_t p = 0; p < scene.particle_count; p++)
		for (int axis = 0; axis < 2; axis++) mean[axis] += scene.particles[p].position[axis] / scene.box[axis] / 20000;
	for (int axis = 0; axis < 2; axis++) assert_true(fabs(mean[axis]) < 5 * sqrt(1.0 / 12 / 20000));
	scene_free(&scene);
}

/* Up to the end that is documented it succeeds; past saturation it says where it got to. */
static void random_placement_ends(void **state)
{
	(void)state;
	for (int dimensions = 1; dimensions <= 3; dimensions++) {
		struct scene_recipe recipe = gas(dimensions, 4000, insertion_end(dimensions));
		recipe.positions = SCENE_RANDOM;
		struct touchstone_scene scene;
		struct scene_error error;
		assert_true(scene_build(&recipe, seed, &scene, &error));
		scene_free(&scene);
		recipe.density = 0.8;
		assert_false(scene_build(&recipe, seed, &scene, &error));
		assert_string_equal(error.key, "start.positions");
		assert_non_null(strstr(error.text, "of 4000 particles"));
		recipe.particle_count = 1000000; /* not even tried */
		assert_false(scene_build(&recipe, seed, &scene, &error));
		assert_non_null(strstr(error.text, "ends before density 0.8"));
	}
}

static void close_packing_is_built(void **state)
{
	(void)state;
	struct touchstone_scene scene;
	struct scene_error error;
	for (size_t cells = 1; cells <= 15; cells += 2) {
		struct scene_recipe recipe = gas(3, 4 * cells * cells * cells, scene_close_packing(3));
		assert_true(scene_build(&recipe, seed, &scene, &error));
		scene_free(&scene);
	}
	struct scene_recipe triangular = gas(2, 100, 0);
	triangular.box[0] = 10, triangular.box[1] = 5 * sqrt(3);
	assert_true(scene_build(&triangular, seed, &scene, &error));
	scene_free(&scene);
	struct scene_recipe rods = gas(1, 50, 1);
	assert_true(scene_build(&rods, seed, &scene, &error));
	assert_true(scene.box[0] == 50);
	scene_free(&scene);
	struct scene_recipe exact = gas(3, 27000, 1);
	assert_true(scene_build(&exact, seed, &scene, &error));
	assert_true(scene.box[0] == 30);
	scene_free(&scene);
}

/* A density that is refused names one that is not. */
static void advice_is_sound(void **state)
{
	(void)state;
	for (int dimensions = 1; dimensions <= 3; dimensions++)
		for (size_t count = 2; count < 400; count += 7) {
			struct scene_recipe recipe = gas(dimensions, count, scene_close_packing(dimensions) * 1.01);
			struct touchstone_scene scene;
			struct scene_error error;
			for (int advice = 0; !scene_build(&recipe, seed, &scene, &error); advice++) {
				assert_true(advice < 2); /* beyond close packing, then beyond this lattice */
				recipe.density = strtod(strstr(error.text, "up to ") + strlen("up to "), NULL);
				assert_true(recipe.density > 0.1);
			}
			scene_free(&scene);
		}
}

static void one_particle(void **state)
{
	(void)state;
	for (int dimensions = 1; dimensions <= 3; dimensions++)
		for (enum scene_positions positions = SCENE_LATTICE; positions <= SCENE_RANDOM; positions++) {
			struct scene_recipe recipe = gas(dimensions, 1, 0.1);
			recipe.positions = positions;
			struct touchstone_scene scene;
			struct scene_error error;
			assert_true(scene_build(&recipe, seed, &scene, &error));
			assert_true(fabs(temperature_of(&scene) - 1) < 1e-14); /* it keeps its motion */
			scene_free(&scene);
		}
}

static void same_seed_same_start(void **state)
{
	(void)state;
	const struct scene_species two[] = {{0.75, {1, 1}}, {0.25, {0.3, 0.1}}};
	struct scene_recipe recipe = gas(3, 5000, 0.45);
	recipe.species = two, recipe.species_count = 2;
	uint64_t digest = UINT64_C(0xcbf29ce484222325);
	for (enum scene_positions positions = SCENE_LATTICE; positions <= SCENE_RANDOM; positions++) {
		recipe.positions = positions;
		recipe.density = positions == SCENE_LATTICE ? 0.8 : 0.45;
		struct touchstone_scene scene;
		struct scene_error error;
		assert_true(scene_build(&recipe, 1, &scene, &error));
		for (size_t p = 0; p < scene.particle_count; p++) {
			uint64_t bits[7] = {0};
			memcpy(bits, scene.particles[p].position, 24);
			memcpy(bits + 3, scene.particles[p].velocity, 24);
			bits[6] = scene.particles[p].species;
			for (int i = 0; i < 7; i++) digest = (digest ^ bits[i]) * UINT64_C(0x100000001b3);
		}
		scene_free(&scene);
	}
	printf("digest of three start states: %016llx\n", (unsigned long long)digest);
	assert_true(digest == UINT64_C(0x90f2d4f791085528)); /* recorded once; every compiler must repeat it */
}

static void refused(const struct scene_recipe *recipe, const char *key, const char *word)
{
	struct touchstone_scene scene;
	struct scene_error error = {0};
	assert_false(scene_build(recipe, seed, &scene, &error));
	assert_string_equal(error.key, key);
	if (!strstr(error.text, word)) fail_msg("'%s' does not say '%s'", error.text, word);
	assert_null(strchr(error.text, '\n'));
}

static void impossible_recipes_are_refused(void **state)
{
	(void)state;
	struct scene_recipe recipe = gas(4, 10, 0.5);
	refused(&recipe, "dimensions", "accepted: 1, 2 or 3");
	recipe = gas(3, 0, 0.5);
	refused(&recipe, "particles", "0; accepted");
	for (int dimensions = 1; dimensions <= 3; dimensions++) {
		recipe = gas(dimensions, 100, 1.0001 * scene_close_packing(dimensions));
		refused(&recipe, "density", "beyond close packing");
	}
	recipe = gas(3, 13500, 1.5);
	refused(&recipe, "density", "1.41421356");
	recipe = gas(3, 1000, 1.4);
	refused(&recipe, "density", "accepted for this many particles: up to");
	recipe = gas(3, 10, NAN);
	refused(&recipe, "density", "nan");
	recipe = gas(3, 10, 0);
	refused(&recipe, "box", "extent of 0");
	recipe.box[0] = recipe.box[1] = 10, recipe.box[2] = 0.5;
	refused(&recipe, "box", "overlaps its own image");
	recipe = gas(3, 10, 0.5);
	recipe.temperature = 0;
	refused(&recipe, "start.temperature", "above 0");
	recipe = gas(3, 10, 0.5);
	recipe.restitution.coefficient = 1.5;
	refused(&recipe, "restitution", "1.5");
	recipe = gas(3, 10, 0.5);
	recipe.boundary_restitution.coefficient = -0.5;
	refused(&recipe, "boundary_restitution", "accepted: 0 to 1");
	recipe = gas(3, 10, 0.5);
	recipe.restitution = (struct touchstone_restitution){TOUCHSTONE_VISCOELASTIC, -1};
	refused(&recipe, "restitution", "dissipation");
	recipe = gas(3, 10, 0.5);
	recipe.acceleration[2] = INFINITY;
	refused(&recipe, "gravity", "finite");
	recipe = gas(3, 10, 0.5);
	recipe.cell = -1;
	refused(&recipe, "cell", "-1");
	const struct touchstone_wall walls[] = {{.normal = {2}, .point = {-1e3}}, {.normal = {0}}};
	recipe = gas(3, 10, 0.5);
	recipe.walls = walls, recipe.wall_count = 2;
	refused(&recipe, "walls[1].normal", "no direction");
	const struct scene_species bad[][2] = {
		{{0.5, {1, 1}}, {0.5, {-1, 1}}}, {{0.5, {1, 1}}, {0.5, {1, 0}}}, {{0.5, {1, 1}}}};
	const char *key[] = {"species[1].diameter", "species[1].mass", "species"};
	const char *word[] = {"-1", "0; accepted", "add up to 0.5"};
	for (int i = 0; i < 3; i++) {
		recipe = gas(3, 10, 0.5);
		recipe.species = bad[i], recipe.species_count = i < 2 ? 2 : 1;
		refused(&recipe, key[i], word[i]);
	}
}

static void impossible_places_are_refused(void **state)
{
	(void)state;
	struct touchstone_particle bodies[] = {{.position = {0}}, {.position = {0.25}}, {.position = {-1.5}}};
	struct scene_recipe recipe = gas(1, 3, 0);
	recipe.positions = SCENE_GIVEN, recipe.velocities = SCENE_AS_GIVEN, recipe.particles = bodies, recipe.box[0] = 8;
	refused(&recipe, "particles", "particles 0 and 1 overlap by 0.75");
	bodies[1].position[0] = 9.5; /* an image of 1.5 */
	struct touchstone_scene scene;
	struct scene_error error;
	assert_true(scene_build(&recipe, seed, &scene, &error));
	assert_true(scene.particles[1].position[0] == 1.5);
	scene_free(&scene);
	recipe.boundary[0] = SCENE_WALLS;
	refused(&recipe, "particles", "particle 1 reaches 6 through the wall");
	recipe.boundary[0] = SCENE_OPEN, recipe.box[0] = 0;
	assert_true(scene_build(&recipe, seed, &scene, &error));
	assert_true(scene.box[0] == 20);
	scene_free(&scene);
	bodies[2].position[1] = 1;
	refused(&recipe, "particles", "1 dimensions");
	bodies[2].position[1] = 0, bodies[2].velocity[0] = NAN;
	refused(&recipe, "particles", "not finite");
	bodies[2].velocity[0] = 0, bodies[2].species = 1;
	refused(&recipe, "species", "particle 2");
	bodies[2].species = 0, bodies[1].position[0] = 1 - 1e-12; /* deeper than rounding */
	refused(&recipe, "particles", "particles 0 and 1 overlap by 9.99978e-13");
	bodies[1].position[0] = 1 - 0x1p-52; /* not */
	assert_true(scene_build(&recipe, seed, &scene, &error));
	scene_free(&scene);
}

int main(void)
{
	printf("seed %llu\n", (unsigned long long)seed);
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(recipes_come_true),
		cmocka_unit_test(fractions_are_dealt),
		cmocka_unit_test(maxwell_has_the_right_width),
		cmocka_unit_test(random_placement_is_uniform),
		cmocka_unit_test(random_placement_ends),
		cmocka_unit_test(close_packing_is_built),
		cmocka_unit_test(advice_is_sound),
		cmocka_unit_test(one_particle),
		cmocka_unit_test(same_seed_same_start),
		cmocka_unit_test(impossible_recipes_are_refused),
		cmocka_unit_test(impossible_places_are_refused),
	};
	return cmocka_run_group_tests(tests, NULL, NULL);
}
