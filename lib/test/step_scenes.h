/* Gases of particles with steps, for the tests of the engine. */
#ifndef LIB_TEST_STEP_SCENES_H
#define LIB_TEST_STEP_SCENES_H

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

enum { SEED = 20160301 };

static const struct scene_species two_sizes[] = {{0.5, {1, 1}}, {0.5, {0.6, 0.3}}};

struct run {
	struct touchstone_scene scene;
	struct touchstone_engine *engine;
};

static inline struct run begin(const struct scene_recipe *recipe, const char *arithmetic, const char *method)
{
	struct run run;
	struct scene_error complaint;
	char error[160] = "";
	if (!scene_build(recipe, SEED, &run.scene, &complaint)) fail_msg("%s %s", complaint.key, complaint.text);
	run.engine = touchstone_create(&run.scene, arithmetic, method, error);
	if (!run.engine) fail_msg("%s", error);
	return run;
}

static inline struct touchstone_status status_of(const struct run *run)
{
	struct touchstone_status status;
	touchstone_status(run->engine, &status);
	return status;
}

static inline struct touchstone_status advance(const struct run *run, uint64_t events)
{
	touchstone_run(run->engine, &(struct touchstone_limits){events, INFINITY, NULL}, NULL);
	return status_of(run);
}

static inline void end(struct run *run)
{
	touchstone_destroy(run->engine);
	scene_free(&run->scene);
}

/* Steps of random distances and energies between the species, some of them left as hard bodies. */
struct drawn {
	struct touchstone_potential potentials[3];
	struct touchstone_step steps[3][4];
	struct touchstone_virtual_wall walls[2];
};

static inline void draw(struct drawn *drawn, struct scene_recipe *recipe, struct random_state *random)
{
	recipe->potentials = drawn->potentials;
	recipe->potential_count = 0;
	for (uint32_t a = 0; a < recipe->species_count; a++)
		for (uint32_t b = 0; b <= a; b++) {
			if (recipe->potential_count && random_below(random, 4) == 0) continue;
			double core = (recipe->species[a].body.diameter + recipe->species[b].body.diameter) / 2;
			size_t number = recipe->potential_count++, count = 1 + random_below(random, 4);
			struct touchstone_step *steps = drawn->steps[number];
			for (size_t s = 0; s < count; s++) {
				double inner = s ? steps[s - 1].distance : core;
				steps[s] = (struct touchstone_step){inner + 0.05 + 0.35 * random_uniform(random),
													2 * random_uniform(random) - 1};
			}
			bool soft = random_below(random, 4) == 0;
			struct touchstone_restitution law = {TOUCHSTONE_CONSTANT, random_below(random, 3) ? 1 : 0.9};
			drawn->potentials[number] = (struct touchstone_potential){{a, b}, soft ? 0 : core, law, count, steps};
		}
	recipe->virtual_walls = drawn->walls;
	recipe->virtual_wall_count = random_below(random, 3);
	for (size_t w = 0; w < 2; w++) {
		int axis = (int)random_below(random, (uint64_t)recipe->dimensions);
		drawn->walls[w] = (struct touchstone_virtual_wall){{0}, {0}};
		drawn->walls[w].point[axis] = 2 * random_uniform(random) - 1;
		drawn->walls[w].normal[axis] = random_below(random, 2) ? 1 : -1;
	}
}

/* A small gas of any kind. */
static inline struct scene_recipe draw_gas(struct drawn *drawn, struct random_state *random)
{
	int dimensions = 1 + (int)random_below(random, 3);
	struct scene_recipe recipe = gas(dimensions, 20 + random_below(random, 40), 0.1 + 0.4 * random_uniform(random));
	recipe.form = random_below(random, 2) ? TOUCHSTONE_ABSOLUTE : TOUCHSTONE_RELATIVE;
	for (int axis = 0; axis < dimensions; axis++)
		if (random_below(random, 3) == 0) recipe.boundary[axis] = SCENE_WALLS;
	if (random_below(random, 4) == 0) recipe.acceleration[dimensions - 1] = -0.1 * random_uniform(random);
	if (random_below(random, 2)) recipe.species_count = 2, recipe.species = two_sizes, recipe.density *= 0.6;
	draw(drawn, &recipe, random);
	return recipe;
}

#endif
