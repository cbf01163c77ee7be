/* A start state that any arithmetic can be given: a scene after elastic equilibration, as doubles. */
#ifndef VERIFY_START_STATE_H
#define VERIFY_START_STATE_H

#include "measure/course.h"
#include "scene/scene.h"

/* Runs the scene elastically in binary64 by `stable`, so many collisions per particle, and fills `particles` (room for
 * the scene's count) with where they then are, how fast, and of which species. False when stopped on the way, and then
 * `error` is empty, or with one line in `error`. */
bool start_state(const struct touchstone_scene *scene, double collisions, const struct watch *watch,
				 struct touchstone_particle *particles, char error[160]);

/* The recipe's scene, with such a start state for its particles; the caller owns it and calls scene_free. False as
 * above, and then there is nothing to free. */
bool start_scene(const struct scene_recipe *recipe, uint64_t seed, double collisions, const struct watch *watch,
				 struct touchstone_scene *scene, char error[160]);

/* A gas of equal elastic spheres of diameter and mass 1 at kT = 1 in a periodic box, on a lattice. */
struct scene_recipe start_spheres(size_t count, double density);

#endif
