/* The arithmetic "short:P": every result of binary64 is rounded once more, to P bits, 4 <= P <= 25.
 *
 * Rounding twice gives the same as rounding the exact result to P bits once, for + - * / and the square root, because
 * 53 >= 2P + 2 (Figueroa, "When is double rounding innocuous?", SIGNUM Newsletter 30(3), 1995).
 * The exponents are those of binary64, with gradual underflow to multiples of 2^(-1021 - P); there, and only there, a
 * product may be rounded twice when P > 17, because it can have bits that the first rounding drops. */
#ifndef NUM_SHORT_H
#define NUM_SHORT_H

#include <float.h>
#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <string.h>

#include "num/conversion.h"

_Static_assert(FLT_EVAL_METHOD == 0, "double operations must round to double, not to something wider");

typedef double num;
#define NUM_ROUNDS_DOUBLES

static const char num_name[] = "short";
enum { num_largest_exponent = DBL_MAX_EXP };

/* The working precision of this thread, kept as a processor keeps its rounding mode in a register; 24 bits until it
 * is chosen. It is stored in the form that rounding wants. */
static _Thread_local struct {
	uint64_t below_half; /* of a unit in the last place kept, less one unit of binary64 */
	uint64_t kept;       /* the bits of a double that may be set */
	int dropped;         /* how many may not */
} num_rounding = {.below_half = (UINT64_C(1) << 28) - 1, .kept = ~UINT64_C(0) << 29, .dropped = 29};

/* Chooses the significand bits of this thread; false, changing nothing, when the arithmetic does not have them. */
static inline bool num_choose(int bits)
{
	if (bits < 4 || bits > 25) return false;
	num_rounding.dropped = DBL_MANT_DIG - bits;
	num_rounding.below_half = (UINT64_C(1) << (num_rounding.dropped - 1)) - 1;
	num_rounding.kept = ~UINT64_C(0) << num_rounding.dropped;
	return true;
}

/* Significand bits in force. */
static inline int num_bits(void)
{
	return DBL_MANT_DIG - num_rounding.dropped;
}

/* To nearest, ties to even. A double's exponent stands above its significand, so that one integer addition rounds
 * the magnitude and carries into the exponent, up to infinity. Infinity stays, having nothing to round, and so does a
 * NaN of which only the top significand bit is set: no other comes out of from_double, nor out of an operation. */
static inline num num_rounded(double value)
{
	uint64_t word;
	memcpy(&word, &value, sizeof word);
	word += num_rounding.below_half + (word >> num_rounding.dropped & 1);
	word &= num_rounding.kept;
	memcpy(&value, &word, sizeof value);
	return value;
}

/* Whether a double lies half way between two numbers. If the double nearest to something does not, its rounding is that
 * of the thing itself. */
static inline bool num_half_way(double value)
{
	uint64_t word;
	memcpy(&word, &value, sizeof word);
	return (word & (2 * num_rounding.below_half + 1)) == num_rounding.below_half + 1;
}

/* Rounded to nearest, ties to even. */
static inline num from_double(double value)
{
	return num_rounded(isnan(value) ? NAN : value);
}

static inline double to_double(num x)
{
	return x;
}

static inline num add(num a, num b)
{
	return num_rounded(a + b);
}

static inline num sub(num a, num b)
{
	return num_rounded(a - b);
}

static inline num mul(num a, num b)
{
	return num_rounded(a * b);
}

static inline num divide(num a, num b)
{
	return num_rounded(a / b);
}

static inline num root(num a)
{
	return num_rounded(sqrt(a));
}

static inline num negated(num a)
{
	return -a;
}

static inline num magnitude(num a)
{
	return fabs(a);
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

/* To be kept: a number is a word of 64 bits, a double. */
enum { num_words_are_doubles = 1 };

static inline int num_words(void)
{
	return 1;
}

static inline void to_words(num x, uint64_t *words)
{
	memcpy(words, &x, sizeof x);
}

/* False when the words are those of no number of this arithmetic. */
static inline bool from_words(const uint64_t *words, num *x)
{
	double value;
	memcpy(&value, words, sizeof value);
	*x = from_double(value);
	return memcmp(x, words, sizeof *x) == 0;
}

/* a b + c, rounded once, unless a b underflows. The product is a double; the sum is rounded to odd, which keeps what a
 * second rounding must know of the bits it dropped. */
static inline num fused(num a, num b, num c)
{
	double product = a * b, sum = product + c, c_part = sum - product;
	double rest = (product - (sum - c_part)) + (c - c_part);
	uint64_t word;
	memcpy(&word, &sum, sizeof word);
	if (rest != 0 && isfinite(sum) && !(word & 1)) sum = nextafter(sum, rest > 0 ? INFINITY : -INFINITY);
	return num_rounded(sum);
}

/* What the rounding of a product left out, exactly unless it underflows: a double holds the whole product. */
static inline num product_rest(num a, num b, num product)
{
	return a * b - product;
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
	return num_rounded(scalbn(x, (int)exponent));
}

/* Bits that hold this number. */
static inline int num_exact_bits(num x)
{
	(void)x;
	return DBL_MANT_DIG;
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
	if (!mpfr_regular_p(x)) return mpfr_get_d(x, MPFR_RNDN);
	double sign = mpfr_signbit(x) ? -1 : 1, smallest = ldexp(1, DBL_MIN_EXP - num_bits());
	long below = DBL_MIN_EXP - mpfr_get_exp(x), bits = num_bits() - (below > 0 ? below : 0);
	if (bits < 0) return sign * 0;
	if (bits == 0)
		return mpfr_min_prec(x) > 1 ? sign * smallest : sign * 0; /* above half the smallest number, or half */
	mpfr_t kept;
	mpfr_init2(kept, bits);
	mpfr_set(kept, x, MPFR_RNDN);
	double result = mpfr_get_d(kept, MPFR_RNDN);
	mpfr_clear(kept);
	return result;
}
#endif

#endif
