/* The arithmetic "twin": a number is the unevaluated sum of two doubles, some 106 bits together.
 *
 * The algorithms and their numbers are those of Joldes, Muller and Popescu, "Tight and rigorous error bounds for basic
 * building blocks of double-word arithmetic", ACM Transactions on Mathematical Software 44(2), 2017; the square root
 * is by Lefevre, Louvet, Muller, Picot and Rideau, "Accurate calculation of Euclidean norms using double-word
 * arithmetic", the same journal, 49(1), 2023. Their relative error bounds, in units of u^2 with u = 2^-53 and
 * u^2 = 2^-106, hold as long as nothing overflows and nothing below 2^-968 (2^106 times the smallest double) is met.
 *
 * Every result is normalised: `high` is the sum rounded to nearest even, `low` the rest. The fused multiply-add is
 * asked of the C library, which computes it exactly in software where the processor has no instruction for it. */
#ifndef NUM_TWIN_H
#define NUM_TWIN_H

#include <float.h>
#include <math.h>
#include <stdbool.h>

_Static_assert(FLT_EVAL_METHOD == 0, "double operations must round to double, not to something wider");

typedef struct {
	double high;
	double low;
} num;

static const char num_name[] = "twin";

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

/* The exact sum of two doubles (algorithm 2, 2Sum). */
static inline num num_sum(double a, double b)
{
	double sum = a + b;
	double b_part = sum - a;
	double a_part = sum - b_part;
	return (num){sum, (a - a_part) + (b - b_part)};
}

/* The same where |a| >= |b| or a is 0 (algorithm 1, Fast2Sum). */
static inline num num_sum_ordered(double a, double b)
{
	double sum = a + b;
	return (num){sum, b - (sum - a)};
}

/* The exact product of two doubles (algorithm 3, 2Prod). */
static inline num num_product(double a, double b)
{
	double product = a * b;
	return (num){product, fma(a, b, -product)};
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
	num high = num_sum(a.high, b.high);
	num low = num_sum(a.low, b.low);
	num sum = num_sum_ordered(high.high, high.low + low.high);
	return num_settled(num_sum_ordered(sum.high, low.low + sum.low), high.high);
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
	num high = num_product(a.high, b.high);
	double cross = a.high * b.low + a.low * b.high;
	return num_settled(num_sum_ordered(high.high, high.low + cross), high.high);
}

/* Error at most 15 u^2 + 56 u^3 (algorithm 17, DWDivDW2, theorem 7.1): one step from the quotient of the high parts,
 * whose product with the divisor is algorithm 7, DWTimesFP1. */
static inline num divide(num a, num b)
{
	double quotient = a.high / b.high;
	num high = num_product(b.high, quotient);
	num partial = num_sum_ordered(high.high, b.low * quotient);
	num product = num_sum_ordered(partial.high, partial.low + high.low);
	double rest = (a.high - product.high) + (a.low - product.low);
	return num_settled(num_sum_ordered(quotient, rest / b.high), quotient);
}

/* Error at most 25/8 u^2 (Lefevre and others, algorithm 8, SQRTDWtoDW): one step from the root of the high part. */
static inline num root(num a)
{
	double high = sqrt(a.high);
	double rest = a.low + fma(-high, high, a.high);
	return num_settled(num_sum_ordered(high, rest / (2 * high)), high);
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

#endif
