#include "method/exact_time.h"

void exact_time_open(struct exact_time *time)
{
	for (int i = 0; i < TOUCHSTONE_MOST_NUMBERS; i++) mpz_init(time->number[i].integer);
	mpz_inits(time->a.integer, time->b.integer, time->c.integer, time->discriminant.integer, time->scratch, NULL);
	mpfr_inits(time->low, time->high, time->least_sum, time->most_sum, NULL);
}

void exact_time_close(struct exact_time *time)
{
	for (int i = 0; i < TOUCHSTONE_MOST_NUMBERS; i++) mpz_clear(time->number[i].integer);
	mpz_clears(time->a.integer, time->b.integer, time->c.integer, time->discriminant.integer, time->scratch, NULL);
	mpfr_clears(time->low, time->high, time->least_sum, time->most_sum, NULL);
}

static void clear_number(struct exact_number *number)
{
	mpz_set_ui(number->integer, 0);
	number->exponent = 0;
}

/* Writes x with an odd integer, or as 0 2^0. */
static void read_number(struct exact_number *number, const mpfr_t x)
{
	clear_number(number);
	if (mpfr_zero_p(x)) return;
	number->exponent = mpfr_get_z_2exp(number->integer, x);
	mp_bitcnt_t zeros = mpz_scan1(number->integer, 0);
	mpz_tdiv_q_2exp(number->integer, number->integer, zeros);
	number->exponent += (long)zeros;
}

/* Gives numbers that are to be added the same exponent, and returns it. */
static long align(struct exact_number number[], int count)
{
	long least = 0;
	bool found = false;
	for (int i = 0; i < count; i++) {
		if (mpz_sgn(number[i].integer) == 0) continue;
		if (!found || number[i].exponent < least) least = number[i].exponent;
		found = true;
	}
	for (int i = 0; i < count; i++) {
		if (mpz_sgn(number[i].integer) != 0)
			mpz_mul_2exp(number[i].integer, number[i].integer, (mp_bitcnt_t)(number[i].exponent - least));
		number[i].exponent = least;
	}
	return least;
}

/* Lengths come first, so that they can be aligned: position, contact distance, velocity. */
static const int ball_slots[] = {0, 1, 2, 4, 5, 6, 3};

static void form_balls(struct exact_time *time)
{
	struct exact_number *length = time->number, *speed = time->number + 4;
	long length_unit = align(length, 4), speed_unit = align(speed, 3);
	mpz_set_ui(time->a.integer, 0);
	mpz_set_ui(time->b.integer, 0);
	mpz_set_ui(time->c.integer, 0);
	for (int axis = 0; axis < 3; axis++) {
		mpz_addmul(time->a.integer, speed[axis].integer, speed[axis].integer);
		mpz_addmul(time->b.integer, length[axis].integer, speed[axis].integer);
		mpz_addmul(time->c.integer, length[axis].integer, length[axis].integer);
	}
	mpz_submul(time->c.integer, length[3].integer, length[3].integer);
	time->a.exponent = 2 * speed_unit;
	time->b.exponent = speed_unit + length_unit;
	time->c.exponent = 2 * length_unit;
}

static void refine(struct exact_number *number, long bits)
{
	mpz_mul_2exp(number->integer, number->integer, (mp_bitcnt_t)bits);
	number->exponent -= bits;
}

/* Distance, contact distance, speed, acceleration. */
static const int plane_slots[] = {0, 2, 3, 1};

static void form_plane(struct exact_time *time)
{
	struct exact_number *number = time->number;
	long length_unit = align(number, 2);
	mpz_set(time->a.integer, number[3].integer);
	mpz_set(time->b.integer, number[2].integer);
	mpz_sub(time->c.integer, number[0].integer, number[1].integer);
	time->a.exponent = number[3].exponent;
	time->b.exponent = number[2].exponent;
	time->c.exponent = length_unit + 1; /* 2 gap */

	/* Exponents such that b^2 and a c have the same. */
	long excess = time->a.exponent + time->c.exponent - 2 * time->b.exponent;
	if (excess % 2 != 0) refine(&time->c, 1), excess--;
	if (excess > 0) refine(&time->a, excess);
	if (excess < 0) refine(&time->b, -excess / 2);
}

static enum exact_event meeting(const struct exact_time *time)
{
	if (mpz_sgn(time->b.integer) >= 0) return EXACT_NEVER;
	if (mpz_sgn(time->c.integer) <= 0) return EXACT_NOW;
	return mpz_sgn(time->discriminant.integer) > 0 ? EXACT_LATER : EXACT_NEVER;
}

static enum exact_event parting(const struct exact_time *time)
{
	if (mpz_sgn(time->a.integer) == 0) return EXACT_NEVER;
	return mpz_sgn(time->b.integer) >= 0 && mpz_sgn(time->c.integer) >= 0 ? EXACT_NOW : EXACT_LATER;
}

void exact_time_decide(struct exact_time *time, enum touchstone_shape shape, mpfr_t number[])
{
	bool balls = shape == TOUCHSTONE_BALL_BALL || shape == TOUCHSTONE_BALL_LEAVE;
	int given = balls ? 7 : shape == TOUCHSTONE_BALL_PLANE ? 4 : 2;
	for (int i = 0; i < given; i++) read_number(&time->number[balls ? ball_slots[i] : plane_slots[i]], number[i]);
	if (shape == TOUCHSTONE_HALF_SPACE) /* no contact distance, no acceleration */
		clear_number(&time->number[1]), clear_number(&time->number[3]);
	if (balls)
		form_balls(time);
	else
		form_plane(time);
	time->turned = mpz_sgn(time->a.integer) < 0;
	time->parts = shape == TOUCHSTONE_BALL_LEAVE || time->turned;
	if (time->turned) {
		mpz_neg(time->a.integer, time->a.integer);
		mpz_neg(time->b.integer, time->b.integer);
		mpz_neg(time->c.integer, time->c.integer);
	}
	mpz_mul(time->discriminant.integer, time->b.integer, time->b.integer);
	mpz_submul(time->discriminant.integer, time->a.integer, time->c.integer);
	time->discriminant.exponent = 2 * time->b.exponent;
	time->event = time->parts ? parting(time) : meeting(time);
}

/* |b| + sqrt(discriminant), or only |b| where that is negative, rounded one way. */
static void sum_of_roots(struct exact_time *time, mpfr_t sum, mpfr_t work, mpfr_rnd_t direction)
{
	mpz_abs(time->scratch, time->b.integer);
	mpfr_set_z(sum, time->scratch, direction);
	if (mpz_sgn(time->discriminant.integer) <= 0) return;
	mpfr_set_z(work, time->discriminant.integer, direction);
	mpfr_sqrt(work, work, direction);
	mpfr_add(sum, sum, work, direction);
}

void exact_time_enclose(struct exact_time *time, mpfr_prec_t precision)
{
	mpfr_ptr low = time->low, high = time->high, least = time->least_sum, most = time->most_sum;
	mpfr_set_prec(low, precision);
	mpfr_set_prec(high, precision);
	mpfr_set_prec(least, precision);
	mpfr_set_prec(most, precision);
	sum_of_roots(time, least, low, MPFR_RNDD);
	sum_of_roots(time, most, high, MPFR_RNDU);
	if (time->parts && mpz_sgn(time->b.integer) <= 0) { /* (-b + sqrt(discriminant)) / a */
		mpfr_set_z(low, time->a.integer, MPFR_RNDU);
		mpfr_set_z(high, time->a.integer, MPFR_RNDD);
		mpfr_div(low, least, low, MPFR_RNDD);
		mpfr_div(high, most, high, MPFR_RNDU);
	} else { /* |c| / (|b| + sqrt(discriminant)) */
		mpz_abs(time->scratch, time->c.integer);
		mpfr_set_z(low, time->scratch, MPFR_RNDD);
		mpfr_set_z(high, time->scratch, MPFR_RNDU);
		mpfr_div(low, low, most, MPFR_RNDD);
		mpfr_div(high, high, least, MPFR_RNDU);
	}
	long unit = time->c.exponent - time->b.exponent;
	mpfr_mul_2si(low, low, unit, MPFR_RNDD);
	mpfr_mul_2si(high, high, unit, MPFR_RNDU);
}
