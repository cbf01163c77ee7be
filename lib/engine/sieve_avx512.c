/* The sieve in vectors of sixteen, on x86 with AVX-512. */
#include "engine/sieve.h"

#ifdef __x86_64__
#include <immintrin.h>

#define LANES 16
#define MACHINE __attribute__((target("avx512f,avx512dq,avx512vl,avx512bw,fma,popcnt,bmi,bmi2")))
#include "engine/sieve_lanes.inl"

typedef flags mask;

INLINE mask less(lanes a, lanes b)
{
	return _mm512_cmp_ps_mask((__m512)a, (__m512)b, _CMP_LT_OQ);
}

INLINE lanes pick(mask which, lanes yes, lanes no)
{
	return (lanes)_mm512_mask_blend_ps((__mmask16)which, (__m512)no, (__m512)yes);
}

INLINE mask behind(size_t count)
{
	return count < LANES ? all_lanes & ~((1u << count) - 1) : 0;
}

INLINE bool any(whole_lanes words)
{
	return _mm512_test_epi32_mask((__m512i)words, (__m512i)words);
}

INLINE flags bits(mask which)
{
	return which;
}

INLINE lanes root(lanes x)
{
	return (lanes)_mm512_sqrt_ps((__m512)x);
}

INLINE lanes near_root(lanes x)
{
	return x * (lanes)_mm512_rsqrt14_ps((__m512)x);
}

INLINE lanes near_inverse(lanes x)
{
	return (lanes)_mm512_rcp14_ps((__m512)x);
}

INLINE lanes larger(lanes a, lanes b)
{
	return (lanes)_mm512_max_ps((__m512)a, (__m512)b);
}

INLINE lanes smaller(lanes a, lanes b)
{
	return (lanes)_mm512_min_ps((__m512)a, (__m512)b);
}

INLINE float minimum(lanes x)
{
	return _mm512_reduce_min_ps((__m512)x);
}

INLINE size_t pack(flags wanted, const uint32_t *from, uint32_t *to)
{
	_mm512_storeu_si512(to, _mm512_maskz_compress_epi32((__mmask16)wanted, _mm512_loadu_si512(from)));
	return (size_t)__builtin_popcount(wanted);
}

/* A transposition of two squares of eight at once: the registers hold rows 0 to 3 and 8 to 11 in their lower halves. */
INLINE void fetch(const struct shadow *shadow, const uint32_t *entry, lanes field[FIELDS])
{
	__m512 row[8], pair[8], quad[8];
	for (int k = 0; k < 8; k++) {
		int lower = k + (k & 4), upper = lower + 4;
		__m256 first = _mm256_load_ps((const float *)&shadow[entry_particle(entry[lower])]);
		__m256 second = _mm256_load_ps((const float *)&shadow[entry_particle(entry[upper])]);
		row[k] = _mm512_insertf32x8(_mm512_castps256_ps512(first), second, 1);
	}
	for (int k = 0; k < 8; k += 2) {
		pair[k] = _mm512_unpacklo_ps(row[k], row[k + 1]);
		pair[k + 1] = _mm512_unpackhi_ps(row[k], row[k + 1]);
	}
	for (int k = 0; k < 8; k += 4)
		for (int half = 0; half < 2; half++) {
			__m512d first = _mm512_castps_pd(pair[k + half]), second = _mm512_castps_pd(pair[k + half + 2]);
			quad[k + 2 * half] = _mm512_castpd_ps(_mm512_unpacklo_pd(first, second));
			quad[k + 2 * half + 1] = _mm512_castpd_ps(_mm512_unpackhi_pd(first, second));
		}
	for (int f = 0; f < 4; f++) {
		field[f] = (lanes)_mm512_shuffle_f32x4(quad[f], quad[f + 4], 0x88);
		field[f + 4] = (lanes)_mm512_shuffle_f32x4(quad[f], quad[f + 4], 0xdd);
	}
}

/* Pairs and limits are two words each. */
INLINE void limits_of(const struct pair_state *pair, size_t count, const struct limits *limits, uint32_t *entry,
					  lanes *outer, lanes *inner)
{
	uint32_t halves = count < LANES ? (UINT32_C(1) << 2 * count) - 1 : UINT32_MAX;
	__m512i low = _mm512_maskz_loadu_epi32((__mmask16)halves, pair);
	__m512i high = _mm512_maskz_loadu_epi32((__mmask16)(halves >> 16), pair + LANES / 2);
	const __m512i even = _mm512_setr_epi32(0, 2, 4, 6, 8, 10, 12, 14, 16, 18, 20, 22, 24, 26, 28, 30);
	__m512i state = _mm512_permutex2var_epi32(low, _mm512_add_epi32(even, _mm512_set1_epi32(1)), high);
	_mm512_store_si512(entry, _mm512_permutex2var_epi32(low, even, high));
	__mmask16 there = count < LANES ? (__mmask16)((1u << count) - 1) : 0xffff;
	*outer = (lanes)_mm512_mask_i32gather_ps(_mm512_setzero_ps(), there, state, &limits->outer, sizeof *limits);
	*inner = (lanes)_mm512_mask_i32gather_ps(_mm512_setzero_ps(), there, state, &limits->inner, sizeof *limits);
}

#include "engine/sieve_passes.inl"
#include "engine/sieve_x86.inl"

const struct sieve_machine sieve_avx512 = {"AVX-512", pass, hold, sooner, check, cast};
#endif
