/* A plug-in for all shapes, whose answers tell what it was asked: each number in its own decimal place. */
#include "touchstone.h"

static double of_balls(const double r[3], const double v[3], double contact_distance)
{
	return r[0] + 10 * r[1] + 100 * r[2] + 1e3 * v[0] + 1e4 * v[1] + 1e5 * v[2] + 1e6 * contact_distance;
}

double touchstone_ball_ball(const double r[3], const double v[3], double contact_distance)
{
	return of_balls(r, v, contact_distance);
}

double touchstone_ball_leave(const double r[3], const double v[3], double contact_distance)
{
	return 1e7 + of_balls(r, v, contact_distance);
}

double touchstone_ball_plane(double distance, double speed, double acceleration, double contact_distance)
{
	return 2e7 + distance + 10 * speed + 100 * acceleration + 1e3 * contact_distance;
}
