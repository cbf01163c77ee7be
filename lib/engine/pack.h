/* Some of four words, close together: by one shuffle, where a machine has none for sixteen. */
#ifndef TOUCHSTONE_PACK_H
#define TOUCHSTONE_PACK_H

#include <immintrin.h>
#include <stddef.h>
#include <stdint.h>

#define PACK_WORD(k) 4 * (k), 4 * (k) + 1, 4 * (k) + 2, 4 * (k) + 3
static const uint8_t pack_order[16][16] __attribute__((aligned(16))) = {
	[0x1] = {PACK_WORD(0)},
	[0x2] = {PACK_WORD(1)},
	[0x3] = {PACK_WORD(0), PACK_WORD(1)},
	[0x4] = {PACK_WORD(2)},
	[0x5] = {PACK_WORD(0), PACK_WORD(2)},
	[0x6] = {PACK_WORD(1), PACK_WORD(2)},
	[0x7] = {PACK_WORD(0), PACK_WORD(1), PACK_WORD(2)},
	[0x8] = {PACK_WORD(3)},
	[0x9] = {PACK_WORD(0), PACK_WORD(3)},
	[0xa] = {PACK_WORD(1), PACK_WORD(3)},
	[0xb] = {PACK_WORD(0), PACK_WORD(1), PACK_WORD(3)},
	[0xc] = {PACK_WORD(2), PACK_WORD(3)},
	[0xd] = {PACK_WORD(0), PACK_WORD(2), PACK_WORD(3)},
	[0xe] = {PACK_WORD(1), PACK_WORD(2), PACK_WORD(3)},
	[0xf] = {PACK_WORD(0), PACK_WORD(1), PACK_WORD(2), PACK_WORD(3)},
};

/* Writes those of four whose bit is set, and what becomes of the rest behind them; returns how many. */
__attribute__((target("avx2,popcnt"))) static inline size_t pack_four(__m128i four, unsigned wanted, uint32_t *to)
{
	_mm_storeu_si128((__m128i *)to, _mm_shuffle_epi8(four, _mm_load_si128((const __m128i *)pack_order[wanted])));
	return (size_t)__builtin_popcount(wanted);
}

#endif
