/* The steps of the sieve in WebAssembly's vectors of four: clang does not make them of the portable loops, and in the
 * live page the engine is six times as fast for it. */
#include <wasm_simd128.h>

INLINE v128_t quarter(const void *x, int k)
{
	return wasm_v128_load((const float *)x + 4 * k);
}

INLINE lanes root_128(lanes x)
{
	lanes root;
	for (int k = 0; k < LANES / 4; k++) wasm_v128_store((float *)&root + 4 * k, wasm_f32x4_sqrt(quarter(&x, k)));
	return root;
}

INLINE flags less_128(lanes a, lanes b)
{
	flags less = 0;
	for (int k = 0; k < LANES / 4; k++)
		less |= wasm_i32x4_bitmask(wasm_f32x4_lt(quarter(&a, k), quarter(&b, k))) << 4 * k;
	return less;
}

INLINE lanes pick_128(flags which, lanes yes, lanes no)
{
	const v128_t bit = wasm_i32x4_const(1, 2, 4, 8);
	lanes picked;
	for (int k = 0; k < LANES / 4; k++) {
		v128_t mask = wasm_i32x4_eq(wasm_v128_and(wasm_i32x4_splat((int)(which >> 4 * k)), bit), bit);
		wasm_v128_store((float *)&picked + 4 * k, wasm_v128_bitselect(quarter(&yes, k), quarter(&no, k), mask));
	}
	return picked;
}

INLINE float least_128(lanes x)
{
	v128_t two = wasm_f32x4_pmin(quarter(&x, 0), quarter(&x, 1)),
		   other = wasm_f32x4_pmin(quarter(&x, 2), quarter(&x, 3));
	v128_t four = wasm_f32x4_pmin(two, other);
	float row[4];
	wasm_v128_store(row, four);
	return fminf(fminf(row[0], row[1]), fminf(row[2], row[3]));
}

/* Eight fields of four particles, turned over. */
INLINE void fetch_128(const struct shadow *shadow, const uint32_t *entry, lanes field[FIELDS])
{
	for (int k = 0; k < LANES; k += 4)
		for (int half = 0; half < FIELDS; half += 4) {
			v128_t row[4];
			for (int lane = 0; lane < 4; lane++)
				row[lane] = wasm_v128_load((const float *)&shadow[entry_particle(entry[k + lane])] + half);
			v128_t low01 = wasm_i32x4_shuffle(row[0], row[1], 0, 4, 1, 5),
				   high01 = wasm_i32x4_shuffle(row[0], row[1], 2, 6, 3, 7);
			v128_t low23 = wasm_i32x4_shuffle(row[2], row[3], 0, 4, 1, 5),
				   high23 = wasm_i32x4_shuffle(row[2], row[3], 2, 6, 3, 7);
			wasm_v128_store((float *)&field[half] + k, wasm_i64x2_shuffle(low01, low23, 0, 2));
			wasm_v128_store((float *)&field[half + 1] + k, wasm_i64x2_shuffle(low01, low23, 1, 3));
			wasm_v128_store((float *)&field[half + 2] + k, wasm_i64x2_shuffle(high01, high23, 0, 2));
			wasm_v128_store((float *)&field[half + 3] + k, wasm_i64x2_shuffle(high01, high23, 1, 3));
		}
}

static const struct steps steps_128 = {fetch_128, root_128, root_128,  inverse_any,
									   less_128,  pick_128, least_128, pack_any};

static void pass_128(const struct sieve *sieve, const struct shadow *shadow, struct sieve_search *search, int searches)
{
	if (searches == 1)
		pass(sieve, shadow, search, 1, &steps_128);
	else
		pass(sieve, shadow, search, 2, &steps_128);
}

static size_t hold_128(const struct sieve *sieve, const struct shadow *shadow, uint32_t self, const struct held *held,
					   size_t count, float *soonest)
{
	return hold(sieve, shadow, self, held, count, soonest, steps_128);
}
