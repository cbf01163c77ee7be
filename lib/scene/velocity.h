/* Start velocities. */
#ifndef TOUCHSTONE_VELOCITY_H
#define TOUCHSTONE_VELOCITY_H

#include "scene/random.h"
#include "scene/scene.h"

/* Sets the velocities of `particles` (the scene's own). The total momentum is then zero to one rounding per axis,
 * except for a single particle, which would have no motion left and keeps its own. A temperature above 0 is met to a
 * few roundings: sum of mass velocity^2 = dimensions * particle_count * temperature. */
void velocity_draw(const struct touchstone_scene *scene, struct touchstone_particle *particles,
				   enum scene_velocities law, double temperature, struct random_state *random);

#endif
