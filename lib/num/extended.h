/* The arithmetic "extended": the x87 long double of 64 significand bits, where the machine has it. */
#ifndef NUM_EXTENDED_H
#define NUM_EXTENDED_H

#include <float.h>

#if LDBL_MANT_DIG != 64
#error "the arithmetic extended needs a long double of 64 significand bits; leave this unit out on this machine"
#endif

typedef long double num;
enum { num_significand_bits = LDBL_MANT_DIG, num_largest_exponent = LDBL_MAX_EXP };
static const char num_name[] = "extended";

#include "native.h"

static inline num root(num a)
{
	return sqrtl(a);
}

static inline num magnitude(num a)
{
	return fabsl(a);
}

/* a b + c, rounded once. */
static inline num fused(num a, num b, num c)
{
	return fmal(a, b, c);
}

/* The 32 leading bits of a number (Veltkamp), unless it is within 2^33 of the range's end. */
static inline num num_upper_half(num a)
{
	num scaled = 0x1.00000001p32L * a;
	return scaled - (scaled - a);
}

/* What the rounding of a product left out (Dekker), exactly unless it underflows or halving overflows; several times
 * faster than the C library's multiply-add, which is done in software here. */
static inline num product_rest(num a, num b, num product)
{
	num a_high = num_upper_half(a), b_high = num_upper_half(b), a_low = a - a_high, b_low = b - b_high;
	return ((a_high * b_high - product) + a_high * b_low + a_low * b_high) + a_low * b_low;
}

/* x = f 2^exponent with 1/2 <= |f| < 1; 0 for zero. */
static inline long exponent_of(num x)
{
	int exponent;
	frexpl(x, &exponent);
	return exponent;
}

/* x 2^exponent. */
static inline num times_power(num x, long exponent)
{
	return scalbnl(x, (int)exponent);
}

/* Exactly, into an `exact` of num_exact_bits. */
static inline void to_mpfr(mpfr_ptr exact, num x)
{
	mpfr_set_ld(exact, x, MPFR_RNDN);
}

/* Rounded to nearest, ties to even, once: to subnormal numbers and infinity as well. */
static inline num from_mpfr(mpfr_srcptr x)
{
	return mpfr_get_ld(x, MPFR_RNDN);
}

#endif
