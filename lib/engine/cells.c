#include "engine/cells.h"

#include <stdlib.h>
#include <string.h>

#include "engine/memory.h"

#ifdef __x86_64__
#include "engine/pack.h"
#endif

/* Entries per cell: two steps of sixteen, of which each cell is then a multiple. */
static const uint32_t gapless_from = 32;

bool cells_create(struct cells *cells, int dimensions, const bool periodic[3], const int count[3], uint32_t capacity)
{
	*cells = (struct cells){.dimensions = dimensions, .capacity = capacity, .gapless = capacity >= gapless_from};
	cells->list_rows = cells_machine(cells->gapless, 0);
	size_t total = capacity;
	for (int axis = 0; axis < 3; axis++) {
		cells->periodic[axis] = periodic[axis];
		cells->count[axis] = count[axis];
		cells->stride[axis] = axis < dimensions ? total : 0;
		if (axis < dimensions && __builtin_mul_overflow(total, (size_t)count[axis] + 2, &total)) return false;
	}
	int beyond_y = dimensions > 1, beyond_z = dimensions > 2;
	for (int z = -beyond_z; z <= beyond_z; z++)
		for (int y = -beyond_y; y <= beyond_y; y++)
			cells->row[cells->rows++] =
				z * (ptrdiff_t)cells->stride[2] + y * (ptrdiff_t)cells->stride[1] - (ptrdiff_t)cells->stride[0];
	cells->entries = total;
	size_t bytes = total * sizeof *cells->entry;
	cells->entry = memory_room(bytes);
	if (cells->entry) memset(cells->entry, 0xff, bytes);
	return cells->entry;
}

void cells_destroy(struct cells *cells)
{
	free(cells->entry);
	*cells = (struct cells){0};
}

/* The coordinates along one axis at which a cell shows: its own, and those of its ghosts, with their image codes. */
static int shown(const struct cells *cells, int axis, int coordinate, int at[3], uint32_t code[3])
{
	at[0] = coordinate, code[0] = 0;
	if (!cells->periodic[axis]) return 1;
	int views = 1, count = cells->count[axis];
	if (coordinate == 1) at[views] = coordinate + count, code[views++] = 1;
	if (coordinate == count) at[views] = coordinate - count, code[views++] = 2;
	return views;
}

/* Writes `entry` in place of `old` in one cell. Looks through all of it: where to stop would have to be guessed. */
static bool replace(struct cells *cells, size_t index, uint32_t old, uint32_t entry)
{
	uint32_t *slot = cells->entry + index, at = cells->capacity;
	if (cells->gapless)
		for (at = 0; at < cells->capacity && slot[at] != old;) at++;
	else
		for (uint32_t i = cells->capacity; i-- > 0;) at = slot[i] == old ? i : at;
	if (at == cells->capacity) return false;
	uint32_t last = at;
	while (cells->gapless && entry == entry_none && last + 1 < cells->capacity && slot[last + 1] != entry_none) last++;
	slot[at] = slot[last];
	slot[last] = entry;
	return true;
}

static bool show(struct cells *cells, const uint16_t cell[3], uint32_t particle, bool enter)
{
	cells->changes++;
	if (!cells_at_border(cells, cell)) {
		size_t index = cells_index(cells, cell);
		return enter ? replace(cells, index, entry_none, particle) : replace(cells, index, particle, entry_none);
	}
	int at[3][3] = {{0}}, views[3] = {1, 1, 1};
	uint32_t code[3][3] = {{0}};
	for (int axis = 0; axis < cells->dimensions; axis++)
		views[axis] = shown(cells, axis, cell[axis], at[axis], code[axis]);
	bool done = true;
	for (int z = 0; z < views[2]; z++)
		for (int y = 0; y < views[1]; y++)
			for (int x = 0; x < views[0]; x++) {
				size_t index = (size_t)at[0][x] * cells->stride[0] + (size_t)at[1][y] * cells->stride[1] +
							   (size_t)at[2][z] * cells->stride[2];
				uint32_t images = code[0][x] | code[1][y] << 2 | code[2][z] << 4;
				uint32_t entry = particle | images << ENTRY_BITS;
				done &= enter ? replace(cells, index, entry_none, entry) : replace(cells, index, entry, entry_none);
			}
	return done;
}

bool cells_insert(struct cells *cells, const uint16_t cell[3], uint32_t particle)
{
	return show(cells, cell, particle, true);
}

void cells_remove(struct cells *cells, const uint16_t cell[3], uint32_t particle)
{
	show(cells, cell, particle, false);
}

/* Without a branch per entry. */
static size_t list_rows_any(const struct cells *cells, const uint32_t *centre, const ptrdiff_t *offset, int rows,
							size_t length, uint32_t self, uint32_t *list)
{
	size_t found = 0;
	(void)cells;
	for (int row = 0; row < rows; row++)
		for (size_t i = 0; i < length; i++) {
			uint32_t entry = centre[offset[row] + (ptrdiff_t)i];
			list[found] = entry;
			found += entry != entry_none && entry != self;
		}
	for (size_t i = 0; i < 16; i++) list[found + i] = 0;
	return found;
}

/* Cell by cell, each as far as it is filled. */
static size_t list_gapless_any(const struct cells *cells, const uint32_t *centre, const ptrdiff_t *offset, int rows,
							   size_t length, uint32_t self, uint32_t *list)
{
	size_t found = 0;
	for (int row = 0; row < rows; row++)
		for (size_t cell = 0; cell < length; cell += cells->capacity)
			for (size_t i = 0; i < cells->capacity; i++) {
				uint32_t entry = centre[offset[row] + (ptrdiff_t)(cell + i)];
				if (entry == entry_none) break;
				list[found] = entry;
				found += entry != self;
			}
	for (size_t i = 0; i < 16; i++) list[found + i] = 0;
	return found;
}

#ifdef __x86_64__
#define AVX2 static __attribute__((target("avx2,popcnt,bmi,bmi2")))
#define AVX2_INLINE AVX2 inline __attribute__((always_inline))
#define AVX512 static __attribute__((target("avx512f,popcnt,bmi,bmi2")))
#define AVX512_INLINE AVX512 inline __attribute__((always_inline))

/* The first sixteen of a row's entries, or `length` if they are fewer, and which lanes they fill. What lies behind them
 * is not read: it would often be a cache line that nobody needs, and for one of 10^6 particles a wait for memory. */
AVX512_INLINE __m512i row_begin(const uint32_t *row, size_t length, __mmask16 *filled)
{
	*filled = length < 16 ? (__mmask16)((1u << length) - 1) : 0xffff;
	if (length >= 16) return _mm512_loadu_si512(row);
	if (length < 8) return _mm512_castsi128_si512(_mm_loadu_si128((const void *)row));
	__m256i eight = _mm256_loadu_si256((const void *)row);
	if (length < 12) return _mm512_castsi256_si512(eight);
	__m128i four = _mm_loadu_si128((const void *)(row + 8));
	return _mm512_inserti64x4(_mm512_castsi256_si512(eight), _mm256_castsi128_si256(four), 1);
}

/* Sixteen entries at a time. */
AVX512_INLINE size_t list_sixteens(const uint32_t *centre, const ptrdiff_t *offset, int rows, size_t length,
								   uint32_t self, uint32_t *list)
{
	const __m512i none = _mm512_set1_epi32((int)entry_none), own = _mm512_set1_epi32((int)self);
	size_t found = 0;
	for (int row = 0; row < rows; row++)
		for (size_t i = 0; i < length; i += 16) {
			__mmask16 used;
			__m512i some = row_begin(centre + offset[row] + i, length - i, &used);
			used = _mm512_mask_cmpneq_epu32_mask(used, some, none);
			used = _mm512_mask_cmpneq_epu32_mask(used, some, own);
			_mm512_storeu_si512(list + found, _mm512_maskz_compress_epi32(used, some));
			found += (unsigned)__builtin_popcount(used);
		}
	_mm512_storeu_si512(list + found, _mm512_setzero_si512());
	return found;
}

/* The usual rows, three cells of four or of eight entries, need no branch on their length. */
AVX512 size_t list_rows_512(const struct cells *cells, const uint32_t *centre, const ptrdiff_t *offset, int rows,
							size_t length, uint32_t self, uint32_t *list)
{
	(void)cells;
	switch (length) {
	case 12:
		return list_sixteens(centre, offset, rows, 12, self, list);
	case 24:
		return list_sixteens(centre, offset, rows, 24, self, list);
	default:
		return list_sixteens(centre, offset, rows, length, self, list);
	}
}

AVX512 size_t list_gapless_512(const struct cells *cells, const uint32_t *centre, const ptrdiff_t *offset, int rows,
							   size_t length, uint32_t self, uint32_t *list)
{
	const __m512i none = _mm512_set1_epi32((int)entry_none), own = _mm512_set1_epi32((int)self);
	size_t found = 0;
	for (int row = 0; row < rows; row++)
		for (size_t cell = 0; cell < length; cell += cells->capacity) {
			__mmask16 filled = 0xffff;
			for (size_t i = 0; i < cells->capacity && filled == 0xffff; i += 16) {
				__m512i some = _mm512_loadu_si512(centre + offset[row] + cell + i);
				filled = _mm512_cmpneq_epu32_mask(some, none);
				__mmask16 used = _mm512_mask_cmpneq_epu32_mask(filled, some, own);
				_mm512_storeu_si512(list + found, _mm512_maskz_compress_epi32(used, some));
				found += (unsigned)__builtin_popcount(used);
			}
		}
	_mm512_storeu_si512(list + found, _mm512_setzero_si512());
	return found;
}

/* Which of eight entries are in use, and not the one that searches. */
AVX2_INLINE unsigned used_of(__m256i eight, __m256i none, __m256i own)
{
	__m256i unused = _mm256_or_si256(_mm256_cmpeq_epi32(eight, none), _mm256_cmpeq_epi32(eight, own));
	return (unsigned)_mm256_movemask_ps(_mm256_castsi256_ps(unused)) ^ 0xff;
}

AVX2_INLINE void end_list(uint32_t *end)
{
	_mm256_storeu_si256((__m256i *)end, _mm256_setzero_si256());
	_mm256_storeu_si256((__m256i *)(end + 8), _mm256_setzero_si256());
}

/* Eight entries at a time, and then four: a cell has a multiple of that. */
AVX2_INLINE size_t list_row(const uint32_t *row, size_t length, __m256i none, __m256i own, uint32_t *list)
{
	size_t found = 0, i = 0;
	for (; i + 8 <= length; i += 8) {
		__m256i eight = _mm256_loadu_si256((const __m256i *)(row + i));
		found += pack_eight(eight, used_of(eight, none, own), list + found);
	}
	if (i == length) return found;
	__m256i four = _mm256_inserti128_si256(none, _mm_loadu_si128((const __m128i *)(row + i)), 0);
	return found + pack_eight(four, used_of(four, none, own), list + found);
}

AVX2_INLINE size_t list_eights(const uint32_t *centre, const ptrdiff_t *offset, int rows, size_t length, uint32_t self,
							   uint32_t *list)
{
	const __m256i none = _mm256_set1_epi32((int)entry_none), own = _mm256_set1_epi32((int)self);
	size_t found = 0;
	for (int row = 0; row < rows; row++) found += list_row(centre + offset[row], length, none, own, list + found);
	end_list(list + found);
	return found;
}

/* The same for rows of eights and fours: without these branches 1.05 times the instructions of dense hard spheres. */
AVX2 size_t list_rows_avx2(const struct cells *cells, const uint32_t *centre, const ptrdiff_t *offset, int rows,
						   size_t length, uint32_t self, uint32_t *list)
{
	(void)cells;
	switch (length) {
	case 12:
		return list_eights(centre, offset, rows, 12, self, list);
	case 24:
		return list_eights(centre, offset, rows, 24, self, list);
	default:
		return list_eights(centre, offset, rows, length, self, list);
	}
}

AVX2 size_t list_gapless_avx2(const struct cells *cells, const uint32_t *centre, const ptrdiff_t *offset, int rows,
							  size_t length, uint32_t self, uint32_t *list)
{
	const __m256i none = _mm256_set1_epi32((int)entry_none), own = _mm256_set1_epi32((int)self);
	size_t found = 0;
	for (int row = 0; row < rows; row++)
		for (size_t cell = 0; cell < length; cell += cells->capacity)
			for (size_t i = 0; i < cells->capacity; i += 4) {
				const uint32_t *at = centre + offset[row] + cell + i;
				found += list_row(at, 4, none, own, list + found);
				if (at[3] == entry_none) break;
			}
	end_list(list + found);
	return found;
}
#endif

cells_lister *cells_machine(bool gapless, size_t number)
{
#ifdef __x86_64__
	bool fair = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("bmi2");
	bool fast = fair && __builtin_cpu_supports("avx512f");
	if (fast && number-- == 0) return gapless ? list_gapless_512 : list_rows_512;
	if (fair && number-- == 0) return gapless ? list_gapless_avx2 : list_rows_avx2;
#endif
	if (number == 0) return gapless ? list_gapless_any : list_rows_any;
	return NULL;
}

size_t cells_entered(const struct cells *cells, const uint16_t cell[3], const int step[3], uint32_t self,
					 uint32_t *list)
{
	const uint32_t *centre = cells->entry + cells_index(cells, cell);
	size_t capacity = cells->capacity, found = 0;
	ptrdiff_t whole[9], end[9]; /* rows that are new, and rows of which one cell is */
	int wholes = 0, ends = 0;
	for (int row = 0; row < cells->rows; row++) {
		int y = row % 3 - 1, z = row / 3 - 1;
		if ((step[1] && y == step[1]) || (step[2] && z == step[2]))
			whole[wholes++] = cells->row[row];
		else
			end[ends++] = cells->row[row] + (1 + step[0]) * (ptrdiff_t)capacity;
	}
	if (wholes) found = cells->list_rows(cells, centre, whole, wholes, 3 * capacity, self, list);
	if (step[0]) found += cells->list_rows(cells, centre, end, ends, capacity, self, list + found);
	return found;
}
