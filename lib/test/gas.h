/* The gas that most tests begin with. */
#ifndef LIB_TEST_GAS_H
#define LIB_TEST_GAS_H

#include <stddef.h>

#include "scene/scene.h"

static const struct scene_species unit_ball[] = {{1, {1, 1}}};

/* Equal elastic balls, periodic, on a lattice, with Maxwell's velocities. */
static inline struct scene_recipe gas(int dimensions, size_t count, double density)
{
	return (struct scene_recipe){
		.dimensions = dimensions,
		.particle_count = count,
		.density = density,
		.boundary_restitution = {TOUCHSTONE_CONSTANT, 1},
		.species_count = 1,
		.species = unit_ball,
		.restitution = {TOUCHSTONE_CONSTANT, 1},
		.positions = SCENE_LATTICE,
		.velocities = SCENE_MAXWELL,
		.temperature = 1,
	};
}

#endif
