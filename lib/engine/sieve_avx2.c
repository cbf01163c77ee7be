/* The sieve in vectors of eight, on x86 with AVX2. */
#include "engine/sieve.h"

#ifdef __x86_64__
#include "engine/pack.h"

#define LANES 8
#define MACHINE __attribute__((target("avx2,fma,popcnt,bmi,bmi2")))
#include "engine/sieve_lanes.inl"
#include "engine/sieve_vectors.inl"

INLINE lanes root(lanes x)
{
	return (lanes)_mm256_sqrt_ps((__m256)x);
}

/* Of rsqrtps and rcpps Intel and AMD give different bits, within 1.5 x 2^-12. */
INLINE lanes near_root(lanes x)
{
	return x * (lanes)_mm256_rsqrt_ps((__m256)x);
}

INLINE lanes near_inverse(lanes x)
{
	return (lanes)_mm256_rcp_ps((__m256)x);
}

INLINE lanes pick(mask which, lanes yes, lanes no)
{
	return (lanes)_mm256_blendv_ps((__m256)no, (__m256)yes, (__m256)which);
}

INLINE bool any(whole_lanes words)
{
	return !_mm256_testz_si256((__m256i)words, (__m256i)words);
}

INLINE flags bits(mask which)
{
	return (flags)_mm256_movemask_ps((__m256)which);
}

INLINE lanes larger(lanes a, lanes b)
{
	return (lanes)_mm256_max_ps((__m256)a, (__m256)b);
}

INLINE lanes smaller(lanes a, lanes b)
{
	return (lanes)_mm256_min_ps((__m256)a, (__m256)b);
}

INLINE float minimum(lanes x)
{
	__m128 four = _mm_min_ps(_mm256_castps256_ps128((__m256)x), _mm256_extractf128_ps((__m256)x, 1));
	__m128 two = _mm_min_ps(four, _mm_movehl_ps(four, four));
	return _mm_cvtss_f32(_mm_min_ss(two, _mm_movehdup_ps(two)));
}

INLINE size_t pack(flags wanted, const uint32_t *from, uint32_t *to)
{
	return pack_eight(_mm256_loadu_si256((const __m256i *)from), wanted, to);
}

/* Every other word of two vectors, in their order: those at even places, and those at odd ones. */
INLINE void part_words(__m256 low, __m256 high, __m256 *even, __m256 *odd)
{
	__m256d evens = _mm256_castps_pd(_mm256_shuffle_ps(low, high, 0x88));
	__m256d odds = _mm256_castps_pd(_mm256_shuffle_ps(low, high, 0xdd));
	*even = _mm256_castpd_ps(_mm256_permute4x64_pd(evens, 0xd8));
	*odd = _mm256_castpd_ps(_mm256_permute4x64_pd(odds, 0xd8));
}

/* Pairs and limits are two words each; those behind the last are of the state of the first. */
INLINE void limits_of(const struct pair_state *pair, size_t count, const struct limits *limits, uint32_t *entry,
					  lanes *outer, lanes *inner)
{
	const __m256i word = _mm256_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7), next = _mm256_set1_epi32(8);
	const __m256i words = _mm256_set1_epi32(count < LANES ? 2 * (int)count : 2 * LANES);
	__m256i low = _mm256_maskload_epi32((const int *)pair, _mm256_cmpgt_epi32(words, word));
	__m256i high =
		_mm256_maskload_epi32((const int *)pair + 8, _mm256_cmpgt_epi32(words, _mm256_add_epi32(word, next)));
	__m256 entries, states, outers, inners, first = _mm256_castsi256_ps(_mm256_set1_epi32((int)pair->state));
	uint32_t state[LANES] __attribute__((aligned(32)));
	part_words(_mm256_castsi256_ps(low), _mm256_castsi256_ps(high), &entries, &states);
	_mm256_store_ps((float *)entry, entries);
	_mm256_store_ps((float *)state, _mm256_blendv_ps(states, first, (__m256)behind(count)));
	double both[LANES];
	for (int lane = 0; lane < LANES; lane++) memcpy(&both[lane], &limits[state[lane]], sizeof both[lane]);
	part_words(_mm256_castpd_ps(_mm256_setr_pd(both[0], both[1], both[2], both[3])),
			   _mm256_castpd_ps(_mm256_setr_pd(both[4], both[5], both[6], both[7])), &outers, &inners);
	*outer = (lanes)outers, *inner = (lanes)inners;
}

/* Eight rows of eight, turned over. */
INLINE void fetch(const struct shadow *shadow, const uint32_t *entry, lanes field[FIELDS])
{
	__m256 row[8], pair[8], quad[8];
	for (int k = 0; k < 8; k++) row[k] = _mm256_load_ps((const float *)&shadow[entry_particle(entry[k])]);
	for (int k = 0; k < 8; k += 2) {
		pair[k] = _mm256_unpacklo_ps(row[k], row[k + 1]);
		pair[k + 1] = _mm256_unpackhi_ps(row[k], row[k + 1]);
	}
	for (int k = 0; k < 8; k += 4)
		for (int half = 0; half < 2; half++) {
			__m256d first = _mm256_castps_pd(pair[k + half]), second = _mm256_castps_pd(pair[k + half + 2]);
			quad[k + 2 * half] = _mm256_castpd_ps(_mm256_unpacklo_pd(first, second));
			quad[k + 2 * half + 1] = _mm256_castpd_ps(_mm256_unpackhi_pd(first, second));
		}
	for (int f = 0; f < 4; f++) {
		field[f] = (lanes)_mm256_permute2f128_ps(quad[f], quad[f + 4], 0x20);
		field[f + 4] = (lanes)_mm256_permute2f128_ps(quad[f], quad[f + 4], 0x31);
	}
}

#include "engine/sieve_passes.inl"
#include "engine/sieve_x86.inl"

const struct sieve_machine sieve_avx2 = {"AVX2", pass, hold, sooner, check, cast};
#endif
