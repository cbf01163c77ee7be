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

/* The steps for which machines differ. */
struct steps {
	void (*fetch)(const struct shadow *shadow, const uint32_t *entry, lanes field[FIELDS]); /* sixteen, by field */
	lanes (*root)(lanes x);
	flags (*less)(lanes a, lanes b);
	uint32_t (*bits)(flags x); /* one for each lane that is set */
	float (*least)(lanes x);
	size_t (*pack)(uint32_t wanted, const uint32_t *from, uint32_t *to); /* what is wanted, close together: how many */
};

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
				   const struct steps step)
{
	static const float u = 0x1p-24f, tiny = 0x1p-120f;
	const struct shadow self = shadow[i];
	const float n = sieve->roundoff, age = sieve->age,
				size = fabsf(self.position[0]) + fabsf(self.position[1]) + fabsf(self.position[2]),
				speed = fabsf(self.velocity[0]) + fabsf(self.velocity[1]) + fabsf(self.velocity[2]),
				h_fixed = 8 * u * (sieve->boxes + size), h_time = 12 * u * sieve->span + sieve->drift;
	const lanes zero = {0}, never = zero + INFINITY, number = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15};
	float latest = sieve->latest;
	size_t kept = 0;
	for (size_t k = 0; k < count; k += LANES) {
		lanes field[FIELDS];
		step.fetch(shadow, entry + k, field);
		if (sieve->images) {
			flags which;
			memcpy(&which, entry + k, sizeof which);
			for (int axis = 0; axis < 3; axis++) field[axis] += shift_of(which, axis, sieve->box[axis]);
		}
		lanes wait = sieve->now - field[3], contact = self.radius + field[7], square = contact * contact;
		lanes s = zero + speed, r1 = zero, a = zero, b = zero, c = -square;
		for (int axis = 0; axis < 3; axis++) {
			lanes theirs = field[4 + axis], v = self.velocity[axis] - theirs;
			lanes r = self.position[axis] - (field[axis] + theirs * wait);
			s += size_of(theirs);
			r1 += size_of(r);
			a += v * v;
			b += r * v;
			c += r * r;
		}
		lanes h = h_fixed + 4 * u * r1 + h_time * s, s2 = s * s;
		lanes q = 4 * h * (r1 + h) + (32 * u + 64 * n) * (r1 * r1 + square) + (64 * n * age * age) * s2 + tiny;
		lanes error_b = s * (2 * h + (12 * u + 16 * n) * r1 + (16 * n * age) * s) + tiny;
		lanes error_d = 2 * s2 * q + tiny, d = b * b - a * c, d_most = d + error_d;
		flags out = ~step.less(number, zero + (float)(count - k)) | step.less(error_b, b) | step.less(d_most, zero);
		if (step.bits(out) == (1u << LANES) - 1) continue;
		lanes d_least = d - error_d;
		lanes low = (c - q) / (error_b - b + step.root(pick(step.less(zero, d_most), d_most, zero)));
		flags sure = step.less(b + error_b, zero) & step.less(zero, d_least) & step.less(q, c);
		lanes high = (c + q) / (step.root(pick(sure, d_least, zero + 1)) - b - error_b);
		if (sieve->by_order) {
			float soonest = step.least(pick(sure & ~out, high, never)) * 1.0001f + sieve->drift;
			latest = soonest < latest ? soonest : latest;
			out |= step.less(zero + latest, low);
		}
		kept += step.pack(~step.bits(out) & ((1u << LANES) - 1), entry + k, entry + kept);
	}
	return kept;
}

INLINE void fetch_any(const struct shadow *shadow, const uint32_t *entry, lanes field[FIELDS])
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

INLINE uint32_t bits_any(flags x)
{
	uint32_t bits = 0;
	for (int lane = 0; lane < LANES; lane++) bits |= (uint32_t)(x[lane] & 1) << lane;
	return bits;
}

INLINE float least_any(lanes x)
{
	float least = x[0];
	for (int lane = 1; lane < LANES; lane++) least = x[lane] < least ? x[lane] : least;
	return least;
}

INLINE size_t pack_any(uint32_t wanted, const uint32_t *from, uint32_t *to)
{
	size_t kept = 0;
	for (; wanted; wanted &= wanted - 1) to[kept++] = from[__builtin_ctz(wanted)];
	return kept;
}

static size_t pass_any(const struct sieve *sieve, const struct shadow *shadow, uint32_t self, uint32_t *entry,
					   size_t count)
{
	return pass(sieve, shadow, self, entry, count,
				(struct steps){fetch_any, root_any, less_any, bits_any, least_any, pack_any});
}

static void cast_any(struct shadow *shadow, double x, double y, double z, double time, double vx, double vy, double vz,
					 double radius)
{
	*shadow = (struct shadow){.position = {(float)x, (float)y, (float)z},
							  .time = (float)time,
							  .velocity = {(float)vx, (float)vy, (float)vz},
							  .radius = (float)radius};
}

#ifdef __x86_64__
#define AVX2 __attribute__((target("avx2,fma,bmi,bmi2")))
#define AVX512 __attribute__((target("avx512f,avx512dq,avx512vl,avx512bw,fma,popcnt,bmi,bmi2")))

AVX2 static size_t pass_avx2(const struct sieve *sieve, const struct shadow *shadow, uint32_t self, uint32_t *entry,
							 size_t count)
{
	return pass(sieve, shadow, self, entry, count,
				(struct steps){fetch_any, root_any, less_any, bits_any, least_any, pack_any});
}

AVX2 static void cast_avx2(struct shadow *shadow, double x, double y, double z, double time, double vx, double vy,
						   double vz, double radius)
{
	__m256 row =
		_mm256_setr_ps((float)x, (float)y, (float)z, (float)time, (float)vx, (float)vy, (float)vz, (float)radius);
	_mm256_store_ps((float *)shadow, row);
}

/* A transposition of two squares of eight at once: the registers hold rows 0 to 3 and 8 to 11 in their lower halves. */
AVX512 static inline void fetch_512(const struct shadow *shadow, const uint32_t *entry, lanes field[FIELDS])
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

AVX512 static inline uint32_t bits_512(flags x)
{
	return _mm512_movepi32_mask((__m512i)x);
}

AVX512 static inline float least_512(lanes x)
{
	return _mm512_reduce_min_ps((__m512)x);
}

AVX512 static size_t pass_512(const struct sieve *sieve, const struct shadow *shadow, uint32_t self, uint32_t *entry,
							  size_t count)
{
	return pass(sieve, shadow, self, entry, count,
				(struct steps){fetch_512, root_512, less_512, bits_512, least_512, pack_any});
}
#endif

const struct sieve_machine *sieve_machine(size_t number)
{
	static const struct sieve_machine any = {"portable", pass_any, cast_any};
#ifdef __x86_64__
	static const struct sieve_machine avx512 = {"AVX-512", pass_512, cast_avx2}, avx2 = {"AVX2", pass_avx2, cast_avx2};
	bool fair = __builtin_cpu_supports("bmi2") && __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
	bool fast = fair && __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
				__builtin_cpu_supports("avx512vl") && __builtin_cpu_supports("avx512bw");
	if (fast && number-- == 0) return &avx512;
	if (fair && number-- == 0) return &avx2;
#endif
	return number == 0 ? &any : NULL;
}
