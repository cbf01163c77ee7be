/* Doubles are integers times powers of two. Zeros at the end of a significand are left out, and numbers that are to be
 * added share one exponent, so that the integers are as short as the input allows. */
#include "oracle/exact.h"
#include <limits.h>
#include <math.h>
#include <string.h>

enum { SIGNIFICAND_BITS = 53, LEAST_EXPONENT = -1074 };

/* x = significand * 2^exponent, the significand an odd integer, or zero. From the bits themselves: frexp and ldexp
 * took a tenth of the time of a hunt for failures. */
static long split(double x, int *exponent)
{
	const uint64_t hidden = UINT64_C(1) << (SIGNIFICAND_BITS - 1);
	uint64_t bits;
	memcpy(&bits, &x, sizeof bits);
	uint64_t significand = bits & (hidden - 1);
	int above = (int)(bits >> (SIGNIFICAND_BITS - 1) & 0x7ff); /* the subnormal and the least normal share a unit */
	if (above > 0) significand |= hidden;
	if (significand == 0) return 0;
	int zeros = __builtin_ctzll(significand);
	*exponent = LEAST_EXPONENT + (above > 0 ? above - 1 : 0) + zeros;
	return bits >> 63 ? -(long)(significand >> zeros) : (long)(significand >> zeros);
}

long dyadic_read(size_t count, const double value[], mpz_t integer[])
{
	int common = INT_MAX, exponent;
	for (size_t i = 0; i < count; i++)
		if (split(value[i], &exponent) != 0 && exponent < common) common = exponent;
	if (common == INT_MAX) common = 0;
	for (size_t i = 0; i < count; i++) {
		long significand = split(value[i], &exponent);
		mpz_set_si(integer[i], significand);
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
	if (bits != 0) mpz_mul_2exp(integer, integer, (mp_bitcnt_t)bits);
}
