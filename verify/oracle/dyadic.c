/* Doubles are integers times powers of two. Zeros at the end of a significand are left out, and numbers that are to be
 * added share one exponent, so that the integers are as short as the input allows. */
#include "oracle/exact.h"
#include <limits.h>
#include <math.h>

enum { SIGNIFICAND_BITS = 53 };

/* x = significand * 2^exponent, the significand an odd integer, or zero. */
static double split(double x, int *exponent)
{
	double significand = ldexp(frexp(x, exponent), SIGNIFICAND_BITS);
	if (significand == 0) return 0;
	int zeros = __builtin_ctzll((unsigned long long)fabs(significand));
	*exponent += zeros - SIGNIFICAND_BITS;
	return ldexp(significand, -zeros);
}

long dyadic_read(size_t count, const double value[], mpz_t integer[])
{
	int common = INT_MAX, exponent;
	for (size_t i = 0; i < count; i++)
		if (split(value[i], &exponent) != 0 && exponent < common) common = exponent;
	if (common == INT_MAX) common = 0;
	for (size_t i = 0; i < count; i++) {
		double significand = split(value[i], &exponent);
		mpz_set_d(integer[i], significand);
		if (significand != 0) dyadic_shift(integer[i], exponent - common);
	}
	return common;
}

double dyadic_to_double(const mpz_t integer, long exponent)
{
	long scale;
	double significand = mpz_get_d_2exp(&scale, integer);
	return ldexp(significand, (int)(scale + exponent));
}

void dyadic_shift(mpz_t integer, long bits)
{
	mpz_mul_2exp(integer, integer, (mp_bitcnt_t)bits);
}
