/* The arithmetic "binary32": the machine's float. */
#ifndef NUM_BINARY32_H
#define NUM_BINARY32_H

#include <float.h>

_Static_assert(FLT_EVAL_METHOD == 0, "float operations must round to float, not to something wider");

typedef float num;
enum { num_significand_bits = FLT_MANT_DIG, num_largest_exponent = FLT_MAX_EXP };
static const char num_name[] = "binary32";

#include "native.h"

static inline num root(num a)
{
	return sqrtf(a);
}

static inline num magnitude(num a)
{
	return fabsf(a);
}

/* a b + c, rounded once. */
static inline num fused(num a, num b, num c)
{
	return fmaf(a, b, c);
}

/* What the rounding of a product left out: exactly, because 53 bits hold any product of two of 24. */
static inline num product_rest(num a, num b, num product)
{
	return (num)((double)a * b - product);
}

/* x = f 2^exponent with 1/2 <= |f| < 1; 0 for zero. */
static inline long exponent_of(num x)
{
	int exponent;
	frexpf(x, &exponent);
	return exponent;
}

/* x 2^exponent. */
static inline num times_power(num x, long exponent)
{
	return scalbnf(x, (int)exponent);
}

#ifndef TOUCHSTONE_WITHOUT_MPFR
/* Exactly, into an `exact` of num_exact_bits. */
static inline void to_mpfr(mpfr_ptr exact, num x)
{
	mpfr_set_flt(exact, x, MPFR_RNDN);
}

/* Rounded to nearest, ties to even, once: to subnormal numbers and infinity as well. */
static inline num from_mpfr(mpfr_srcptr x)
{
	return mpfr_get_flt(x, MPFR_RNDN);
}
#endif

#endif
