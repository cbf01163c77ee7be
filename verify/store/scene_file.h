/* Scene files: YAML that says what is simulated and how. The keys are explained at the top of cases/hard-spheres.yaml.
 *
 * Everything that is wrong with one is said on one line, "FILE:LINE: key: what; accepted: what", or "--set KEY=VALUE:
 * key: ..." when an override is to blame. */
#ifndef TOUCHSTONE_SCENE_FILE_H
#define TOUCHSTONE_SCENE_FILE_H

#include "scene/scene.h"
#include "store/text.h"

struct scene_file {
	char *name;                      /* of the file, without folder and ending */
	const char *title;               /* one line; the name where none is given */
	const char *about;               /* further text; "" where none is given */
	const char *method;              /* "stable" where none is given; not looked up here, nor is the arithmetic */
	const char *arithmetic;          /* "binary64" where none is given */
	uint64_t seed;                   /* 1 where none is given */
	struct touchstone_limits limits; /* UINT64_MAX events, INFINITY time where none are given */
	double equilibrate;              /* elastic collisions per particle before measuring; 0 where none are given */
	struct scene_recipe recipe;
	struct scene_source *source; /* what all of this points into, and where each key was said */
};

/* Reads a scene file; each of `settings` (KEY=VALUE, as after --set) overrides a key, the last one first. NULL with a
 * message when the file or a setting is not what it should be. The caller owns the result. */
struct scene_file *scene_file_open(const char *path, size_t setting_count, const char *const settings[],
								   char error[STORE_ERROR]);
void scene_file_close(struct scene_file *file);

/* Makes the scene of `file`, by its seed; free it with scene_free. False with a message when there is no such start
 * state: no room, overlaps, particles beyond walls. */
bool scene_file_build(const struct scene_file *file, struct touchstone_scene *scene, char error[STORE_ERROR]);

/* Fills `error` with a message about a key, such as "method" or "species[1].mass", led by where it was given (or, when
 * it was not, where it should be), and returns false. */
__attribute__((format(printf, 4, 5))) bool scene_file_refuse(const struct scene_file *file, char error[STORE_ERROR],
															 const char *key, const char *format, ...);

#endif
