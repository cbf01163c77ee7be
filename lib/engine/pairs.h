/* Pair states: which pairs are within a step of their potential, and within how many. Whole numbers only.
 *
 * Only pairs in a state other than the outermost, which is the commonest, are stored (2016 paper, section 6), so that
 * memory grows with the particles and not with their pairs. The hash goes by particle: a pair stands in the bucket of
 * either of its two, so that a search finds all that a particle has captured in one place. A pair is a particle and an
 * entry (engine/cells.h), for in a narrow box two images of one particle may be captured at once. */
#ifndef TOUCHSTONE_PAIRS_H
#define TOUCHSTONE_PAIRS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "engine/ahead.h"

struct pair_state {
	uint32_t entry; /* the partner, and its image as the bucket's own particle sees it */
	uint32_t state; /* > 0 */
};

struct pair_bucket {
	uint32_t first; /* in `slot` */
	uint16_t used;
	uint8_t size; /* it has room for 2^size; 0: for none */
};

enum { PAIR_SIZES = 17 };

struct pairs {
	struct pair_bucket *bucket; /* per particle; NULL: no pair is ever captured */
	uint32_t particles;
	struct pair_state *slot;
	size_t slots, room;
	uint32_t spare[PAIR_SIZES]; /* for each size the first block that is free; each names the next in its entry */
	uint64_t count;             /* pairs */
};

/* Makes an empty store; false when there is no memory for it. */
bool pairs_create(struct pairs *pairs, uint32_t particles);
void pairs_destroy(struct pairs *pairs);
size_t pairs_memory(const struct pairs *pairs);

/* All that particle i has captured, until the next change of state; `*count` of them. */
static inline const struct pair_state *pairs_of(const struct pairs *pairs, uint32_t i, uint32_t *count)
{
	const struct pair_bucket *bucket = &pairs->bucket[i];
	*count = bucket->used;
	return pairs->slot + bucket->first;
}

/* Asks for what pairs_of() will read. */
static inline void pairs_ahead(const struct pairs *pairs, uint32_t i)
{
	const struct pair_state *slot = pairs->slot + pairs->bucket[i].first, *end = slot + pairs->bucket[i].used;
	for (; slot < end; slot += 64 / sizeof *slot) ahead(slot);
}

/* State of particle i and an entry; 0 for those not stored. */
uint32_t pairs_get(const struct pairs *pairs, uint32_t i, uint32_t entry);

/* Stores the state of particle i and an entry that are not stored, for both of them; false when memory ran out. */
bool pairs_add(struct pairs *pairs, uint32_t i, uint32_t entry, uint32_t state);

/* Gives particle i and an entry another state, for both of them; false when memory ran out. */
bool pairs_set(struct pairs *pairs, uint32_t i, uint32_t entry, uint32_t state);

/* From here on particle i is counted one box farther along an axis (by 1 or -1), and its partners are not. */
void pairs_shift(struct pairs *pairs, uint32_t i, int axis, int by);

#endif
