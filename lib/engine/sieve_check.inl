/* Pairs that ought to be between two distances, looked over by every machine. */

INLINE size_t check(const struct sieve *sieve, const struct shadow *shadow, uint32_t i, const struct held *held,
					size_t count, uint32_t *kept, const struct steps step)
{
	const struct own own = own_of(sieve, &shadow[i]);
	const lanes zero = {0}, number = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15};
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
		flags out = ~step.less(number, zero + (float)(count - k)) | (beyond & within);
		uint32_t each[LANES];
		for (uint32_t lane = 0; lane < LANES; lane++) each[lane] = (uint32_t)k + lane;
		if (step.bits(out) != all_lanes) found += step.pack(~step.bits(out) & all_lanes, each, kept + found);
	}
	return found;
}

static size_t check_any(const struct sieve *sieve, const struct shadow *shadow, uint32_t self, const struct held *held,
						size_t count, uint32_t *kept)
{
	return check(sieve, shadow, self, held, count, kept,
				 (struct steps){fetch_any, root_any, less_any, bits_any, least_any, pack_any});
}

#ifdef __x86_64__
AVX2 static size_t check_avx2(const struct sieve *sieve, const struct shadow *shadow, uint32_t self,
							  const struct held *held, size_t count, uint32_t *kept)
{
	return check(sieve, shadow, self, held, count, kept,
				 (struct steps){fetch_any, root_any, less_any, bits_any, least_any, pack_any});
}

AVX512 static size_t check_512(const struct sieve *sieve, const struct shadow *shadow, uint32_t self,
							   const struct held *held, size_t count, uint32_t *kept)
{
	return check(sieve, shadow, self, held, count, kept,
				 (struct steps){fetch_512, root_512, less_512, bits_512, least_512, pack_any});
}
#elif defined __wasm_simd128__
static size_t check_128(const struct sieve *sieve, const struct shadow *shadow, uint32_t self, const struct held *held,
						size_t count, uint32_t *kept)
{
	return check(sieve, shadow, self, held, count, kept,
				 (struct steps){fetch_128, root_128, less_128, bits_128, least_128, pack_any});
}
#endif
