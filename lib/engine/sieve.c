#include "engine/sieve.h"

#include <math.h>
#include <string.h>

#include "engine/cells.h"

#ifdef __x86_64__
#include <immintrin.h>
#endif

enum { LANES = 16, FIELDS = sizeof(struct shadow) / sizeof(float) };
typedef float lanes __attribute__((vector_size(LANES * sizeof(float))));
typedef int32_t flags __attribute__((vector_size(LANES * sizeof(int32_t))));

#define INLINE static inline __attribute__((always_inline))

/* The steps for which machines differ: sixteen shadows in, their fields out; square roots; comparison; and keeping the
 * lanes that are wanted, close together, but for the particle itself. */
typedef void fetch_step(const struct shadow *shadow, const uint32_t entry[LANES], lanes field[FIELDS]);
typedef lanes root_step(lanes x);
typedef flags less_step(lanes a, lanes b);
typedef size_t pack_step(flags keep, size_t valid, uint32_t self, flags which, lanes low, lanes high, uint32_t *entry,
						 float *lows, float *highs);

INLINE lanes size_of(lanes x)
{
	return (lanes)((flags)x & 0x7fffffff);
}

INLINE lanes pick(flags mask, lanes yes, lanes no)
{
	return (lanes)(((flags)yes & mask) | ((flags)no & ~mask));
}

/* How far the image an entry means is shifted along an axis. */
INLINE lanes shift_of(flags entry, int axis, float box)
{
	flags code = entry >> (ENTRY_BITS + 2 * axis) & 3;
	return __builtin_convertvector((code & 1) - (code >> 1), lanes) * box;
}

INLINE size_t pass(const struct sieve *sieve, const struct shadow *shadow, uint32_t i, uint32_t *entry, size_t count,
				   float *bounds, fetch_step *fetch, root_step *root, less_step *less, pack_step *pack)
{
	static const float u = 0x1p-24f, tiny = 0x1p-120f;
	const struct shadow self = shadow[i];
	const float n = sieve->roundoff, size = fabsf(self.position[0]) + fabsf(self.position[1]) + fabsf(self.position[2]),
				speed = fabsf(self.velocity[0]) + fabsf(self.velocity[1]) + fabsf(self.velocity[2]),
				base_error = 4 * u * (sieve->boxes + size), speed_error = 8 * u * sieve->span + sieve->drift;
	const lanes zero = {0}, never = zero + INFINITY;
	float *lows = bounds, *highs = bounds + count + LANES;
	size_t kept = 0;
	for (size_t k = 0; k < count; k += LANES) {
		lanes field[FIELDS];
		flags which;
		memcpy(&which, entry + k, sizeof which);
		fetch(shadow, entry + k, field);
		lanes wait = sieve->now - field[3], contact = self.radius + field[7], x = {0}, s = {0}, r1 = {0};
		lanes a = {0}, b = {0}, c = -(contact * contact);
		for (int axis = 0; axis < 3; axis++) {
			lanes theirs = field[4 + axis], v = self.velocity[axis] - theirs;
			lanes r = self.position[axis] - shift_of(which, axis, sieve->box[axis]) - (field[axis] + theirs * wait);
			x += size_of(field[axis]);
			s += size_of(theirs);
			r1 += size_of(r);
			a += v * v;
			b += r * v;
			c += r * r;
		}
		s += speed;
		lanes far = r1 + s * sieve->age, square = contact * contact;
		lanes h = base_error + 4 * u * x + s * speed_error;
		lanes q = 4 * h * (r1 + h) + 32 * u * (r1 * r1 + square) + 32 * n * (far * far + square) + tiny;
		lanes error_b = s * (2 * h + 12 * u * r1 + 16 * n * far) + tiny, error_d = 2 * s * s * q + tiny;
		lanes d = b * b - a * c, d_most = d + error_d, d_least = d - error_d;
		flags out = less(error_b, b) | less(d_most, zero);
		lanes low = (c - q) / (error_b - b + root(pick(less(zero, d_most), d_most, zero)));
		flags sure = less(b + error_b, zero) & less(zero, d_least) & less(q, c);
		lanes high = (c + q) / (root(pick(sure, d_least, zero + 1)) - b - error_b);
		out |= less(zero + sieve->latest, low);
		kept += pack(~out, count - k, i, which, low, pick(sure, high, never), entry + kept, lows + kept, highs + kept);
	}
	if (kept < 2 || !sieve->by_order) return kept;

	float latest = INFINITY;
	for (size_t k = 0; k < kept; k++) latest = fminf(latest, highs[k]);
	latest = latest * 1.0001f + sieve->drift;
	size_t left = 0;
	for (size_t k = 0; k < kept; k++) {
		entry[left] = entry[k];
		left += !(lows[k] > latest);
	}
	return left;
}

INLINE void fetch_any(const struct shadow *shadow, const uint32_t entry[LANES], lanes field[FIELDS])
{
	for (int lane = 0; lane < LANES; lane++) {
		float row[FIELDS];
		memcpy(row, &shadow[entry_particle(entry[lane])], sizeof row);
		for (int f = 0; f < FIELDS; f++) field[f][lane] = row[f];
	}
}

INLINE lanes root_any(lanes x)
{
	for (int lane = 0; lane < LANES; lane++) x[lane] = sqrtf(x[lane]);
	return x;
}

INLINE flags less_any(lanes a, lanes b)
{
	flags less;
	for (int lane = 0; lane < LANES; lane++) less[lane] = -(a[lane] < b[lane]);
	return less;
}

INLINE size_t pack_any(flags keep, size_t valid, uint32_t self, flags which, lanes low, lanes high, uint32_t *entry,
					   float *lows, float *highs)
{
	size_t kept = 0;
	for (size_t lane = 0; lane < LANES && lane < valid; lane++) {
		entry[kept] = (uint32_t)which[lane];
		lows[kept] = low[lane];
		highs[kept] = high[lane];
		kept += (size_t)(keep[lane] & (entry[kept] != self));
	}
	return kept;
}

static size_t pass_any(const struct sieve *sieve, const struct shadow *shadow, uint32_t self, uint32_t *entry,
					   size_t count, float *bounds)
{
	return pass(sieve, shadow, self, entry, count, bounds, fetch_any, root_any, less_any, pack_any);
}

#ifdef __x86_64__
#define AVX2 __attribute__((target("avx2,fma")))
#define AVX512 __attribute__((target("avx512f,avx512dq,avx512vl,avx512bw,fma,popcnt")))

AVX2 static size_t pass_avx2(const struct sieve *sieve, const struct shadow *shadow, uint32_t self, uint32_t *entry,
							 size_t count, float *bounds)
{
	return pass(sieve, shadow, self, entry, count, bounds, fetch_any, root_any, less_any, pack_any);
}

/* A transposition of two squares of eight at once: the registers hold rows 0 to 3 and 8 to 11 in their lower halves. */
AVX512 static inline void fetch_512(const struct shadow *shadow, const uint32_t entry[LANES], lanes field[FIELDS])
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

AVX512 static inline lanes root_512(lanes x)
{
	return (lanes)_mm512_sqrt_ps((__m512)x);
}

AVX512 static inline flags less_512(lanes a, lanes b)
{
	return (flags)_mm512_movm_epi32(_mm512_cmp_ps_mask((__m512)a, (__m512)b, _CMP_LT_OQ));
}

AVX512 static inline size_t pack_512(flags keep, size_t valid, uint32_t self, flags which, lanes low, lanes high,
									 uint32_t *entry, float *lows, float *highs)
{
	unsigned inside = valid < LANES ? (1u << valid) - 1 : (1u << LANES) - 1;
	__mmask16 mask = _mm512_mask_cmpneq_epi32_mask(_mm512_movepi32_mask((__m512i)keep) & (__mmask16)inside,
												   (__m512i)which, _mm512_set1_epi32((int)self));
	_mm512_storeu_si512(entry, _mm512_maskz_compress_epi32(mask, (__m512i)which));
	_mm512_storeu_ps(lows, _mm512_maskz_compress_ps(mask, (__m512)low));
	_mm512_storeu_ps(highs, _mm512_maskz_compress_ps(mask, (__m512)high));
	return (size_t)__builtin_popcount(mask);
}

AVX512 static size_t pass_512(const struct sieve *sieve, const struct shadow *shadow, uint32_t self, uint32_t *entry,
							  size_t count, float *bounds)
{
	return pass(sieve, shadow, self, entry, count, bounds, fetch_512, root_512, less_512, pack_512);
}
#endif

sieve_pass *sieve_number(size_t number, const char **name)
{
#ifdef __x86_64__
	bool fast = __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
				__builtin_cpu_supports("avx512vl") && __builtin_cpu_supports("avx512bw");
	bool fair = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
	if (fast && number-- == 0) return *name = "AVX-512", pass_512;
	if (fair && number-- == 0) return *name = "AVX2", pass_avx2;
#endif
	return number == 0 ? *name = "portable", pass_any : NULL;
}

sieve_pass *sieve_choose(void)
{
	const char *name;
	return sieve_number(0, &name);
}
