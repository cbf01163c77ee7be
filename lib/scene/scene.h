/* Scenes: a recipe (what a scene file says) and a seed become the start state that an engine is made from.
 *
 * Every function is a pure function of its arguments, built on + - * / and square roots, so that a seed means the
 * same start, bit for bit, on every machine. Coordinates run from -box/2 to +box/2 on every axis. */
#ifndef TOUCHSTONE_SCENE_H
#define TOUCHSTONE_SCENE_H

#include "touchstone.h"

/* What both ends of an axis are. */
enum scene_boundary {
	SCENE_PERIODIC,
	SCENE_WALLS, /* a wall at each end, at -box/2 and +box/2 */
	SCENE_OPEN,  /* nothing: the box only says where particles start */
};

enum scene_positions {
	SCENE_LATTICE, /* face-centred cubic; triangular in 2 dimensions (of any aspect ratio); evenly spaced in 1 */
	SCENE_CUBIC,   /* simple cubic; square in 2 dimensions; evenly spaced in 1 */
	SCENE_RANDOM,  /* uniform where there is room, one particle after the other (random sequential addition) */
	SCENE_GIVEN,   /* those of `particles` */
};

enum scene_velocities {
	SCENE_MAXWELL, /* normal, of variance kT/mass, then zero total momentum and exactly the stated temperature */
	SCENE_UNIFORM, /* in [-1, 1] on each axis, then zero total momentum; scaled when a temperature is stated */
	SCENE_REST,
	SCENE_AS_GIVEN, /* those of `particles` */
};

struct scene_species {
	double fraction; /* of all particles; the fractions of a recipe add up to 1. Not read for given positions */
	struct touchstone_species body;
};

struct scene_recipe {
	int dimensions;
	size_t particle_count;
	double density; /* sum of diameter^dimensions over volume (N sigma^d / V for one species), which makes a cubic
					   box; 0: `box` is given */
	double box[3];  /* 0 on an open axis of given particles: as wide as they need */
	enum scene_boundary boundary[3];
	struct touchstone_restitution boundary_restitution; /* of the walls at the ends of axes */
	size_t wall_count;
	const struct touchstone_wall *walls; /* further ones; normals of any length above 0 */
	size_t species_count;
	const struct scene_species *species;
	struct touchstone_restitution restitution; /* between particles that have no potential */
	size_t potential_count;
	const struct touchstone_potential *potentials;
	size_t virtual_wall_count;
	const struct touchstone_virtual_wall *virtual_walls; /* normals of any length above 0 */
	double acceleration[3];
	enum scene_positions positions;
	enum scene_velocities velocities;
	double temperature;                          /* kT; 0: not stated */
	const struct touchstone_particle *particles; /* particle_count of them, when any part is given */
	enum touchstone_form form;
	enum touchstone_search search;
	double cell, clock;
	double contact_time, shrinking, search_step; /* of methods; 0: what they say themselves */
};

/* Why a scene cannot be. `key` is the part of the recipe that is to blame, in the words of a scene file, such as
 * "density" or "species[1].diameter"; `text` is one line that goes on from it and says what is accepted. */
struct scene_error {
	char key[48];
	size_t particle; /* the particle to blame, or SIZE_MAX */
	char text[224];
};

/* Most particles of a scene: what an engine can number. */
enum { SCENE_MOST_PARTICLES = (1 << 26) - 1 };

/* Makes the scene. The caller owns it and calls scene_free. False, with `error` filled and nothing to free, when the
 * recipe contradicts itself, has no room for its particles or fails scene_check. */
bool scene_build(const struct scene_recipe *recipe, uint64_t seed, struct touchstone_scene *scene,
				 struct scene_error *error);
void scene_free(struct touchstone_scene *scene);

/* Whether a scene, from wherever, is one that an engine can start from: finite numbers, positive diameters and masses,
 * restitution in 0 to 1, a box wide enough, no particle beyond a wall, none overlapping another. A depth of up to 64
 * ulp of the longest side of the box is taken for touching. Takes O(N) time whatever the sizes of the particles. */
bool scene_check(const struct touchstone_scene *scene, struct scene_error *error);

/* The highest density (in the units of the recipe) of equal particles: sqrt(2), 2/sqrt(3), 1. */
double scene_close_packing(int dimensions);

#endif
