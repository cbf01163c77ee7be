/* rounded: the time of the stable rule, correctly rounded: to nearest even in the precision and the range of the
 * arithmetic, for all numbers it has, subnormal and huge ones included.
 *
 * Source: Touchstone's own. In binary64 a fast path (method/rounded_fast.inl) answers in twice the precision with a
 * proven bound and a rounding test (as Ziv, "Fast evaluation of elementary mathematical functions with correctly
 * rounded last bit", ACM Transactions on Mathematical Software 17(3), 1991); in short arithmetics that answer is
 * rounded once more, unless it lies half way between two numbers. What it leaves, and every other arithmetic, goes the
 * exact way: signs by integers, the time enclosed with more and more bits until both ends round alike. This ends: an
 * irrational time is never half way between two numbers, and a binary fraction is at last enclosed in itself.
 *
 * Bound: half a unit in the last place; no event missed, none invented. A question with a number that is not finite is
 * answered by NaN. Attained wherever a time lies half way between two numbers:
 *     half-space 0x1p-1074 -2 */

#if defined NUM_HAS_BATCHES || defined NUM_ROUNDS_DOUBLES
#define ROUNDED_IS_FAST
#include "method/rounded_fast.inl"

/* What the fast path's answer, the nearest double, says of the nearest number; NaN: nothing. */
static inline __attribute__((always_inline)) num rounded_fast(double time, struct quadratic *f)
{
#ifdef NUM_ROUNDS_DOUBLES
	if (num_half_way(time)) return NAN;
	*f = (struct quadratic){from_double(f->a), from_double(f->b), from_double(f->c), from_double(f->discriminant)};
	return from_double(time);
#else
	(void)f;
	return time;
#endif
}
#endif

/* number 2^-halvings, turned back if the quadratic was turned, in the working arithmetic. */
static num rounded_step(struct exact_time *time, const struct exact_number *number, int halvings)
{
	mpfr_set_prec(time->high, (mpfr_prec_t)mpz_sizeinbase(number->integer, 2) + 1);
	mpfr_set_z_2exp(time->high, number->integer, number->exponent - halvings, MPFR_RNDN);
	return from_mpfr(time->high);
}

static num rounded_later(struct exact_time *time)
{
	for (mpfr_prec_t precision = num_bits() + 32;; precision *= 2) {
		exact_time_enclose(time, precision);
		num least = from_mpfr(time->low), most = from_mpfr(time->high);
		if (!less(least, most)) return least;
	}
}

/* The exact way, for a question of `count` numbers in the order of touchstone.h. */
__attribute__((noinline)) static num rounded_exactly(enum touchstone_shape shape, int count, const num numbers[],
													 struct quadratic *f)
{
	struct exact_time time;
	mpfr_t exact[TOUCHSTONE_MOST_NUMBERS];
	num answer = from_double(INFINITY);
	for (int i = 0; i < count; i++)
		if (!is_finite(numbers[i])) return from_double(NAN);
	exact_time_open(&time);
	for (int i = 0; i < count; i++) {
		mpfr_init2(exact[i], num_exact_bits(numbers[i]));
		to_mpfr(exact[i], numbers[i]);
	}
	exact_time_decide(&time, shape, exact);
	bool plane = shape == TOUCHSTONE_BALL_PLANE || shape == TOUCHSTONE_HALF_SPACE;
	num a = rounded_step(&time, &time.a, 0), b = rounded_step(&time, &time.b, 0);
	num c = rounded_step(&time, &time.c, plane), discriminant = rounded_step(&time, &time.discriminant, 0);
	*f = (struct quadratic){a, b, c, discriminant};
	if (time.turned) *f = (struct quadratic){negated(a), negated(b), negated(c), discriminant};
	if (time.event == EXACT_NOW) answer = from_double(0);
	if (time.event == EXACT_LATER) answer = rounded_later(&time);
	for (int i = 0; i < count; i++) mpfr_clear(exact[i]);
	exact_time_close(&time);
	return answer;
}

static num rounded_balls_exactly(enum touchstone_shape shape, const struct balls *balls, struct quadratic *f)
{
	num numbers[7];
	for (int axis = 0; axis < 3; axis++) numbers[axis] = balls->r[axis], numbers[3 + axis] = balls->v[axis];
	numbers[6] = balls->contact;
	return rounded_exactly(shape, 7, numbers, f);
}

static inline __attribute__((always_inline)) num rounded_ball_ball(const struct balls *balls, struct quadratic *f)
{
#ifdef ROUNDED_IS_FAST
	num fast = rounded_fast(fast_balls(false, balls, f), f);
	if (!isnan(fast)) return fast;
#endif
	return rounded_balls_exactly(TOUCHSTONE_BALL_BALL, balls, f);
}

static inline __attribute__((always_inline)) num rounded_ball_leave(const struct balls *balls, struct quadratic *f)
{
#ifdef ROUNDED_IS_FAST
	num fast = rounded_fast(fast_balls(true, balls, f), f);
	if (!isnan(fast)) return fast;
#endif
	return rounded_balls_exactly(TOUCHSTONE_BALL_LEAVE, balls, f);
}

static inline __attribute__((always_inline)) num rounded_ball_plane(const struct flight *flight, struct quadratic *f)
{
#ifdef ROUNDED_IS_FAST
	num fast = rounded_fast(fast_plane(flight, f), f);
	if (!isnan(fast)) return fast;
#endif
	const num numbers[] = {flight->distance, flight->speed, flight->acceleration, flight->contact};
	return rounded_exactly(TOUCHSTONE_BALL_PLANE, 4, numbers, f);
}

/* In binary64 the one quotient of the stable rule is rounded correctly already. */
static inline num rounded_half_space(const struct passage *passage, struct quadratic *f)
{
#ifdef NUM_HAS_BATCHES
	if (isfinite(passage->distance) && isfinite(passage->speed)) return stable_half_space(passage, f);
#endif
	const num numbers[] = {passage->distance, passage->speed};
	return rounded_exactly(TOUCHSTONE_HALF_SPACE, 2, numbers, f);
}

static inline void rounded_claim(enum touchstone_shape shape, struct touchstone_claim *claim)
{
	(void)shape;
	*claim = (struct touchstone_claim){0, INFINITY, 0, 0.5, true, true, true, true};
	if (num_bits() > 53) claim->most_ulp = 0.5 + ldexp(1, 52 - num_bits()); /* rounded to double in the end */
}
