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

static const float u = 0x1p-24f, tiny = 0x1p-120f;

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

/* The particle that searches. */
struct own {
	struct shadow shadow;
	float speed, h_fixed, h_time;
};

INLINE struct own own_of(const struct sieve *sieve, const struct shadow *shadow)
{
	const float *x = shadow->position, *v = shadow->velocity;
	float size = fabsf(x[0]) + fabsf(x[1]) + fabsf(x[2]);
	return (struct own){.shadow = *shadow,
						.speed = fabsf(v[0]) + fabsf(v[1]) + fabsf(v[2]),
						.h_fixed = 8 * u * (sieve->boxes + size) + sieve->grain,
						.h_time = 12 * u * sieve->span + sieve->drift};
}

/* Sixteen particles as it sees them at the time of the search, in the terms of sieve.h: R, S, a, b and r.r. */
struct others {
	lanes radius, r1, s, a, b, rr, h;
};

INLINE struct others others_of(const struct sieve *sieve, const struct own *own, const struct shadow *shadow,
							   const uint32_t *entry, const struct steps *step)
{
	lanes field[FIELDS];
	step->fetch(shadow, entry, field);
	if (sieve->images) {
		flags which;
		memcpy(&which, entry, sizeof which);
		for (int axis = 0; axis < 3; axis++) field[axis] += shift_of(which, axis, sieve->box[axis]);
	}
	const lanes zero = {0};
	lanes wait = sieve->now - field[3];
	struct others others = {field[7], zero, zero + own->speed, zero, zero, zero, zero};
	for (int axis = 0; axis < 3; axis++) {
		lanes theirs = field[4 + axis], v = own->shadow.velocity[axis] - theirs;
		lanes r = own->shadow.position[axis] - (field[axis] + theirs * wait);
		others.s += size_of(theirs);
		others.r1 += size_of(r);
		others.a += v * v;
		others.b += r * v;
		others.rr += r * r;
	}
	others.h = own->h_fixed + 4 * u * others.r1 + own->h_time * others.s;
	return others;
}

/* E_c, for no distance whose square is larger. */
INLINE lanes error_of_c(const struct sieve *sieve, const struct others *o, lanes square)
{
	const float n = sieve->roundoff, age = sieve->age;
	return 4 * o->h * (o->r1 + o->h) + (32 * u + 64 * n) * (o->r1 * o->r1 + square) +
		   (64 * n * age * age) * (o->s * o->s) + tiny;
}

INLINE lanes error_of_b(const struct sieve *sieve, const struct others *o)
{
	const float n = sieve->roundoff;
	return o->s * (2 * o->h + (12 * u + 16 * n) * o->r1 + (16 * n * sieve->age + sieve->late) * o->s) + tiny;
}

/* When pairs meet at a distance: not before `low`; and, where that is sure, not after `high`. */
struct meeting {
	lanes low, high;
	flags misses, sure;
};

INLINE struct meeting meeting_of(const struct others *o, lanes c, lanes q, lanes error_b, const struct steps *step)
{
	const lanes zero = {0};
	lanes error_d = 2 * (o->s * o->s) * q + tiny, d = o->b * o->b - o->a * c, most = d + error_d, least = d - error_d;
	struct meeting meeting;
	meeting.misses = step->less(error_b, o->b) | step->less(most, zero);
	meeting.low = (c - q) / (error_b - o->b + step->root(pick(step->less(zero, most), most, zero)));
	meeting.sure = step->less(o->b + error_b, zero) & step->less(zero, least) & step->less(q, c);
	meeting.high = (c + q) / (step->root(pick(meeting.sure, least, zero + 1)) - o->b - error_b);
	return meeting;
}

/* The latest meeting that is still of interest, when some surely come no later than `high`. */
INLINE float latest_of(const struct sieve *sieve, float latest, lanes high, const struct steps *step)
{
	float soonest = step->least(high) * 1.0001f + sieve->late;
	return soonest < latest ? soonest : latest;
}

/* Which pairs are surely beyond what is heard. */
INLINE flags unheard(const struct sieve *sieve, const struct others *o, lanes square, const struct steps *step)
{
	lanes farthest = square * (sieve->heard * sieve->heard);
	return step->less(error_of_c(sieve, o, farthest), o->rr - farthest);
}

static const uint32_t all_lanes = (1u << LANES) - 1;

INLINE size_t pass(const struct sieve *sieve, const struct shadow *shadow, uint32_t i, uint32_t *entry, size_t count,
				   const struct steps step)
{
	const struct own own = own_of(sieve, &shadow[i]);
	const lanes zero = {0}, never = zero + INFINITY, number = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15};
	float latest = sieve->latest;
	size_t kept = 0;
	for (size_t k = 0; k < count; k += LANES) {
		struct others others = others_of(sieve, &own, shadow, entry + k, &step);
		lanes contact = own.shadow.radius + others.radius, square = contact * contact;
		lanes q = error_of_c(sieve, &others, square), error_b = error_of_b(sieve, &others);
		struct meeting meeting = meeting_of(&others, others.rr - square, q, error_b, &step);
		flags out = ~step.less(number, zero + (float)(count - k)) | meeting.misses;
		if (sieve->heard > 0)
			out &= ~step.less(number, zero + (float)(count - k)) | unheard(sieve, &others, square, &step);
		if (step.bits(out) == all_lanes) continue;
		if (sieve->by_order) {
			latest = latest_of(sieve, latest, pick(meeting.sure & ~out, meeting.high, never), &step);
			flags late = step.less(zero + latest, meeting.low);
			out |= sieve->heard > 0 ? late & unheard(sieve, &others, square, &step) : late;
		}
		kept += step.pack(~step.bits(out) & all_lanes, entry + k, entry + kept);
	}
	return kept;
}

/* No event of a pair comes before: that of meeting where it surely meets, that of parting where it surely does not, and
 * now where that is in doubt. Both are a quotient with a root in it, of which one is formed. */
INLINE lanes bound_of(const struct sieve *sieve, const struct others *o, lanes inner, lanes outer,
					  const struct steps *step)
{
	const lanes zero = {0};
	const float fine = 0x1p-18f + 16 * sieve->roundoff;
	flags parts = step->less(zero, outer);
	lanes farther = pick(parts, outer, inner);
	lanes q = error_of_c(sieve, o, farther * farther), error_b = error_of_b(sieve, o), b = o->b + error_b;
	lanes error_a = (16 * u + 8 * sieve->roundoff) * (o->s * o->s) + tiny, a = o->a + error_a;
	lanes c_meets = o->rr - inner * inner, c = o->rr - outer * outer + q;
	lanes error_d = 2 * (o->s * o->s) * q + tiny, d = o->b * o->b - o->a * c_meets;
	flags misses = step->less(error_b, o->b) | step->less(d + error_d, zero);
	flags meets = step->less(b, zero) & step->less(error_d, d);
	lanes square = pick(meets, d + error_d, b * b * (1 - 32 * u) - a * c);
	lanes end = step->root(pick(step->less(zero, square), square, zero));
	flags opens = step->less(zero, b);
	lanes over = pick(meets, c_meets - q, pick(opens, -c, end - b));
	lanes under = pick(meets, error_b - o->b + end, pick(opens, b + end, a));
	lanes low = over / under * (1 - fine);
	return pick(meets | (misses & parts), low, pick(misses, zero + INFINITY, zero));
}

INLINE size_t hold(const struct sieve *sieve, const struct shadow *shadow, uint32_t i, const struct held *held,
				   size_t count, float *soonest, const struct steps step)
{
	const struct own own = own_of(sieve, &shadow[i]);
	const lanes zero = {0}, number = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15};
	float least = INFINITY;
	size_t first = 0;
	for (size_t k = 0; k < count; k += LANES) {
		struct others others = others_of(sieve, &own, shadow, held->entry + k, &step);
		lanes inner, outer;
		memcpy(&inner, held->inner + k, sizeof inner);
		memcpy(&outer, held->outer + k, sizeof outer);
		lanes low = bound_of(sieve, &others, inner, outer, &step);
		low = pick(step.less(number, zero + (float)(count - k)), low, zero + INFINITY);
		memcpy(soonest + k, &low, sizeof low);
		float least_here = step.least(low);
		if (!(least_here < least)) continue;
		least = least_here;
		first = k + (size_t)__builtin_ctz(~step.bits(step.less(zero + least, low)));
	}
	return first;
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

static size_t hold_any(const struct sieve *sieve, const struct shadow *shadow, uint32_t self, const struct held *held,
					   size_t count, float *soonest)
{
	return hold(sieve, shadow, self, held, count, soonest,
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

#ifdef __wasm_simd128__
#include "engine/sieve_wasm.inl"
#endif

#ifdef __x86_64__
#define AVX2 __attribute__((target("avx2,fma,bmi,bmi2")))
#define AVX512 __attribute__((target("avx512f,avx512dq,avx512vl,avx512bw,fma,popcnt,bmi,bmi2")))

AVX2 static size_t pass_avx2(const struct sieve *sieve, const struct shadow *shadow, uint32_t self, uint32_t *entry,
							 size_t count)
{
	return pass(sieve, shadow, self, entry, count,
				(struct steps){fetch_any, root_any, less_any, bits_any, least_any, pack_any});
}

AVX2 static size_t hold_avx2(const struct sieve *sieve, const struct shadow *shadow, uint32_t self,
							 const struct held *held, size_t count, float *soonest)
{
	return hold(sieve, shadow, self, held, count, soonest,
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

AVX512 static size_t hold_512(const struct sieve *sieve, const struct shadow *shadow, uint32_t self,
							  const struct held *held, size_t count, float *soonest)
{
	return hold(sieve, shadow, self, held, count, soonest,
				(struct steps){fetch_512, root_512, less_512, bits_512, least_512, pack_any});
}
#endif

#include "engine/sieve_check.inl"

const struct sieve_machine *sieve_machine(size_t number)
{
	static const struct sieve_machine any = {"portable", pass_any, hold_any, check_any, cast_any};
#ifdef __x86_64__
	static const struct sieve_machine avx512 = {"AVX-512", pass_512, hold_512, check_512, cast_avx2},
									  avx2 = {"AVX2", pass_avx2, hold_avx2, check_avx2, cast_avx2};
	bool fair = __builtin_cpu_supports("bmi2") && __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
	bool fast = fair && __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
				__builtin_cpu_supports("avx512vl") && __builtin_cpu_supports("avx512bw");
	if (fast && number-- == 0) return &avx512;
	if (fair && number-- == 0) return &avx2;
#elif defined __wasm_simd128__
	static const struct sieve_machine simd = {"WebAssembly SIMD", pass_128, hold_128, check_128, cast_any};
	if (number-- == 0) return &simd;
#endif
	return number == 0 ? &any : NULL;
}
