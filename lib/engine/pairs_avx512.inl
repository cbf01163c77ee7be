/* The search over pairs in binary64, by the stable rule, on straight flights: eight partners at a time with AVX-512.
 *
 * This is consider_pairs() of search.inl once more, operation by operation in the same order, so that its results are
 * the same to the last bit; a test holds the two against each other. A partner's body is one cache line: eight lines
 * are loaded and transposed, and then every step is one instruction for all eight. Measured with `make bench`. */
#include <immintrin.h>

#define AVX512 __attribute__((target("avx512f,avx512dq,avx512vl,avx512bw,popcnt,bmi,lzcnt")))

static bool has_avx512(void)
{
	return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
		   __builtin_cpu_supports("avx512vl") && __builtin_cpu_supports("avx512bw");
}

/* Eight bodies in, eight fields out. */
AVX512 static inline void transpose(__m512d row[8])
{
	__m512d pair[8], quad[8];
	for (int i = 0; i < 8; i += 2) {
		pair[i] = _mm512_unpacklo_pd(row[i], row[i + 1]);
		pair[i + 1] = _mm512_unpackhi_pd(row[i], row[i + 1]);
	}
	for (int i = 0; i < 8; i += 4)
		for (int k = 0; k < 2; k++) {
			quad[i + k] = _mm512_shuffle_f64x2(pair[i + k], pair[i + k + 2], 0x88);
			quad[i + k + 2] = _mm512_shuffle_f64x2(pair[i + k], pair[i + k + 2], 0xdd);
		}
	/* quad[0], quad[1]: fields 0|4 and 1|5 of bodies 0..3; quad[2], quad[3]: fields 2|6 and 3|7; then bodies 4..7 */
	for (int k = 0; k < 4; k++) {
		row[k] = _mm512_shuffle_f64x2(quad[k], quad[k + 4], 0x88);
		row[k + 4] = _mm512_shuffle_f64x2(quad[k], quad[k + 4], 0xdd);
	}
}

/* Places of eight particles: index by axis. */
AVX512 static inline void load_places(const struct place *place, const uint32_t j[8], __m256i index[3])
{
	__m512i low = _mm512_castsi128_si512(_mm_load_si128((const __m128i *)&place[j[0]]));
	__m512i high = _mm512_castsi128_si512(_mm_load_si128((const __m128i *)&place[j[4]]));
	low = _mm512_inserti32x4(low, _mm_load_si128((const __m128i *)&place[j[1]]), 1);
	high = _mm512_inserti32x4(high, _mm_load_si128((const __m128i *)&place[j[5]]), 1);
	low = _mm512_inserti32x4(low, _mm_load_si128((const __m128i *)&place[j[2]]), 2);
	high = _mm512_inserti32x4(high, _mm_load_si128((const __m128i *)&place[j[6]]), 2);
	low = _mm512_inserti32x4(low, _mm_load_si128((const __m128i *)&place[j[3]]), 3);
	high = _mm512_inserti32x4(high, _mm_load_si128((const __m128i *)&place[j[7]]), 3);
	__m512i every = _mm512_castsi256_si512(_mm256_setr_epi32(0, 4, 8, 12, 16, 20, 24, 28));
	for (int axis = 0; axis < 3; axis++) {
		index[axis] = _mm512_castsi512_si256(_mm512_permutex2var_epi32(low, every, high));
		every = _mm512_add_epi32(every, _mm512_set1_epi32(1));
	}
}

AVX512 static void search_512(struct touchstone_engine *engine, uint32_t i, size_t candidates, struct plan *plan)
{
	uint32_t *candidate = engine->candidate;
	const struct body *body = engine->body, *self = &body[i];
	const struct place *place = engine->place;
	const __m512d zero = _mm512_setzero_pd(), never = _mm512_set1_pd(INFINITY);
	const __m512d own_time = _mm512_set1_pd(self->time), own_page = _mm512_set1_pd(self->page);
	__m512d contact = _mm512_set1_pd(engine->contact * engine->contact), soonest = never;
	__m512i where = _mm512_setzero_si512();
	__mmask8 tied = 0;
	_mm256_storeu_si256((__m256i *)&candidate[candidates], _mm256_set1_epi32((int)i)); /* nothing meets itself */
	for (size_t k = 0; k < candidates; k += 8) {
		uint32_t j[8];
		__m256i entry = _mm256_loadu_si256((const __m256i *)&candidate[k]), index[3];
		_mm256_storeu_si256((__m256i *)j, _mm256_and_si256(entry, _mm256_set1_epi32(ENTRY_PARTICLE)));
		__m512d field[8];
		for (int lane = 0; lane < 8; lane++) field[lane] = _mm512_load_pd((const double *)&body[j[lane]]);
		transpose(field);
		load_places(place, j, index);
		__m512d wait = _mm512_add_pd(_mm512_sub_pd(own_time, field[6]), _mm512_sub_pd(own_page, field[7]));
		__mmask8 self_flies = _mm512_cmp_pd_mask(wait, zero, _CMP_LT_OQ);
		__m512d a = zero, b = zero, c = zero;
		bool images = !_mm256_testz_si256(entry, _mm256_set1_epi32(~(int)ENTRY_PARTICLE));
		for (int axis = 0; axis < 3; axis++) {
			__m256i places = _mm256_sub_epi32(_mm256_set1_epi32(place[i].index[axis]), index[axis]);
			if (images) { /* codes 0, 1, 2 mean images 0, 1, -1 */
				__m256i code = _mm256_and_si256(_mm256_srli_epi32(entry, ENTRY_BITS + 2 * axis), _mm256_set1_epi32(3));
				__m256i image =
					_mm256_sub_epi32(_mm256_and_si256(code, _mm256_set1_epi32(1)), _mm256_srli_epi32(code, 1));
				places = _mm256_sub_epi32(places, _mm256_mullo_epi32(image, _mm256_set1_epi32(engine->places[axis])));
			}
			__m512d shift = _mm512_mul_pd(_mm512_cvtepi32_pd(places), _mm512_set1_pd(engine->place_width[axis]));
			__m512d offset = _mm512_add_pd(_mm512_sub_pd(_mm512_set1_pd(self->position[axis]), field[axis]), shift);
			__m512d own = _mm512_set1_pd(self->velocity[axis]), other = field[3 + axis];
			__m512d r = _mm512_sub_pd(offset, _mm512_mul_pd(_mm512_mask_mov_pd(other, self_flies, own), wait));
			__m512d v = _mm512_sub_pd(own, other);
			a = axis ? _mm512_add_pd(a, _mm512_mul_pd(v, v)) : _mm512_mul_pd(v, v);
			b = axis ? _mm512_add_pd(b, _mm512_mul_pd(r, v)) : _mm512_mul_pd(r, v);
			c = axis ? _mm512_add_pd(c, _mm512_mul_pd(r, r)) : _mm512_mul_pd(r, r);
		}
		if (engine->species_count > 1) {
			double square[8];
			for (int lane = 0; lane < 8; lane++) {
				double s = contact_distance(engine, i, j[lane]);
				square[lane] = s * s;
			}
			contact = _mm512_loadu_pd(square);
		}
		c = _mm512_sub_pd(c, contact);
		__m512d discriminant = _mm512_sub_pd(_mm512_mul_pd(b, b), _mm512_mul_pd(a, c));
		__mmask8 overlap = _mm512_cmp_pd_mask(c, zero, _CMP_LE_OQ);
		__mmask8 real = _mm512_cmp_pd_mask(discriminant, zero, _CMP_GT_OQ);
		__mmask8 meets = _mm512_cmp_pd_mask(b, zero, _CMP_LT_OQ) & (overlap | real);
		if (!meets) continue;
		__m512d below = _mm512_sub_pd(_mm512_sqrt_pd(discriminant), b);
		__m512d after = _mm512_maskz_div_pd((__mmask8)~overlap, c, below);
		/* its own clock is ahead of all others but when it looks again at what it left long ago */
		for (unsigned odd = meets & self_flies; odd; odd &= odd - 1) {
			double waits[8];
			int lane = __builtin_ctz(odd);
			_mm512_storeu_pd(waits, after);
			consider(engine, i, &body[j[lane]], waits[lane], TOUCHSTONE_CONTACT, candidate[k + lane], plan);
		}
		__m512d time = _mm512_mask_add_pd(never, (__mmask8)(meets & ~self_flies), own_time, after);
		__mmask8 sooner = _mm512_cmp_pd_mask(time, soonest, _CMP_LT_OQ);
		tied |= _mm512_mask_cmp_pd_mask(_mm512_cmp_pd_mask(time, never, _CMP_LT_OQ), time, soonest, _CMP_EQ_OQ);
		soonest = _mm512_min_pd(time, soonest);
		where = _mm512_mask_cvtepu32_epi64(where, sooner, entry);
	}
	double first = _mm512_reduce_min_pd(soonest);
	if (first == INFINITY) return;
	unsigned found = _mm512_cmp_pd_mask(soonest, _mm512_set1_pd(first), _CMP_EQ_OQ);
	if ((found & (found - 1)) || tied) {
		consider_pairs(engine, i, candidates, plan); /* ties are rare, and settled where they always are */
		return;
	}
	uint64_t chosen[8];
	_mm512_storeu_si512(chosen, where);
	consider_moment(engine, i, moment_on(engine, self->page, first), TOUCHSTONE_CONTACT,
					(uint32_t)chosen[__builtin_ctz(found)], plan);
}
