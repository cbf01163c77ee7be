#include "engine/sieve.h"

#include <math.h>
#include <string.h>

#include "engine/cells.h"

#ifdef __x86_64__
#include <immintrin.h>
#endif

enum { LANES = 16, FIELDS = sizeof(struct shadow) / sizeof(float) };
typedef float lanes __attribute__((vector_size(LANES * sizeof(float))));
typedef int32_t whole_lanes __attribute__((vector_size(LANES * sizeof(int32_t))));
typedef uint32_t flags; /* a bit for each lane */

#define INLINE static inline __attribute__((always_inline))

static const flags all_lanes = (1u << LANES) - 1;
static const float u = 0x1p-24f, tiny = 0x1p-120f, huge = 0x1p120f;

/* The steps for which machines differ. */
struct steps {
	void (*fetch)(const struct shadow *shadow, const uint32_t *entry, lanes field[FIELDS]); /* sixteen, by field */
	lanes (*root)(lanes x);
	lanes (*near_root)(lanes x);    /* from tiny to huge: within 2^-11 of itself, */
	lanes (*near_inverse)(lanes x); /* and so is this: many times quicker than root and quotient */
	flags (*less)(lanes a, lanes b);
	lanes (*pick)(flags which, lanes yes, lanes no);
	float (*least)(lanes x);
	size_t (*pack)(flags wanted, const uint32_t *from, uint32_t *to); /* what is wanted, close together: how many */
	/* the entries of sixteen pairs, or as many as there are and then 0, and their limits */
	void (*limits)(const struct pair_state *pair, size_t count, const struct limits *limits, uint32_t *entry,
				   lanes *outer, lanes *inner);
};

INLINE lanes size_of(lanes x)
{
	return (lanes)((whole_lanes)x & 0x7fffffff);
}

/* The lanes behind the last of `count`. */
INLINE flags behind(size_t count)
{
	return count < LANES ? all_lanes & ~((1u << count) - 1) : 0;
}

/* How far the image an entry means is shifted along an axis. */
INLINE lanes shift_of(whole_lanes entry, int axis, float box)
{
	whole_lanes code = entry >> (ENTRY_BITS + 2 * axis) & 3;
	return __builtin_convertvector((code & 1) - (code >> 1), lanes) * box;
}

/* The particle that searches, and the factors of its bounds that are the same for all others. */
struct own {
	struct shadow shadow;
	float speed, g_fixed, g_time, two_lengths, per_length, b_fixed, b_slope;
};

INLINE struct own own_of(const struct sieve *sieve, const struct shadow *shadow)
{
	const float *x = shadow->position, *v = shadow->velocity, n = sieve->roundoff;
	float size = fabsf(x[0]) + fabsf(x[1]) + fabsf(x[2]);
	float length = sieve->length;
	return (struct own){.shadow = *shadow,
						.speed = fabsf(v[0]) + fabsf(v[1]) + fabsf(v[2]),
						.g_fixed = 8 * u * (sieve->boxes + size) + sieve->grain,
						.g_time = 12 * u * sieve->span + sieve->drift,
						.two_lengths = 2 * length,
						.per_length = 6 / length,
						.b_fixed = (10 * u + 8 * n) * length,
						.b_slope = (30 * u + 24 * n) / length};
}

/* Sixteen particles as it sees them at the time of the search, in the terms of sieve.h: S, a, b, r.r, and what their
 * bounds come to: E_c, but for s^2, is c_fixed + r.r c_slope. */
struct others {
	lanes radius, s, a, b, rr, c_fixed, c_slope, error_b;
};

INLINE struct others others_of(const struct sieve *sieve, const struct own *own, const struct shadow *shadow,
							   const uint32_t *entry, const struct steps *step)
{
	lanes field[FIELDS];
	step->fetch(shadow, entry, field);
	if (sieve->images) {
		whole_lanes which;
		memcpy(&which, entry, sizeof which);
		for (int axis = 0; axis < 3; axis++) field[axis] += shift_of(which, axis, sieve->box[axis]);
	}
	const float n = sieve->roundoff, age = sieve->age;
	const lanes zero = {0};
	lanes wait = sieve->now - field[3];
	struct others others = {.radius = field[7], .s = zero + own->speed, .a = zero, .b = zero, .rr = zero};
	for (int axis = 0; axis < 3; axis++) {
		lanes theirs = field[4 + axis], v = own->shadow.velocity[axis] - theirs;
		lanes r = own->shadow.position[axis] - (field[axis] + theirs * wait);
		others.s += size_of(theirs);
		others.a += v * v;
		others.b += r * v;
		others.rr += r * r;
	}
	lanes g = own->g_fixed + own->g_time * others.s;
	others.c_fixed = g * (own->two_lengths + 4 * g) + (64 * n * age * age) * (others.s * others.s) + tiny;
	others.c_slope = own->per_length * g + (144 * u + 192 * n);
	others.error_b =
		others.s * (2 * g + own->b_fixed + (16 * n * age + sieve->late) * others.s + own->b_slope * others.rr) + tiny;
	return others;
}

/* E_c, for no distance whose square is larger. */
INLINE lanes error_of_c(const struct sieve *sieve, const struct others *o, lanes square)
{
	return o->c_fixed + (32 * u + 64 * sieve->roundoff) * square + o->c_slope * o->rr;
}

/* When pairs meet at a distance: not before `low`; and, where that is sure, not after `high`. */
struct meeting {
	lanes low, high;
	flags misses, sure;
};

INLINE struct meeting meeting_of(const struct others *o, lanes c, lanes q, const struct steps *step)
{
	static const float fine = 0x1p-9f; /* for a root and an inverse that are near */
	const lanes zero = {0}, error_b = o->error_b;
	lanes error_d = 2 * (o->s * o->s) * q + tiny, d = o->b * o->b - o->a * c, most = d + error_d, least = d - error_d;
	struct meeting meeting;
	meeting.misses = step->less(error_b, o->b) | step->less(most, zero);
	lanes end = step->near_root(step->pick(step->less(zero + tiny, most), most, zero + tiny));
	meeting.low = (c - q) * step->near_inverse(error_b - o->b + end) * (1 - fine);
	meeting.sure = step->less(o->b + error_b, zero) & step->less(zero + tiny, least) & step->less(least, zero + huge) &
				   step->less(q, c);
	lanes begin = step->near_root(step->pick(meeting.sure, least, zero + 1));
	meeting.high = (c + q) * step->near_inverse(begin - o->b - error_b) * (1 + fine);
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

/* How far a search has come. */
struct progress {
	struct own own;
	float latest;
	size_t kept;
};

/* When the last of those that are kept meets. */
INLINE void tell_time(struct sieve_search *search, const struct meeting *meeting, flags kept)
{
	float low[LANES], high[LANES];
	if (!kept) return;
	memcpy(low, &meeting->low, sizeof low);
	memcpy(high, &meeting->high, sizeof high);
	int last = 31 - __builtin_clz(kept);
	search->from = low[last];
	search->by = meeting->sure >> last & 1 ? high[last] : INFINITY;
}

/* The next sixteen of one search, or of two: step by step together, since each step waits for the one before it and not
 * for those of the other. */
INLINE void sift_next(const struct sieve *sieve, const struct shadow *shadow, struct sieve_search *search,
					  struct progress *progress, int searches, size_t at, const struct steps *step)
{
	const lanes zero = {0}, never = zero + INFINITY;
	struct others others[2];
	struct meeting meeting[2];
	lanes square[2];
	flags none[2], out[2];
	for (int k = 0; k < searches; k++)
		others[k] = others_of(sieve, &progress[k].own, shadow, search[k].entry + at, step);
	for (int k = 0; k < searches; k++) {
		lanes contact = progress[k].own.shadow.radius + others[k].radius;
		square[k] = contact * contact;
		meeting[k] = meeting_of(&others[k], others[k].rr - square[k], error_of_c(sieve, &others[k], square[k]), step);
	}
	for (int k = 0; k < searches; k++) {
		none[k] = behind(search[k].count - at);
		out[k] = none[k] | meeting[k].misses;
		if (sieve->heard > 0) out[k] &= none[k] | unheard(sieve, &others[k], square[k], step);
	}
	if ((out[0] & out[searches - 1]) == all_lanes) return;
	for (int k = 0; k < searches && sieve->by_order; k++) {
		progress[k].latest =
			latest_of(sieve, progress[k].latest, step->pick(meeting[k].sure & ~out[k], meeting[k].high, never), step);
		flags late = step->less(zero + progress[k].latest, meeting[k].low);
		out[k] |= sieve->heard > 0 ? late & unheard(sieve, &others[k], square[k], step) : late;
	}
	for (int k = 0; k < searches && sieve->timed; k++) tell_time(&search[k], &meeting[k], ~out[k] & all_lanes);
	for (int k = 0; k < searches; k++)
		progress[k].kept += step->pack(~out[k] & all_lanes, search[k].entry + at, search[k].entry + progress[k].kept);
}

INLINE void pass(const struct sieve *sieve, const struct shadow *shadow, struct sieve_search *search, int searches,
				 const struct steps *step)
{
	struct progress progress[2];
	size_t at = 0;
	for (int k = 0; k < searches; k++)
		progress[k] = (struct progress){.own = own_of(sieve, &shadow[search[k].self]), .latest = search[k].latest};
	if (searches == 2)
		for (; at < search[0].count && at < search[1].count; at += LANES)
			sift_next(sieve, shadow, search, progress, 2, at, step);
	for (int k = 0; k < searches; k++) {
		for (size_t rest = at; rest < search[k].count; rest += LANES)
			sift_next(sieve, shadow, &search[k], &progress[k], 1, rest, step);
		search[k].count = progress[k].kept;
	}
}

/* No event of a pair comes before: that of meeting where it surely meets, that of parting where it surely does not, and
 * now where that is in doubt. Both are a quotient with a root in it, of which one is formed. */
INLINE lanes bound_of(const struct sieve *sieve, const struct others *o, lanes inner, lanes outer,
					  const struct steps *step)
{
	const float fine = 0x1p-18f + 16 * sieve->roundoff;
	const lanes zero = {0};
	flags parts = step->less(zero, outer);
	lanes farther = step->pick(parts, outer, inner);
	lanes q = error_of_c(sieve, o, farther * farther), error_b = o->error_b, b = o->b + error_b;
	lanes error_a = (16 * u + 8 * sieve->roundoff) * (o->s * o->s) + tiny, a = o->a + error_a;
	lanes c_meets = o->rr - inner * inner, c = o->rr - outer * outer + q;
	lanes error_d = 2 * (o->s * o->s) * q + tiny, d = o->b * o->b - o->a * c_meets;
	flags misses = step->less(error_b, o->b) | step->less(d + error_d, zero);
	flags meets = step->less(b, zero) & step->less(error_d, d);
	lanes square = step->pick(meets, d + error_d, b * b * (1 - 32 * u) - a * c);
	lanes end = step->root(step->pick(step->less(zero, square), square, zero));
	flags opens = step->less(zero, b);
	lanes over = step->pick(meets, c_meets - q, step->pick(opens, -c, end - b));
	lanes under = step->pick(meets, error_b - o->b + end, step->pick(opens, b + end, a));
	lanes low = over / under * (1 - fine);
	return step->pick(meets | (misses & parts), low, step->pick(misses, zero + INFINITY, zero));
}

/* The next sixteen of one outlook, or of two: step by step together. */
INLINE void hold_next(const struct sieve *sieve, const struct shadow *shadow, struct sieve_outlook *outlook,
					  const struct own *own, float *least, int outlooks, size_t at, const struct steps *step)
{
	const lanes zero = {0};
	lanes outer[2], inner[2];
	struct others others[2];
	for (int k = 0; k < outlooks; k++) {
		uint32_t entry[LANES] __attribute__((aligned(64)));
		step->limits(outlook[k].pair + at, outlook[k].count - at, outlook[k].limits, entry, &outer[k], &inner[k]);
		others[k] = others_of(sieve, &own[k], shadow, entry, step);
	}
	for (int k = 0; k < outlooks; k++) {
		lanes low = bound_of(sieve, &others[k], inner[k], outer[k], step);
		low = step->pick(behind(outlook[k].count - at), zero + INFINITY, low);
		memcpy(outlook[k].soonest + at, &low, sizeof low);
		float least_here = step->least(low);
		if (!(least_here < least[k])) continue;
		least[k] = least_here;
		outlook[k].first = at + (size_t)__builtin_ctz(~step->less(zero + least_here, low));
	}
}

INLINE void hold(const struct sieve *sieve, const struct shadow *shadow, struct sieve_outlook *outlook, int outlooks,
				 const struct steps *step)
{
	struct own own[2];
	float least[2] = {INFINITY, INFINITY};
	size_t at = 0;
	for (int k = 0; k < outlooks; k++) own[k] = own_of(sieve, &shadow[outlook[k].self]), outlook[k].first = 0;
	if (outlooks == 2)
		for (; at < outlook[0].count && at < outlook[1].count; at += LANES)
			hold_next(sieve, shadow, outlook, own, least, 2, at, step);
	for (int k = 0; k < outlooks; k++)
		for (size_t rest = at; rest < outlook[k].count; rest += LANES)
			hold_next(sieve, shadow, &outlook[k], &own[k], &least[k], 1, rest, step);
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

INLINE lanes inverse_any(lanes x)
{
	return 1 / x;
}

INLINE flags less_any(lanes a, lanes b)
{
	flags less = 0;
	for (int lane = 0; lane < LANES; lane++) less |= (flags)(a[lane] < b[lane]) << lane;
	return less;
}

INLINE lanes pick_any(flags which, lanes yes, lanes no)
{
	for (int lane = 0; lane < LANES; lane++) no[lane] = which >> lane & 1 ? yes[lane] : no[lane];
	return no;
}

INLINE float least_any(lanes x)
{
	float least = x[0];
	for (int lane = 1; lane < LANES; lane++) least = x[lane] < least ? x[lane] : least;
	return least;
}

INLINE size_t pack_any(flags wanted, const uint32_t *from, uint32_t *to)
{
	size_t kept = 0;
	for (; wanted; wanted &= wanted - 1) to[kept++] = from[__builtin_ctz(wanted)];
	return kept;
}

INLINE void limits_any(const struct pair_state *pair, size_t count, const struct limits *limits, uint32_t *entry,
					   lanes *outer, lanes *inner)
{
	const struct pair_state none = {0, pair->state};
	for (size_t lane = 0; lane < LANES; lane++) {
		struct pair_state one = lane < count ? pair[lane] : none;
		entry[lane] = one.entry;
		(*outer)[lane] = limits[one.state].outer;
		(*inner)[lane] = limits[one.state].inner;
	}
}

static const struct steps steps_any = {fetch_any, root_any,  root_any, inverse_any, less_any,
									   pick_any,  least_any, pack_any, limits_any};

static void pass_any(const struct sieve *sieve, const struct shadow *shadow, struct sieve_search *search, int searches)
{
	pass(sieve, shadow, search, searches, &steps_any);
}

static void hold_any(const struct sieve *sieve, const struct shadow *shadow, struct sieve_outlook *outlook,
					 int outlooks)
{
	if (outlooks == 1)
		hold(sieve, shadow, outlook, 1, &steps_any);
	else
		hold(sieve, shadow, outlook, 2, &steps_any);
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
#include "engine/sieve_avx.inl"
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
