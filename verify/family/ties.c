/* Two questions with exactly the same time. Source: symmetric start states (lattices, Newton's cradle), in which events
 * coincide and an engine must order them by something else than rounding. */
#include <math.h>

#include "family/draw.h"
#include "family/make.h"

/* Axes exchanged in a circle, some turned around, particles exchanged, lengths and speeds times one power of two. */
static void same_pair_moved(struct random_state *random, double *number)
{
	double moved[6];
	int circle = draw_between(random, 0, 2), exponent = draw_between(random, -40, 40);
	for (int axis = 0; axis < 3; axis++) {
		double turn = draw_sign(random, 1);
		moved[axis] = turn * number[(axis + circle) % 3];
		moved[3 + axis] = turn * number[3 + (axis + circle) % 3];
	}
	for (int i = 0; i < 6; i++) number[i] = moved[i];
	draw_shift(number, 7, exponent);
}

/* The pair of whole numbers of up to 44 bits, turned by the matrix of a frame, whose length of up to 8 bits scales
 * everything: exact, though no number is like another. */
static void same_pair_turned(struct random_state *random, double *number)
{
	struct draw_frame frame = draw_frame(random, 3);
	double turned[6] = {0};
	for (int axis = 0; axis < 3; axis++)
		for (int i = 0; i < 3; i++) {
			turned[axis] += (double)frame.axis[i][axis] * number[i];
			turned[3 + axis] += (double)frame.axis[i][axis] * number[3 + i];
		}
	for (int i = 0; i < 6; i++) number[i] = turned[i];
	number[6] *= (double)frame.length;
}

/* Coming at each other from some contact distances away, on a path that may miss, in whole numbers of so many bits. */
static void whole_pair(struct random_state *random, double *number)
{
	double scale = 0x1p42;
	for (int axis = 0; axis < 3; axis++) {
		number[axis] = rint(scale * draw_sign(random, 1 + draw_uniform(random)));
		number[3 + axis] = -rint((number[axis] + scale * draw_sign(random, draw_uniform(random))) / 2);
	}
	number[6] = rint(scale * 1.25);
}

/* A pair in contact after just `time`, a whole number of up to 8 bits: contact vector n of whole length, any v (which
 * approaches, or parts where the pair is to leave), and r = n - v t in whole numbers. */
static void meets_at(struct random_state *random, enum touchstone_shape shape, double time, double *number)
{
	struct draw_frame frame = draw_frame(random, 6);
	int64_t multiple = draw_whole(random, 37);
	double normal[3], *v = number + 3;
	for (int axis = 0; axis < 3; axis++) normal[axis] = (double)(frame.axis[0][axis] * multiple);
	do {
		draw_vector(random, v);
		for (int axis = 0; axis < 3; axis++) v[axis] = rint(v[axis] * 0x1p43);
	} while (draw_dot(v, normal) * draw_dot(v, normal) < 0x1p-20 * draw_dot(v, v) * draw_dot(normal, normal));
	double turn = (draw_dot(v, normal) > 0) == (shape == TOUCHSTONE_BALL_LEAVE) ? 1 : -1;
	for (int axis = 0; axis < 3; axis++) v[axis] *= turn;
	for (int axis = 0; axis < 3; axis++) number[axis] = normal[axis] - v[axis] * time;
	number[6] = (double)(frame.length * multiple);
}

/* speed, acceleration and h = -(speed + acceleration t / 2) t in whole numbers, on the way down after t, and not below
 * the plane and sinking at the start. */
static void falls_at(struct random_state *random, double time, double *number)
{
	double half_pull = draw_sign(random, (double)draw_whole(random, 34)), speed;
	if (draw_chance(random, 4)) half_pull = 0;
	double at_contact = -(double)draw_whole(random, 42);
	speed = at_contact - 2 * half_pull * time;
	double contact = draw_chance(random, 2) ? 0 : (double)draw_whole(random, 50);
	number[0] = contact - (speed + half_pull * time) * time;
	number[1] = speed;
	number[2] = 2 * half_pull;
	number[3] = contact;
}

static void meet_at_one_time(struct random_state *random, enum touchstone_shape shape, bool second, double *number)
{
	double time = (double)draw_steps(random, 8);
	int exponent = draw_between(random, -60, 0); /* of the time: lengths stay whole numbers, speeds do not */
	struct random_state other = random_seed(random_bits(random));
	struct random_state *own = second ? &other : random;
	bool planar = shape == TOUCHSTONE_BALL_PLANE || shape == TOUCHSTONE_HALF_SPACE;
	if (!planar) {
		meets_at(own, shape, time, number);
		draw_shift(number + 3, 3, -exponent);
		draw_shift(number, 7, draw_between(own, -100, 40));
		return;
	}
	falls_at(own, time, number);
	if (shape == TOUCHSTONE_HALF_SPACE) {
		number[1] = -(double)draw_whole(own, 45);
		number[0] = -number[1] * time;
	}
	draw_shift(number + 1, 1, -exponent);
	draw_shift(number + 2, 1, -2 * exponent);
	draw_shift(number, 4, draw_between(own, -100, 40));
}

/* Even questions are drawn; odd ones are the pair before, moved or turned, or another pair altogether that meets at the
 * same time. Planes only have the last kind. */
void make_ties(enum touchstone_shape shape, struct random_state *random, uint64_t index, double *number)
{
	bool balls = shape == TOUCHSTONE_BALL_BALL || shape == TOUCHSTONE_BALL_LEAVE, second = index % 2;
	int kind = balls ? draw_between(random, 0, 2) : 2;
	if (kind == 2) {
		meet_at_one_time(random, shape, second, number);
		return;
	}
	whole_pair(random, number);
	if (second && kind == 0) same_pair_moved(random, number);
	if (second && kind == 1) same_pair_turned(random, number);
}
