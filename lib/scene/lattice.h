/* Regular start positions: a lattice fitted into a box of any shape, with as much room around each site as the
 * number of particles allows. */
#ifndef TOUCHSTONE_LATTICE_H
#define TOUCHSTONE_LATTICE_H

#include "touchstone.h"

/* Layers of points along each axis. A centred lattice keeps those points whose three indices add up to an even
 * number: face-centred cubic when the spacings are equal; in 2 dimensions triangular when they are as 1 to sqrt(3). */
struct lattice {
	int dimensions;
	bool centred;
	size_t layers[3];
	double spacing[3];
	double first[3]; /* coordinate of layer 0 */
	size_t sites;
	double distance; /* between nearest sites, periodic images included */
};

/* What a lattice is fitted to. */
struct lattice_box {
	int dimensions;
	double extent[3];
	bool periodic[3];
	bool walled[3];  /* sites keep half a diameter from both ends */
	double diameter; /* of the largest particle */
};

/* The lattice with at least `count` sites that has the widest distance between nearest sites; among equals the one
 * with the fewest sites. Its distance may be less than the diameter: then the particles do not fit; it is 0 when not
 * even one site does. */
struct lattice lattice_fit(const struct lattice_box *box, bool centred, size_t count);

/* Puts `count` particles (at most lattice.sites) on sites; vacancies are spread evenly among them. */
void lattice_place(const struct lattice *lattice, struct touchstone_particle *particles, size_t count);

#endif
