/* Overlaps so deep that no rounding explains them: of two particles by nearest images, or of a particle and a wall.
 *
 * Particles are sorted along the first axis, so that only those are compared that lie within a diameter of one another
 * there: of N in a cube some N^(5/3) pairs, not N^2. */
#ifndef VERIFY_DEEP_OVERLAP_H
#define VERIFY_DEEP_OVERLAP_H

#include <stdint.h>

#include "touchstone.h"

/* Two particles, the lower number first, or a particle and a wall. */
struct deep_overlap {
	uint32_t first, second;
	bool wall;
	double depth; /* how near, over the contact distance */
};

/* Where particles are looked at; positions are the owner's to fill. */
struct deep_overlaps {
	const struct touchstone_scene *scene;
	double (*position)[3]; /* absolute and finite, one each */
	double (*sorted)[2];   /* place on the first axis, within the box, and number */
};

/* For a scene that outlives it. False when out of memory; end it with deep_overlaps_free either way. */
bool deep_overlaps_make(struct deep_overlaps *overlaps, const struct touchstone_scene *scene);
void deep_overlaps_free(struct deep_overlaps *overlaps);

/* Finds the deepest, if one is nearer than that part of its contact distance (at most 1). Cores of potentials do not
 * count. */
bool deep_overlaps_find(struct deep_overlaps *overlaps, double part, struct deep_overlap *deepest);

/* How near the two are now, over their contact distance. */
double deep_overlaps_depth(const struct deep_overlaps *overlaps, const struct deep_overlap *overlap);

#endif
