#include "fuzz/mutate.h"

#include <math.h>
#include <string.h>

#include "family/draw.h"
#include "store/query_file.h"

enum { X = 0, VX = 3, CONTACT = 6 };                      /* of balls */
enum { DISTANCE, SPEED, ACCELERATION, CONTACT_OF_PLANE }; /* of a plane */
enum { DOUBLE_BITS = 53, FARTHEST = 1000, FINE = 24 };

static bool of_balls(enum touchstone_shape shape)
{
	return shape == TOUCHSTONE_BALL_BALL || shape == TOUCHSTONE_BALL_LEAVE;
}

static size_t choose(struct random_state *random, size_t count)
{
	return (size_t)(random_bits(random) >> 32) * count >> 32;
}

/* Another bit of the significand. */
static double with_a_flip(struct random_state *random, double number)
{
	uint64_t bits;
	memcpy(&bits, &number, sizeof bits);
	bits ^= UINT64_C(1) << choose(random, DOUBLE_BITS - 1);
	memcpy(&number, &bits, sizeof number);
	return number;
}

static double rescaled(struct random_state *random, double number, int most)
{
	return ldexp(number, draw_between(random, -most, most));
}

static double near(struct random_state *random, double number, unsigned bits)
{
	if (number == 0) return draw_sign(random, 0x1p-1074);
	int64_t steps = draw_steps(random, bits);
	return copysign(draw_stepped(fabs(number), random_bits(random) >> 63 ? steps : -steps), number);
}

/* Fewer bits: round numbers are where finders' comparisons are with zero. */
static double rounder(struct random_state *random, double number)
{
	int exponent, bits = draw_between(random, 1, 12);
	double significand = frexp(number, &exponent);
	return ldexp(trunc(ldexp(significand, bits)), exponent - bits);
}

/* Balls whose distance is the contact distance but for a few units; or that graze but for a few; or that meet head on
 * from afar. */
static void place_balls(struct random_state *random, double *number)
{
	double *r = number + X, *v = number + VX;
	size_t along = choose(random, 3), across = (along + 1 + choose(random, 2)) % 3;
	switch (choose(random, 3)) {
	case 0:
		number[CONTACT] = near(random, sqrt(draw_dot(r, r)), FINE);
		break;
	case 1: {
		double speed = v[along] == 0 ? 1 : v[along], away = r[along] == 0 ? 1 : r[along];
		memset(v, 0, 3 * sizeof *v);
		memset(r, 0, 3 * sizeof *r);
		v[along] = speed;
		r[along] = copysign(away, -speed);
		r[across] = near(random, number[CONTACT], 40);
		break;
	}
	default:
		for (int axis = 0; axis < 3; axis++) v[axis] = -r[axis];
	}
}

/* A ball at the plate but for a few units; or that reaches it but for a few. */
static void place_over_plane(struct random_state *random, double *number)
{
	if (choose(random, 2)) {
		number[DISTANCE] = near(random, number[CONTACT_OF_PLANE], FINE);
	} else {
		double gap = number[DISTANCE] - number[CONTACT_OF_PLANE], speed = number[SPEED];
		if (gap != 0) number[ACCELERATION] = near(random, speed * speed / (2 * gap), FINE);
	}
}

static void change(enum touchstone_shape shape, struct random_state *random, double *number)
{
	size_t count = shape_numbers(shape), one = choose(random, count), other = choose(random, count);
	double kept = number[one];
	switch (choose(random, 13)) {
	case 0:
	case 1:
		number[one] = with_a_flip(random, kept);
		break;
	case 2:
		number[one] = rescaled(random, kept, 4);
		break;
	case 3:
		number[one] = rescaled(random, kept, 100);
		break;
	case 4:
		number[one] = number[other];
		break;
	case 5:
		number[one] = number[other];
		number[other] = kept;
		break;
	case 6:
		number[one] = 0;
		break;
	case 7:
		number[one] = -kept;
		break;
	case 8:
		number[one] = draw_sign(random, 1);
		break;
	case 9:
		number[one] = near(random, kept, 8);
		break;
	case 10:
		number[one] = rounder(random, kept);
		break;
	default:
		if (of_balls(shape))
			place_balls(random, number);
		else if (shape == TOUCHSTONE_BALL_PLANE)
			place_over_plane(random, number);
		else
			number[one] = near(random, kept, FINE);
	}
	for (size_t n = 0; n < count; n++)
		if (!isfinite(number[n])) number[n] = kept;
}

void fuzz_mutate(enum touchstone_shape shape, struct random_state *random, double number[TOUCHSTONE_MOST_NUMBERS])
{
	size_t changes = 1 + choose(random, 3);
	for (size_t k = 0; k < changes; k++) change(shape, random, number);
}

void fuzz_nudge(enum touchstone_shape shape, struct random_state *random, double number[TOUCHSTONE_MOST_NUMBERS])
{
	size_t which = choose(random, shape_numbers(shape));
	number[which] = near(random, number[which], 4);
	if (!isfinite(number[which])) number[which] = 1;
}

void fuzz_fit(enum touchstone_shape shape, int bits, double number[TOUCHSTONE_MOST_NUMBERS])
{
	for (size_t n = 0; bits < DOUBLE_BITS && n < shape_numbers(shape); n++) {
		int exponent;
		double significand = frexp(number[n], &exponent);
		number[n] = ldexp(trunc(ldexp(significand, bits)), exponent - bits);
		if (bits == 24 && number[n] != (double)(float)number[n]) number[n] = 1;
	}
}
