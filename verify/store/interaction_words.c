/* From the words of a scene file to potentials and virtual walls. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "scene/potential.h"
#include "store/scene_source.h"
#include "store/scene_values.h"

enum { MOST_STEPS = 1000 };

/* Which two species a potential is between: the only one there is, or two by their names. */
static bool read_between(const struct scene_file *file, unsigned p, uint32_t species[2], char *error)
{
	const struct scene_words *words = file->source->words;
	const struct potential_words *potential = &words->potentials[p];
	size_t count = file->recipe.species_count;
	char key[YAML_PATH], name[TEXT_SHOWN], shown[TEXT_SHOWN];
	snprintf(key, sizeof key, "potentials[%u].between", p);
	if (!potential->between && count == 1) return true;
	if (!potential->between || !words->species)
		return scene_file_refuse(file, error, key,
								 "%zu species; accepted: a list of species, and the names of two here", count);
	for (int side = 0; side < 2; side++) {
		const char *word = potential->between[side % potential->between_count];
		size_t s = 0;
		for (; s < words->species_count; s++) {
			scene_words_species(words, s, name);
			if (strcmp(word, name) == 0) break;
		}
		scene_words_species(words, 0, name);
		if (s == words->species_count)
			return scene_file_refuse(file, error, key, "'%s' is not one of the %u species; the first is '%.40s'",
									 text_shown(shown, word), words->species_count, name);
		species[side] = (uint32_t)s;
	}
	return true;
}

static struct touchstone_step *new_steps(struct touchstone_potential *potential, size_t count)
{
	struct touchstone_step *steps = calloc(count, sizeof *steps);
	potential->steps = steps;
	potential->step_count = steps ? count : 0;
	return steps;
}

static bool read_steps(const struct scene_file *file, unsigned p, struct touchstone_potential *potential, char *error)
{
	const struct potential_words *words = &file->source->words->potentials[p];
	struct touchstone_step *steps = new_steps(potential, words->steps_count);
	if (!steps) return scene_file_refuse(file, error, "potentials", "no memory for %u steps", words->steps_count);
	for (unsigned s = 0; s < words->steps_count; s++) {
		const struct step_words *step = &words->steps[s];
		char key[2][YAML_PATH];
		snprintf(key[0], YAML_PATH, "potentials[%u].steps[%u].distance", p, s);
		snprintf(key[1], YAML_PATH, "potentials[%u].steps[%u].energy", p, s);
		if (!step->distance || !step->energy)
			return scene_file_refuse(file, error, key[step->distance ? 1 : 0], "not given; accepted: a finite number");
		if (!value_number(file, key[0], step->distance, VALUE_POSITIVE, &steps[s].distance, error) ||
			!value_number(file, key[1], step->energy, VALUE_ANY, &steps[s].energy, error))
			return false;
	}
	return true;
}

static bool read_lennard_jones(const struct scene_file *file, unsigned p, struct touchstone_potential *potential,
							   char *error)
{
	const struct lennard_jones_words *words = file->source->words->potentials[p].lennard_jones;
	struct lennard_jones law = {1, 1, potential->core, 3};
	uint64_t count = 20;
	char key[4][YAML_PATH];
	static const char *const keys[] = {"energy", "length", "cutoff", "steps"};
	for (int k = 0; k < 4; k++) snprintf(key[k], YAML_PATH, "potentials[%u].lennard_jones.%s", p, keys[k]);
	if (!value_number(file, key[0], words->energy, VALUE_POSITIVE, &law.energy, error) ||
		!value_number(file, key[1], words->length, VALUE_POSITIVE, &law.length, error) ||
		!value_number(file, key[2], words->cutoff, VALUE_POSITIVE, &law.cutoff, error) ||
		!value_count(file, key[3], words->steps, 1, MOST_STEPS, &count, error))
		return false;
	if (!(law.core > 0)) {
		snprintf(key[0], YAML_PATH, "potentials[%u].core", p);
		return scene_file_refuse(file, error, key[0], "%g, so that there is no first step; accepted: a core above 0",
								 law.core);
	}
	if (!(law.cutoff > law.core))
		return scene_file_refuse(file, error, key[2], "%g; accepted: above the core, %g", law.cutoff, law.core);
	struct touchstone_step *steps = new_steps(potential, count);
	if (!steps) return scene_file_refuse(file, error, key[3], "no memory for %llu", (unsigned long long)count);
	potential_lennard_jones(&law, file->recipe.dimensions, count, steps);
	return true;
}

static bool read_potential(const struct scene_file *file, unsigned p, struct touchstone_potential *potential,
						   char *error)
{
	const struct potential_words *words = &file->source->words->potentials[p];
	char key[3][YAML_PATH];
	snprintf(key[0], YAML_PATH, "potentials[%u].core", p);
	snprintf(key[1], YAML_PATH, "potentials[%u].restitution", p);
	snprintf(key[2], YAML_PATH, "potentials[%u].steps", p);
	if (!read_between(file, p, potential->species, error)) return false;
	const struct scene_species *species = file->recipe.species;
	potential->core = (species[potential->species[0]].body.diameter + species[potential->species[1]].body.diameter) / 2;
	potential->restitution = file->recipe.restitution;
	if (!value_number(file, key[0], words->core, VALUE_NOT_NEGATIVE, &potential->core, error)) return false;
	if (words->restitution && !value_restitution(file, key[1], words->restitution, &potential->restitution, error))
		return false;
	if (words->steps && words->lennard_jones)
		return scene_file_refuse(file, error, key[2], "given beside lennard_jones; accepted: one of the two");
	if (words->steps) return read_steps(file, p, potential, error);
	return !words->lennard_jones || read_lennard_jones(file, p, potential, error);
}

static bool read_virtual_walls(struct scene_file *file, char *error)
{
	const struct scene_words *words = file->source->words;
	unsigned count = words->virtual_walls_count;
	struct touchstone_virtual_wall *walls = calloc(count + 1, sizeof *walls);
	file->source->virtual_walls = walls;
	if (!walls) return scene_file_refuse(file, error, "virtual_walls", "no memory for %u", count);
	for (unsigned w = 0; w < count; w++) {
		const struct wall_words *wall = &words->virtual_walls[w];
		char key[2][YAML_PATH];
		snprintf(key[0], YAML_PATH, "virtual_walls[%u].point", w);
		snprintf(key[1], YAML_PATH, "virtual_walls[%u].normal", w);
		if (!wall->point || !wall->normal)
			return scene_file_refuse(file, error, key[wall->point ? 1 : 0],
									 "not given; accepted: a list of numbers, one for each dimension");
		if (!value_vector(file, key[0], wall->point, wall->point_count, false, VALUE_ANY, walls[w].point, error) ||
			!value_vector(file, key[1], wall->normal, wall->normal_count, false, VALUE_ANY, walls[w].normal, error))
			return false;
	}
	file->recipe.virtual_walls = walls;
	file->recipe.virtual_wall_count = count;
	return true;
}

bool interaction_words_understand(struct scene_file *file, char error[STORE_ERROR])
{
	const struct scene_words *words = file->source->words;
	struct touchstone_potential *potentials = calloc(words->potentials_count + 1, sizeof *potentials);
	file->source->potentials = potentials;
	if (!potentials) return scene_file_refuse(file, error, "potentials", "no memory for %u", words->potentials_count);
	file->recipe.potentials = potentials;
	for (unsigned p = 0; p < words->potentials_count; p++) {
		file->recipe.potential_count++;
		if (!read_potential(file, p, &potentials[p], error)) return false;
	}
	return read_virtual_walls(file, error);
}
