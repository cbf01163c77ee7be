#include "engine/pairs.h"

#include <stdlib.h>
#include <string.h>

#include "engine/cells.h"

static const uint32_t no_block = UINT32_MAX;

bool pairs_create(struct pairs *pairs, uint32_t particles)
{
	*pairs = (struct pairs){.particles = particles};
	for (int size = 0; size < PAIR_SIZES; size++) pairs->spare[size] = no_block;
	pairs->bucket = calloc(particles, sizeof *pairs->bucket);
	pairs->room = 64;
	pairs->slot = malloc(pairs->room * sizeof *pairs->slot);
	return pairs->bucket && pairs->slot;
}

void pairs_destroy(struct pairs *pairs)
{
	free(pairs->bucket);
	free(pairs->slot);
	*pairs = (struct pairs){0};
}

size_t pairs_memory(const struct pairs *pairs)
{
	return pairs->bucket ? pairs->particles * sizeof *pairs->bucket + pairs->room * sizeof *pairs->slot : 0;
}

/* Finds a free block of 2^size slots; no_block when there is no memory. */
static uint32_t take_block(struct pairs *pairs, int size)
{
	uint32_t block = pairs->spare[size];
	if (block != no_block) {
		pairs->spare[size] = pairs->slot[block].entry;
		return block;
	}
	size_t needed = pairs->slots + ((size_t)1 << size);
	if (needed >= no_block) return no_block;
	if (needed > pairs->room) {
		size_t room = needed + needed / 4 + 64;
		struct pair_state *slot = realloc(pairs->slot, room * sizeof *slot);
		if (!slot) return no_block;
		pairs->slot = slot, pairs->room = room;
	}
	block = (uint32_t)pairs->slots;
	pairs->slots = needed;
	return block;
}

/* Gives a bucket another size, and what it holds another place. */
static bool resize(struct pairs *pairs, struct pair_bucket *bucket, int size)
{
	if (size >= PAIR_SIZES) return false;
	uint32_t block = size ? take_block(pairs, size) : 0;
	if (block == no_block) return false;
	if (bucket->used) memcpy(pairs->slot + block, pairs->slot + bucket->first, bucket->used * sizeof *pairs->slot);
	if (bucket->size) {
		pairs->slot[bucket->first].entry = pairs->spare[bucket->size];
		pairs->spare[bucket->size] = bucket->first;
	}
	bucket->first = block;
	bucket->size = (uint8_t)size;
	return true;
}

static struct pair_state *find(const struct pairs *pairs, uint32_t i, uint32_t entry)
{
	typedef uint32_t two_slots __attribute__((vector_size(2 * sizeof(struct pair_state))));
	enum { AT_ONCE = 8 };
	const two_slots wanted = {entry, 0, entry, 0}; /* no state is 0 */
	struct pair_state *slot = pairs->slot + pairs->bucket[i].first, *end = slot + pairs->bucket[i].used;
	for (; end - slot >= AT_ONCE; slot += AT_ONCE) {
		two_slots two[AT_ONCE / 2];
		memcpy(two, slot, sizeof two);
		__typeof__(two[0] == wanted) same =
			(two[0] == wanted) | (two[1] == wanted) | (two[2] == wanted) | (two[3] == wanted);
		if (same[0] | same[2]) break;
	}
	for (; slot < end; slot++)
		if (slot->entry == entry) return slot;
	return NULL;
}

uint32_t pairs_get(const struct pairs *pairs, uint32_t i, uint32_t entry)
{
	const struct pair_state *slot = find(pairs, i, entry);
	return slot ? slot->state : 0;
}

static bool append(struct pairs *pairs, uint32_t i, uint32_t entry, uint32_t state)
{
	struct pair_bucket *bucket = &pairs->bucket[i];
	bool full = bucket->used == (bucket->size ? 1u << bucket->size : 0);
	if (full && !resize(pairs, bucket, bucket->size + 1)) return false;
	pairs->slot[bucket->first + bucket->used++] = (struct pair_state){entry, state};
	return true;
}

static bool drop(struct pairs *pairs, uint32_t i, struct pair_state *slot)
{
	struct pair_bucket *bucket = &pairs->bucket[i];
	*slot = pairs->slot[bucket->first + --bucket->used];
	if (bucket->used == 0) return resize(pairs, bucket, 0);
	bool roomy = bucket->size > 1 && bucket->used == 1u << bucket->size >> 2;
	return !roomy || resize(pairs, bucket, bucket->size - 1);
}

bool pairs_add(struct pairs *pairs, uint32_t i, uint32_t entry, uint32_t state)
{
	pairs->count++;
	return append(pairs, i, entry, state) && append(pairs, entry_particle(entry), entry_mirrored(entry, i), state);
}

bool pairs_set(struct pairs *pairs, uint32_t i, uint32_t entry, uint32_t state)
{
	struct pair_state *slot = find(pairs, i, entry);
	if (!slot) return !state || pairs_add(pairs, i, entry, state);
	uint32_t j = entry_particle(entry);
	if (state) {
		slot->state = find(pairs, j, entry_mirrored(entry, i))->state = state;
		return true;
	}
	pairs->count--;
	return drop(pairs, i, slot) && drop(pairs, j, find(pairs, j, entry_mirrored(entry, i)));
}

/* What lies on the other side already could not be captured after the move, nor before it: cells are wider than any
 * step. Image 0 goes first, so that two images of one partner are never mistaken. */
void pairs_shift(struct pairs *pairs, uint32_t i, int axis, int by)
{
	struct pair_state *slot = pairs->slot + pairs->bucket[i].first;
	for (int image = 0; image == 0 || image == -by; image -= by)
		for (uint32_t k = 0; k < pairs->bucket[i].used; k++) {
			uint32_t entry = slot[k].entry, shifted = entry_shifted(entry, axis, by);
			if (entry_image(entry, axis) != image) continue;
			find(pairs, entry_particle(entry), entry_mirrored(entry, i))->entry = entry_mirrored(shifted, i);
			slot[k].entry = shifted;
		}
}
