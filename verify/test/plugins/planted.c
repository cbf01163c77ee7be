/* Finders with one fault each, for the fuzzer to find. All else is the correctly rounded answer, which the program that
 * loads this has. */
#include <float.h>
#include <math.h>
#include <stdlib.h>

#include "touchstone.h"

typedef double finder(const double r[3], const double v[3], double contact);
finder planted_nothing, planted_sign, planted_missing_guard, planted_wrong_root, planted_swapped_operands;
finder planted_absolute_epsilon, planted_lost_compensation, planted_wrong_branch_at_zero, planted_off_by_one_ulp;
finder planted_crash, planted_hang;

double planted_nothing(const double r[3], const double v[3], double contact)
{
	const double question[1][TOUCHSTONE_MOST_NUMBERS] = {{r[0], r[1], r[2], v[0], v[1], v[2], contact}};
	double time;
	char error[160];
	if (!touchstone_find("binary64", "rounded", TOUCHSTONE_BALL_BALL, question, 1, false, &time, error)) abort();
	return time;
}

static double dot(const double a[3], const double b[3])
{
	return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static double discriminant(const double r[3], const double v[3], double contact)
{
	double b = dot(r, v);
	return b * b - dot(v, v) * (dot(r, r) - contact * contact);
}

double planted_sign(const double r[3], const double v[3], double contact)
{
	double time = planted_nothing(r, v, contact);
	return time < INFINITY ? -time : time;
}

double planted_missing_guard(const double r[3], const double v[3], double contact)
{
	if (dot(r, v) > 0 && dot(r, r) - contact * contact < 0) return 0; /* overlapped, though receding */
	return planted_nothing(r, v, contact);
}

double planted_wrong_root(const double r[3], const double v[3], double contact)
{
	double time = planted_nothing(r, v, contact), D = discriminant(r, v, contact);
	return time > 0 && time < INFINITY && D > 0 ? (sqrt(D) - dot(r, v)) / dot(v, v) : time;
}

double planted_swapped_operands(const double r[3], const double v[3], double contact)
{
	const double back[3] = {-v[0], -v[1], -v[2]};
	return planted_nothing(r, back, contact);
}

double planted_absolute_epsilon(const double r[3], const double v[3], double contact)
{
	return discriminant(r, v, contact) < 1e-9 ? INFINITY : planted_nothing(r, v, contact);
}

double planted_lost_compensation(const double r[3], const double v[3], double contact)
{
	double time = planted_nothing(r, v, contact), D = discriminant(r, v, contact);
	double c = dot(r, r) - contact * contact;
	return time > 0x1p-500 && time < 0x1p500 && D > 0 && c > 0 ? c / (sqrt(D) - dot(r, v)) : time;
}

double planted_wrong_branch_at_zero(const double r[3], const double v[3], double contact)
{
	return dot(r, r) == contact * contact && contact > 0x1p-500 ? INFINITY : planted_nothing(r, v, contact);
}

double planted_off_by_one_ulp(const double r[3], const double v[3], double contact)
{
	double time = planted_nothing(r, v, contact);
	return time > 1 && time < 2 ? nextafter(time, 2) : time;
}

double planted_crash(const double r[3], const double v[3], double contact)
{
	if (dot(v, v) == 0 && r[0] > 1) abort();
	return planted_nothing(r, v, contact);
}

double planted_hang(const double r[3], const double v[3], double contact)
{
	volatile bool for_ever = dot(r, v) < 0 && discriminant(r, v, contact) == 0;
	while (for_ever) continue;
	return planted_nothing(r, v, contact);
}
