/* What goes wrong first in a run, judged without anyone looking on.
 *
 * A run is checked whenever each of its particles has had an event, on average. It goes wrong when
 *
 *	halts            the method has no answer to go on with (the engine's verdict)
 *	not finite       a coordinate or a speed is no longer a number
 *	loops            events go on but time does not (the engine's verdict), in a scene that loses no energy
 *	runs back        the clock is earlier than at the check before
 *	gains energy     of the energy's scale (conservation.h), at the start or now, more than 1 % has come in, besides
 *	                 what kicks and thermal walls bring
 *	drifts           or, in a scene that loses none, has gone; or the momentum along an axis on which nothing outside
 *	                 acts has changed by more than 1 % of its scale now: a gas that cools must not end as a flock, which
 *	                 it does in any arithmetic when nothing is left but what rounding made of its first speeds
 *	entangles        two particles are nearer than 9/10 of their contact distance, and overlap at the next ten checks
 *too penetrates       or have parted by then; or a particle is so deep in a wall
 *
 * Where the scene itself loses energy, to come to rest is right, and so is a verdict of collapse, flock or not.
 *
 * Once something is wrong, the run is repeated from the last check that found nothing, event by event, for the first
 * event that shows it.
 */
#ifndef VERIFY_FAILURE_H
#define VERIFY_FAILURE_H

#include "measure/course.h"

enum failure_kind {
	FAILURE_NONE,
	FAILURE_REST, /* none: the run came to rest, as it should */
	FAILURE_OVER, /* none, but no event is left: in a gas, particles that no longer meet */
	FAILURE_DRIFTS,
	FAILURE_GAINS_ENERGY,
	FAILURE_PASSES,
	FAILURE_ENTANGLES,
	FAILURE_BACKWARDS,
	FAILURE_LOOPS,
	FAILURE_HALTS,
	FAILURE_NOT_FINITE,
};

struct failure {
	enum failure_kind kind;
	uint64_t event;  /* the first that shows it, from 1, or the last before none is left; 0 where nothing is wrong */
	double time;     /* of it */
	uint64_t events; /* executed when it was judged, or in all */
	bool stopped;    /* by the watch: nothing wrong until then */
	char text[200];  /* one line for people: what, who, when; "" where nothing is wrong */
};

static const double failure_conserved = 0.01, failure_depth = 0.9; /* the bounds above */

/* Runs the scene, `collisions` elastic ones per particle first, and judges. False with one line in `error` when no
 * engine can be made. Memory: five numbers a particle, and the states it keeps. */
bool failure_find(const struct touchstone_scene *scene, double collisions, const char *arithmetic, const char *method,
				  const struct touchstone_limits *limits, const struct watch *watch, struct failure *failure,
				  char error[160]);

/* "survives", "rests", "drifts", ... */
const char *failure_word(enum failure_kind kind);

static inline bool failure_survived(const struct failure *failure)
{
	return failure->kind <= FAILURE_OVER;
}

#endif
