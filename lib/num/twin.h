/* The arithmetic "twin": a number is the unevaluated sum of two doubles, some 106 bits together.
 *
 * The algorithms and their numbers are those of Joldes, Muller and Popescu, "Tight and rigorous error bounds for basic
 * building blocks of double-word arithmetic", ACM Transactions on Mathematical Software 44(2), 2017; the square root
 * is by Lefevre, Louvet, Muller, Picot and Rideau, "Accurate calculation of Euclidean norms using double-word
 * arithmetic", the same journal, 49(1), 2023. Their relative error bounds, in units of u^2 with u = 2^-53 and
 * u^2 = 2^-106, hold as long as nothing overflows and nothing below 2^-968 (2^106 times the smallest double) is met.
 *
 * Every result is normalised: `high` is the sum rounded to nearest even, `low` the rest. */
#ifndef NUM_TWIN_H
#define NUM_TWIN_H

#include <float.h>
#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <string.h>

#include "num/conversion.h"
#include "num/error_free.h"

typedef struct two num;

static const char num_name[] = "twin";
enum { num_largest_exponent = DBL_MAX_EXP };
#define NUM_HAS_SUM_REST /* the sums below are not those of sum_rest.inl */

/* Chooses the significand bits of this thread; false, changing nothing, when the arithmetic does not have them.
 * 0 stands for the only choice there is. */
static inline bool num_choose(int bits)
{
	return bits == 0 || bits == 2 * DBL_MANT_DIG;
}

/* Significand bits in force. */
static inline int num_bits(void)
{
	return 2 * DBL_MANT_DIG;
}

static inline num from_double(double value)
{
	return (num){value, 0};
}

/* Rounded to nearest even, as the normalised form already is. */
static inline double to_double(num x)
{
	return x.high;
}

/* The result, unless it is a zero, whose sign the algorithms lose, or beyond the range, where they make differences of
 * infinities: then what the same operation gives on the high parts alone. */
static inline num num_settled(num result, double high_alone)
{
	bool regular = fabs(result.high) > 0 && fabs(result.high) <= DBL_MAX;
	return (num){regular ? result.high : high_alone, regular ? result.low : 0};
}

/* Error at most 3 u^2 + 13 u^3, whatever cancels (algorithm 6, AccurateDWPlusDW, theorem 3.1). */
static inline num add(num a, num b)
{
	num high = two_sum(a.high, b.high);
	num low = two_sum(a.low, b.low);
	num sum = two_sum_ordered(high.high, high.low + low.high);
	return num_settled(two_sum_ordered(sum.high, low.low + sum.low), high.high);
}

static inline num negated(num a)
{
	return (num){-a.high, -a.low};
}

/* As add. */
static inline num sub(num a, num b)
{
	return add(a, negated(b));
}

/* Error at most 5 u^2 (algorithm 10, DWTimesDW1; theorem 5.1 has 7 u^2, and Muller and Rideau, "Formalization of
 * double-word arithmetic, and comments on ...", the same journal, 48(1), 2022, sharpen it to 5). Algorithm 12 does
 * with 4 but is not commutative, and a product must not depend on which of two particles is called the first. */
static inline num mul(num a, num b)
{
	num high = two_product(a.high, b.high);
	double cross = a.high * b.low + a.low * b.high;
	return num_settled(two_sum_ordered(high.high, high.low + cross), high.high);
}

/* Error at most 15 u^2 + 56 u^3 (algorithm 17, DWDivDW2, theorem 7.1): one step from the quotient of the high parts,
 * whose product with the divisor is algorithm 7, DWTimesFP1. */
static inline num divide(num a, num b)
{
	double quotient = a.high / b.high;
	num high = two_product(b.high, quotient);
	num partial = two_sum_ordered(high.high, b.low * quotient);
	num product = two_sum_ordered(partial.high, partial.low + high.low);
	double rest = (a.high - product.high) + (a.low - product.low);
	return num_settled(two_sum_ordered(quotient, rest / b.high), quotient);
}

/* Error at most 25/8 u^2 (Lefevre and others, algorithm 8, SQRTDWtoDW): one step from the root of the high part. */
static inline num root(num a)
{
	double high = sqrt(a.high);
	double rest = a.low + fma(-high, high, a.high);
	return num_settled(two_sum_ordered(high, rest / (2 * high)), high);
}

static inline num magnitude(num a)
{
	return a.high < 0 ? negated(a) : a;
}

/* Whether a < b; false when either is not a number. */
static inline bool less(num a, num b)
{
	return (a.high < b.high) | ((a.high == b.high) & (a.low < b.low));
}

static inline bool is_finite(num a)
{
	return isfinite(a.high);
}

/* To be kept: a number is two words of 64 bits, its doubles, the high one first. */
enum { num_words_are_doubles = 1 };

static inline int num_words(void)
{
	return 2;
}

static inline void to_words(num x, uint64_t *words)
{
	memcpy(words, &x.high, sizeof x.high);
	memcpy(words + 1, &x.low, sizeof x.low);
}

/* False when the words are those of no number of this arithmetic. */
static inline bool from_words(const uint64_t *words, num *x)
{
	memcpy(&x->high, words, sizeof x->high);
	memcpy(&x->low, words + 1, sizeof x->low);
	return isfinite(x->high) ? x->high + x->low == x->high : x->low == 0;
}

/* The sum of a few doubles, which it overwrites, as a twin: passes of exact sums (VecSum) sift the rounding errors
 * downward; after four of them what the last, plain sum errs by lies below 2^-212 of the terms that came in. */
static inline num num_sifted(double *term, int count)
{
	for (int pass = 0; pass < 4; pass++)
		for (int i = 1; i < count; i++) {
			struct two sum = two_sum(term[i], term[i - 1]);
			term[i] = sum.high, term[i - 1] = sum.low;
		}
	double rest = 0;
	for (int i = 0; i + 1 < count; i++) rest += term[i];
	return two_sum(term[count - 1], rest);
}

/* a + b - sum, to the precision of a twin. */
static inline num sum_rest(num a, num b, num sum)
{
	double term[6] = {a.low, b.low, -sum.low, a.high, b.high, -sum.high};
	return num_settled(num_sifted(term, 6), 0);
}

/* a b - product, to the precision of a twin. */
static inline num product_rest(num a, num b, num product)
{
	num high = two_product(a.high, b.high), one = two_product(a.high, b.low), other = two_product(a.low, b.high);
	num low = two_product(a.low, b.low);
	double term[10] = {low.low,  one.low,    other.low,    low.high,  high.low,
					   one.high, other.high, -product.low, high.high, -product.high};
	return num_settled(num_sifted(term, 10), 0);
}

/* a b + c as if rounded once: the product is taken with its rest. */
static inline num fused(num a, num b, num c)
{
	num product = mul(a, b), rest = product_rest(a, b, product), sum = add(product, c);
	return add(sum, add(rest, sum_rest(product, c, sum)));
}

/* The high part is f 2^exponent with 1/2 <= |f| < 1; 0 for zero. */
static inline long exponent_of(num x)
{
	int exponent;
	frexp(x.high, &exponent);
	return exponent;
}

/* x 2^exponent. */
static inline num times_power(num x, long exponent)
{
	return (num){scalbn(x.high, (int)exponent), scalbn(x.low, (int)exponent)};
}

/* Bits that hold this number: the parts may lie as far apart as the exponents of doubles. */
static inline int num_exact_bits(num x)
{
	return x.low == 0 ? DBL_MANT_DIG : DBL_MANT_DIG + 1 + (int)(exponent_of(x) - ilogb(x.low) + DBL_MANT_DIG);
}

#ifndef TOUCHSTONE_WITHOUT_MPFR
/* Exactly, into an `exact` of num_exact_bits. */
static inline void to_mpfr(mpfr_ptr exact, num x)
{
	mpfr_set_d(exact, x.high, MPFR_RNDN);
	mpfr_add_d(exact, exact, x.low, MPFR_RNDN);
}

/* The double nearest to x and the double nearest to the rest, ties to even. */
static inline num from_mpfr(mpfr_srcptr x)
{
	double high = mpfr_get_d(x, MPFR_RNDN);
	if (!isfinite(high) || high == 0) return (num){high, 0};
	mpfr_t rest;
	mpfr_init2(rest, mpfr_get_prec(x) + DBL_MANT_DIG);
	mpfr_sub_d(rest, x, high, MPFR_RNDN);
	double low = mpfr_get_d(rest, MPFR_RNDN);
	mpfr_clear(rest);
	return (num){high, low};
}
#endif

#endif
