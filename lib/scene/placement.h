/* Where particles start, by any of the ways a recipe may ask for. */
#ifndef TOUCHSTONE_PLACEMENT_H
#define TOUCHSTONE_PLACEMENT_H

#include "scene/random.h"
#include "scene/scene.h"

/* Sum of diameter^dimensions over all particles. */
double placement_content(const struct touchstone_scene *scene);

/* Sets the positions of `particles` (the scene's own, their species known, in a frame that is sound); given ones are
 * brought into the box along periodic axes. False when there is no room for all; where the recipe limits the packing,
 * the scene's count becomes that of the particles placed. */
bool placement_fill(const struct scene_recipe *recipe, struct touchstone_scene *scene,
					struct touchstone_particle *particles, struct random_state *random, struct scene_error *error);

#endif
