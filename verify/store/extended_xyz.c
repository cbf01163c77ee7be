#include "store/extended_xyz.h"

#include <errno.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "aside.h"
#include "scene/scene.h"

_Static_assert((int)REPORT_ERROR <= (int)STORE_ERROR, "a message of aside.h must fit");

enum { MOST_COLUMNS = 64, LONGEST_LINE = 4096 };

/* What a column of a particle's line is. */
enum column { OTHER, SPECIES, POSITION, VELOCITY = POSITION + 3, RADIUS = VELOCITY + 3, MASS };

/* Diameter and mass of one particle, to be sorted into species. */
struct body {
	struct touchstone_species size;
	size_t particle;
};

struct reader {
	struct extended_xyz *file;
	const char *path;
	FILE *stream;
	size_t line;
	char text[LONGEST_LINE];
	enum column column[MOST_COLUMNS];
	size_t columns;
	int dimensions;
	bool has_origin;
	double origin[3];
	size_t known_count;
	const struct extended_xyz_species *known;
	struct body *bodies; /* without known species */
	char *error;
};

__attribute__((format(printf, 2, 3))) static bool refuse(const struct reader *reader, const char *format, ...)
{
	int length = snprintf(reader->error, STORE_ERROR, "%.200s:%zu: ", reader->path, reader->line);
	va_list arguments;
	va_start(arguments, format);
	vsnprintf(reader->error + length, STORE_ERROR - (size_t)length, format, arguments);
	va_end(arguments);
	text_one_line(reader->error);
	return false;
}

static bool next_line(struct reader *reader, const char *expected)
{
	reader->line++;
	if (!fgets(reader->text, sizeof reader->text, reader->stream)) {
		if (ferror(reader->stream)) return refuse(reader, "cannot be read: %s", strerror(errno));
		return refuse(reader, "the file ends; accepted: %s", expected);
	}
	size_t length = strlen(reader->text);
	if (length + 1 < sizeof reader->text || reader->text[length - 1] == '\n') return true;
	return refuse(reader, "a line without end; accepted: up to %d characters", LONGEST_LINE - 2);
}

/* Splits one name:type:count of the properties into columns. */
static bool add_property(struct reader *reader, const char *name, const char *type, const char *count)
{
	static const struct {
		const char *name;
		enum column column;
		char type;
		uint64_t count;
	} known[] = {{"species", SPECIES, 'S', 1}, {"pos", POSITION, 'R', 3},        {"velo", VELOCITY, 'R', 3},
				 {"vel", VELOCITY, 'R', 3},    {"velocities", VELOCITY, 'R', 3}, {"radius", RADIUS, 'R', 1},
				 {"mass", MASS, 'R', 1},       {"masses", MASS, 'R', 1}};
	char shown[TEXT_SHOWN];
	uint64_t width;
	if (!type || !count || !text_count(count, &width) || width < 1 || reader->columns + width > MOST_COLUMNS)
		return refuse(reader, "property '%s'; accepted: NAME:TYPE:COUNT, in all up to %d columns",
					  text_shown(shown, name), MOST_COLUMNS);
	enum column column = OTHER;
	for (size_t i = 0; i < sizeof known / sizeof *known; i++) {
		if (strcmp(name, known[i].name) != 0) continue;
		if (*type != known[i].type || width != known[i].count)
			return refuse(reader, "property %s:%.1s; accepted: %s:%c:%d", name, type, name, known[i].type,
						  (int)known[i].count);
		column = known[i].column;
	}
	for (uint64_t i = 0; i < width; i++)
		reader->column[reader->columns++] = column == OTHER ? OTHER : column + (enum column)i;
	return true;
}

static bool read_properties(struct reader *reader, char *value)
{
	reader->columns = 0;
	char *rest, *name = strtok_r(value, ":", &rest);
	for (; name; name = strtok_r(NULL, ":", &rest)) {
		char *type = strtok_r(NULL, ":", &rest);
		char *count = type ? strtok_r(NULL, ":", &rest) : NULL;
		if (!add_property(reader, name, type, count)) return false;
	}
	return true;
}

static bool read_numbers(struct reader *reader, const char *key, char *value, int count, double numbers[])
{
	char *rest, *word = strtok_r(value, " \t", &rest);
	for (int i = 0; i < count; i++, word = strtok_r(NULL, " \t", &rest))
		if (!word || !text_number(word, &numbers[i])) return refuse(reader, "%s; accepted: %d numbers", key, count);
	return !word || refuse(reader, "%s; accepted: %d numbers", key, count);
}

static bool read_lattice(struct reader *reader, char *value)
{
	double side[9];
	if (!read_numbers(reader, "Lattice", value, 9, side)) return false;
	for (int i = 0; i < 9; i++)
		if (i % 4 && side[i] != 0) return refuse(reader, "a slanted Lattice; accepted: sides along the axes");
	for (int axis = 0; axis < reader->dimensions; axis++) {
		reader->file->box[axis] = side[4 * axis];
		if (!(side[4 * axis] > 0))
			return refuse(reader, "Lattice with a side of %g; accepted: above 0", side[4 * axis]);
	}
	return reader->file->has_box = true;
}

/* The second line: KEY=VALUE with the value in quotes when there are blanks in it. */
static bool read_heading(struct reader *reader)
{
	char plain[] = "species:S:1:pos:R:3";
	if (!next_line(reader, "a line with Lattice and Properties") || !read_properties(reader, plain)) return false;
	char *at = reader->text;
	for (at += strspn(at, " \t\r\n"); *at; at += strspn(at, " \t\r\n")) {
		char *key = at;
		at += strcspn(at, "= \t\r\n");
		if (*at != '=') continue;
		*at++ = '\0';
		bool quoted = *at == '"' || *at == '\'';
		const char quote[] = {*at, '\0'};
		char *value = at += quoted;
		at += strcspn(at, quoted ? quote : " \t\r\n");
		if (quoted && !*at) return refuse(reader, "a quote that does not end; accepted: KEY=\"VALUE\"");
		if (*at) *at++ = '\0';
		if (strcmp(key, "Lattice") == 0 && !read_lattice(reader, value)) return false;
		if (strcmp(key, "Properties") == 0 && !read_properties(reader, value)) return false;
		if (strcmp(key, "Origin") != 0) continue;
		reader->has_origin = true;
		if (!read_numbers(reader, "Origin", value, 3, reader->origin)) return false;
	}
	bool has[MASS + 1] = {false};
	for (size_t i = 0; i < reader->columns; i++) has[reader->column[i]] = true;
	reader->file->has_velocities = has[VELOCITY];
	if (!has[POSITION]) return refuse(reader, "no positions; accepted: Properties with pos:R:3");
	if (reader->known_count && !has[SPECIES])
		return refuse(reader, "no species; accepted: Properties with species:S:1");
	return true;
}

static bool read_species(struct reader *reader, const char *word, struct touchstone_particle *particle)
{
	if (!reader->known_count) return true;
	for (size_t s = 0; s < reader->known_count; s++) {
		if (strcmp(word, reader->known[s].name) != 0) continue;
		particle->species = (uint32_t)s;
		return true;
	}
	char shown[TEXT_SHOWN];
	return refuse(reader, "species '%s' is not one of the %zu of the scene; the first is '%.40s'",
				  text_shown(shown, word), reader->known_count, reader->known[0].name);
}

static bool read_column(struct reader *reader, enum column column, const char *word,
						struct touchstone_particle *particle, struct body *body)
{
	if (column == OTHER) return true;
	if (column == SPECIES) return read_species(reader, word, particle);
	char shown[TEXT_SHOWN];
	double number;
	if (!text_number(word, &number))
		return refuse(reader, "'%s' is no number; accepted: finite numbers", text_shown(shown, word));
	if (column == RADIUS || column == MASS) {
		if (!(number > 0))
			return refuse(reader, "%s %g; accepted: above 0", column == MASS ? "mass" : "radius", number);
		if (body && column == MASS) body->size.mass = number;
		if (body && column == RADIUS) body->size.diameter = 2 * number;
		return true;
	}
	bool place = column < VELOCITY;
	int axis = (int)(column - (place ? POSITION : VELOCITY));
	if (axis >= reader->dimensions && number != 0)
		return refuse(reader, "%g along %c; accepted: 0 in %d dimensions", number, "xyz"[axis], reader -> dimensions);
	if (place && axis < reader->dimensions && reader->has_origin)
		number -= reader->origin[axis] + reader->file->box[axis] / 2;
	(place ? particle->position : particle->velocity)[axis] = number;
	return true;
}

static bool read_particle(struct reader *reader, size_t index)
{
	if (!next_line(reader, "a line for each particle")) return false;
	struct body *body = reader->bodies ? &reader->bodies[index] : NULL;
	if (body) *body = (struct body){{1, 1}, index};
	char *rest, *word = strtok_r(reader->text, " \t\r\n", &rest);
	for (size_t i = 0; i < reader->columns; i++, word = strtok_r(NULL, " \t\r\n", &rest)) {
		if (!word) return refuse(reader, "%zu columns; accepted: %zu, as the Properties say", i, reader->columns);
		if (!read_column(reader, reader->column[i], word, &reader->file->particles[index], body)) return false;
	}
	return !word || refuse(reader, "more columns than the %zu of the Properties", reader->columns);
}

static bool read_count(struct reader *reader)
{
	if (!next_line(reader, "the number of particles")) return false;
	char shown[TEXT_SHOWN], *rest, *word = strtok_r(reader->text, " \t\r\n", &rest);
	uint64_t count;
	if (!word || strtok_r(NULL, " \t\r\n", &rest) || !text_count(word, &count) || count < 1 ||
		count > SCENE_MOST_PARTICLES)
		return refuse(reader, "'%s' is no number of particles; accepted: 1 to %d", text_shown(shown, word ? word : ""),
					  SCENE_MOST_PARTICLES);
	struct stat state;
	bool sized = fstat(fileno(reader->stream), &state) == 0 && S_ISREG(state.st_mode);
	if (sized && count > (uint64_t)state.st_size / 2)
		return refuse(reader, "the file is too short for %s particles", text_shown(shown, word));
	reader->file->particle_count = (size_t)count;
	return true;
}

static int by_size(const void *first, const void *second)
{
	const struct touchstone_species *one = &((const struct body *)first)->size;
	const struct touchstone_species *two = &((const struct body *)second)->size;
	if (one->diameter != two->diameter) return one->diameter < two->diameter ? -1 : 1;
	return (one->mass > two->mass) - (one->mass < two->mass);
}

/* Every size that occurs becomes a species, the smallest first. */
static bool make_species(struct reader *reader)
{
	struct extended_xyz *file = reader->file;
	file->species_count = reader->known_count;
	if (!reader->known_count) {
		qsort(reader->bodies, file->particle_count, sizeof *reader->bodies, by_size);
		for (size_t i = 0; i < file->particle_count; i++) {
			file->species_count += i == 0 || by_size(&reader->bodies[i - 1], &reader->bodies[i]) != 0;
			file->particles[reader->bodies[i].particle].species = (uint32_t)(file->species_count - 1);
		}
	}
	file->species = malloc(file->species_count * sizeof *file->species);
	if (!file->species) return refuse(reader, "no memory for %zu species", file->species_count);
	for (size_t s = 0; s < reader->known_count; s++) file->species[s] = reader->known[s].body;
	for (size_t i = 0; i < file->particle_count && !reader->known_count; i++)
		file->species[file->particles[reader->bodies[i].particle].species] = reader->bodies[i].size;
	return true;
}

static bool read_all(struct reader *reader)
{
	struct extended_xyz *file = reader->file;
	if (!read_count(reader) || !read_heading(reader)) return false;
	if (reader->has_origin && !file->has_box) return refuse(reader, "an Origin without Lattice; accepted: both");
	file->first_line = reader->line + 1;
	file->particles = calloc(file->particle_count, sizeof *file->particles);
	if (!reader->known_count) reader->bodies = malloc(file->particle_count * sizeof *reader->bodies);
	if (!file->particles || (!reader->known_count && !reader->bodies))
		return refuse(reader, "no memory for %zu particles", file->particle_count);
	for (size_t p = 0; p < file->particle_count; p++)
		if (!read_particle(reader, p)) return false;
	return make_species(reader);
}

bool extended_xyz_read(struct extended_xyz *file, const char *path, int dimensions, size_t known_count,
					   const struct extended_xyz_species *known, char error[STORE_ERROR])
{
	*file = (struct extended_xyz){0};
	struct reader reader = {.file = file,
							.path = path,
							.stream = fopen(path, "r"),
							.dimensions = dimensions,
							.known_count = known_count,
							.known = known,
							.error = error};
	if (!reader.stream) {
		snprintf(error, STORE_ERROR, "%.200s: cannot be read: %s", path, strerror(errno));
		text_one_line(error);
		return false;
	}
	bool read = read_all(&reader);
	fclose(reader.stream);
	free(reader.bodies);
	if (!read) extended_xyz_free(file);
	return read;
}

void extended_xyz_free(struct extended_xyz *file)
{
	free(file->particles);
	free(file->species);
	*file = (struct extended_xyz){0};
}

void extended_xyz_frame(FILE *stream, const struct touchstone_scene *scene, double time, const uint32_t *captured)
{
	double side[3] = {1, 1, 1};
	for (int axis = 0; axis < scene->dimensions; axis++) side[axis] = scene->box[axis];
	fprintf(stream, "%zu\nLattice=\"%.17g 0 0 0 %.17g 0 0 0 %.17g\" Origin=\"%.17g %.17g %.17g\" pbc=\"%c %c %c\" ",
			scene->particle_count, side[0], side[1], side[2], -side[0] / 2, -side[1] / 2, -side[2] / 2,
			"FT"[scene->periodic[0]], "FT"[scene->periodic[1]], "FT"[scene->periodic[2]]);
	fprintf(stream, "Time=%.17g Properties=species:S:1:pos:R:3:velo:R:3:radius:R:1:mass:R:1%s\n", time,
			captured ? ":captured:I:1" : "");
	for (size_t p = 0; p < scene->particle_count; p++) {
		const struct touchstone_particle *particle = &scene->particles[p];
		const struct touchstone_species *species = &scene->species[particle->species];
		const double *r = particle->position, *v = particle->velocity;
		fprintf(stream, "%u %.17g %.17g %.17g %.17g %.17g %.17g %.17g %.17g", particle->species + 1, r[0], r[1], r[2],
				v[0], v[1], v[2], species->diameter / 2, species->mass);
		if (captured) fprintf(stream, " %u", captured[p]);
		putc('\n', stream);
	}
}

bool extended_xyz_write(const char *path, const struct touchstone_scene *scene, const uint32_t *captured,
						char error[STORE_ERROR])
{
	struct aside file;
	if (!aside_open(&file, error, "%s", path)) return false;
	extended_xyz_frame(file.stream, scene, scene->clock, captured);
	return aside_keep(&file, error);
}
