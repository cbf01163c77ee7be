/* What the arithmetics that the compiler itself computes in have in common. The including header gives `num`, a
 * floating-point type whose operations round to nearest even into that type and no wider one, and
 * `num_significand_bits`; the functions of the C library and of MPFR that go by a type's name are its own. */
#ifndef NUM_NATIVE_H
#define NUM_NATIVE_H

#include <math.h>
#include <stdbool.h>

#include "num/conversion.h"

/* Chooses the significand bits of this thread; false, changing nothing, when the arithmetic does not have them.
 * 0 stands for the only choice there is. */
static inline bool num_choose(int bits)
{
	return bits == 0 || bits == num_significand_bits;
}

/* Significand bits in force. */
static inline int num_bits(void)
{
	return num_significand_bits;
}

/* Bits that hold this number. */
static inline int num_exact_bits(num x)
{
	(void)x;
	return num_significand_bits;
}

/* Rounded to nearest, ties to even. */
static inline num from_double(double value)
{
	return (num)value;
}

/* Rounded to nearest, ties to even, once: to a subnormal double as well. */
static inline double to_double(num x)
{
	return (double)x;
}

static inline num add(num a, num b)
{
	return a + b;
}

static inline num sub(num a, num b)
{
	return a - b;
}

static inline num mul(num a, num b)
{
	return a * b;
}

static inline num divide(num a, num b)
{
	return a / b;
}

static inline num negated(num a)
{
	return -a;
}

/* Whether a < b; false when either is not a number. */
static inline bool less(num a, num b)
{
	return a < b;
}

static inline bool is_finite(num a)
{
	return isfinite(a);
}

#endif
