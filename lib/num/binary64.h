/* The arithmetic "binary64": the machine's double, the production engine. */
#ifndef NUM_BINARY64_H
#define NUM_BINARY64_H

#include <float.h>

_Static_assert(FLT_EVAL_METHOD == 0, "double operations must round to double, not to something wider");

typedef double num;
enum { num_significand_bits = DBL_MANT_DIG, num_largest_exponent = DBL_MAX_EXP };
static const char num_name[] = "binary64";

#include "native.h"

static inline num root(num a)
{
	return sqrt(a);
}

static inline num magnitude(num a)
{
	return fabs(a);
}

/* a b + c, rounded once. */
static inline num fused(num a, num b, num c)
{
	return fma(a, b, c);
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
	frexp(x, &exponent);
	return exponent;
}

/* x 2^exponent. */
static inline num times_power(num x, long exponent)
{
	return scalbn(x, (int)exponent);
}

#ifndef TOUCHSTONE_WITHOUT_MPFR
/* Exactly, into an `exact` of num_exact_bits. */
static inline void to_mpfr(mpfr_ptr exact, num x)
{
	mpfr_set_d(exact, x, MPFR_RNDN);
}

/* Rounded to nearest, ties to even, once: to subnormal numbers and infinity as well. */
static inline num from_mpfr(mpfr_srcptr x)
{
	return mpfr_get_d(x, MPFR_RNDN);
}
#endif

#endif
