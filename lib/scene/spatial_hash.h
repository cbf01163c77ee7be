/* Who overlaps whom, in constant time per particle: cells as wide as the particles in them, found by hashing.
 *
 * Particles are sorted by size into levels, each half as wide as the one before, so that a crowd of small particles
 * around a large one does not fall into one cell. Enter them level by level, the widest (level 0) first. */
#ifndef TOUCHSTONE_SPATIAL_HASH_H
#define TOUCHSTONE_SPATIAL_HASH_H

#include "touchstone.h"

enum { SPATIAL_HASH_LEVELS = 24 }; /* the last takes all that is smaller */

/* What a search needs of an entered particle, in half a cache line. */
struct spatial_hash_entry {
	double position[3];
	uint32_t species;
	uint32_t next; /* in the same bucket */
};

struct spatial_hash {
	const struct touchstone_scene *scene;
	bool used[SPATIAL_HASH_LEVELS];            /* whether any species is of that level */
	double per_length[SPATIAL_HASH_LEVELS][3]; /* cells per unit of length */
	int64_t count[SPATIAL_HASH_LEVELS][3];     /* cells around, on a periodic axis */
	uint8_t *level;                            /* of each species */
	struct spatial_hash_entry *entry;          /* of each particle */
	uint32_t *first;                           /* particle in each bucket */
	uint32_t mask;                             /* buckets - 1 */
};

/* Makes an empty table for the particles of a scene, whose box and species are final but whose positions may still be
 * to come. The scene must outlive it. False when there is no memory. */
bool spatial_hash_create(struct spatial_hash *hash, const struct touchstone_scene *scene);
void spatial_hash_destroy(struct spatial_hash *hash);

/* Enters a particle where its position says. On periodic axes that must lie within the box. */
void spatial_hash_insert(struct spatial_hash *hash, uint32_t particle);

/* How deep a particle reaches into one that was entered, at its own level or a wider one: contact distance minus the
 * distance of centres to the nearest image; 0 when it reaches into none. The search ends early at a depth above
 * `enough`. Names the other particle when the depth is not 0. */
double spatial_hash_depth(const struct spatial_hash *hash, uint32_t particle, double enough, uint32_t *other);

#endif
