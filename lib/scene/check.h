/* The parts of scene_check, and how the parts of lib/scene say no. */
#ifndef TOUCHSTONE_CHECK_H
#define TOUCHSTONE_CHECK_H

#include "scene/scene.h"

/* Fills `error` (particle: SIZE_MAX for none) and returns false. */
__attribute__((format(printf, 4, 5))) bool scene_refuse(struct scene_error *error, const char *key, size_t particle,
														const char *format, ...);

bool scene_check_restitution(struct touchstone_restitution restitution, const char *key, struct scene_error *error);

/* Everything but the particles, whose number is looked at only. */
bool scene_check_frame(const struct touchstone_scene *scene, struct scene_error *error);

/* The particles of a scene whose frame is sound. */
bool scene_check_particles(const struct touchstone_scene *scene, struct scene_error *error);

#endif
