/* Numbers of very different sizes, and sizes at which squares leave the range of doubles. Source: the trials of
 * QuadraticEquation.jl (Goualard), where unscaled solvers fail on 20 to 30 % of draws over all exponents. */
#include <math.h>

#include "family/draw.h"
#include "family/make.h"
#include "store/query_file.h"

/* The exponent of the largest of `count` numbers. */
static int largest_exponent(const double *number, int count)
{
	double largest = 0;
	for (int i = 0; i < count; i++) largest = fmax(largest, fabs(number[i]));
	return largest > 0 ? ilogb(largest) : 0;
}

/* A pair of which one is aimed at the other: v = -(r + contact x), with components of x below `spread`. Below 1/sqrt(3)
 * it always hits, as far as rounding lets it. */
static void aimed(struct random_state *random, double contact, double spread, double *number)
{
	double *r = number, *v = number + 3, aside[3], reach = fmin(contact, 1);
	do draw_vector(random, r);
	while (draw_dot(r, r) < 0x1p-4);
	draw_vector(random, aside);
	for (int axis = 0; axis < 3; axis++) v[axis] = -(r[axis] + reach * spread * aside[axis]);
	number[6] = contact;
}

/* Brings the largest component of r to 2^length and that of v to 2^speed; the contact distance goes with r. */
static void size_balls(double *number, int length, int speed)
{
	int shift = length - largest_exponent(number, 3);
	draw_shift(number, 3, shift);
	draw_shift(number + 6, 1, shift);
	draw_shift(number + 3, 3, speed - largest_exponent(number + 3, 3));
}

/* Height above contact, speed and acceleration of these sizes, of any sign; the contact distance is zero, or of the
 * height's size. */
static void size_plane(struct random_state *random, double *number, int length, int speed, int acceleration)
{
	number[0] = draw_scaled(random, length, length);
	number[1] = draw_scaled(random, speed, speed);
	number[2] = draw_chance(random, 8) ? 0 : draw_scaled(random, acceleration, acceleration);
	number[3] = draw_chance(random, 2) ? 0 : fabs(draw_scaled(random, length, length));
	if (draw_chance(random, 2)) number[1] = -fabs(number[1]);
}

/* Position, velocity and diameter each anywhere from 2^-240 to 2^240: no product of four of them leaves the range. */
void make_scale_ratios(enum touchstone_shape shape, struct random_state *random, uint64_t index, double *number)
{
	(void)index;
	int length = draw_between(random, -240, 240), speed = draw_between(random, -240, 240);
	switch (shape) {
	case TOUCHSTONE_BALL_BALL:
	case TOUCHSTONE_BALL_LEAVE:
		aimed(random, fabs(draw_scaled(random, -240 - length, 240 - length)), 0.75, number);
		size_balls(number, length, speed);
		break;
	case TOUCHSTONE_BALL_PLANE:
		size_plane(random, number, length, speed, draw_between(random, -240, 240));
		if (number[3] != 0) number[3] = fabs(draw_scaled(random, -240, 240));
		break;
	case TOUCHSTONE_HALF_SPACE:
		size_plane(random, number, length, speed, 0);
		break;
	}
}

/* Plane: speeds of 2^speed, lengths on any scale from `least` on which the acceleration that goes with them, speed^2
 * over length, is a double. */
static void plane_of_speed(struct random_state *random, double *number, int speed)
{
	int least = 2 * speed - 1000, most = 2 * speed + 1000;
	int length = draw_between(random, least > -1000 ? least : -1000, most < 1000 ? most : 1000);
	size_plane(random, number, length, speed, 2 * speed - length);
}

/* One or both of r.r and v.v overflow, or only (r.v)^2 does. */
void make_overflow(enum touchstone_shape shape, struct random_state *random, uint64_t index, double *number)
{
	(void)index;
	if (shape == TOUCHSTONE_BALL_PLANE) {
		plane_of_speed(random, number, draw_between(random, 512, 990));
		return;
	}
	int length = draw_between(random, 512, 1000), speed = draw_between(random, 512, 1000);
	int which = draw_between(random, 0, 3);
	if (which == 0) length = draw_between(random, -500, 500);
	if (which == 1) speed = draw_between(random, -500, 500);
	if (which == 2) length = draw_between(random, 260, 500), speed = draw_between(random, 260, 500);
	aimed(random, draw_uniform(random), which == 2 ? 0.25 : 0.75, number);
	size_balls(number, length, speed);
}

/* One or both of r.r and v.v underflow to zero, or only (r.v)^2 does. */
void make_underflow(enum touchstone_shape shape, struct random_state *random, uint64_t index, double *number)
{
	(void)index;
	if (shape == TOUCHSTONE_BALL_PLANE) {
		plane_of_speed(random, number, draw_between(random, -990, -540));
		return;
	}
	int length = draw_between(random, -1000, -540), speed = draw_between(random, -1000, -540);
	int which = draw_between(random, 0, 3);
	if (which == 0) length = draw_between(random, -500, 500);
	if (which == 1) speed = draw_between(random, -500, 500);
	if (which == 2) length = draw_between(random, -500, -275), speed = draw_between(random, -500, -275);
	aimed(random, draw_uniform(random), 0.75, number);
	size_balls(number, length, speed);
}

/* Lengths, speeds or both below the smallest normal double, with 1 to 52 bits left. */
void make_subnormal(enum touchstone_shape shape, struct random_state *random, uint64_t index, double *number)
{
	(void)index;
	int length = draw_between(random, -1074, -1023), speed = draw_between(random, -1074, -1023);
	int which = draw_between(random, 0, 2);
	switch (shape) {
	case TOUCHSTONE_BALL_BALL:
	case TOUCHSTONE_BALL_LEAVE:
		if (which == 0) length = draw_between(random, -500, 500);
		if (which == 1) speed = draw_between(random, -500, 500);
		aimed(random, draw_uniform(random), 0.75, number);
		size_balls(number, length, speed);
		break;
	case TOUCHSTONE_BALL_PLANE:
		size_plane(random, number, length, speed, draw_between(random, -1074, -1023));
		if (which == 0) number[2] = ldexp(number[2], draw_between(random, 0, 1000));
		if (which == 1) number[1] = ldexp(number[1], draw_between(random, 0, 1000));
		break;
	case TOUCHSTONE_HALF_SPACE:
		if (which == 0) length = draw_between(random, -500, 500);
		if (which == 1) speed = draw_between(random, -500, 500);
		size_plane(random, number, length, speed, 0);
		break;
	}
}

/* Later than 2^25 for certain: aimed well within contact, or out of a well at least twice as wide as the way gone. Some
 * take 2^1000. */
void make_huge_times(enum touchstone_shape shape, struct random_state *random, uint64_t index, double *number)
{
	(void)index;
	int length = draw_between(random, 0, 20), speed = draw_between(random, -240, -30);
	switch (shape) {
	case TOUCHSTONE_BALL_BALL:
		aimed(random, 0.25 * draw_uniform(random), 0.5, number); /* |r| > 1/4 */
		if (number[6] < 0x1p-45) number[6] = 0x1p-45;            /* so that rounding v does not make it miss */
		size_balls(number, length, speed);
		break;
	case TOUCHSTONE_BALL_LEAVE:
		aimed(random, 4 * draw_significand(random), 0.5, number); /* |r| < sqrt(3) */
		size_balls(number, length, speed);
		break;
	case TOUCHSTONE_BALL_PLANE:
		number[3] = draw_chance(random, 2) ? 0 : fabs(draw_scaled(random, length, length));
		number[0] = number[3] * 2 + fabs(draw_scaled(random, length, length));
		number[1] = -fabs(draw_scaled(random, speed, speed));
		number[2] = draw_chance(random, 2) ? 0 : -fabs(draw_scaled(random, -6, 0));
		draw_shift(&number[2], 1, 2 * speed - length);
		break;
	case TOUCHSTONE_HALF_SPACE:
		number[0] = fabs(draw_scaled(random, 0, 100));
		number[1] = -fabs(draw_scaled(random, -900, -30));
		break;
	}
}

/* Ordinary questions in which some numbers, at least one, are replaced by a zero of either sign. */
void make_zeros(enum touchstone_shape shape, struct random_state *random, uint64_t index, double *number)
{
	(void)index;
	unsigned count = (unsigned)shape_numbers(shape);
	int speed = draw_between(random, -2, 2), acceleration = draw_between(random, -2, 2);
	if (count == 7)
		aimed(random, draw_uniform(random), 0.75, number);
	else
		size_plane(random, number, 0, speed, acceleration);
	uint64_t zeros = draw_chance(random, 2) ? UINT64_C(1) << random_below(random, count)
											: 1 + random_below(random, (UINT64_C(1) << count) - 1);
	for (unsigned i = 0; i < count; i++)
		if (zeros >> i & 1) number[i] = draw_sign(random, 0);
}

/* Any finite doubles at all: random significands over random exponents. Nearly always one term is all that counts, so
 * that a finder without a fault here has not proved much. */
void make_patterns(enum touchstone_shape shape, struct random_state *random, uint64_t index, double *number)
{
	(void)index;
	(void)shape;
	for (int i = 0; i < TOUCHSTONE_MOST_NUMBERS; i++) number[i] = draw_pattern(random);
	number[6] = fabs(number[6]);
}
