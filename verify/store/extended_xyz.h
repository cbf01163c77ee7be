/* Extended XYZ: a text format for particles that most viewers read. Two lines of heading (how many; then
 * Lattice="..." Properties=species:S:1:pos:R:3:velo:R:3:radius:R:1:mass:R:1), then one line per particle. */
#ifndef TOUCHSTONE_EXTENDED_XYZ_H
#define TOUCHSTONE_EXTENDED_XYZ_H

#include <stdio.h>

#include "store/text.h"
#include "touchstone.h"

/* A species that a scene knows by name. */
struct extended_xyz_species {
	const char *name;
	struct touchstone_species body;
};

/* What a file says. */
struct extended_xyz {
	size_t particle_count;
	struct touchstone_particle *particles; /* species: index into the species below */
	size_t species_count;
	struct touchstone_species *species;
	bool has_box, has_velocities;
	double box[3];
	size_t first_line; /* of particle 0; each has a line */
};

/* Reads the first frame of a file. Lattice must lie along the axes; with an Origin (its lower corner) coordinates are
 * shifted so that the box is centred, without they are taken as they are. Columns species, pos, velo (or vel,
 * velocities), radius, mass (or masses) are used, others passed over. With known species, each particle's is looked up
 * by name; without, it is made from radius (1/2 where there is no such column) and mass (1). False with a message, and
 * nothing to free, when the file cannot be read or is no such file. */
bool extended_xyz_read(struct extended_xyz *file, const char *path, int dimensions, size_t known_count,
					   const struct extended_xyz_species *known, char error[STORE_ERROR]);
void extended_xyz_free(struct extended_xyz *file);

/* Writes the particles of a scene at a time as one frame, species by number from 1, every number with all its digits;
 * and, unless it is NULL, how many partners each has captured, in a column of that name, for viewers to colour by. */
void extended_xyz_frame(FILE *stream, const struct touchstone_scene *scene, double time, const uint32_t *captured);

/* The same as a file of one frame, at the scene's clock. */
bool extended_xyz_write(const char *path, const struct touchstone_scene *scene, const uint32_t *captured,
						char error[STORE_ERROR]);

#endif
