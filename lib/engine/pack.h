/* Some of eight words, close together, where a machine has no instruction for it. */
#ifndef TOUCHSTONE_PACK_H
#define TOUCHSTONE_PACK_H

#include <immintrin.h>
#include <stddef.h>
#include <stdint.h>

/* For each choice of eight the numbers of those that are wanted, in bytes, from the lowest: number i stands behind as
 * many as are wanted of those before it. */
#define PACK_BIT(m, i) ((m) >> (i)&1)
#define PACK_BEFORE_1(m) PACK_BIT(m, 0)
#define PACK_BEFORE_2(m) (PACK_BEFORE_1(m) + PACK_BIT(m, 1))
#define PACK_BEFORE_3(m) (PACK_BEFORE_2(m) + PACK_BIT(m, 2))
#define PACK_BEFORE_4(m) (PACK_BEFORE_3(m) + PACK_BIT(m, 3))
#define PACK_BEFORE_5(m) (PACK_BEFORE_4(m) + PACK_BIT(m, 4))
#define PACK_BEFORE_6(m) (PACK_BEFORE_5(m) + PACK_BIT(m, 5))
#define PACK_BEFORE_7(m) (PACK_BEFORE_6(m) + PACK_BIT(m, 6))
#define PACK_BYTE(m, i) (UINT64_C(i) * PACK_BIT(m, i) << 8 * PACK_BEFORE_##i(m))
#define PACK_1(m)                                                                                                \
	(PACK_BYTE(m, 1) | PACK_BYTE(m, 2) | PACK_BYTE(m, 3) | PACK_BYTE(m, 4) | PACK_BYTE(m, 5) | PACK_BYTE(m, 6) | \
	 PACK_BYTE(m, 7))
#define PACK_4(m) PACK_1(m), PACK_1((m) + 1), PACK_1((m) + 2), PACK_1((m) + 3)
#define PACK_16(m) PACK_4(m), PACK_4((m) + 4), PACK_4((m) + 8), PACK_4((m) + 12)
#define PACK_64(m) PACK_16(m), PACK_16((m) + 16), PACK_16((m) + 32), PACK_16((m) + 48)
static const uint64_t pack_order[256] = {PACK_64(0), PACK_64(64), PACK_64(128), PACK_64(192)};

/* Writes those of eight whose bit is set, and behind them what is of no meaning; returns how many. */
__attribute__((target("avx2,popcnt"), always_inline)) static inline size_t pack_eight(__m256i eight, unsigned wanted,
																					  uint32_t *to)
{
	__m256i order = _mm256_cvtepu8_epi32(_mm_loadl_epi64((const __m128i *)&pack_order[wanted]));
	_mm256_storeu_si256((__m256i *)to, _mm256_permutevar8x32_epi32(eight, order));
	return (size_t)__builtin_popcount(wanted);
}

#endif
