/* A finder for Touchstone to grade, as anyone may write it: the formula for the roots of a quadratic, from the
 * textbook.
 *
 *     cc -O2 -shared -fPIC -Ilib -o example.so verify/test/plugins/example.c -lm
 *     touchstone grade --plugin ./example.so
 *
 * Two balls are in contact when |r + v t| = s, that is, a t^2 + 2 b t + c = 0 with a = v.v, b = r.v, c = r.r - s^2. */
#include <math.h>

#include "touchstone.h"

double touchstone_ball_ball(const double r[3], const double v[3], double contact_distance)
{
	double a = v[0] * v[0] + v[1] * v[1] + v[2] * v[2];
	double b = r[0] * v[0] + r[1] * v[1] + r[2] * v[2];
	double c = r[0] * r[0] + r[1] * r[1] + r[2] * r[2] - contact_distance * contact_distance;
	double discriminant = b * b - a * c;
	if (b >= 0) return INFINITY; /* they recede */
	if (c <= 0) return 0;        /* they overlap, and approach */
	if (discriminant <= 0) return INFINITY;
	return (-b - sqrt(discriminant)) / a; /* loses digits where b^2 is much larger than a c */
}
