#include "engine/pairs.h"

#include <stdlib.h>
#include <string.h>

#include "engine/cells.h"

static const uint32_t no_block = UINT32_MAX;

enum { AT_ONCE = 8 }; /* slots that are read: so many stand behind the last */

bool pairs_create(struct pairs *pairs, uint32_t particles)
{
	*pairs = (struct pairs){.particles = particles};
	for (int size = 0; size < PAIR_SIZES; size++) pairs->spare[size] = no_block;
	pairs->bucket = calloc(particles, sizeof *pairs->bucket);
	pairs->room = 64;
	pairs->slot = malloc((pairs->room + AT_ONCE) * sizeof *pairs->slot);
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
		struct pair_state *slot = realloc(pairs->slot, (room + AT_ONCE) * sizeof *slot);
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

/* Where particle i has an entry; NULL where it is not stored. Eight at a time, a bit for each: in a loop that ends at
 * the slot that is looked for a processor would have to guess which. */
static struct pair_state *find(const struct pairs *pairs, uint32_t i, uint32_t entry)
{
	typedef uint32_t two_slots __attribute__((vector_size(2 * sizeof(struct pair_state))));
	const two_slots wanted = {entry, 0, entry, 0}; /* no state is 0 */
	const struct pair_bucket *bucket = &pairs->bucket[i];
	struct pair_state *slot = pairs->slot + bucket->first;
	for (uint32_t at = 0; at < bucket->used; at += AT_ONCE) {
		two_slots bits = {0};
		for (uint32_t k = 0; k < AT_ONCE; k += 2) {
			two_slots two;
			memcpy(&two, slot + at + k, sizeof two);
			bits |= (two_slots)(two == wanted) & (two_slots){UINT32_C(1) << k, 0, UINT32_C(2) << k, 0};
		}
		uint32_t found = bits[0] | bits[2];
		if (bucket->used - at < AT_ONCE) found &= (UINT32_C(1) << (bucket->used - at)) - 1;
		if (found) return slot + at + __builtin_ctz(found);
	}
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
