/* What makes two scenes one: a number that is the same if and only if (but once in 2^64 times) their engines, in the
 * same arithmetic and by the same method, have the same events. How neighbours are searched for does not count. */
#ifndef VERIFY_SCENE_IDENTITY_H
#define VERIFY_SCENE_IDENTITY_H

#include "touchstone.h"

uint64_t scene_identity(const struct touchstone_scene *scene);

#endif
