/* Pairs that pass each other at the contact distance, and balls that turn back just at the plane: the discriminant is
 * zero, or all but zero. Source: 2014 paper, after eq. 10 (a glancing touch is no event); the near-double roots on
 * which published quadratic solvers fail most (Goualard's trials of QuadraticEquation.jl).
 *
 * A frame of whole vectors e, f, orthogonal and of the same whole length, gives exact tangents in any direction:
 * contact distance s |e|, r = s e - t f, v = w f. The impact parameter is the contact distance, whatever t and w. */
#include <math.h>

#include "family/draw.h"
#include "family/make.h"

/* Frames of 6 bits have components below 2^14, so that the whole numbers s, t below 2^37 keep r within 2^52, and w
 * below 2^39 keeps v within 2^53. */
static void exact_tangent(struct random_state *random, double *r, double *v, double *contact)
{
	struct draw_frame frame = draw_frame(random, 6);
	int64_t s = draw_whole(random, 37), t = draw_whole(random, 37), w = draw_whole(random, 39);
	for (int axis = 0; axis < 3; axis++) {
		r[axis] = (double)(s * frame.axis[0][axis] - t * frame.axis[1][axis]);
		v[axis] = (double)(w * frame.axis[1][axis]);
	}
	*contact = (double)(s * frame.length);
}

/* At any angle, with rounded coordinates: the tangent is good to a few ulp. */
static void rounded_tangent(struct random_state *random, double *r, double *v, double *contact)
{
	double aside[3];
	do {
		draw_vector(random, v);
		draw_vector(random, aside);
		r[0] = v[1] * aside[2] - v[2] * aside[1];
		r[1] = v[2] * aside[0] - v[0] * aside[2];
		r[2] = v[0] * aside[1] - v[1] * aside[0];
	} while (draw_dot(r, r) < 0x1p-6 || draw_dot(v, v) < 0x1p-6);
	*contact = sqrt(draw_dot(r, r));
	double flight = 4 * draw_uniform(random);
	for (int axis = 0; axis < 3; axis++) r[axis] -= v[axis] * flight;
}

/* speed^2 = 2 acceleration h exactly: x y, y^2 and x^2 / 2, of 26 bits each. The contact distance is added exactly. A
 * ball pushed away touches; one pulled in starts below the plane and its peak is just there. */
static void exact_turn(struct random_state *random, double *number)
{
	int64_t x = draw_whole(random, 26), y = draw_whole(random, 26);
	int64_t contact = draw_chance(random, 2) ? 0 : draw_whole(random, 51); /* in units of x^2 / 2 too */
	double pull = draw_chance(random, 2) ? 1 : -1;
	number[0] = pull > 0 ? (double)(2 * contact + x * x) : (double)(2 * contact - x * x);
	number[1] = -pull * (double)(x * y);
	number[2] = pull * (double)(y * y);
	number[3] = (double)(2 * contact);
	number[0] /= 2;
	number[3] /= 2;
}

/* Lengths and speeds each on a scale of their own, some 2^20 apart. */
static void scale_balls(struct random_state *random, double *number)
{
	int length = draw_between(random, -20, 0) - ilogb(number[6]), speed = draw_between(random, -70, -30);
	draw_shift(number, 3, length);
	draw_shift(number + 3, 3, speed);
	draw_shift(number + 6, 1, length);
}

static void scale_plane(struct random_state *random, double *number)
{
	int length = draw_between(random, -60, -30), speed = draw_between(random, -60, -30);
	draw_shift(number, 1, length);
	draw_shift(number + 1, 1, speed);
	draw_shift(number + 2, 1, 2 * speed - length);
	draw_shift(number + 3, 1, length);
}

/* b^2 = ac exactly. */
void make_double_root(enum touchstone_shape shape, struct random_state *random, uint64_t index, double *number)
{
	(void)index;
	if (shape == TOUCHSTONE_BALL_PLANE) {
		exact_turn(random, number);
		scale_plane(random, number);
	} else {
		exact_tangent(random, number, number + 3, number + 6);
		scale_balls(random, number);
	}
}

/* From 1 to 2^24 ulp off the tangent: even questions hit, odd ones miss. Only where the tangent itself is rounded may a
 * few ulp go the other way. */
void make_grazing(enum touchstone_shape shape, struct random_state *random, uint64_t index, double *number)
{
	int64_t steps = draw_chance(random, 2) ? 1 : draw_steps(random, 24);
	int64_t into = index % 2 == 0 ? steps : -steps;
	if (shape == TOUCHSTONE_BALL_PLANE) {
		exact_turn(random, number);
		scale_plane(random, number);
		number[2] = copysign(draw_stepped(fabs(number[2]), -into), number[2]); /* less push or pull: it comes through */
		return;
	}
	if (draw_chance(random, 2)) {
		exact_tangent(random, number, number + 3, number + 6);
		scale_balls(random, number);
	} else {
		rounded_tangent(random, number, number + 3, number + 6);
	}
	number[6] = draw_stepped(number[6], into);
}
