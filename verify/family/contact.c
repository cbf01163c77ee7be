/* Pairs about to touch, overlapping, on their way apart, or at rest. Source: the states that the papers show rounding
 * to leave behind (2014 paper, sections 2 and 3: contacts executed a little early or late, so that the pair is next
 * looked at a few ulp from contact on either side). */
#include <math.h>

#include "family/draw.h"
#include "family/make.h"

/* A pair in contact to within rounding, r and contact distance; then moved `side` (1: apart, -1: into each other) by
 * changing the contact distance. Half of them are multiples of whole vectors of whole length, for which contact is
 * exact and one step decides. For the others the computed |r| is off by at most 2.5 roundings, and four steps are
 * taken at least. */
static void near_touching(struct random_state *random, int side, double number[TOUCHSTONE_MOST_NUMBERS])
{
	double *r = number, *contact = &number[6];
	int64_t steps = draw_steps(random, 32);
	if (draw_chance(random, 2)) {
		struct draw_frame frame = draw_frame(random, 6);
		int64_t multiple = draw_whole(random, 39); /* times at most 4 * 63^2 < 2^14: below 2^53 */
		for (int axis = 0; axis < 3; axis++) r[axis] = (double)(frame.axis[0][axis] * multiple);
		*contact = (double)(frame.length * multiple);
		draw_shift(number, 7, -ilogb(*contact));
		if (side > 0 && draw_chance(random, 8)) steps = 0; /* touching exactly */
	} else {
		do draw_vector(random, r);
		while (draw_dot(r, r) < 0x1p-8);
		*contact = sqrt(draw_dot(r, r));
		steps += 4;
	}
	*contact = draw_stepped(*contact, -side * steps);
}

/* A velocity, three times in four an approaching one. */
static void draw_velocity(struct random_state *random, const double r[3], double v[3])
{
	draw_vector(random, v);
	if (draw_dot(r, v) > 0 && !draw_chance(random, 4))
		for (int axis = 0; axis < 3; axis++) v[axis] = -v[axis];
	draw_shift(v, 3, draw_between(random, -8, 8));
}

/* Speed and acceleration: as above; the acceleration toward the plane, away from it, or none. */
static void draw_fall(struct random_state *random, double *speed, double *acceleration)
{
	double parting = draw_chance(random, 4) ? 1 : -1, pushed = draw_chance(random, 3) ? 1 : -1;
	*speed = parting * fabs(draw_scaled(random, -20, 4));
	*acceleration = draw_chance(random, 4) ? 0 : pushed * fabs(draw_scaled(random, -4, 4));
}

static void make_beside_contact(enum touchstone_shape shape, struct random_state *random, int side, double *number)
{
	switch (shape) {
	case TOUCHSTONE_BALL_BALL:
	case TOUCHSTONE_BALL_LEAVE:
		near_touching(random, side, number);
		draw_velocity(random, number, number + 3);
		draw_shift(number, 7, draw_between(random, -8, 8));
		break;
	case TOUCHSTONE_BALL_PLANE:
		number[3] = fabs(draw_scaled(random, -4, 4));
		number[0] = draw_stepped(number[3], side * draw_steps(random, 32));
		draw_fall(random, &number[1], &number[2]);
		break;
	case TOUCHSTONE_HALF_SPACE:
		number[0] = side * fabs(draw_scaled(random, -80, -20));
		draw_fall(random, &number[1], &number[2]);
		break;
	}
}

/* Apart by 0 to 2^32 ulp. */
void make_near_contact(enum touchstone_shape shape, struct random_state *random, uint64_t index, double *number)
{
	(void)index;
	make_beside_contact(shape, random, 1, number);
}

/* Overlapping by 1 to 2^32 ulp. */
void make_just_overlapping(enum touchstone_shape shape, struct random_state *random, uint64_t index, double *number)
{
	(void)index;
	make_beside_contact(shape, random, -1, number);
}

/* r.v >= 0 exactly. Half have r.v = 0, or nearly so: v is a multiple of a vector orthogonal to r, and a little of r. */
static void receding_balls(struct random_state *random, double *r, double *v, double *contact)
{
	if (draw_chance(random, 2)) {
		struct draw_frame frame = draw_frame(random, 6);
		int64_t length = draw_whole(random, 39), speed = draw_whole(random, 38);
		int64_t apart = draw_chance(random, 4) ? 0 : draw_steps(random, 20);
		for (int axis = 0; axis < 3; axis++) {
			r[axis] = (double)(frame.axis[0][axis] * length);
			v[axis] = (double)(frame.axis[1][axis] * speed + frame.axis[0][axis] * apart);
		}
		draw_shift(r, 3, draw_between(random, -60, -40));
		draw_shift(v, 3, draw_between(random, -60, -40));
	} else {
		do {
			draw_vector(random, r);
			draw_vector(random, v);
		} while (fabs(draw_dot(r, v)) < 0x1p-40); /* the sign of what is computed is the true one */
		double turn = draw_dot(r, v) < 0 ? -1 : 1;
		for (int axis = 0; axis < 3; axis++) v[axis] *= turn;
		draw_shift(v, 3, draw_between(random, -8, 8));
	}
	*contact = sqrt(draw_dot(r, r)) * (0.5 + draw_uniform(random));
}

void make_receding(enum touchstone_shape shape, struct random_state *random, uint64_t index, double *number)
{
	(void)index;
	if (shape == TOUCHSTONE_BALL_BALL) {
		receding_balls(random, number, number + 3, number + 6);
		return;
	}
	double contact = shape == TOUCHSTONE_BALL_PLANE ? fabs(draw_scaled(random, -4, 4)) : 0;
	number[0] = contact + draw_scaled(random, -60, 4);
	number[1] = draw_chance(random, 8) ? 0 : fabs(draw_scaled(random, -60, 4));
	if (shape == TOUCHSTONE_HALF_SPACE) return;
	number[2] = draw_chance(random, 4) ? 0 : fabs(draw_scaled(random, -20, 4));
	number[3] = contact;
}

/* No velocity, its zeros of either sign; over a plane half of them are pulled or pushed. */
void make_at_rest(enum touchstone_shape shape, struct random_state *random, uint64_t index, double *number)
{
	(void)index;
	bool planar = shape == TOUCHSTONE_BALL_PLANE || shape == TOUCHSTONE_HALF_SPACE;
	if (planar) {
		number[0] = draw_scaled(random, -60, 4);
		number[1] = draw_sign(random, 0);
		if (shape == TOUCHSTONE_HALF_SPACE) return;
		number[2] = draw_chance(random, 2) ? draw_sign(random, 0) : draw_scaled(random, -20, 4);
		number[3] = fabs(draw_scaled(random, -4, 0));
		return;
	}
	near_touching(random, draw_chance(random, 2) ? 1 : -1, number);
	if (draw_chance(random, 2)) number[6] *= 2 * draw_uniform(random);
	for (int axis = 0; axis < 3; axis++) number[3 + axis] = draw_sign(random, 0);
}
