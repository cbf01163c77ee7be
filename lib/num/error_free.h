/* Sums and products of two doubles without error: the rounded result and what its rounding left out.
 *
 * The names in brackets are those of Joldes, Muller and Popescu, "Tight and rigorous error bounds for basic building
 * blocks of double-word arithmetic", ACM Transactions on Mathematical Software 44(2), 2017. All hold to nearest, as
 * long as nothing overflows and, for products, the rest does not underflow. The fused multiply-add is asked of
 * the C library, which computes it exactly in software where the processor has no instruction for it. */
#ifndef NUM_ERROR_FREE_H
#define NUM_ERROR_FREE_H

#include <float.h>
#include <math.h>

_Static_assert(FLT_EVAL_METHOD == 0, "double operations must round to double, not to something wider");

/* The unevaluated sum high + low. */
struct two {
	double high;
	double low;
};

/* a + b exactly (algorithm 2, 2Sum). */
static inline __attribute__((always_inline)) struct two two_sum(double a, double b)
{
	double sum = a + b;
	double b_part = sum - a;
	double a_part = sum - b_part;
	return (struct two){sum, (a - a_part) + (b - b_part)};
}

/* The same where |a| >= |b| or a is 0 (algorithm 1, Fast2Sum). */
static inline __attribute__((always_inline)) struct two two_sum_ordered(double a, double b)
{
	double sum = a + b;
	return (struct two){sum, b - (sum - a)};
}

/* a b exactly (algorithm 3, 2Prod). */
static inline __attribute__((always_inline)) struct two two_product(double a, double b)
{
	double product = a * b;
	return (struct two){product, fma(a, b, -product)};
}

#endif
