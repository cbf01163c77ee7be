/* How far an answer is from the truth, for those who grade finders: in units in the last place, and as a distance. */
#include "oracle/exact.h"
#include "oracle/filter.h"
#include <math.h>

static long max(long x, long y)
{
	return x > y ? x : y;
}

static long min(long x, long y)
{
	return x < y ? x : y;
}

/* |got - surd| / ulp(surd), from as many digits as it takes for the difference to have 32 of its own. */
static double error_of(struct oracle *oracle, const struct surd *surd, double got)
{
	mpz_t *difference = &oracle->scratch[2], *answer = &oracle->scratch[3];
	long answer_unit = dyadic_read(1, &got, answer);
	for (long width = 2 * DIGITS;; width *= 2) {
		long unit;
		bool inexact = surd_digits(oracle, surd, width, oracle->digits, &unit);
		long ulp = max(unit + (long)mpz_sizeinbase(oracle->digits, 2) - 53, -1074);
		long common = min(unit, answer_unit);
		dyadic_shift(oracle->digits, unit - common);
		mpz_mul_2exp(*difference, *answer, (mp_bitcnt_t)(answer_unit - common));
		mpz_sub(*difference, *difference, oracle->digits);
		if (inexact && (long)mpz_sizeinbase(*difference, 2) < unit - common + 33) continue;
		return fabs(dyadic_to_double(*difference, common - ulp));
	}
}

double oracle_error(struct oracle *oracle, const struct oracle_time *time, double got)
{
	if (isnan(got)) return got;
	if (!isfinite(got)) return got == oracle_round(oracle, time, MPFR_RNDN) ? 0 : INFINITY;
	if (time->event == ORACLE_NEVER) return INFINITY;
	if (time->event == ORACLE_NOW) return ldexp(fabs(got), 1074);
	double ulps;
	if (!oracle->force_exact && filter_error(&time->estimate, got, &ulps)) return ulps;
	exact_solve(oracle, &time->query, &oracle->first);
	return error_of(oracle, &oracle->first, got);
}

/* |r + v t| - |contact| = ((r + v t)^2 - contact^2) / (|r + v t| + |contact|), the numerator exact. */
static double gap_of_balls(struct oracle *oracle, const struct oracle_query *query, double t)
{
	const double *r = query->ball.r;
	const double lengths[4] = {r[0], r[1], r[2], query->ball.contact};
	mpz_t *length = oracle->number, *speed = oracle->number + 4;
	mpz_t *time = &oracle->scratch[0], *numerator = &oracle->scratch[1], *denominator = &oracle->scratch[2];
	long length_unit = dyadic_read(4, lengths, length), flight_unit = dyadic_read(3, query->ball.v, speed);
	flight_unit += dyadic_read(1, &t, time);
	long unit = min(length_unit, flight_unit);
	dyadic_shift(*time, flight_unit - unit);
	for (int i = 0; i < 4; i++) dyadic_shift(length[i], length_unit - unit);
	mpz_set_ui(*denominator, 0);
	for (int axis = 0; axis < 3; axis++) {
		mpz_addmul(length[axis], speed[axis], *time);
		mpz_addmul(*denominator, length[axis], length[axis]);
	}
	mpz_set(*numerator, *denominator);
	mpz_submul(*numerator, length[3], length[3]);
	if (mpz_sgn(*numerator) == 0) return 0;

	/* The denominator to DIGITS bits more than a whole number. */
	dyadic_shift(*denominator, 2 * DIGITS);
	mpz_sqrt(*denominator, *denominator);
	mpz_abs(length[3], length[3]);
	dyadic_shift(length[3], DIGITS);
	mpz_add(*denominator, *denominator, length[3]);
	long scale, other_scale;
	double quotient = mpz_get_d_2exp(&scale, *numerator) / mpz_get_d_2exp(&other_scale, *denominator);
	return ldexp(quotient, (int)(unit + DIGITS + scale - other_scale));
}

/* sum += product 2^exponent, both in units of 2^unit; the unit becomes finer as needed. */
static void accumulate(mpz_t sum, long *unit, mpz_t product, long exponent)
{
	long common = min(*unit, exponent);
	dyadic_shift(sum, *unit - common);
	dyadic_shift(product, exponent - common);
	mpz_add(sum, sum, product);
	*unit = common;
}

/* distance - contact + speed t + acceleration t^2 / 2 */
static double gap_of_plane(struct oracle *oracle, const double number[4], double t)
{
	mpz_t *sum = &oracle->scratch[0], *time = &oracle->scratch[1], *term = &oracle->scratch[2];
	long unit = dyadic_read(1, &number[0], sum);
	long exponent = dyadic_read(1, &number[3], term);
	mpz_neg(*term, *term);
	accumulate(*sum, &unit, *term, exponent);
	long time_unit = dyadic_read(1, &t, time);
	exponent = dyadic_read(1, &number[1], term);
	mpz_mul(*term, *term, *time);
	accumulate(*sum, &unit, *term, exponent + time_unit);
	exponent = dyadic_read(1, &number[2], term);
	mpz_mul(*term, *term, *time);
	mpz_mul(*term, *term, *time);
	accumulate(*sum, &unit, *term, exponent + 2 * time_unit - 1);
	return dyadic_to_double(*sum, unit);
}

double oracle_gap(struct oracle *oracle, const struct oracle_query *query, double t)
{
	if (!isfinite(t)) return NAN;
	switch (query->shape) {
	case ORACLE_BALL_BALL:
	case ORACLE_BALL_LEAVE:
		return gap_of_balls(oracle, query, t);
	case ORACLE_BALL_PLANE:
		return gap_of_plane(oracle, query->number, t);
	case ORACLE_HALF_SPACE:
		break;
	}
	return gap_of_plane(oracle, (double[4]){query->plane.distance, query->plane.speed, 0, 0}, t);
}
