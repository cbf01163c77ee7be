/* The arithmetic "binary128": IEEE 754 quadruple precision, computed in software by the compiler's library. */
#ifndef NUM_BINARY128_H
#define NUM_BINARY128_H

__extension__ typedef __float128 num;
enum { num_significand_bits = 113, num_largest_exponent = 16384 };
static const char num_name[] = "binary128";

#include "native.h"

/* The C library's functions, declared here because not every compiler sees their declarations. Its square root is
 * correctly rounded; libquadmath's sqrtq is not: one result in four is wrong in its last bit. */
extern num sqrtf128(num a);
extern num fmaf128(num a, num b, num c);
extern num frexpf128(num x, int *exponent);
extern num scalbnf128(num x, int exponent);
extern int mpfr_set_float128(mpfr_ptr result, num x, mpfr_rnd_t rounding);
extern num mpfr_get_float128(mpfr_srcptr x, mpfr_rnd_t rounding);

static inline num root(num a)
{
	return sqrtf128(a);
}

static inline num magnitude(num a)
{
	return a < 0 ? -a : a;
}

/* a b + c, rounded once. */
static inline num fused(num a, num b, num c)
{
	return fmaf128(a, b, c);
}

/* What the rounding of a product left out, exactly unless it underflows. */
static inline num product_rest(num a, num b, num product)
{
	return fused(a, b, -product);
}

/* x = f 2^exponent with 1/2 <= |f| < 1; 0 for zero. */
static inline long exponent_of(num x)
{
	int exponent;
	frexpf128(x, &exponent);
	return exponent;
}

/* x 2^exponent. */
static inline num times_power(num x, long exponent)
{
	return scalbnf128(x, (int)exponent);
}

/* Exactly, into an `exact` of num_exact_bits. */
static inline void to_mpfr(mpfr_ptr exact, num x)
{
	mpfr_set_float128(exact, x, MPFR_RNDN);
}

/* Rounded to nearest, ties to even, once: to subnormal numbers and infinity as well. */
static inline num from_mpfr(mpfr_srcptr x)
{
	return mpfr_get_float128(x, MPFR_RNDN);
}

#endif
