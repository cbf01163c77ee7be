/* Bands of distance: which particles stand so far from another that something may happen between them soon. In
 * binary32, between the points that neighbour lists are made for (engine/neighbours.inl). */
#ifndef TOUCHSTONE_BANDS_H
#define TOUCHSTONE_BANDS_H

#include <stddef.h>
#include <stdint.h>

enum { MOST_BANDS = 8 };

struct bands {
	int count;
	float low[MOST_BANDS], high[MOST_BANDS]; /* squares of distances; apart from each other, in no order */
};

struct anchor {
	float at[4]; /* the last of no meaning: four are read at once */
};

/* Adds a band, from one distance to a larger one. Bands that overlap become one, and so do the last two when there are
 * too many. */
void bands_add(struct bands *bands, double low, double high);

/* Writes to `found` those of `count` entries (engine/cells.h) whose anchors are within a band of the point `to` and
 * were not of the point `from` (a NaN there: of none), and returns how many. Whether an anchor is within a band of
 * another does not depend on which of the two asks, to the last bit. Behind the last entry stand 16 more that name
 * particles which exist; `found` has room for 16 more than are found. */
typedef size_t bands_lister(const struct bands *bands, const struct anchor *anchor, const float box[3],
							const float from[3], const float to[3], const uint32_t *entry, size_t count,
							uint32_t *found);

/* The fastest there is on this machine (number 0), and the others, to be compared: NULL after the last. */
bands_lister *bands_machine(size_t number);

#endif
