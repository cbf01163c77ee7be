/* The steps of the sieve on x86: in two vectors of eight, and in one of sixteen. */
#define AVX2 __attribute__((target("avx2,fma,popcnt,bmi,bmi2")))
#define AVX512 __attribute__((target("avx512f,avx512dq,avx512vl,avx512bw,fma,popcnt,bmi,bmi2")))

struct halves {
	__m256 low, high;
};

AVX2 static inline struct halves halves_of(lanes x)
{
	struct halves halves;
	memcpy(&halves, &x, sizeof halves);
	return halves;
}

AVX2 static inline lanes lanes_of(__m256 low, __m256 high)
{
	struct halves halves = {low, high};
	lanes x;
	memcpy(&x, &halves, sizeof x);
	return x;
}

AVX2 static inline lanes root_avx2(lanes x)
{
	struct halves half = halves_of(x);
	return lanes_of(_mm256_sqrt_ps(half.low), _mm256_sqrt_ps(half.high));
}

/* Of rsqrtps and rcpps Intel and AMD give different bits, within 1.5 x 2^-12. */
AVX2 static inline lanes near_root_avx2(lanes x)
{
	struct halves half = halves_of(x);
	return x * lanes_of(_mm256_rsqrt_ps(half.low), _mm256_rsqrt_ps(half.high));
}

AVX2 static inline lanes near_inverse_avx2(lanes x)
{
	struct halves half = halves_of(x);
	return lanes_of(_mm256_rcp_ps(half.low), _mm256_rcp_ps(half.high));
}

AVX2 static inline flags less_avx2(lanes a, lanes b)
{
	struct halves x = halves_of(a), y = halves_of(b);
	int low = _mm256_movemask_ps(_mm256_cmp_ps(x.low, y.low, _CMP_LT_OQ));
	int high = _mm256_movemask_ps(_mm256_cmp_ps(x.high, y.high, _CMP_LT_OQ));
	return (flags)(low | high << 8);
}

AVX2 static inline __m256 mask_of(flags eight)
{
	const __m256i bit = _mm256_setr_epi32(1, 2, 4, 8, 16, 32, 64, 128);
	return _mm256_castsi256_ps(_mm256_cmpeq_epi32(_mm256_and_si256(_mm256_set1_epi32((int)eight), bit), bit));
}

AVX2 static inline lanes pick_avx2(flags which, lanes yes, lanes no)
{
	struct halves x = halves_of(yes), y = halves_of(no);
	return lanes_of(_mm256_blendv_ps(y.low, x.low, mask_of(which)),
					_mm256_blendv_ps(y.high, x.high, mask_of(which >> 8)));
}

AVX2 static inline float least_avx2(lanes x)
{
	struct halves half = halves_of(x);
	__m256 eight = _mm256_min_ps(half.low, half.high);
	__m128 four = _mm_min_ps(_mm256_castps256_ps128(eight), _mm256_extractf128_ps(eight, 1));
	__m128 two = _mm_min_ps(four, _mm_movehl_ps(four, four));
	return _mm_cvtss_f32(_mm_min_ss(two, _mm_movehdup_ps(two)));
}

/* Eight rows of eight, turned over. */
AVX2 static inline void turn_avx2(const struct shadow *shadow, const uint32_t *entry, __m256 column[FIELDS])
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
		column[f] = _mm256_permute2f128_ps(quad[f], quad[f + 4], 0x20);
		column[f + 4] = _mm256_permute2f128_ps(quad[f], quad[f + 4], 0x31);
	}
}

AVX2 static inline void fetch_avx2(const struct shadow *shadow, const uint32_t *entry, lanes field[FIELDS])
{
	__m256 low[FIELDS], high[FIELDS];
	turn_avx2(shadow, entry, low);
	turn_avx2(shadow, entry + 8, high);
	for (int f = 0; f < FIELDS; f++) field[f] = lanes_of(low[f], high[f]);
}

AVX2 static void cast_avx2(struct shadow *shadow, double x, double y, double z, double time, double vx, double vy,
						   double vz, double radius)
{
	__m256 row =
		_mm256_setr_ps((float)x, (float)y, (float)z, (float)time, (float)vx, (float)vy, (float)vz, (float)radius);
	_mm256_store_ps((float *)shadow, row);
}

static const struct steps steps_avx2 = {fetch_avx2, root_avx2, near_root_avx2, near_inverse_avx2,
										less_avx2,  pick_avx2, least_avx2,     pack_any};

AVX2 static void pass_avx2(const struct sieve *sieve, const struct shadow *shadow, struct sieve_search *search,
						   int searches)
{
	if (searches == 1)
		pass(sieve, shadow, search, 1, &steps_avx2);
	else
		pass(sieve, shadow, search, 2, &steps_avx2);
}

AVX2 static size_t hold_avx2(const struct sieve *sieve, const struct shadow *shadow, uint32_t self,
							 const struct held *held, size_t count, float *soonest)
{
	return hold(sieve, shadow, self, held, count, soonest, steps_avx2);
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

AVX512 static inline lanes near_root_512(lanes x)
{
	return x * (lanes)_mm512_rsqrt14_ps((__m512)x);
}

AVX512 static inline lanes near_inverse_512(lanes x)
{
	return (lanes)_mm512_rcp14_ps((__m512)x);
}

AVX512 static inline flags less_512(lanes a, lanes b)
{
	return _mm512_cmp_ps_mask((__m512)a, (__m512)b, _CMP_LT_OQ);
}

AVX512 static inline lanes pick_512(flags which, lanes yes, lanes no)
{
	return (lanes)_mm512_mask_blend_ps((__mmask16)which, (__m512)no, (__m512)yes);
}

AVX512 static inline float least_512(lanes x)
{
	return _mm512_reduce_min_ps((__m512)x);
}

AVX512 static inline size_t pack_512(flags wanted, const uint32_t *from, uint32_t *to)
{
	_mm512_storeu_si512(to, _mm512_maskz_compress_epi32((__mmask16)wanted, _mm512_loadu_si512(from)));
	return (size_t)__builtin_popcount(wanted);
}

static const struct steps steps_512 = {fetch_512, root_512, near_root_512, near_inverse_512,
									   less_512,  pick_512, least_512,     pack_512};

AVX512 static void pass_512(const struct sieve *sieve, const struct shadow *shadow, struct sieve_search *search,
							int searches)
{
	if (searches == 1)
		pass(sieve, shadow, search, 1, &steps_512);
	else
		pass(sieve, shadow, search, 2, &steps_512);
}

AVX512 static size_t hold_512(const struct sieve *sieve, const struct shadow *shadow, uint32_t self,
							  const struct held *held, size_t count, float *soonest)
{
	return hold(sieve, shadow, self, held, count, soonest, steps_512);
}
