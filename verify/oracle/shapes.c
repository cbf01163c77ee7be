/* From a query to its time. Every shape is a quadratic a t^2 + 2 b t + c with a >= 0, in units of a power of two, and
 * one of two tables: `meet` where the quadratic itself is the overlap function, `part` where its negative is. A ball
 * that is accelerated away from a plane, or not at all, meets it as balls meet; one accelerated towards it parts from
 * the region above it. */
#include "oracle/exact.h"
#include <assert.h>
#include <math.h>

/* |r + v t|^2 - contact^2, with t in units of 2^(the returned exponent). */
static long read_balls(struct oracle *oracle, const struct oracle_query *query)
{
	const double *r = query->ball.r;
	const double lengths[4] = {r[0], r[1], r[2], query->ball.contact};
	mpz_t *length = oracle->number, *speed = oracle->number + 4;
	long length_unit = dyadic_read(4, lengths, length);
	long speed_unit = dyadic_read(3, query->ball.v, speed);
	mpz_set_ui(oracle->a, 0);
	mpz_set_ui(oracle->b, 0);
	mpz_set_ui(oracle->c, 0);
	for (int axis = 0; axis < 3; axis++) {
		mpz_addmul(oracle->a, speed[axis], speed[axis]);
		mpz_addmul(oracle->b, length[axis], speed[axis]);
		mpz_addmul(oracle->c, length[axis], length[axis]);
	}
	mpz_submul(oracle->c, length[3], length[3]);
	return length_unit - speed_unit;
}

/* acceleration t^2 + 2 speed t + 2 h, or its negative so that a >= 0, in the same manner. */
static long read_plane(struct oracle *oracle, double distance, double speed, double acceleration, double contact)
{
	double turn = acceleration < 0 ? -1 : 1;
	const double lengths[2] = {turn * distance, turn * contact};
	const double turned_speed = turn * speed, size = fabs(acceleration);
	long length_unit = dyadic_read(2, lengths, oracle->number) + 1; /* 2 h */
	long speed_unit = dyadic_read(1, &turned_speed, &oracle->b);
	long acceleration_unit = dyadic_read(1, &size, &oracle->a);
	mpz_sub(oracle->c, oracle->number[0], oracle->number[1]);

	/* With t in units of length_unit / speed_unit, only the first term has another unit than the others. */
	long excess = acceleration_unit + length_unit - 2 * speed_unit;
	if (excess >= 0) {
		dyadic_shift(oracle->a, excess);
	} else {
		dyadic_shift(oracle->b, -excess);
		dyadic_shift(oracle->c, -excess);
	}
	return length_unit - speed_unit;
}

static void find_discriminant(struct oracle *oracle)
{
	mpz_mul(oracle->discriminant, oracle->b, oracle->b);
	mpz_submul(oracle->discriminant, oracle->a, oracle->c);
}

static long bits(const mpz_t x)
{
	return (long)mpz_sizeinbase(x, 2);
}

static long max(long x, long y)
{
	return x > y ? x : y;
}

static enum oracle_event meet(struct oracle *oracle, struct surd *surd)
{
	if (mpz_sgn(oracle->b) >= 0) return ORACLE_NEVER;
	if (mpz_sgn(oracle->c) <= 0) return ORACLE_NOW;
	find_discriminant(oracle);
	if (mpz_sgn(oracle->discriminant) <= 0) return ORACLE_NEVER;

	/* The root of the discriminant is at least 0 and, but for a = 0, less than -b: c / -2b < t <= c / -b. */
	surd->magnitude = bits(oracle->c) - bits(oracle->b) - 2;
	surd->sign = -1;
	mpz_neg(surd->rational, oracle->b);
	if (mpz_sgn(oracle->a) > 0) {
		mpz_set(surd->radicand, oracle->discriminant);
		mpz_set(surd->divisor, oracle->a);
	} else { /* c / -2b */
		mpz_mul_2exp(surd->divisor, surd->rational, 1);
		mpz_set(surd->rational, oracle->c);
		mpz_set_ui(surd->radicand, 0);
	}
	return ORACLE_LATER;
}

static enum oracle_event part(struct oracle *oracle, struct surd *surd)
{
	if (mpz_sgn(oracle->a) == 0) return ORACLE_NEVER;
	if (mpz_sgn(oracle->b) >= 0 && mpz_sgn(oracle->c) >= 0) return ORACLE_NOW;
	find_discriminant(oracle);
	if (mpz_sgn(oracle->discriminant) < 0) mpz_set_ui(oracle->discriminant, 0); /* leaves -b / a */

	/* |b| + sqrt(discriminant) lies between 2^shortest and 2^(shortest + 2). */
	long shortest = max(bits(oracle->b) - 1, (bits(oracle->discriminant) - 1) / 2);
	if (mpz_sgn(oracle->b) <= 0)
		surd->magnitude = shortest - bits(oracle->a);
	else /* t = -c / (b + sqrt(discriminant)) */
		surd->magnitude = bits(oracle->c) - 1 - (shortest + 2);
	surd->sign = 1;
	mpz_neg(surd->rational, oracle->b);
	mpz_set(surd->radicand, oracle->discriminant);
	mpz_set(surd->divisor, oracle->a);
	return ORACLE_LATER;
}

/* Fills a, b and c; returns the exponent of the unit of time. */
static long read_query(struct oracle *oracle, const struct oracle_query *query)
{
	assert(oracle_accepts(query)); /* the filter accepts no others */
	if (query->shape == ORACLE_BALL_BALL || query->shape == ORACLE_BALL_LEAVE) return read_balls(oracle, query);
	bool accelerated = query->shape == ORACLE_BALL_PLANE;
	return read_plane(oracle, query->plane.distance, query->plane.speed, accelerated ? query->plane.acceleration : 0,
					  accelerated ? query->plane.contact : 0);
}

enum oracle_event exact_solve(struct oracle *oracle, const struct oracle_query *query, struct surd *surd)
{
	oracle->exact_count++;
	surd->exponent = read_query(oracle, query);
	bool parts =
		query->shape == ORACLE_BALL_LEAVE || (query->shape == ORACLE_BALL_PLANE && query->plane.acceleration < 0);
	return parts ? part(oracle, surd) : meet(oracle, surd);
}

void exact_signs(struct oracle *oracle, const struct oracle_query *query, int signs[ORACLE_SIGNS])
{
	oracle->exact_count++;
	read_query(oracle, query);
	find_discriminant(oracle);
	signs[0] = mpz_sgn(oracle->a);
	signs[1] = mpz_sgn(oracle->b);
	signs[2] = mpz_sgn(oracle->c);
	signs[3] = mpz_sgn(oracle->discriminant);
}

double oracle_graze(struct oracle *oracle, const struct oracle_query *query)
{
	long scale, other_scale;
	read_query(oracle, query);
	find_discriminant(oracle);
	mpz_mul(oracle->scratch[0], oracle->b, oracle->b);
	if (mpz_sgn(oracle->b) == 0) return INFINITY;
	double ratio = mpz_get_d_2exp(&scale, oracle->discriminant) / mpz_get_d_2exp(&other_scale, oracle->scratch[0]);
	return fabs(ldexp(ratio, (int)(scale - other_scale)));
}
