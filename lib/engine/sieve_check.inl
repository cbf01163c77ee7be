/* Pairs that ought to be between two distances, looked over by every machine. */

INLINE size_t check(const struct sieve *sieve, const struct shadow *shadow, uint32_t i, const struct held *held,
					size_t count, uint32_t *kept, const struct steps step)
{
	const struct own own = own_of(sieve, &shadow[i]);
	const lanes zero = {0};
	size_t found = 0;
	for (size_t k = 0; k < count; k += LANES) {
		struct others others = others_of(sieve, &own, shadow, held->entry + k, &step);
		lanes inner, outer;
		memcpy(&inner, held->inner + k, sizeof inner);
		memcpy(&outer, held->outer + k, sizeof outer);
		lanes least = inner * inner, most = outer * outer;
		flags beyond = ~step.less(zero, inner) | step.less(error_of_c(sieve, &others, least), others.rr - least);
		flags within =
			~step.less(outer, zero + INFINITY) | step.less(error_of_c(sieve, &others, most), most - others.rr);
		flags out = (behind(count - k) | (beyond & within)) & all_lanes;
		uint32_t each[LANES];
		for (uint32_t lane = 0; lane < LANES; lane++) each[lane] = (uint32_t)k + lane;
		if (out != all_lanes) found += step.pack(~out & all_lanes, each, kept + found);
	}
	return found;
}

static size_t check_any(const struct sieve *sieve, const struct shadow *shadow, uint32_t self, const struct held *held,
						size_t count, uint32_t *kept)
{
	return check(sieve, shadow, self, held, count, kept, steps_any);
}

#ifdef __x86_64__
AVX2 static size_t check_avx2(const struct sieve *sieve, const struct shadow *shadow, uint32_t self,
							  const struct held *held, size_t count, uint32_t *kept)
{
	return check(sieve, shadow, self, held, count, kept, steps_avx2);
}

AVX512 static size_t check_512(const struct sieve *sieve, const struct shadow *shadow, uint32_t self,
							   const struct held *held, size_t count, uint32_t *kept)
{
	return check(sieve, shadow, self, held, count, kept, steps_512);
}
#elif defined __wasm_simd128__
static size_t check_128(const struct sieve *sieve, const struct shadow *shadow, uint32_t self, const struct held *held,
						size_t count, uint32_t *kept)
{
	return check(sieve, shadow, self, held, count, kept, steps_128);
}
#endif
