/* What rounding left out, sums of products rounded once, and the way to MPFR and back, for num_test.inl. Numbers whose
 * rests could fall out of the range are passed over. */

#include "num/sum_rest.inl"

/* Whether x and its last bits, down to four times the precision, are well within the range. */
static bool ample(const mpfr_t x)
{
	if (!mpfr_regular_p(x)) return false;
	mpfr_exp_t room = largest_exponent ? largest_exponent - 40 : 100000;
	return mpfr_get_exp(x) < room && mpfr_get_exp(x) > 4 * num_bits() - room;
}

/* |found - expected| <= tolerance size */
static bool near(const mpfr_t found, const mpfr_t expected, const mpfr_t size, double tolerance)
{
	if (mpfr_nan_p(found)) return false;
	mpfr_t difference, allowed;
	mpfr_init2(difference, 64);
	mpfr_init2(allowed, 64);
	mpfr_sub(difference, found, expected, MPFR_RNDA);
	mpfr_mul_d(allowed, size, tolerance, MPFR_RNDN);
	bool within = mpfr_cmpabs(difference, allowed) <= 0;
	mpfr_clears(difference, allowed, NULL);
	return within;
}

/* Every number here has num_bits bits or is a twin, whose parts lie no farther apart than exact_bits. */
static void rests_body(struct bench *bench)
{
	bool twin = allowed_error[MUL] > 0;
	mpfr_t exact, rest, size;
	mpfr_inits2(8 * num_bits() + 2 * exact_bits, exact, rest, size, NULL);
	for (int i = 0; i < cases / 10; i++) {
		num a = random_number(), b = random_partner(a), product = mul(a, b), sum = add(a, b),
			c = random_partner(product);
		value(bench->a, a);
		value(bench->b, b);
		mpfr_mul(size, bench->a, bench->b, MPFR_RNDN);
		if (!ample(bench->a) || !ample(bench->b) || !ample(size)) continue;

		value(bench->found, product);
		mpfr_sub(rest, size, bench->found, MPFR_RNDN);
		value(bench->found, product_rest(a, b, product));
		if (!near(bench->found, rest, size, twin ? 0x1p-155 : 0))
			fail_with("product_rest", bench->a, bench->b, bench->found, rest);

		if (labs(exponent_of(a) - exponent_of(b)) < 4 * num_bits()) {
			mpfr_add(exact, bench->a, bench->b, MPFR_RNDN);
			value(bench->found, sum);
			mpfr_sub(rest, exact, bench->found, MPFR_RNDN);
			value(bench->found, sum_rest(a, b, sum));
			if (!near(bench->found, rest, bench->a, twin ? 0x1p-155 : 0) &&
				!near(bench->found, rest, bench->b, twin ? 0x1p-155 : 0))
				fail_with("sum_rest", bench->a, bench->b, bench->found, rest);
		}

		value(exact, c);
		mpfr_fma(twin ? exact : bench->expected, bench->a, bench->b, exact, MPFR_RNDN);
		if (twin) mpfr_set(bench->expected, exact, MPFR_RNDN);
		value(bench->found, fused(a, b, c));
		if (ample(bench->expected) && !near(bench->found, bench->expected, bench->expected, twin ? 0x1p-102 : 0) &&
			!(twin && near(bench->found, bench->expected, size, 0x1p-150)))
			fail_with("fused", bench->a, bench->b, bench->found, bench->expected);
	}
	mpfr_clears(exact, rest, size, NULL);
}

static void rests_are_what_rounding_left_out(void **state)
{
	(void)state;
	at_each_precision(rests_body);
}

/* To MPFR exactly and back; and from more bits than there are, rounded once, at the ends of the range as well. */
static void mpfr_body(struct bench *bench)
{
	gmp_randstate_t random;
	mpfr_t wide, same;
	gmp_randinit_default(random);
	mpfr_init2(wide, num_bits() + 20);
	for (int i = 0; i < cases / 10; i++) {
		num a = random_number();
		value(bench->a, a);
		mpfr_init2(same, num_exact_bits(a));
		to_mpfr(same, a);
		value(bench->found, from_mpfr(same));
		if (!mpfr_equal_p(same, bench->a) || !mpfr_equal_p(bench->found, bench->a))
			fail_with("to_mpfr and back", bench->a, same, bench->found, bench->a);
		mpfr_clear(same);

		mpfr_urandomb(wide, random);
		if (random_below(2))
			mpfr_prec_round(wide, num_bits() + 1, MPFR_RNDN), mpfr_prec_round(wide, num_bits() + 20, 0);
		long most = largest_exponent ? largest_exponent : 5000, near_end = num_bits() + 20 - random_below(40);
		mpfr_mul_2si(wide, wide, random_below(2) ? random_around_zero(100) : near_end - most, MPFR_RNDN);
		if (random_below(8) == 0) mpfr_mul_2si(wide, wide, 2 * most - 2 * near_end, MPFR_RNDN);
		if (random_below(2)) mpfr_neg(wide, wide, MPFR_RNDN);
		limit(bench->expected, mpfr_set(bench->expected, wide, MPFR_RNDN), largest_exponent);
		value(bench->found, from_mpfr(wide));
		bool twin = allowed_error[MUL] > 0;
		bool fine = agrees(bench->found, bench->expected, 0);
		if (twin && mpfr_number_p(bench->found))
			fine = mpfr_get_exp(wide) < -900 || near(bench->found, wide, wide, 0x1p-106);
		if (!fine) fail_with("from_mpfr", wide, wide, bench->found, bench->expected);
	}
	mpfr_clear(wide);
	gmp_randclear(random);
}

static void mpfr_and_back(void **state)
{
	(void)state;
	at_each_precision(mpfr_body);
}

/* Exponents are MPFR's, and powers of two only move them. */
static void exponents_body(struct bench *bench)
{
	for (int i = 0; i < cases / 20; i++) {
		num a = random_number();
		value(bench->a, a);
		if (!ample(bench->a)) continue;
		long above =
			exponent_of(a) - mpfr_get_exp(bench->a); /* a twin just below a power of two has a high part on it */
		assert_true(above == 0 || (above == 1 && allowed_error[MUL] > 0));
		mpfr_mul_2si(bench->b, bench->a, 7 - i % 15, MPFR_RNDN);
		value(bench->found, times_power(a, 7 - i % 15));
		if (!mpfr_equal_p(bench->found, bench->b)) fail_with("times_power", bench->a, bench->a, bench->found, bench->b);
	}
	assert_int_equal(exponent_of(from_double(0)), 0);
}

static void exponents(void **state)
{
	(void)state;
	at_each_precision(exponents_body);
}
