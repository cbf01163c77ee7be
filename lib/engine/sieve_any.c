/* The sieve on any machine, in vectors of four: those of WebAssembly have names for two of its steps. */
#define LANES 4
#define MACHINE
#include "engine/sieve_lanes.inl"
#include "engine/sieve_vectors.inl"

#ifdef __wasm_simd128__
#include <wasm_simd128.h>
#endif

INLINE lanes root(lanes x)
{
#ifdef __wasm_simd128__
	return (lanes)wasm_f32x4_sqrt((v128_t)x);
#else
	for (int lane = 0; lane < LANES; lane++) x[lane] = sqrtf(x[lane]);
	return x;
#endif
}

INLINE lanes near_root(lanes x)
{
	return root(x);
}

INLINE lanes near_inverse(lanes x)
{
	return 1 / x;
}

INLINE lanes pick(mask which, lanes yes, lanes no)
{
	return (lanes)((which & (whole_lanes)yes) | (~which & (whole_lanes)no));
}

INLINE bool any(whole_lanes words)
{
	return words[0] | words[1] | words[2] | words[3];
}

INLINE flags bits(mask which)
{
#ifdef __wasm_simd128__
	return (flags)wasm_i32x4_bitmask((v128_t)which);
#else
	const whole_lanes bit = which & (whole_lanes){1, 2, 4, 8};
	return (flags)(bit[0] | bit[1] | bit[2] | bit[3]);
#endif
}

INLINE lanes larger(lanes a, lanes b)
{
	return pick(b < a, a, b);
}

INLINE lanes smaller(lanes a, lanes b)
{
	return pick(a < b, a, b);
}

INLINE float minimum(lanes x)
{
	float first = x[1] < x[0] ? x[1] : x[0], second = x[3] < x[2] ? x[3] : x[2];
	return second < first ? second : first;
}

INLINE size_t pack(flags wanted, const uint32_t *from, uint32_t *to)
{
	size_t kept = 0;
	for (; wanted; wanted &= wanted - 1) to[kept++] = from[__builtin_ctz(wanted)];
	return kept;
}

INLINE void limits_of(const struct pair_state *pair, size_t count, const struct limits *limits, uint32_t *entry,
					  lanes *outer, lanes *inner)
{
	const struct pair_state none = {0, pair->state};
	lanes far = {0}, near = far;
	for (size_t lane = 0; lane < LANES; lane++) {
		struct pair_state one = lane < count ? pair[lane] : none;
		entry[lane] = one.entry;
		far[lane] = limits[one.state].outer;
		near[lane] = limits[one.state].inner;
	}
	*outer = far, *inner = near;
}

/* Two squares of four by four, turned over. */
INLINE void fetch(const struct shadow *shadow, const uint32_t *entry, lanes field[FIELDS])
{
	for (int half = 0; half < FIELDS; half += 4) {
		lanes row[4];
		for (int k = 0; k < 4; k++)
			memcpy(&row[k], (const float *)&shadow[entry_particle(entry[k])] + half, sizeof row[k]);
		lanes low01 = __builtin_shufflevector(row[0], row[1], 0, 4, 1, 5),
			  high01 = __builtin_shufflevector(row[0], row[1], 2, 6, 3, 7);
		lanes low23 = __builtin_shufflevector(row[2], row[3], 0, 4, 1, 5),
			  high23 = __builtin_shufflevector(row[2], row[3], 2, 6, 3, 7);
		field[half] = __builtin_shufflevector(low01, low23, 0, 1, 4, 5);
		field[half + 1] = __builtin_shufflevector(low01, low23, 2, 3, 6, 7);
		field[half + 2] = __builtin_shufflevector(high01, high23, 0, 1, 4, 5);
		field[half + 3] = __builtin_shufflevector(high01, high23, 2, 3, 6, 7);
	}
}

static void cast(struct shadow *shadow, double x, double y, double z, double time, double vx, double vy, double vz,
				 double radius)
{
	*shadow = (struct shadow){.position = {(float)x, (float)y, (float)z},
							  .time = (float)time,
							  .velocity = {(float)vx, (float)vy, (float)vz},
							  .radius = (float)radius};
}

#include "engine/sieve_passes.inl"

#ifdef __wasm_simd128__
#define NAME "WebAssembly SIMD"
#else
#define NAME "portable"
#endif

const struct sieve_machine sieve_any = {NAME, pass, hold, sooner, check, cast};
