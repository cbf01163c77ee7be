/* A plug-in that does not survive being loaded. */
#include <stdlib.h>

#include "touchstone.h"

__attribute__((constructor)) static void begin(void)
{
	abort();
}

double touchstone_ball_ball(const double r[3], const double v[3], double contact_distance)
{
	return r[0] + v[0] + contact_distance;
}
