/* Digits and order of quadratic surds, by integer square roots and by squaring: nothing here is approximate. */
#include "oracle/exact.h"

static long max(long x, long y)
{
	return x > y ? x : y;
}

bool surd_digits(struct oracle *oracle, const struct surd *surd, long width, mpz_t digits, long *exponent)
{
	/* floor((p + sqrt(d)) / s) = floor((p + floor(sqrt(d))) / s) for integers, and so for 2^shift times the value. */
	mpz_t *root = &oracle->scratch[0], *rest = &oracle->scratch[1];
	long shift = width - 1 - surd->magnitude, up = max(shift, 0);
	mpz_mul_2exp(*root, surd->radicand, 2 * (mp_bitcnt_t)up);
	mpz_sqrtrem(*root, *rest, *root);
	bool inexact = mpz_sgn(*rest) != 0;
	mpz_mul_2exp(digits, surd->rational, (mp_bitcnt_t)up);
	if (surd->sign > 0) {
		mpz_add(digits, digits, *root);
	} else {
		mpz_sub(digits, digits, *root);
		mpz_sub_ui(digits, digits, inexact);
	}
	mpz_mul_2exp(*rest, surd->divisor, (mp_bitcnt_t)(up - shift));
	mpz_fdiv_qr(digits, *rest, digits, *rest);
	*exponent = surd->exponent - shift;
	return inexact || mpz_sgn(*rest) != 0;
}

int surd_round(struct oracle *oracle, mpfr_t result, const struct surd *surd, mpfr_rnd_t direction)
{
	/* Two bits more than the result keeps, and a last one that stands for all the rest. */
	long exponent;
	bool inexact = surd_digits(oracle, surd, mpfr_get_prec(result) + 2, oracle->digits, &exponent);
	dyadic_shift(oracle->digits, 1);
	if (inexact) mpz_setbit(oracle->digits, 0);
	return mpfr_set_z_2exp(result, oracle->digits, exponent - 1, direction);
}

/* The sign of rational + sign sqrt(radicand); overwrites `rational`. */
static int sign_with_root(mpz_t rational, int sign, const mpz_t radicand)
{
	int of_rational = mpz_sgn(rational);
	int of_root = mpz_sgn(radicand) == 0 ? 0 : sign;
	if (of_rational == 0 || of_rational == of_root) return of_root;
	if (of_root == 0) return of_rational;
	mpz_mul(rational, rational, rational);
	return of_rational * mpz_cmp(rational, radicand);
}

/* The sign of rational + sign sqrt(radicand) + other_sign sqrt(other). Overwrites `rational` and `work`. */
static int sign_with_roots(mpz_t rational, int sign, const mpz_t radicand, int other_sign, const mpz_t other,
						   mpz_t work)
{
	int of_rational = mpz_sgn(rational);
	int of_roots = sign * mpz_cmp(radicand, other);
	if (sign == other_sign) of_roots = mpz_sgn(radicand) == 0 && mpz_sgn(other) == 0 ? 0 : sign;
	if (of_rational == 0) return of_roots;
	if (of_roots == 0 || (of_rational > 0) == (of_roots > 0)) return of_rational;

	/* Opposite signs: the squares decide, rational^2 against radicand + other +- 2 sqrt(radicand other). */
	mpz_mul(rational, rational, rational);
	mpz_sub(rational, rational, radicand);
	mpz_sub(rational, rational, other);
	mpz_mul(work, radicand, other);
	dyadic_shift(work, 2);
	return of_rational * sign_with_root(rational, -sign * other_sign, work);
}

/* -1 or 1 when the leading digits tell the two apart, else 0. */
static int compare_digits(struct oracle *oracle, const struct surd *first, const struct surd *second)
{
	long difference = first->magnitude + first->exponent - second->magnitude - second->exponent;
	if (difference >= 3) return 1;
	if (difference <= -3) return -1;
	long exponent, other_exponent;
	surd_digits(oracle, first, DIGITS, oracle->digits, &exponent);
	surd_digits(oracle, second, DIGITS, oracle->other_digits, &other_exponent);
	dyadic_shift(oracle->digits, max(exponent - other_exponent, 0));
	dyadic_shift(oracle->other_digits, max(other_exponent - exponent, 0));
	mpz_sub(oracle->digits, oracle->digits, oracle->other_digits);
	/* Each is short by less than one unit of its own last digit. */
	long uncertain = exponent > other_exponent ? exponent - other_exponent : other_exponent - exponent;
	if ((long)mpz_sizeinbase(oracle->digits, 2) <= uncertain) return 0;
	return mpz_sgn(oracle->digits);
}

int surd_compare(struct oracle *oracle, const struct surd *first, const struct surd *second)
{
	int order = compare_digits(oracle, first, second);
	if (order != 0) return order;

	/* The sign of first - second, times both divisors and a power of two. */
	mpz_t *rational = &oracle->scratch[0], *work = &oracle->scratch[1];
	mpz_t *radicand = &oracle->scratch[2], *other = &oracle->scratch[3];
	long up = max(first->exponent - second->exponent, 0), other_up = max(second->exponent - first->exponent, 0);
	mpz_mul(*rational, first->rational, second->divisor);
	dyadic_shift(*rational, up);
	mpz_mul(*work, second->rational, first->divisor);
	dyadic_shift(*work, other_up);
	mpz_sub(*rational, *rational, *work);
	mpz_mul(*radicand, second->divisor, second->divisor);
	mpz_mul(*radicand, *radicand, first->radicand);
	dyadic_shift(*radicand, 2 * up);
	mpz_mul(*other, first->divisor, first->divisor);
	mpz_mul(*other, *other, second->radicand);
	dyadic_shift(*other, 2 * other_up);
	order = sign_with_roots(*rational, first->sign, *radicand, -second->sign, *other, *work);
	return (order > 0) - (order < 0);
}

int surd_compare_double(struct oracle *oracle, const struct surd *surd, double value)
{
	/* The sign of surd - value, times the divisor and a power of two. */
	mpz_t *rational = &oracle->scratch[0], *subtrahend = &oracle->scratch[1], *radicand = &oracle->scratch[2];
	long exponent = dyadic_read(1, &value, subtrahend);
	long up = max(surd->exponent - exponent, 0), value_up = max(exponent - surd->exponent, 0);
	mpz_mul(*subtrahend, *subtrahend, surd->divisor);
	dyadic_shift(*subtrahend, value_up);
	mpz_mul_2exp(*rational, surd->rational, (mp_bitcnt_t)up);
	mpz_sub(*rational, *rational, *subtrahend);
	mpz_mul_2exp(*radicand, surd->radicand, 2 * (mp_bitcnt_t)up);
	int order = sign_with_root(*rational, surd->sign, *radicand);
	return (order > 0) - (order < 0);
}
