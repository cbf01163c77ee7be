#include "measure/start_state.h"

#include <stdio.h>
#include <stdlib.h>

bool start_state(const struct touchstone_scene *scene, double collisions, const struct watch *watch,
				 struct touchstone_particle *particles, char error[160])
{
	struct touchstone_engine *engine = touchstone_create(scene, "binary64", "stable", error);
	if (!engine) return false;
	*error = '\0';
	bool through = course_equilibrate(engine, collisions, watch);
	for (uint32_t i = 0; i < scene->particle_count; i++) {
		touchstone_state(engine, i, particles[i].position, particles[i].velocity);
		particles[i].species = scene->particles[i].species;
	}
	touchstone_destroy(engine);
	return through;
}

bool start_scene(const struct scene_recipe *recipe, uint64_t seed, double collisions, const struct watch *watch,
				 struct touchstone_scene *scene, char error[160])
{
	struct scene_error wrong;
	if (!scene_build(recipe, seed, scene, &wrong)) {
		snprintf(error, 160, "%.40s: %.110s", wrong.key, wrong.text);
		return false;
	}
	struct touchstone_particle *particles = calloc(scene->particle_count, sizeof *particles);
	snprintf(error, 160, "out of memory");
	bool good = particles && start_state(scene, collisions, watch, particles, error);
	free((void *)scene->particles);
	scene->particles = particles;
	if (!good) scene_free(scene);
	return good;
}

struct scene_recipe start_spheres(size_t count, double density)
{
	static const struct scene_species ball = {1, {1, 1}};
	return (struct scene_recipe){
		.dimensions = 3,
		.particle_count = count,
		.density = density,
		.boundary_restitution = {TOUCHSTONE_CONSTANT, 1},
		.species_count = 1,
		.species = &ball,
		.restitution = {TOUCHSTONE_CONSTANT, 1},
		.positions = SCENE_LATTICE,
		.velocities = SCENE_MAXWELL,
		.temperature = 1,
	};
}
