#include "engine/bands.h"

#include <math.h>
#include <stdbool.h>

#include "engine/cells.h"

#ifdef __x86_64__
#include "engine/pack.h"
#endif

void bands_add(struct bands *bands, double low, double high)
{
	float least = (float)(low * low), most = (float)(high * high);
	for (int b = 0; b < bands->count;) {
		bool overlaps = least <= bands->high[b] && bands->low[b] <= most;
		if (!overlaps && !(bands->count == MOST_BANDS && b == MOST_BANDS - 1)) {
			b++;
			continue;
		}
		least = fminf(least, bands->low[b]), most = fmaxf(most, bands->high[b]);
		bands->count--;
		bands->low[b] = bands->low[bands->count], bands->high[b] = bands->high[bands->count];
		b = 0; /* the wider one may overlap others */
	}
	bands->low[bands->count] = least;
	bands->high[bands->count++] = most;
}

static bool within(const struct bands *bands, const float own[3], const float other[3], const float shift[3])
{
	float square = 0;
	for (int axis = 0; axis < 3; axis++) {
		float offset = own[axis] - other[axis] - shift[axis];
		square += offset * offset;
	}
	bool inside = false;
	for (int b = 0; b < bands->count; b++) inside |= square >= bands->low[b] && square <= bands->high[b];
	return inside;
}

static size_t list_any(const struct bands *bands, const struct anchor *anchor, const float box[3], const float from[3],
					   const float to[3], const uint32_t *entry, size_t count, uint32_t *found)
{
	size_t all = 0;
	for (size_t k = 0; k < count; k++) {
		const float *other = anchor[entry_particle(entry[k])].at;
		float shift[3];
		for (int axis = 0; axis < 3; axis++) shift[axis] = (float)entry_image(entry[k], axis) * box[axis];
		found[all] = entry[k];
		all += within(bands, to, other, shift) && !within(bands, from, other, shift);
	}
	return all;
}

#ifdef __x86_64__
#define AVX512 __attribute__((target("avx512f,avx512dq,popcnt,bmi,bmi2")))

/* Three coordinates of sixteen anchors: four transpositions of squares of four at once. */
AVX512 static inline void fetch(const struct anchor *anchor, const uint32_t *entry, __m512 at[3])
{
	__m512 row[4];
	for (int k = 0; k < 4; k++) {
		row[k] = _mm512_castps128_ps512(_mm_loadu_ps(anchor[entry_particle(entry[k])].at));
		row[k] = _mm512_insertf32x4(row[k], _mm_loadu_ps(anchor[entry_particle(entry[k + 4])].at), 1);
		row[k] = _mm512_insertf32x4(row[k], _mm_loadu_ps(anchor[entry_particle(entry[k + 8])].at), 2);
		row[k] = _mm512_insertf32x4(row[k], _mm_loadu_ps(anchor[entry_particle(entry[k + 12])].at), 3);
	}
	__m512d low01 = _mm512_castps_pd(_mm512_unpacklo_ps(row[0], row[1])),
			low23 = _mm512_castps_pd(_mm512_unpacklo_ps(row[2], row[3]));
	__m512d high01 = _mm512_castps_pd(_mm512_unpackhi_ps(row[0], row[1])),
			high23 = _mm512_castps_pd(_mm512_unpackhi_ps(row[2], row[3]));
	at[0] = _mm512_castpd_ps(_mm512_unpacklo_pd(low01, low23));
	at[1] = _mm512_castpd_ps(_mm512_unpackhi_pd(low01, low23));
	at[2] = _mm512_castpd_ps(_mm512_unpacklo_pd(high01, high23));
}

AVX512 static inline __mmask16 lanes_within(const struct bands *bands, const float own[3], const __m512 other[3],
											const __m512 shift[3])
{
	__m512 square = _mm512_setzero_ps();
	for (int axis = 0; axis < 3; axis++) {
		__m512 offset = _mm512_sub_ps(_mm512_sub_ps(_mm512_set1_ps(own[axis]), other[axis]), shift[axis]);
		square = _mm512_add_ps(square, _mm512_mul_ps(offset, offset));
	}
	__mmask16 inside = 0;
	for (int b = 0; b < bands->count; b++) {
		__mmask16 beyond = _mm512_cmp_ps_mask(square, _mm512_set1_ps(bands->low[b]), _CMP_GE_OQ);
		inside |= _mm512_mask_cmp_ps_mask(beyond, square, _mm512_set1_ps(bands->high[b]), _CMP_LE_OQ);
	}
	return inside;
}

AVX512 static size_t list_512(const struct bands *bands, const struct anchor *anchor, const float box[3],
							  const float from[3], const float to[3], const uint32_t *entry, size_t count,
							  uint32_t *found)
{
	size_t all = 0;
	for (size_t k = 0; k < count; k += 16) {
		__m512i some = _mm512_loadu_si512(entry + k), one = _mm512_set1_epi32(1);
		__m512 at[3], shift[3] = {_mm512_setzero_ps(), _mm512_setzero_ps(), _mm512_setzero_ps()};
		fetch(anchor, entry + k, at);
		bool images = _mm512_test_epi32_mask(some, _mm512_set1_epi32((int)~ENTRY_PARTICLE));
		for (int axis = 0; images && axis < 3; axis++) {
			__m512i code = _mm512_srli_epi32(some, (unsigned)(ENTRY_BITS + 2 * axis));
			__m512i image =
				_mm512_sub_epi32(_mm512_and_epi32(code, one), _mm512_and_epi32(_mm512_srli_epi32(code, 1), one));
			shift[axis] = _mm512_mul_ps(_mm512_cvtepi32_ps(image), _mm512_set1_ps(box[axis]));
		}
		__mmask16 used = count - k < 16 ? (__mmask16)((1u << (count - k)) - 1) : 0xffff;
		used &= lanes_within(bands, to, at, shift) & (__mmask16)~lanes_within(bands, from, at, shift);
		_mm512_storeu_si512(found + all, _mm512_maskz_compress_epi32(used, some));
		all += (unsigned)__builtin_popcount(used);
	}
	return all;
}

#define AVX2 __attribute__((target("avx2,popcnt,bmi,bmi2")))

/* Three coordinates of eight anchors: two transpositions of squares of four at once. */
AVX2 static inline void fetch_eight(const struct anchor *anchor, const uint32_t *entry, __m256 at[3])
{
	__m256d pair[4];
	for (int k = 0; k < 4; k += 2) {
		__m256 row[2];
		for (int j = 0; j < 2; j++) {
			__m128 first = _mm_loadu_ps(anchor[entry_particle(entry[k + j])].at);
			__m128 second = _mm_loadu_ps(anchor[entry_particle(entry[k + j + 4])].at);
			row[j] = _mm256_insertf128_ps(_mm256_castps128_ps256(first), second, 1);
		}
		pair[k] = _mm256_castps_pd(_mm256_unpacklo_ps(row[0], row[1]));
		pair[k + 1] = _mm256_castps_pd(_mm256_unpackhi_ps(row[0], row[1]));
	}
	at[0] = _mm256_castpd_ps(_mm256_unpacklo_pd(pair[0], pair[2]));
	at[1] = _mm256_castpd_ps(_mm256_unpackhi_pd(pair[0], pair[2]));
	at[2] = _mm256_castpd_ps(_mm256_unpacklo_pd(pair[1], pair[3]));
}

AVX2 static inline __m256 eight_within(const struct bands *bands, const float own[3], const __m256 other[3],
									   const __m256 shift[3])
{
	__m256 square = _mm256_setzero_ps(), inside = square;
	for (int axis = 0; axis < 3; axis++) {
		__m256 offset = _mm256_sub_ps(_mm256_sub_ps(_mm256_set1_ps(own[axis]), other[axis]), shift[axis]);
		square = _mm256_add_ps(square, _mm256_mul_ps(offset, offset));
	}
	for (int b = 0; b < bands->count; b++) {
		__m256 beyond = _mm256_cmp_ps(square, _mm256_set1_ps(bands->low[b]), _CMP_GE_OQ);
		__m256 before = _mm256_cmp_ps(square, _mm256_set1_ps(bands->high[b]), _CMP_LE_OQ);
		inside = _mm256_or_ps(inside, _mm256_and_ps(beyond, before));
	}
	return inside;
}

AVX2 static size_t list_avx2(const struct bands *bands, const struct anchor *anchor, const float box[3],
							 const float from[3], const float to[3], const uint32_t *entry, size_t count,
							 uint32_t *found)
{
	size_t all = 0;
	for (size_t k = 0; k < count; k += 8) {
		__m256i some = _mm256_loadu_si256((const __m256i *)(entry + k)), one = _mm256_set1_epi32(1);
		__m256 at[3], shift[3] = {_mm256_setzero_ps(), _mm256_setzero_ps(), _mm256_setzero_ps()};
		fetch_eight(anchor, entry + k, at);
		bool images = !_mm256_testz_si256(some, _mm256_set1_epi32((int)~ENTRY_PARTICLE));
		for (int axis = 0; images && axis < 3; axis++) {
			__m256i code = _mm256_srli_epi32(some, ENTRY_BITS + 2 * axis);
			__m256i image =
				_mm256_sub_epi32(_mm256_and_si256(code, one), _mm256_and_si256(_mm256_srli_epi32(code, 1), one));
			shift[axis] = _mm256_mul_ps(_mm256_cvtepi32_ps(image), _mm256_set1_ps(box[axis]));
		}
		__m256 newly = _mm256_andnot_ps(eight_within(bands, from, at, shift), eight_within(bands, to, at, shift));
		unsigned used = (unsigned)_mm256_movemask_ps(newly) & (count - k < 8 ? (1u << (count - k)) - 1 : 0xff);
		all += pack_eight(some, used, found + all);
	}
	return all;
}
#endif

bands_lister *bands_machine(size_t number)
{
#ifdef __x86_64__
	if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("bmi2") &&
		number-- == 0)
		return list_512;
	if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("bmi2") && number-- == 0) return list_avx2;
#endif
	return number == 0 ? list_any : NULL;
}
