/* A start state that any arithmetic can be given: a scene after elastic equilibration, as doubles. */
#ifndef VERIFY_START_STATE_H
#define VERIFY_START_STATE_H

#include "measure/course.h"

/* Runs the scene elastically in binary64 by `stable`, so many collisions per particle, and fills `particles` (room for
 * the scene's count) with where they then are, how fast, and of which species. False when stopped on the way, and then
 * `error` is empty, or with one line in `error`. */
bool start_state(const struct touchstone_scene *scene, double collisions, const struct watch *watch,
				 struct touchstone_particle *particles, char error[160]);

#endif
