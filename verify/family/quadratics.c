/* Quadratics a t^2 + b t + c on which published solvers fail, as balls and planes. Sources: Goualard's trials of
 * QuadraticEquation.jl (numbers 2 to 8, 11 to 13), Forsythe and Kahan (1, 9), Nievergelt (10). */
#include <math.h>
#include <stdlib.h>

#include "family/draw.h"
#include "family/make.h"

/* The discriminant of some is (b^2 - 4 a c) / 4 = x y with short x and y: these can be asked of balls, exactly. v is a
 * along one axis, r is b / 2 along it and (y - x) / 2 aside, the contact distance is (x + y) / 2; then v.v, 2 r.v and
 * r.r - contact^2 are a (a, b, c). */
struct quadratic {
	double a, b, c;
	double x, y;
	bool of_balls;
};

static const struct quadratic quadratics[] = {
	/* 1: b^2 far above 4 a c */
	{1, -0x1p27, 0x1.8p-1, 0x1.cf3dd06694p+25, 0x1.1af2p+26, true},
	{1, -1e9, 1, 0x1.dcd64ffp+28, 0x1.dcd6501p+28, true},
	/* 2: b^2 overflows */
	{0x1.fffffffffffffp+511, -0x1.fffffffffffffp+511, -0x1.fffffffffffffp+511, 0, 0, false},
	/* 3: mixed scales */
	{8, 0x1p800, -0x1p500, 0, 0, false},
	{0x1p600, 0x1p-1, -0x1p600, 0, 0, false},
	{0x1p600, 0x1p-1, -0x1p-600, 1, 0x1.1p+0, true},
	{0x1p600, -0x1p-600, -0x1p-600, 0, 0, false},
	/* 4: underflow invents a root */
	{0x1p-550, -0x1p-552, 0x1p-550, 0x1.cp-552, -0x1.2p-549, true},
	/* 5: roots two ulp apart */
	{1, -0x1.0000000000001p0, 0x1.0000000000002p-2, 0x1p-53, 0x1p-53, true},
	{0x1p600, -0x1.0000000000001p600, 0x1.0000000000002p598, 0x1p547, 0x1p547, true},
	/* 6: subnormal c */
	{1, -0x1.0000000000001p-511, 0x1p-1024, 0x1.5555555555556p-538, 0x1.8p-538, true},
	/* 7: an exact double, subnormal root; half of the published one, whose 2 a overflows */
	{0x1p1022, -1, 0x1p-1024, 0, 0, true},
	/* 8: all subnormal */
	{0x1p-1073, -0x1p-1073, -0x1p-1073, 0, 0, false},
	/* 10: Nievergelt */
	{-158114166017, 316227766017, -158113600000, 0x1.14602p+18, 0x1.14602p+18, true},
	{-312499999999, 707106781186, -4e11, 0x1.cp+18, 0x1.b76a756dcp+18, true},
	/* 11: no b */
	{0x1.8p-1026, 0, -0x1p1022, 0x1p-2, 0x1.8p-2, true},
	{2, 0, 3, 1, -6, true},
	/* 12: degenerate */
	{0, -0x1p600, 0x1p600, 0, 0, false},
	{0, -2, 0x1p-1073, 0, 0, false},
	{0, 0, 0, 0, 0, false},
	{0, 0, 1, 0, 0, false},
	/* 13: one ulp from touching, inside and outside */
	{1, -2, 0x1.fffffffffffffp-1, 0x1p-27, 0x1p-26, true},
	{1, -2, 0x1.0000000000001p0, 0x1p-27, -0x1p-25, true},
};
enum { QUADRATICS = sizeof quadratics / sizeof *quadratics };

/* 9: k (F_n, -2 F_(n-1), F_(n-2)) for an even n up to 78. By Cassini's identity the discriminant is 4 k^2 exactly. */
static struct quadratic fibonacci(struct random_state *random)
{
	double before = 1, now = 1, after = 2; /* F_1, F_2, F_3 */
	for (int n = 2 * draw_between(random, 1, 38); n > 0; n--) {
		before = now;
		now = after;
		after = before + now;
	}
	double most = floor(0x1p53 / now), multiple = draw_chance(random, 2) ? 1 : most;
	return (struct quadratic){
		multiple * now, -2 * multiple * before, multiple * (now - before), multiple, multiple, true};
}

static struct quadratic draw_quadratic(struct random_state *random, bool of_balls)
{
	if (draw_chance(random, 3)) return fibonacci(random);
	struct quadratic quadratic;
	do quadratic = quadratics[random_below(random, QUADRATICS)];
	while (of_balls && !quadratic.of_balls);
	return quadratic;
}

/* Other units of length and time, where no number comes near the ends of the range. */
static void change_units(struct random_state *random, double *number, const int speed_power[], int count)
{
	int length = draw_between(random, -8, 8), rate = draw_between(random, -8, 8);
	if (draw_chance(random, 2)) return;
	for (int i = 0; i < count; i++)
		if (number[i] != 0 && abs(ilogb(number[i])) > 990) return;
	for (int i = 0; i < count; i++) number[i] = ldexp(number[i], length + speed_power[i] * rate);
}

/* The roots as they are or with their signs exchanged (b negated); over a plane also with all three negated. Balls in
 * any direction along the axes. */
void make_quadratics(enum touchstone_shape shape, struct random_state *random, uint64_t index, double *number)
{
	(void)index;
	static const int of_balls[] = {0, 0, 0, 1, 1, 1, 0}, of_plane[] = {0, 1, 2, 0};
	bool balls = shape != TOUCHSTONE_BALL_PLANE;
	struct quadratic chosen = draw_quadratic(random, balls);
	double back = draw_chance(random, 4) ? -1 : 1, turn = draw_sign(random, 1);
	if (!balls) {
		number[0] = turn * chosen.c;
		number[1] = turn * back * chosen.b;
		number[2] = turn * 2 * chosen.a;
		change_units(random, number, of_plane, 4);
		return;
	}
	int along = draw_between(random, 0, 2), aside = (along + draw_between(random, 1, 2)) % 3;
	number[along] = turn * back * chosen.b / 2;
	number[aside] = draw_sign(random, (chosen.y - chosen.x) / 2);
	number[3 + along] = turn * chosen.a;
	number[6] = fabs(chosen.x + chosen.y) / 2;
	change_units(random, number, of_balls, 7);
}
