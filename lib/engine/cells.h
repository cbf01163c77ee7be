/* Search cells: which particles may be near which. Whole numbers only; nothing here moves a particle.
 *
 * A grid of cells covers the box, with one layer of ghosts around it. A cell is a short row of entries; an entry is
 * a particle and, in a ghost, the periodic image that is meant. The same particle stands in every ghost that shows
 * it, so a search never asks about boundaries, and a box of one cell per axis is a search over all pairs and images. */
#ifndef TOUCHSTONE_CELLS_H
#define TOUCHSTONE_CELLS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "engine/ahead.h"

/* An entry: the particle in the low bits; above them two bits per axis, the image: 0, or 1 for +1, or 2 for -1. */
enum { ENTRY_BITS = 26 };
#define ENTRY_PARTICLE ((UINT32_C(1) << ENTRY_BITS) - 1)
static const uint32_t entry_none = UINT32_MAX; /* image 3 on every axis: never a particle */

static inline uint32_t entry_particle(uint32_t entry)
{
	return entry & ENTRY_PARTICLE;
}

/* How many boxes the entry's particle is shifted along an axis: -1, 0 or 1. */
static inline int entry_image(uint32_t entry, int axis)
{
	uint32_t code = entry >> (ENTRY_BITS + 2 * axis) & 3;
	return (int)(code & 1) - (int)(code >> 1);
}

/* The same pair as the entry's particle sees it: +1 and -1 change places. */
static inline uint32_t entry_mirrored(uint32_t entry, uint32_t particle)
{
	uint32_t images = entry >> ENTRY_BITS;
	return particle | ((images & 0x15) << 1 | (images & 0x2a) >> 1) << ENTRY_BITS;
}

/* The entry's particle, so many boxes farther along an axis: -1, 0 or 1 in all. */
static inline uint32_t entry_shifted(uint32_t entry, int axis, int by)
{
	int image = entry_image(entry, axis) + by;
	uint32_t code = image < 0 ? 2 : (uint32_t)image;
	return (entry & ~(UINT32_C(3) << (ENTRY_BITS + 2 * axis))) | code << (ENTRY_BITS + 2 * axis);
}

/* Lists the entries in use, but for `self`, in so many rows of `length` entries each, which begin at `centre` + offset.
 */
struct cells;
typedef size_t cells_lister(const struct cells *cells, const uint32_t *centre, const ptrdiff_t *offset, int rows,
							size_t length, uint32_t self, uint32_t *list);

struct cells {
	int dimensions;
	bool periodic[3];
	int count[3];      /* without ghosts; coordinates of real cells run from 1 to count */
	size_t stride[3];  /* in entries */
	uint32_t capacity; /* entries per cell: 4, 8, 12 or 16, or that doubled so many times */
	bool gapless;      /* whether the entries of a cell stand without gaps: where cells are large and mostly empty */
	uint32_t *entry;   /* all cells, x fastest */
	size_t entries;
	ptrdiff_t row[9]; /* offsets, in entries, of the rows of three cells around a cell */
	int rows;
	uint64_t changes;        /* how often a particle was entered or taken out */
	cells_lister *list_rows; /* the fastest there is */
};

/* The fastest lister of this machine (number 0), and the others, to be compared: NULL after the last. The entries of a
 * gapless grid's cells stand without gaps. */
cells_lister *cells_machine(bool gapless, size_t number);

/* Makes an empty grid; false when there is no memory for it. */
bool cells_create(struct cells *cells, int dimensions, const bool periodic[3], const int count[3], uint32_t capacity);
void cells_destroy(struct cells *cells);

/* Enters a particle into its cell and the ghosts that show it; false when one of them is full. */
bool cells_insert(struct cells *cells, const uint16_t cell[3], uint32_t particle);
void cells_remove(struct cells *cells, const uint16_t cell[3], uint32_t particle);

static inline size_t cells_index(const struct cells *cells, const uint16_t cell[3])
{
	return cell[0] * cells->stride[0] + cell[1] * cells->stride[1] + cell[2] * cells->stride[2];
}

/* Lists the entries of a cell and its neighbours, or only of those that are not neighbours of the cell it was entered
 * from by a step of -1, 0 or 1 along each axis, but for the entry `self`.
 * `list` has room for cells_most() entries and 32 more, and 16 times particle 0 after the last. Returns
 * how many there are. */
static inline size_t cells_around(const struct cells *cells, const uint16_t cell[3], uint32_t self, uint32_t *list)
{
	return cells->list_rows(cells, cells->entry + cells_index(cells, cell), cells->row, cells->rows,
							3 * (size_t)cells->capacity, self, list);
}

/* Fetches a cell and its neighbours into the cache. */
static inline void cells_ahead(const struct cells *cells, const uint16_t cell[3])
{
	const uint32_t *centre = cells->entry + cells_index(cells, cell);
	for (int row = 0; row < cells->rows; row++) { /* a row is seldom longer than a cache line, but often lies in two */
		ahead(centre + cells->row[row]);
		ahead(centre + cells->row[row] + 3 * cells->capacity - 1);
	}
}

size_t cells_entered(const struct cells *cells, const uint16_t cell[3], const int step[3], uint32_t self,
					 uint32_t *list);

static inline size_t cells_most(const struct cells *cells)
{
	return (size_t)cells->rows * 3 * cells->capacity;
}

/* Whether a search from this cell may see images. */
static inline bool cells_at_border(const struct cells *cells, const uint16_t cell[3])
{
	bool at_border = false;
	for (int axis = 0; axis < 3; axis++)
		at_border |= cells->periodic[axis] & ((cell[axis] <= 1) | (cell[axis] >= cells->count[axis]));
	return at_border;
}

#endif
