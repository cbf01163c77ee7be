#include "store/scene_schema.h"

#include "scene/scene.h"

/* Every value is a pointer, so that what is absent can be told from what is 0. */
enum { WORD = CYAML_FLAG_OPTIONAL | CYAML_FLAG_POINTER, CHOICE = WORD | CYAML_FLAG_STRICT };

static const cyaml_strval_t positions[] = {
	{"lattice", SCENE_LATTICE}, {"cubic", SCENE_CUBIC}, {"random", SCENE_RANDOM}, {"file", SCENE_GIVEN}};
static const cyaml_strval_t velocities[] = {
	{"maxwell", SCENE_MAXWELL}, {"uniform", SCENE_UNIFORM}, {"rest", SCENE_REST}, {"file", SCENE_AS_GIVEN}};
static const cyaml_strval_t boundaries[] = {{"periodic", SCENE_PERIODIC}, {"walls", SCENE_WALLS}, {"open", SCENE_OPEN}};
static const cyaml_strval_t forms[] = {{"relative", TOUCHSTONE_RELATIVE}, {"absolute", TOUCHSTONE_ABSOLUTE}};
static const cyaml_strval_t searches[] = {
	{"cells", TOUCHSTONE_CELLS}, {"all", TOUCHSTONE_ALL}, {"unsieved", TOUCHSTONE_UNSIEVED}};

static const cyaml_schema_value_t number = {CYAML_VALUE_STRING(CYAML_FLAG_POINTER, char, 0, CYAML_UNLIMITED)};
static const cyaml_schema_value_t boundary = {
	CYAML_VALUE_ENUM(CYAML_FLAG_STRICT, int, boundaries, CYAML_ARRAY_LEN(boundaries))};

static const cyaml_schema_field_t wall_fields[] = {
	CYAML_FIELD_SEQUENCE("point", WORD, struct wall_words, point, &number, 1, 3),
	CYAML_FIELD_SEQUENCE("normal", WORD, struct wall_words, normal, &number, 1, 3),
	CYAML_FIELD_STRING_PTR("restitution", WORD, struct wall_words, restitution, 0, CYAML_UNLIMITED), CYAML_FIELD_END};

static const cyaml_schema_field_t virtual_wall_fields[] = {
	CYAML_FIELD_SEQUENCE("point", WORD, struct wall_words, point, &number, 1, 3),
	CYAML_FIELD_SEQUENCE("normal", WORD, struct wall_words, normal, &number, 1, 3), CYAML_FIELD_END};

static const cyaml_schema_field_t step_fields[] = {
	CYAML_FIELD_STRING_PTR("distance", WORD, struct step_words, distance, 0, CYAML_UNLIMITED),
	CYAML_FIELD_STRING_PTR("energy", WORD, struct step_words, energy, 0, CYAML_UNLIMITED), CYAML_FIELD_END};
static const cyaml_schema_value_t step = {CYAML_VALUE_MAPPING(CYAML_FLAG_DEFAULT, struct step_words, step_fields)};

static const cyaml_schema_field_t lennard_jones_fields[] = {
	CYAML_FIELD_STRING_PTR("energy", WORD, struct lennard_jones_words, energy, 0, CYAML_UNLIMITED),
	CYAML_FIELD_STRING_PTR("length", WORD, struct lennard_jones_words, length, 0, CYAML_UNLIMITED),
	CYAML_FIELD_STRING_PTR("cutoff", WORD, struct lennard_jones_words, cutoff, 0, CYAML_UNLIMITED),
	CYAML_FIELD_STRING_PTR("steps", WORD, struct lennard_jones_words, steps, 0, CYAML_UNLIMITED), CYAML_FIELD_END};

static const cyaml_schema_field_t potential_fields[] = {
	CYAML_FIELD_SEQUENCE("between", WORD, struct potential_words, between, &number, 1, 2),
	CYAML_FIELD_STRING_PTR("core", WORD, struct potential_words, core, 0, CYAML_UNLIMITED),
	CYAML_FIELD_STRING_PTR("restitution", WORD, struct potential_words, restitution, 0, CYAML_UNLIMITED),
	CYAML_FIELD_SEQUENCE("steps", WORD, struct potential_words, steps, &step, 1, 1000),
	CYAML_FIELD_MAPPING_PTR("lennard_jones", WORD, struct potential_words, lennard_jones, lennard_jones_fields),
	CYAML_FIELD_END};

static const cyaml_schema_field_t species_fields[] = {
	CYAML_FIELD_STRING_PTR("name", WORD, struct species_words, name, 0, CYAML_UNLIMITED),
	CYAML_FIELD_STRING_PTR("fraction", WORD, struct species_words, fraction, 0, CYAML_UNLIMITED),
	CYAML_FIELD_STRING_PTR("diameter", WORD, struct species_words, diameter, 0, CYAML_UNLIMITED),
	CYAML_FIELD_STRING_PTR("mass", WORD, struct species_words, mass, 0, CYAML_UNLIMITED), CYAML_FIELD_END};

static const cyaml_schema_field_t body_fields[] = {
	CYAML_FIELD_SEQUENCE("position", WORD, struct body_words, position, &number, 1, 3),
	CYAML_FIELD_SEQUENCE("velocity", WORD, struct body_words, velocity, &number, 1, 3),
	CYAML_FIELD_STRING_PTR("species", WORD, struct body_words, species, 0, CYAML_UNLIMITED),
	CYAML_FIELD_STRING_PTR("diameter", WORD, struct body_words, diameter, 0, CYAML_UNLIMITED),
	CYAML_FIELD_STRING_PTR("mass", WORD, struct body_words, mass, 0, CYAML_UNLIMITED),
	CYAML_FIELD_END};

static const cyaml_schema_field_t start_fields[] = {
	CYAML_FIELD_ENUM_PTR("positions", CHOICE, struct start_words, positions, positions, CYAML_ARRAY_LEN(positions)),
	CYAML_FIELD_ENUM_PTR("velocities", CHOICE, struct start_words, velocities, velocities, CYAML_ARRAY_LEN(velocities)),
	CYAML_FIELD_STRING_PTR("file", WORD, struct start_words, file, 0, CYAML_UNLIMITED),
	CYAML_FIELD_STRING_PTR("temperature", WORD, struct start_words, temperature, 0, CYAML_UNLIMITED), CYAML_FIELD_END};

static const cyaml_schema_value_t wall = {CYAML_VALUE_MAPPING(CYAML_FLAG_DEFAULT, struct wall_words, wall_fields)};
static const cyaml_schema_value_t virtual_wall = {
	CYAML_VALUE_MAPPING(CYAML_FLAG_DEFAULT, struct wall_words, virtual_wall_fields)};
static const cyaml_schema_value_t potential = {
	CYAML_VALUE_MAPPING(CYAML_FLAG_DEFAULT, struct potential_words, potential_fields)};
static const cyaml_schema_value_t species = {
	CYAML_VALUE_MAPPING(CYAML_FLAG_DEFAULT, struct species_words, species_fields)};
static const cyaml_schema_value_t body = {CYAML_VALUE_MAPPING(CYAML_FLAG_DEFAULT, struct body_words, body_fields)};

static const cyaml_schema_field_t fields[] = {
	CYAML_FIELD_STRING_PTR("title", WORD, struct scene_words, title, 0, CYAML_UNLIMITED),
	CYAML_FIELD_STRING_PTR("about", WORD, struct scene_words, about, 0, CYAML_UNLIMITED),
	CYAML_FIELD_STRING_PTR("dimensions", WORD, struct scene_words, dimensions, 0, CYAML_UNLIMITED),
	CYAML_FIELD_STRING_PTR("particles", WORD, struct scene_words, particles, 0, CYAML_UNLIMITED),
	CYAML_FIELD_STRING_PTR("density", WORD, struct scene_words, density, 0, CYAML_UNLIMITED),
	CYAML_FIELD_SEQUENCE("box", WORD, struct scene_words, box, &number, 1, 3),
	CYAML_FIELD_SEQUENCE("boundaries", WORD, struct scene_words, boundaries, &boundary, 1, 3),
	CYAML_FIELD_STRING_PTR("boundary_restitution", WORD, struct scene_words, boundary_restitution, 0, CYAML_UNLIMITED),
	CYAML_FIELD_SEQUENCE("walls", WORD, struct scene_words, walls, &wall, 1, 10000),
	CYAML_FIELD_SEQUENCE("species", WORD, struct scene_words, species, &species, 1, 10000),
	CYAML_FIELD_SEQUENCE("bodies", WORD, struct scene_words, bodies, &body, 1, 10000),
	CYAML_FIELD_STRING_PTR("restitution", WORD, struct scene_words, restitution, 0, CYAML_UNLIMITED),
	CYAML_FIELD_SEQUENCE("potentials", WORD, struct scene_words, potentials, &potential, 1, 1000),
	CYAML_FIELD_SEQUENCE("virtual_walls", WORD, struct scene_words, virtual_walls, &virtual_wall, 1, 1000),
	CYAML_FIELD_SEQUENCE("gravity", WORD, struct scene_words, gravity, &number, 1, 3),
	CYAML_FIELD_MAPPING_PTR("start", WORD, struct scene_words, start, start_fields),
	CYAML_FIELD_STRING_PTR("equilibrate", WORD, struct scene_words, equilibrate, 0, CYAML_UNLIMITED),
	CYAML_FIELD_STRING_PTR("seed", WORD, struct scene_words, seed, 0, CYAML_UNLIMITED),
	CYAML_FIELD_STRING_PTR("method", WORD, struct scene_words, method, 0, CYAML_UNLIMITED),
	CYAML_FIELD_STRING_PTR("arithmetic", WORD, struct scene_words, arithmetic, 0, CYAML_UNLIMITED),
	CYAML_FIELD_ENUM_PTR("form", CHOICE, struct scene_words, form, forms, CYAML_ARRAY_LEN(forms)),
	CYAML_FIELD_ENUM_PTR("search", CHOICE, struct scene_words, search, searches, CYAML_ARRAY_LEN(searches)),
	CYAML_FIELD_STRING_PTR("cell", WORD, struct scene_words, cell, 0, CYAML_UNLIMITED),
	CYAML_FIELD_STRING_PTR("clock", WORD, struct scene_words, clock, 0, CYAML_UNLIMITED),
	CYAML_FIELD_STRING_PTR("contact_time", WORD, struct scene_words, contact_time, 0, CYAML_UNLIMITED),
	CYAML_FIELD_STRING_PTR("shrinking", WORD, struct scene_words, shrinking, 0, CYAML_UNLIMITED),
	CYAML_FIELD_STRING_PTR("search_step", WORD, struct scene_words, search_step, 0, CYAML_UNLIMITED),
	CYAML_FIELD_STRING_PTR("events", WORD, struct scene_words, events, 0, CYAML_UNLIMITED),
	CYAML_FIELD_STRING_PTR("time", WORD, struct scene_words, time, 0, CYAML_UNLIMITED),
	CYAML_FIELD_END};

const cyaml_schema_value_t scene_schema = {CYAML_VALUE_MAPPING(CYAML_FLAG_POINTER, struct scene_words, fields)};
