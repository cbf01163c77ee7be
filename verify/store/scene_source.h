/* What a scene file points into, and where each key was said. For the parts of the scene file's reader only. */
#ifndef TOUCHSTONE_SCENE_SOURCE_H
#define TOUCHSTONE_SCENE_SOURCE_H

#include "store/extended_xyz.h"
#include "store/scene_file.h"
#include "store/scene_schema.h"
#include "store/yaml_text.h"

struct scene_source {
	size_t text_count;
	struct yaml_text *texts;   /* the file, then the settings in order */
	struct scene_words *words; /* of all of them together */
	struct scene_species *species;
	struct touchstone_wall *walls;
	struct touchstone_potential *potentials; /* as many as the recipe has, each with its steps */
	struct touchstone_virtual_wall *virtual_walls;
	struct touchstone_particle *particles;
	char *start_path;  /* of the file with start positions, or NULL */
	size_t start_line; /* of particle 0 in it */
};

/* The text that gave a key last, or the scene file; `line` as yaml_text_locate has it. */
const struct yaml_text *scene_source_of(const struct scene_source *source, const char *key, size_t *line);

/* Turns the words into the recipe and the rest of `file`. False with a message when one of them cannot be understood.
 */
bool scene_words_understand(struct scene_file *file, char error[STORE_ERROR]);

/* The same for potentials and virtual walls, when the species are known. */
bool interaction_words_understand(struct scene_file *file, char error[STORE_ERROR]);

/* What particles and potentials call a species that is listed: its name, or its number from 1. */
void scene_words_species(const struct scene_words *words, size_t s, char name[TEXT_SHOWN]);

#endif
