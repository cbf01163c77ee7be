/* How a scene with convection begins: who is hot. */
#ifndef TOUCHSTONE_SCENE_CONVECTION_H
#define TOUCHSTONE_SCENE_CONVECTION_H

#include "scene/scene.h"

/* Gives the scene, whose walls and positions are set, the temperatures that the recipe asks for: none, or of each
 * particle 1 where (first coordinate) / (box) < (last coordinate) / (box), else 0; of the walls that stand at the ends
 * of the last axis those of the recipe, of others none. False, with `error` filled, when that makes no sense. */
bool convection_start(const struct scene_recipe *recipe, struct touchstone_scene *scene, struct scene_error *error);
void convection_free(struct touchstone_scene *scene);

/* Whether the scene's kick, temperatures and thermostat are numbers that make sense. */
bool convection_check(const struct touchstone_scene *scene, struct scene_error *error);

#endif
