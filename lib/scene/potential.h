/* Stepped potentials and virtual walls: what a scene may say of them, and a potential made by a rule. */
#ifndef TOUCHSTONE_SCENE_POTENTIAL_H
#define TOUCHSTONE_SCENE_POTENTIAL_H

#include "scene/scene.h"

/* Most species of a scene that has potentials: an engine keeps a table of all pairs of them. */
enum { POTENTIAL_MOST_SPECIES = 1000 };

/* Distance at which particles of two species collide: the mean of their diameters, or the core of their potential; 0
 * when they never do. */
double potential_core(const struct touchstone_scene *scene, uint32_t first, uint32_t second);

/* Whether an engine can be made of the potentials, or virtual walls, of a scene whose box and species are in order. */
bool potential_check(const struct touchstone_scene *scene, struct scene_error *error);
bool potential_check_virtual_walls(const struct touchstone_scene *scene, struct scene_error *error);

/* A potential of Lennard and Jones, 4 energy ((length/r)^12 - (length/r)^6), cut off but not shifted. */
struct lennard_jones {
	double energy, length; /* depth, and the distance at which it is 0 */
	double core, cutoff;   /* 0 < core < cutoff */
};

/* Makes it into `count` steps of equal width from the core to the cutoff; the energy of each is the mean over the
 * volume of its shell in that many dimensions. This is one of the rules compared by Thomson, Lue and Bannerman,
 * "Mapping continuous potentials to discrete forms", Journal of Chemical Physics 140, 034105 (2014). */
void potential_lennard_jones(const struct lennard_jones *law, int dimensions, size_t count,
							 struct touchstone_step *steps);

#endif
