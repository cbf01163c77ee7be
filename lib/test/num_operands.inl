/* Random numbers that are hard to round, for the arithmetic whose header was included before. */

static gmp_randstate_t random_state;

/* The seed is printed; to repeat a run, give it in the environment: SEED=12345. */
static int seed_random(void **state)
{
	const char *given = getenv("SEED");
	unsigned long seed = given ? strtoul(given, NULL, 10) : (unsigned long)time(NULL);
	print_message("%s: SEED=%lu\n", num_name, seed);
	gmp_randinit_default(random_state);
	gmp_randseed_ui(random_state, seed);
	(void)state;
	return 0;
}

static int clear_random(void **state)
{
	gmp_randclear(random_state);
	mpfr_free_cache();
	(void)state;
	return 0;
}

static int random_below(int bound)
{
	return (int)gmp_urandomm_ui(random_state, (unsigned long)bound);
}

/* -extent .. extent, half of them near 0. */
static int random_around_zero(int extent)
{
	int reach = random_below(2) ? 2 : extent;
	return random_below(2 * reach + 1) - reach;
}

/* x 2^exponent, in steps that no arithmetic finds too large: exact while the range lasts. */
static num scaled(num x, int exponent)
{
	for (int step; exponent; exponent -= step) {
		step = exponent > 100 ? 100 : exponent < -100 ? -100 : exponent;
		x = mul(x, from_double(ldexp(1, step)));
	}
	return x;
}

/* An integer that the working precision can hold, put together from pieces without rounding. */
static num from_integer(const mpz_t integer)
{
	int bits = (int)mpz_sizeinbase(integer, 2), step = num_bits() < 32 ? num_bits() : 32;
	num x = from_double(0);
	mpz_t piece;
	mpz_init(piece);
	for (int place = (bits - 1) / step * step; place >= 0; place -= step) {
		mpz_tdiv_q_2exp(piece, integer, (mp_bitcnt_t)place);
		mpz_tdiv_r_2exp(piece, piece, (mp_bitcnt_t)step);
		x = add(mul(x, from_double(ldexp(1, step))), from_double(mpz_get_d(piece)));
	}
	mpz_clear(piece);
	return x;
}

/* An integer of at most so many bits: either uniform, or of long runs of ones and zeros, which make ties, near ties
 * and long carries. */
static num random_integer(int bits)
{
	mpz_t integer;
	mpz_init(integer);
	if (random_below(2))
		mpz_urandomb(integer, random_state, (mp_bitcnt_t)bits);
	else
		mpz_rrandomb(integer, random_state, (mp_bitcnt_t)bits);
	num x = from_integer(integer);
	mpz_clear(integer);
	return random_below(2) ? x : negated(x);
}

/* A number that takes the whole precision or only a part of it, between about 2^-P and 2^2P. */
static num random_number(void)
{
	int bits = random_below(2) ? num_bits() : 1 + random_below(num_bits());
	return scaled(random_integer(bits), random_around_zero(num_bits() + 2));
}

/* A partner for a: unrelated, or so near to a or -a that they cancel. */
static num random_partner(num a)
{
	if (random_below(4)) return random_number();
	num b = add(a, mul(a, scaled(from_double(random_around_zero(8)), 1 - num_bits())));
	return random_below(2) ? b : negated(b);
}

/* A dividend and a divisor whose quotient lies as near to halfway between two numbers as P bits allow. For an odd
 * `middle` m of P + 1 bits, b = r / m modulo 2^(P+1) makes b m - r a multiple a 2^(P+1), so that
 * a 2^(P+1) / b = m - r / b. False when b came out too long. */
static bool random_hard_quotient(num *a, num *b)
{
	mp_bitcnt_t bits = (mp_bitcnt_t)num_bits();
	int rest = 2 * random_below(8) - 7;
	mpz_t middle, modulus, dividend, divisor;
	mpz_inits(middle, modulus, dividend, divisor, NULL);
	mpz_urandomb(middle, random_state, bits);
	mpz_setbit(middle, 0);
	mpz_setbit(middle, bits);
	mpz_setbit(modulus, bits + 1);
	mpz_invert(divisor, middle, modulus);
	mpz_mul_si(divisor, divisor, rest);
	mpz_mod(divisor, divisor, modulus);
	mpz_mul(dividend, divisor, middle);
	mpz_set_si(middle, rest);
	mpz_sub(dividend, dividend, middle);
	mpz_tdiv_q_2exp(dividend, dividend, bits + 1);
	bool fits = mpz_sizeinbase(divisor, 2) <= bits && mpz_sizeinbase(dividend, 2) <= bits && mpz_sgn(dividend) > 0;
	if (fits) *a = from_integer(dividend), *b = from_integer(divisor);
	mpz_clears(middle, modulus, dividend, divisor, NULL);
	return fits;
}

/* A number whose square root lies as near to halfway between two numbers as P bits allow: m^2 = r modulo 2^(P+2), with
 * m of P + 1 bits found one bit at a time from a small r = 1 modulo 8, makes m^2 - r a multiple a 2^(P+2). */
static num random_hard_square(void)
{
	mp_bitcnt_t bits = (mp_bitcnt_t)num_bits();
	mpz_t middle, rest, square;
	mpz_inits(middle, rest, square, NULL);
	mpz_set_si(rest, bits > 8 ? 8 * (random_below(31) - 15) + 1 : 1);
	mpz_set_ui(middle, 1);
	for (mp_bitcnt_t bit = 3; bit < bits + 2; bit++) {
		mpz_mul(square, middle, middle);
		mpz_sub(square, square, rest);
		if (mpz_tstbit(square, bit)) mpz_setbit(middle, bit - 1);
	}
	if (!mpz_tstbit(middle, bits)) {
		mpz_set_ui(square, 0);
		mpz_setbit(square, bits + 1);
		mpz_sub(middle, square, middle);
	}
	mpz_mul(square, middle, middle);
	mpz_sub(square, square, rest);
	mpz_tdiv_q_2exp(square, square, bits + 2);
	num a = scaled(from_integer(square), (int)bits + 2);
	mpz_clears(middle, rest, square, NULL);
	return a;
}
