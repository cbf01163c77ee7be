/* Twice double precision with a bound that travels along. A number is high + low, with |low| <= u |high| where
 * u = 2^-53, and a bound on its distance from the true one; b, c, the discriminant and t are each made by a few of the
 * operations below. Sums and products of two doubles are split exactly (Knuth; Dekker and Veltkamp), so an operation
 * errs only by the roundings of its low parts and by the products of low parts that it leaves out. To first order:
 *
 *   x1 y1 + .. + xn yn, n <= 4: 16 u^2 S with S = |x1 y1| + .. + |xn yn|, bounded by 32. The rest is made of n errors
 * of products, of sum u S, and n - 1 errors of sums, each u S; at most n additions round each: n u n u S. x y: 8 u^2 |x
 * y|, bounded by 16. Left out xl yl: 1; roundings of xh yl and xl yh: 1 + 1; of their sum: 2; of adding the error of xh
 * yh: 3. x + y: 3 u^2 (|x| + |y|), bounded by 4. Rounding of xl + yl: 1; of adding the error of xh + yh: 2.
 *   sqrt(x): 5.2 u^2 sqrt(x), bounded by 8. y = sqrt(xh) rounded, then y + (x - y^2) / 2y. Roundings of the residual,
 *     2 + 3, halved by the division; of the quotient, at most 1.5 u: 1.5; Newton's remainder: (1.5 u)^2 / 2.
 *   x / y: 12 u^2 |x / y|, bounded by 16. q = xh / yh rounded, then q + (x - q y) / yh. Roundings of the residual,
 * whose first part xh - q yh is exact: adding xl: 2; q yl: 1; their difference: 3; yh for y: 3; of the quotient: 3.
 *
 * The errors E of the arguments are passed on: to x y, |x| Ey + |y| Ex + Ex Ey; to x + y, Ex + Ey; to sqrt(x),
 * |x~ - x| / (sqrt(x~) + sqrt(x)) <= Ex / sqrt(x~); to x / y, (Ex + |x~ / y~| Ey) / |y|, with |y| >= |y~| - Ey. Every
 * bound above exceeds its error by a fifth or more, and bounds only enter sums, products and quotients in which they
 * count upward: that fifth covers the rounding of the bounds themselves (under a hundred operations, each within
 * 1 + 2^-53), high written for high + low, and terms in u^3.
 *
 * Range: the filter looks only at numbers that are zero or of magnitude 2^-100 to 2^100. They are multiples of 2^-152.
 * Sums and products of multiples of a power of two, rounded or not, are multiples of it or of its square, so the sums
 * of products and their parts are multiples of 2^-304 and the discriminant's of 2^-608: exact or normal, never
 * underflowing. A positive discriminant has a root >= 2^-304, and t, as its quotients show, lies in 2^-510 to 2^510;
 * the products that are split for them are multiples of 2^-920. Only q yl and the quotient of a residual may underflow,
 * by 2^-1075, which is divided by no less than 2^-304 and so lies far below the bound of at least 2^-102 2^-510.
 * Nothing reaches 2^520, so nothing overflows. A bound is zero only for a number that was given or whose S is zero: it
 * is then exact. */
#include "oracle/filter.h"
#include <math.h>

enum sign { NEGATIVE = -1, ZERO = 0, POSITIVE = 1, UNSURE = 2 };

static bool in_range(size_t count, const double number[])
{
	bool all = true;
	for (size_t i = 0; i < count; i++) {
		double size = fabs(number[i]);
		all &= size == 0 || (size >= 0x1p-100 && size <= 0x1p100);
	}
	return all;
}

/* x + y = high + low exactly. */
static struct oracle_estimate exact_sum(double x, double y)
{
	double high = x + y, from_y = high - x;
	return (struct oracle_estimate){high, (x - (high - from_y)) + (y - from_y), 0};
}

static double upper_half(double x)
{
	double scaled = 0x8000001p0 * x;
	return scaled - (scaled - x);
}

/* x y = high + low exactly. */
static struct oracle_estimate exact_product(double x, double y)
{
	double high = x * y, x1 = upper_half(x), y1 = upper_half(y), x2 = x - x1, y2 = y - y1;
	return (struct oracle_estimate){high, ((x1 * y1 - high) + x1 * y2 + x2 * y1) + x2 * y2, 0};
}

static struct oracle_estimate dot(int count, const double x[], const double y[])
{
	double sum = 0, rest = 0, size = 0;
	for (int i = 0; i < count; i++) {
		struct oracle_estimate product = exact_product(x[i], y[i]);
		struct oracle_estimate next = exact_sum(sum, product.high);
		sum = next.high;
		rest += next.low + product.low;
		size += fabs(product.high);
	}
	struct oracle_estimate result = exact_sum(sum, rest);
	result.bound = 0x1p-101 * size;
	return result;
}

static struct oracle_estimate negate(struct oracle_estimate x)
{
	return (struct oracle_estimate){-x.high, -x.low, x.bound};
}

static struct oracle_estimate multiply(struct oracle_estimate x, struct oracle_estimate y)
{
	struct oracle_estimate product = exact_product(x.high, y.high);
	struct oracle_estimate result = exact_sum(product.high, product.low + (x.high * y.low + x.low * y.high));
	result.bound =
		0x1p-102 * fabs(product.high) + (fabs(x.high) * y.bound + fabs(y.high) * x.bound + x.bound * y.bound);
	return result;
}

static struct oracle_estimate add(struct oracle_estimate x, struct oracle_estimate y)
{
	struct oracle_estimate sum = exact_sum(x.high, y.high);
	struct oracle_estimate result = exact_sum(sum.high, sum.low + (x.low + y.low));
	result.bound = 0x1p-104 * (fabs(x.high) + fabs(y.high)) + (x.bound + y.bound);
	return result;
}

/* Of an x that is surely positive. */
static struct oracle_estimate root(struct oracle_estimate x)
{
	double first = sqrt(x.high);
	struct oracle_estimate square = exact_product(first, first);
	double residual = ((x.high - square.high) - square.low) + x.low;
	struct oracle_estimate result = exact_sum(first, residual / (2 * first));
	result.bound = 0x1p-103 * first + x.bound / first;
	return result;
}

/* By a y that is surely positive. */
static struct oracle_estimate divide(struct oracle_estimate x, struct oracle_estimate y)
{
	double first = x.high / y.high;
	struct oracle_estimate product = exact_product(first, y.high);
	double residual = (((x.high - product.high) - product.low) + x.low) - first * y.low;
	struct oracle_estimate result = exact_sum(first, residual / y.high);
	result.bound = 0x1p-102 * fabs(first) + (x.bound + fabs(first) * y.bound) / (y.high - y.bound);
	return result;
}

static enum sign sign(struct oracle_estimate x)
{
	if (fabs(x.high) > 2 * x.bound) return x.high > 0 ? POSITIVE : NEGATIVE;
	return x.bound == 0 ? ZERO : UNSURE;
}

static struct oracle_estimate discriminant(struct oracle_estimate a, struct oracle_estimate b, struct oracle_estimate c)
{
	return add(multiply(b, b), negate(multiply(a, c)));
}

/* The tables of oracle.h, over a t^2 + 2 b t + c with a >= 0; as in shapes.c, `meet` for the quadratic itself and
 * `part` for its negative. Each returns false where a sign that it needs is unsure. */
static bool meet(struct oracle_estimate a, struct oracle_estimate b, struct oracle_estimate c, struct oracle_time *time)
{
	enum sign of_b = sign(b), of_c = sign(c);
	time->event = ORACLE_NEVER;
	if (of_b == UNSURE) return false;
	if (of_b != NEGATIVE) return true;
	time->event = ORACLE_NOW;
	if (of_c == UNSURE) return false;
	if (of_c != POSITIVE) return true;
	struct oracle_estimate radicand = discriminant(a, b, c);
	enum sign of_radicand = sign(radicand);
	time->event = of_radicand == POSITIVE ? ORACLE_LATER : ORACLE_NEVER;
	if (of_radicand == POSITIVE) time->estimate = divide(c, add(negate(b), root(radicand)));
	return of_radicand != UNSURE;
}

static bool part(struct oracle_estimate a, struct oracle_estimate b, struct oracle_estimate c, struct oracle_time *time)
{
	enum sign of_b = sign(b), of_c = sign(c);
	time->event = ORACLE_NEVER;
	if (sign(a) == ZERO) return true;
	if (of_b == UNSURE) return false;
	time->event = ORACLE_NOW;
	if (of_b != NEGATIVE && of_c == UNSURE) return false;
	if (of_b != NEGATIVE && of_c != NEGATIVE) return true;
	time->event = ORACLE_LATER;
	struct oracle_estimate radicand = discriminant(a, b, c);
	enum sign of_radicand = sign(radicand);
	if (of_radicand == UNSURE) return false;
	if (of_radicand != POSITIVE)
		time->estimate = divide(negate(b), a);
	else if (of_b == NEGATIVE)
		time->estimate = divide(add(negate(b), root(radicand)), a);
	else
		time->estimate = divide(negate(c), add(b, root(radicand)));
	return true;
}

/* What a query asks: a t^2 + 2 b t + c, with a >= 0, and which of the two tables. */
struct quadratic {
	struct oracle_estimate a, b, c;
	bool parts;
};

static bool read_balls(const struct oracle_query *query, struct quadratic *asked)
{
	const double *r = query->ball.r, *v = query->ball.v, contact = query->ball.contact;
	if (!in_range(7, query->number)) return false;
	asked->a = dot(3, v, v);
	asked->b = dot(3, r, v);
	asked->c = dot(4, (double[4]){r[0], r[1], r[2], contact}, (double[4]){r[0], r[1], r[2], -contact});
	asked->parts = query->shape == ORACLE_BALL_LEAVE;
	return true;
}

static bool read_plane(const double number[4], struct quadratic *asked)
{
	if (!in_range(4, number)) return false;
	double speed = number[1], acceleration = number[2];
	struct oracle_estimate height = exact_sum(number[0], -number[3]);
	asked->a = (struct oracle_estimate){fabs(acceleration), 0, 0};
	asked->b = (struct oracle_estimate){speed, 0, 0};
	asked->c = (struct oracle_estimate){2 * height.high, 2 * height.low, 0};
	asked->parts = acceleration < 0;
	if (!asked->parts) return true;
	asked->b = negate(asked->b);
	asked->c = negate(asked->c);
	return true;
}

static bool read(const struct oracle_query *query, struct quadratic *asked)
{
	if (query->shape == ORACLE_BALL_BALL || query->shape == ORACLE_BALL_LEAVE) return read_balls(query, asked);
	if (query->shape == ORACLE_BALL_PLANE) return read_plane(query->number, asked);
	return read_plane((double[4]){query->plane.distance, query->plane.speed, 0, 0}, asked);
}

bool filter_solve(const struct oracle_query *query, struct oracle_time *time)
{
	struct quadratic asked;
	if (!read(query, &asked)) return false;
	return (asked.parts ? part : meet)(asked.a, asked.b, asked.c, time);
}

bool filter_signs(const struct oracle_query *query, int signs[ORACLE_SIGNS])
{
	struct quadratic asked;
	if (!read(query, &asked)) return false;
	const struct oracle_estimate value[ORACLE_SIGNS] = {asked.a, asked.b, asked.c,
														discriminant(asked.a, asked.b, asked.c)};
	for (int s = 0; s < ORACLE_SIGNS; s++)
		if ((signs[s] = sign(value[s])) == UNSURE) return false;
	return true;
}

/* high is the double nearest to high + low. The time lies strictly on one side of it, less than one step of the
 * doubles away, when low is farther from zero than all that is uncertain; 2^-104 high covers the additions here. */
bool filter_round(const struct oracle_estimate *estimate, mpfr_rnd_t direction, double *rounded)
{
	double high = estimate->high, uncertain = estimate->bound + 0x1p-104 * high;
	double least = estimate->low - uncertain, most = estimate->low + uncertain;
	bool above = least > 0, below = most < 0;
	*rounded = high;
	if (direction == MPFR_RNDN) return high + least == high && high + most == high;
	if (below && direction != MPFR_RNDU) *rounded = nextafter(high, 0);
	if (above && direction == MPFR_RNDU) *rounded = nextafter(high, INFINITY);
	return above || below;
}

/* The low parts lose at most u^2 of either time here; what else is lost is relative to the difference, and within the
 * fifth that the bounds have to spare. */
bool filter_compare(const struct oracle_estimate *first, const struct oracle_estimate *second, int *order)
{
	double difference = (first->high - second->high) + (first->low - second->low);
	double uncertain = first->bound + second->bound + 0x1p-102 * (first->high + fabs(second->high));
	*order = difference > 0 ? 1 : -1;
	return fabs(difference) > uncertain;
}

/* got - high is exact when they are within a factor of two of each other (Sterbenz), and otherwise within u, so the
 * difference is known within 3u and the estimate's own bound. */
bool filter_error(const struct oracle_estimate *estimate, double got, double *ulps)
{
	int exponent;
	bool binade_begins = frexp(estimate->high, &exponent) == 0.5;
	if (binade_begins && estimate->low + estimate->bound < 0)
		exponent--;
	else if (binade_begins && !(estimate->low - estimate->bound > 0))
		return false;
	double difference = fabs((got - estimate->high) - estimate->low);
	*ulps = ldexp(difference, 53 - exponent);
	return estimate->bound <= 0x1p-60 * estimate->high && difference * 0x1p-31 >= estimate->bound;
}
