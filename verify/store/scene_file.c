#include "store/scene_file.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "store/scene_source.h"
#include "store/yaml_schema.h"

const struct yaml_text *scene_source_of(const struct scene_source *source, const char *key, size_t *line)
{
	for (size_t t = source->text_count; t-- > 1;)
		if (yaml_text_locate(&source->texts[t], key, line)) return &source->texts[t];
	yaml_text_locate(&source->texts[0], key, line);
	return &source->texts[0];
}

bool scene_file_refuse(const struct scene_file *file, char error[STORE_ERROR], const char *key, const char *format, ...)
{
	size_t line;
	const struct yaml_text *text = scene_source_of(file->source, key, &line);
	va_list arguments;
	va_start(arguments, format);
	yaml_text_blame(text, line, key, error, format, arguments);
	va_end(arguments);
	return false;
}

/* A density takes the place of a box, and a box that of a density. */
static void displace(struct scene_words *words, struct scene_words *other, bool density, bool box)
{
	if (density && !box) {
		char **entries = words->box;
		unsigned count = words->box_count;
		words->box = other->box, words->box_count = other->box_count;
		other->box = entries, other->box_count = count;
	} else if (box && !density) {
		char *word = words->density;
		words->density = other->density;
		other->density = word;
	}
}

/* Reads the file and the settings into the words. */
static bool read_texts(struct scene_source *source, const char *path, size_t setting_count,
					   const char *const settings[], char error[STORE_ERROR])
{
	cyaml_data_t *data = NULL;
	if (!yaml_text_read(&source->texts[0], path, error)) return false;
	source->text_count = 1;
	if (!yaml_schema_load(&source->texts[0], &scene_schema, &data, error)) return false;
	source->words = data;
	if (!data)
		return yaml_text_refuse(&source->texts[0], 1, "", error,
								"empty; accepted: keys and values, such as density: 0.5");
	for (size_t s = 0; s < setting_count; s++) {
		struct yaml_text *text = &source->texts[source->text_count];
		if (!yaml_text_setting(text, settings[s], error)) return false;
		source->text_count++;
		if (!yaml_schema_load(text, &scene_schema, &data, error)) return false;
		struct scene_words *other = data;
		bool density = other->density, box = other->box;
		yaml_schema_override(&scene_schema, source->words, other);
		displace(source->words, other, density, box);
		yaml_schema_free(&scene_schema, other);
	}
	return true;
}

struct scene_file *scene_file_open(const char *path, size_t setting_count, const char *const settings[],
								   char error[STORE_ERROR])
{
	struct scene_file *file = calloc(1, sizeof *file);
	if (file) file->source = calloc(1, sizeof *file->source);
	if (file && file->source) {
		file->name = text_stem(path);
		file->source->texts = calloc(1 + setting_count, sizeof *file->source->texts);
	}
	if (!file || !file->source || !file->name || !file->source->texts)
		snprintf(error, STORE_ERROR, "out of memory");
	else if (read_texts(file->source, path, setting_count, settings, error) && scene_words_understand(file, error))
		return file;
	scene_file_close(file);
	return NULL;
}

void scene_file_close(struct scene_file *file)
{
	if (!file) return;
	struct scene_source *source = file->source;
	if (source) {
		if (source->words) yaml_schema_free(&scene_schema, source->words);
		for (size_t t = 0; t < source->text_count; t++) yaml_text_close(&source->texts[t]);
		free(source->texts);
		free(source->species);
		free(source->walls);
		for (size_t p = 0; p < file->recipe.potential_count; p++) free((void *)source->potentials[p].steps);
		free(source->potentials);
		free(source->virtual_walls);
		free(source->particles);
		free(source->start_path);
		free(source);
	}
	free(file->name);
	free(file);
}

bool scene_file_build(const struct scene_file *file, struct touchstone_scene *scene, char error[STORE_ERROR])
{
	struct scene_error problem;
	if (scene_build(&file->recipe, file->seed, scene, &problem)) return true;
	const struct scene_source *source = file->source;
	bool about_particle = problem.particle != SIZE_MAX;
	if (about_particle && source->start_path) {
		snprintf(error, STORE_ERROR, "%.200s:%zu: %s", source->start_path, source->start_line + problem.particle,
				 problem.text);
		text_one_line(error);
		return false;
	}
	char key[YAML_PATH];
	if (about_particle && source->words->bodies)
		snprintf(key, sizeof key, "bodies[%zu]", problem.particle);
	else
		snprintf(key, sizeof key, "%s", problem.key);
	return scene_file_refuse(file, error, key, "%s", problem.text);
}
