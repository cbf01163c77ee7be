/* The keys of a scene file, as libcyaml reads them: words, still to be understood. A key that is absent is NULL. */
#ifndef TOUCHSTONE_SCENE_SCHEMA_H
#define TOUCHSTONE_SCENE_SCHEMA_H

#include <cyaml/cyaml.h>

struct wall_words {
	char **point, **normal, *restitution;
	unsigned point_count, normal_count;
};

struct step_words {
	char *distance, *energy;
};

struct lennard_jones_words {
	char *energy, *length, *cutoff, *steps;
};

struct potential_words {
	char **between, *core, *restitution;
	struct step_words *steps;
	struct lennard_jones_words *lennard_jones;
	unsigned between_count, steps_count;
};

struct species_words {
	char *name, *fraction, *diameter, *mass;
};

struct body_words {
	char **position, **velocity, *species, *diameter, *mass;
	unsigned position_count, velocity_count;
};

struct start_words {
	int *positions, *velocities; /* enum scene_positions, enum scene_velocities */
	char *file, *temperature;
};

struct scene_words {
	char *title, *about, *dimensions, *particles, *density, *restitution, *boundary_restitution;
	char *equilibrate, *seed, *method, *arithmetic, *cell, *clock, *events, *time;
	char *contact_time, *shrinking, *search_step;
	int *form, *search; /* enum touchstone_form, enum touchstone_search */
	char **box, **gravity;
	int *boundaries;                          /* enum scene_boundary */
	struct wall_words *walls, *virtual_walls; /* virtual ones have no restitution */
	struct potential_words *potentials;
	struct species_words *species;
	struct body_words *bodies;
	struct start_words *start;
	unsigned box_count, gravity_count, boundaries_count, walls_count, species_count, bodies_count, potentials_count,
		virtual_walls_count;
};

/* Of type pointer to struct scene_words. */
extern const cyaml_schema_value_t scene_schema;

#endif
