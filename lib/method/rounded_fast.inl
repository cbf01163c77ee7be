/* The fast path of `rounded` in binary64: the time in twice the precision, with a bound on its error, and a test
 * whether every number within the bound rounds to the same double. Where it cannot tell, or anything is near the ends
 * of the range, the answer is a NaN, and the exact path is asked. There is not one branch, so that loops over questions
 * become vectors where the machine has a multiply-add.
 *
 * A number is high + low, known to `error`. With u = 2^-53, to first order (h, l: high and low part, |l| <= u |h|
 * unless said otherwise; an exact sum or product is one of num/error_free.h):
 *
 *   x1 y1 + .. + xn yn, n <= 4: n^2 u^2 S, S = |x1 y1| + .. + |xn yn|. The n errors of products and n - 1 of sums are
 *     each at most u S and pass n roundings on their way into the low part. Bound 32 u^2 S.
 *   b^2: 4 u^2 b^2 (left out l^2: 1, rounding: 3). a c: 6 u^2 |a c| (left out: 1, roundings: 2 + 3). Their difference:
 *     7 u^2 (b^2 + |a c|) (roundings: 3 for the low parts, 4 with the error of the sum). Together 13 u^2 (b^2 + |a c|),
 *     bound 16 of them. Passed on: 2 |b| Eb + Eb^2 + |a| Ec + |c| Ea + Ea Ec, where the squares are covered by what the
 *     bounds of the sums have to spare: Eb is twice what was proven, and below |b| wherever it matters.
 *   sqrt(x): y = sqrt(h) rounded, then y + (x - y^2) / 2y. Roundings of the residual, at most 3 u: 1.5 u^2 y; of the
 *     reciprocal and the product: 3; what Newton leaves: (3 u)^2 / 8. Together 5.7 u^2 y; |l| <= 1.5 u y. Passed on:
 *     Ex / y, as both roots are above y / 2 where x > 2 Ex.
 *   |b| + sqrt: two roundings of the low part, 1.5 and 2.5 u^2; with the root's own, 9.7, bound 16; |l| <= 2.5 u h.
 *   x / y with |l| <= 2.5 u h in both: q = xh (1 / yh), 2 u off; q + (x - q y) / yh. The residual is at most 7 u;
 *     roundings: 2 where xh - q yh is not exact, 5, 7; the quotient is 4.5 u off, of 7 u: 31.5. Together 45.5 u^2 q,
 *     bound 64; what is spared covers the roundings of the test, 2 u^2. Passed on: (Ex + q Ey) / y; Ey / y is at most
 *     2 u wherever the test can succeed.
 *
 * Every bound exceeds its error by a fifth or more, and bounds only enter sums and products that count upward: that
 * covers their own roundings and the terms in u^3.
 *
 * Range: S is required to be 2^-200 to 2^200 for a, b and c, where underflows add at most some 2^-1070 to a bound of
 * at least 2^-301. Signs are only trusted if the number is above twice its error, so b^2 and a c are above 2^-602 and
 * the discriminant, where trusted, is above 2^-702; times lie in 2^-504 to 2^502. Nothing else underflows that matters,
 * and nothing overflows. The numbers of a plane are zero or 2^-100 to 2^100 each and its a, b and c are exact. */

#include "num/error_free.h"

struct known {
	double high, low, error;
};

/* A sum of products on the way: what it is, what its roundings left out, and the sum of the magnitudes. */
struct running {
	double sum, rest, size;
};

static inline __attribute__((always_inline)) struct running first_product(double x, double y)
{
	struct two product = two_product(x, y);
	return (struct running){product.high, product.low, fabs(product.high)};
}

static inline __attribute__((always_inline)) struct running plus_product(struct running before, double x, double y)
{
	struct two product = two_product(x, y), sum = two_sum(before.sum, product.high);
	return (struct running){sum.high, before.rest + (sum.low + product.low), before.size + fabs(product.high)};
}

static inline __attribute__((always_inline)) struct running running_dot(const double x[3], const double y[3])
{
	return plus_product(plus_product(first_product(x[0], y[0]), x[1], y[1]), x[2], y[2]);
}

static inline __attribute__((always_inline)) struct known total(struct running running)
{
	struct two sum = two_sum(running.sum, running.rest);
	return (struct known){sum.high, sum.low, 0x1p-101 * running.size};
}

static inline __attribute__((always_inline)) struct known known_discriminant(struct known a, struct known b,
																			 struct known c)
{
	struct two square = two_product(b.high, b.high), product = two_product(a.high, c.high);
	double square_low = fma(2 * b.high, b.low, square.low);
	double product_low = fma(a.high, c.low, fma(a.low, c.high, product.low));
	struct two difference = two_sum(square.high, -product.high);
	struct two result = two_sum(difference.high, difference.low + (square_low - product_low));
	double own = 0x1p-102 * (square.high + fabs(product.high));
	double passed = 2 * fabs(b.high) * b.error + (fabs(a.high) * c.error + fabs(c.high) * a.error);
	return (struct known){result.high, result.low, own + passed};
}

/* |b| + sqrt(discriminant), or |b| where that is surely not positive. */
static inline __attribute__((always_inline)) struct known known_sum(struct known b, struct known discriminant)
{
	bool real = discriminant.high > 0;
	double radicand = real ? discriminant.high : 1, first = sqrt(radicand), half = 0.5 / first;
	double residual = fma(-first, first, radicand) + discriminant.low;
	double high = real ? first : 0, low = real ? residual * half : 0, error = real ? 2 * half * discriminant.error : 0;
	double b_high = fabs(b.high), b_low = b.high < 0 ? -b.low : b.low;
	struct two sum = two_sum(b_high, high);
	return (struct known){sum.high, sum.low + (low + b_low), 0x1p-102 * sum.high + (b.error + error)};
}

/* The double nearest to x / y, both positive; NaN where that is not known. */
static inline __attribute__((always_inline)) double known_quotient(struct known x, struct known y)
{
	double reciprocal = 1 / y.high, first = x.high * reciprocal;
	double residual = fma(-first, y.high, x.high) + fma(-first, y.low, x.low);
	struct two quotient = two_sum_ordered(first, residual * reciprocal);
	double error = 0x1p-100 * first + (x.error + first * y.error) * reciprocal;
	bool same = (quotient.high + (quotient.low - error) == quotient.high) &
				(quotient.high + (quotient.low + error) == quotient.high);
	return same ? quotient.high : NAN;
}

/* Truth in these is an int: & and | are meant, and no branch. */
static inline __attribute__((always_inline)) int negative(struct known x)
{
	return x.high < -2 * x.error;
}

static inline __attribute__((always_inline)) int positive(struct known x)
{
	return x.high > 2 * x.error;
}

/* Not positive, and not negative: an x that is known exactly may be zero. */
static inline __attribute__((always_inline)) int at_most_zero(struct known x)
{
	return x.high <= -2 * x.error;
}

static inline __attribute__((always_inline)) int at_least_zero(struct known x)
{
	return x.high >= 2 * x.error;
}

/* The rule of stable_meeting(), and NaN where a sign or a rounding is unsure. */
static inline __attribute__((always_inline)) double fast_meeting(struct known a, struct known b, struct known c,
																 struct quadratic *f)
{
	struct known discriminant = known_discriminant(a, b, c);
	*f = (struct quadratic){a.high, b.high, c.high, discriminant.high};
	double time = known_quotient(c, known_sum(b, discriminant));
	int comes = negative(b), outside = comes & positive(c);
	int never = at_least_zero(b) | (outside & at_most_zero(discriminant));
	time = (outside & positive(discriminant)) ? time : NAN;
	time = never ? INFINITY : time;
	return (comes & at_most_zero(c)) ? 0 : time;
}

/* The rule of stable_parting(). */
static inline __attribute__((always_inline)) double fast_parting(struct known a, struct known b, struct known c,
																 struct quadratic *f)
{
	struct known discriminant = known_discriminant(a, b, c);
	*f = (struct quadratic){a.high, b.high, c.high, discriminant.high};
	int comes = negative(b), goes = at_least_zero(b);
	struct known sum = known_sum(b, discriminant), fall = {-c.high, -c.low, c.error};
	struct known over = {comes ? sum.high : fall.high, comes ? sum.low : fall.low, comes ? sum.error : fall.error};
	struct known under = {comes ? a.high : sum.high, comes ? a.low : sum.low, comes ? a.error : sum.error};
	double time = known_quotient(over, under);
	int settled = positive(a) & (positive(discriminant) | (comes & at_most_zero(discriminant)));
	time = (settled & (comes | (goes & negative(c)))) ? time : NAN;
	return (goes & at_least_zero(c) & positive(a)) ? 0 : time;
}

static inline __attribute__((always_inline)) int middling(double size)
{
	return (size >= 0x1p-200) & (size <= 0x1p200);
}

static inline __attribute__((always_inline)) double fast_balls(bool part, const struct balls *balls,
															   struct quadratic *f)
{
	struct running vv = running_dot(balls->v, balls->v), rv = running_dot(balls->r, balls->v);
	struct running rr = plus_product(running_dot(balls->r, balls->r), balls->contact, -balls->contact);
	struct known a = total(vv), b = total(rv), c = total(rr);
	double time = part ? fast_parting(a, b, c, f) : fast_meeting(a, b, c, f);
	return (middling(vv.size) & middling(rv.size) & middling(rr.size)) ? time : NAN;
}

static inline __attribute__((always_inline)) int zero_or_near(double x)
{
	return (x == 0) | ((fabs(x) >= 0x1p-100) & (fabs(x) <= 0x1p100));
}

static inline __attribute__((always_inline)) double fast_plane(const struct flight *flight, struct quadratic *f)
{
	double speed = flight->speed, acceleration = flight->acceleration;
	struct two gap = two_sum(flight->distance, -flight->contact);
	bool falls = acceleration < 0;
	struct known a = {fabs(acceleration), 0, 0}, b = {falls ? -speed : speed, 0, 0};
	struct known c = {falls ? -2 * gap.high : 2 * gap.high, falls ? -2 * gap.low : 2 * gap.low, 0};
	double time = falls ? fast_parting(a, b, c, f) : fast_meeting(a, b, c, f);
	*f = (struct quadratic){acceleration, speed, gap.high, f->discriminant};
	int near = zero_or_near(flight->distance) & zero_or_near(flight->contact) & zero_or_near(speed) &
			   zero_or_near(acceleration);
	return near ? time : NAN;
}
