/* A plug-in that does, at each contact distance, something else that no finder should do. At others it is right where
 * balls fly head-on along x at speed 1. */
#include <math.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>

#include "touchstone.h"

static int asked;

static void *volatile nowhere;

double touchstone_ball_ball(const double r[3], const double v[3], double contact_distance)
{
	asked++;
	switch ((int)contact_distance) {
	case 101:
		return *(double *)nowhere;
	case 102:
		for (volatile int i = 0; i < 2; i = 0) continue;
		return 0;
	case 103:
		return NAN;
	case 104:
		return -1;
	case 105:
		return v[0] * 1e300;
	case 106:
		exit(0);
	case 107:
		raise(SIGUSR1);
		return 0;
	case 108:
		abort();
	case 109:
		printf("touchstone: all is well\n");
		fflush(stdout);
		break;
	case 110:
		((double *)r)[0] = 1e9; /* the question is not for it to change */
		break;
	case 111:
		if (asked > 1) abort(); /* not when it is asked nothing else */
		break;
	}
	return r[0] - contact_distance;
}

/* Under a name of its own. */
double another_name(const double r[3], const double v[3], double contact_distance)
{
	(void)v;
	return r[0] - contact_distance;
}
