/* The reader of scenes, and what makes a start state of one, if it is small. */
#include "fuzz/target/target.h"

#include "store/scene_file.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
	char path[40], error[STORE_ERROR];
	int file = target_file(data, size, path);
	struct scene_file *scene_file = scene_file_open(path, 0, NULL, error);
	struct touchstone_scene scene;
	if (scene_file && scene_file->recipe.particle_count < 64 && scene_file_build(scene_file, &scene, error))
		scene_free(&scene);
	scene_file_close(scene_file);
	close(file);
	return 0;
}
