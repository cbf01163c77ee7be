/* What the arithmetics that the compiler itself computes in have in common. The including header gives `num`, a
 * floating-point type whose operations round to nearest even into that type and no wider one, and
 * `num_significand_bits`; the functions of the C library and of MPFR that go by a type's name are its own. */
#ifndef NUM_NATIVE_H
#define NUM_NATIVE_H

#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <string.h>

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

/* To be kept: its bytes as they stand in memory. A long double has ten of them. */
enum { num_bytes = num_significand_bits == 64 ? 10 : (int)sizeof(num), num_words_are_doubles = num_bytes == 8 };

/* Words of 64 bits that keep any number. */
static inline int num_words(void)
{
	return (num_bytes + 7) / 8;
}

static inline void to_words(num x, uint64_t *words)
{
	memset(words, 0, (size_t)num_words() * sizeof *words);
	memcpy(words, &x, num_bytes);
}

/* False when the words are those of no number of this arithmetic. */
static inline bool from_words(const uint64_t *words, num *x)
{
	uint64_t again[2];
	*x = 0;
	memcpy(x, words, num_bytes);
	to_words(*x, again);
	if (num_bytes == 10 && words[0] >> 63 != ((words[1] & 0x7fff) != 0)) return false; /* no processor makes such */
	return memcmp(again, words, (size_t)num_words() * sizeof *words) == 0;
}

#endif
