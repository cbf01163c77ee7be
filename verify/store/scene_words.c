/* From the words of a scene file to numbers, and to a recipe. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "store/scene_source.h"
#include "store/scene_values.h"

static bool read_walls(struct scene_file *file, char *error)
{
	const struct scene_words *words = file->source->words;
	struct touchstone_wall *walls = calloc(words->walls_count + 1, sizeof *walls);
	file->source->walls = walls;
	if (!walls) return scene_file_refuse(file, error, "walls", "no memory for %u", words->walls_count);
	for (unsigned w = 0; w < words->walls_count; w++) {
		const struct wall_words *wall = &words->walls[w];
		char key[3][YAML_PATH];
		snprintf(key[0], YAML_PATH, "walls[%u].point", w);
		snprintf(key[1], YAML_PATH, "walls[%u].normal", w);
		snprintf(key[2], YAML_PATH, "walls[%u].restitution", w);
		if (!wall->point || !wall->normal)
			return scene_file_refuse(file, error, key[wall->point ? 1 : 0],
									 "not given; accepted: a list of numbers, one for each dimension");
		if (!value_vector(file, key[0], wall->point, wall->point_count, false, VALUE_ANY, walls[w].point, error) ||
			!value_vector(file, key[1], wall->normal, wall->normal_count, false, VALUE_ANY, walls[w].normal, error) ||
			!value_restitution(file, key[2], wall->restitution, &walls[w].restitution, error))
			return false;
	}
	file->recipe.walls = walls;
	file->recipe.wall_count = words->walls_count;
	return true;
}

/* The species listed; one of diameter and mass 1 where there is no list. */
static bool read_species(struct scene_file *file, char *error)
{
	const struct scene_words *words = file->source->words;
	size_t count = words->species ? words->species_count : 1;
	struct scene_species *species = calloc(count, sizeof *species);
	file->source->species = species;
	if (!species) return scene_file_refuse(file, error, "species", "no memory for %zu", count);
	for (size_t s = 0; s < count; s++) {
		species[s] = (struct scene_species){count == 1, {1, 1}};
		if (!words->species) continue;
		const struct species_words *one = &words->species[s];
		char key[3][YAML_PATH];
		snprintf(key[0], YAML_PATH, "species[%zu].fraction", s);
		snprintf(key[1], YAML_PATH, "species[%zu].diameter", s);
		snprintf(key[2], YAML_PATH, "species[%zu].mass", s);
		if (!value_number(file, key[0], one->fraction, VALUE_NOT_NEGATIVE, &species[s].fraction, error) ||
			!value_number(file, key[1], one->diameter, VALUE_POSITIVE, &species[s].body.diameter, error) ||
			!value_number(file, key[2], one->mass, VALUE_POSITIVE, &species[s].body.mass, error))
			return false;
	}
	file->recipe.species = species;
	file->recipe.species_count = count;
	return true;
}

void scene_words_species(const struct scene_words *words, size_t s, char name[TEXT_SHOWN])
{
	if (words->species[s].name)
		snprintf(name, TEXT_SHOWN, "%s", words->species[s].name);
	else
		snprintf(name, TEXT_SHOWN, "%zu", s + 1);
}

/* A body that says its own size gets the species of that size, which is made when there is none yet. */
static bool size_body(struct scene_file *file, unsigned b, uint32_t *species, char *error)
{
	const struct body_words *body = &file->source->words->bodies[b];
	struct touchstone_species size = {1, 1};
	char diameter[YAML_PATH], mass[YAML_PATH];
	snprintf(diameter, sizeof diameter, "bodies[%u].diameter", b);
	snprintf(mass, sizeof mass, "bodies[%u].mass", b);
	if (!value_number(file, diameter, body->diameter, VALUE_POSITIVE, &size.diameter, error) ||
		!value_number(file, mass, body->mass, VALUE_POSITIVE, &size.mass, error))
		return false;
	struct scene_recipe *recipe = &file->recipe;
	size_t s = 0;
	while (s < recipe->species_count &&
		   (recipe->species[s].body.diameter != size.diameter || recipe->species[s].body.mass != size.mass))
		s++;
	if (s == recipe->species_count) file->source->species[recipe->species_count++].body = size;
	*species = (uint32_t)s;
	return true;
}

/* A body that names a species, or is of the only one listed. */
static bool name_body(struct scene_file *file, unsigned b, uint32_t *species, char *error)
{
	const struct scene_words *words = file->source->words;
	const struct body_words *body = &words->bodies[b];
	char key[YAML_PATH], shown[TEXT_SHOWN], name[TEXT_SHOWN];
	snprintf(key, sizeof key, "bodies[%u].species", b);
	if (!words->species)
		return scene_file_refuse(file, error, key, "given without a list of species; accepted: diameter and mass");
	if (body->diameter || body->mass)
		return scene_file_refuse(file, error, key, "a diameter or mass beside a list of species; accepted: species");
	for (size_t s = 0; s < words->species_count; s++) {
		scene_words_species(words, s, name);
		*species = (uint32_t)s;
		if (body->species ? strcmp(body->species, name) == 0 : words->species_count == 1) return true;
	}
	scene_words_species(words, 0, name);
	return scene_file_refuse(file, error, key, "'%s' is not one of the %u species; the first is '%.40s'",
							 text_shown(shown, body->species ? body->species : ""), words->species_count, name);
}

static bool read_bodies(struct scene_file *file, char *error)
{
	const struct scene_words *words = file->source->words;
	struct scene_recipe *recipe = &file->recipe;
	if (!words->species) { /* each body may bring its own */
		free(file->source->species);
		recipe->species = file->source->species = calloc(words->bodies_count, sizeof *recipe->species);
		recipe->species_count = 0;
	}
	struct touchstone_particle *particles = calloc(words->bodies_count, sizeof *particles);
	file->source->particles = particles;
	if (!particles || !recipe->species)
		return scene_file_refuse(file, error, "bodies", "no memory for %u", words->bodies_count);
	for (unsigned b = 0; b < words->bodies_count; b++) {
		const struct body_words *body = &words->bodies[b];
		char position[YAML_PATH], velocity[YAML_PATH];
		snprintf(position, sizeof position, "bodies[%u].position", b);
		snprintf(velocity, sizeof velocity, "bodies[%u].velocity", b);
		if (!body->position) return scene_file_refuse(file, error, position, "not given; accepted: a list of numbers");
		if (!value_vector(file, position, body->position, body->position_count, false, VALUE_ANY, particles[b].position,
						  error) ||
			!value_vector(file, velocity, body->velocity, body->velocity_count, false, VALUE_ANY, particles[b].velocity,
						  error))
			return false;
		if (words->species || body->species ? !name_body(file, b, &particles[b].species, error)
											: !size_body(file, b, &particles[b].species, error))
			return false;
	}
	recipe->particles = particles;
	recipe->particle_count = words->bodies_count;
	return true;
}

/* A path in the scene file begins at its folder; one in a setting, where the user stands. */
static char *start_path(const struct scene_source *source)
{
	const char *word = source->words->start->file;
	size_t line;
	const char *from = source->texts[0].name, *slash = strrchr(from, '/');
	bool from_file = scene_source_of(source, "start.file", &line)->lined;
	char *path = NULL;
	if (word[0] == '/' || !from_file || !slash) return strdup(word);
	return asprintf(&path, "%.*s/%s", (int)(slash - from), from, word) < 0 ? NULL : path;
}

/* Particles from a file in extended XYZ. */
static bool read_start_file(struct scene_file *file, char *error)
{
	struct scene_source *source = file->source;
	const struct scene_words *words = source->words;
	struct scene_recipe *recipe = &file->recipe;
	size_t known_count = words->species ? words->species_count : 0;
	struct extended_xyz_species *known = calloc(known_count + 1, sizeof *known);
	char(*names)[TEXT_SHOWN] = calloc(known_count + 1, sizeof *names);
	source->start_path = start_path(source);
	bool memory = known && names && source->start_path;
	for (size_t s = 0; memory && s < known_count; s++) {
		scene_words_species(words, s, names[s]);
		known[s] = (struct extended_xyz_species){names[s], recipe->species[s].body};
	}
	struct extended_xyz xyz;
	bool read = memory && extended_xyz_read(&xyz, source->start_path, recipe->dimensions, known_count, known, error);
	free(known);
	free(names);
	if (!memory) return scene_file_refuse(file, error, "start.file", "out of memory");
	if (!read) return false;
	source->particles = xyz.particles;
	source->start_line = xyz.first_line;
	recipe->particles = xyz.particles;
	recipe->particle_count = xyz.particle_count;
	free(source->species);
	recipe->species = source->species = calloc(xyz.species_count, sizeof *source->species);
	recipe->species_count = xyz.species_count;
	for (size_t s = 0; source->species && s < xyz.species_count; s++) source->species[s].body = xyz.species[s];
	free(xyz.species);
	if (!source->species) return scene_file_refuse(file, error, "start.file", "out of memory");
	if (!words->box && xyz.has_box) memcpy(recipe->box, xyz.box, sizeof recipe->box);
	if (recipe->velocities == SCENE_AS_GIVEN && !xyz.has_velocities)
		return scene_file_refuse(file, error, "start.file",
								 "no velocities in it; accepted: Properties with velo:R:3, or other start.velocities");
	return true;
}

/* Which keys go together, by where the positions are from. */
static bool check_company(const struct scene_file *file, char *error)
{
	const struct scene_words *words = file->source->words;
	const struct start_words *start = words->start;
	enum scene_velocities law = file->recipe.velocities;
	bool given = file->recipe.positions == SCENE_GIVEN;
	if (words->density && words->box)
		return scene_file_refuse(file, error, "box", "given beside a density; accepted: one of the two");
	if (given && words->density)
		return scene_file_refuse(file, error, "density", "given beside positions; accepted: a box");
	if (words->bodies && words->particles)
		return scene_file_refuse(file, error, "particles", "given beside a list of bodies; accepted: one of the two");
	if (words->bodies && start && (start->positions || start->file))
		return scene_file_refuse(file, error, start->file ? "start.file" : "start.positions",
								 "given beside a list of bodies; accepted: one of the two");
	if (given && !words->bodies && !start->file)
		return scene_file_refuse(file, error, "start.file", "not given; accepted: the path of an extended XYZ file");
	if (!given && start && start->file)
		return scene_file_refuse(file, error, "start.file", "given without 'positions: file'; accepted: both");
	if (!given && law == SCENE_AS_GIVEN)
		return scene_file_refuse(file, error, "start.velocities", "'file' without 'positions: file'; accepted: both");
	if (!given && !words->particles)
		return scene_file_refuse(file, error, "particles", "not given; accepted: a number, or a list of bodies");
	if (!given && !words->density && !words->box)
		return scene_file_refuse(file, error, "density", "not given; accepted: a density or a box");
	return true;
}

static bool read_start(struct scene_file *file, char *error)
{
	const struct scene_words *words = file->source->words;
	const struct start_words *start = words->start;
	struct scene_recipe *recipe = &file->recipe;
	recipe->positions = words->bodies ? SCENE_GIVEN : SCENE_LATTICE;
	if (start && start->positions && !words->bodies) recipe->positions = (enum scene_positions) * start->positions;
	recipe->velocities = recipe->positions == SCENE_GIVEN ? SCENE_AS_GIVEN : SCENE_MAXWELL;
	if (start && start->velocities) recipe->velocities = (enum scene_velocities) * start->velocities;
	if (!check_company(file, error)) return false;

	recipe->temperature = recipe->velocities == SCENE_MAXWELL;
	if (start &&
		!value_number(file, "start.temperature", start->temperature, VALUE_POSITIVE, &recipe->temperature, error))
		return false;
	uint64_t particles = 0;
	if (!value_count(file, "particles", words->particles, 1, SCENE_MOST_PARTICLES, &particles, error)) return false;
	recipe->particle_count = (size_t)particles;
	if (words->bodies) return read_bodies(file, error);
	if (recipe->positions != SCENE_GIVEN) return true;
	if (!read_start_file(file, error)) return false;
	return !words->particles || particles == recipe->particle_count ||
		   scene_file_refuse(file, error, "particles", "'%s', but start.file has %zu; accepted: the same, or none",
							 words->particles, recipe->particle_count);
}

static bool read_space(struct scene_file *file, char *error)
{
	const struct scene_words *words = file->source->words;
	struct scene_recipe *recipe = &file->recipe;
	uint64_t dimensions = 3;
	if (!value_count(file, "dimensions", words->dimensions, 1, 3, &dimensions, error)) return false;
	recipe->dimensions = (int)dimensions;
	if (words->boundaries && !value_length(file, "boundaries", words->boundaries_count, true, error)) return false;
	for (int axis = 0; axis < recipe->dimensions && words->boundaries; axis++)
		recipe->boundary[axis] = (enum scene_boundary)words->boundaries[words->boundaries_count == 1 ? 0 : axis];
	return value_number(file, "density", words->density, VALUE_POSITIVE, &recipe->density, error) &&
		   value_vector(file, "box", words->box, words->box_count, true, VALUE_POSITIVE, recipe->box, error) &&
		   value_vector(file, "gravity", words->gravity, words->gravity_count, false, VALUE_ANY, recipe->acceleration,
						error) &&
		   value_restitution(file, "restitution", words->restitution, &recipe->restitution, error) &&
		   value_restitution(file, "boundary_restitution", words->boundary_restitution, &recipe->boundary_restitution,
							 error);
}

/* What methods leave open. */
static bool read_method(struct scene_file *file, char *error)
{
	const struct scene_words *words = file->source->words;
	struct scene_recipe *recipe = &file->recipe;
	return value_number(file, "contact_time", words->contact_time, VALUE_POSITIVE, &recipe->contact_time, error) &&
		   value_number(file, "shrinking", words->shrinking, VALUE_POSITIVE, &recipe->shrinking, error) &&
		   value_number(file, "search_step", words->search_step, VALUE_POSITIVE, &recipe->search_step, error);
}

static bool read_run(struct scene_file *file, char *error)
{
	const struct scene_words *words = file->source->words;
	file->title = words->title ? words->title : file->name;
	file->about = words->about ? words->about : "";
	file->method = words->method ? words->method : "stable";
	file->arithmetic = words->arithmetic ? words->arithmetic : "binary64";
	file->seed = 1;
	file->limits = (struct touchstone_limits){UINT64_MAX, INFINITY, NULL};
	if (words->form) file->recipe.form = (enum touchstone_form) * words->form;
	if (words->search) file->recipe.search = (enum touchstone_search) * words->search;
	return value_count(file, "seed", words->seed, 0, UINT64_MAX, &file->seed, error) &&
		   value_count(file, "events", words->events, 0, UINT64_MAX, &file->limits.events, error) &&
		   value_number(file, "time", words->time, VALUE_NOT_NEGATIVE, &file->limits.time, error) &&
		   value_number(file, "equilibrate", words->equilibrate, VALUE_NOT_NEGATIVE, &file->equilibrate, error) &&
		   value_number(file, "cell", words->cell, VALUE_NOT_NEGATIVE, &file->recipe.cell, error) &&
		   value_number(file, "clock", words->clock, VALUE_NOT_NEGATIVE, &file->recipe.clock, error);
}

bool scene_words_understand(struct scene_file *file, char error[STORE_ERROR])
{
	return read_space(file, error) && read_run(file, error) && read_method(file, error) && read_walls(file, error) &&
		   read_species(file, error) && read_start(file, error) && interaction_words_understand(file, error);
}
