/* The horizon over the bits carried, and what its slope says (design, section 5.6): an error grows as exp(lambda n) in
 * n events per particle, so that each further bit is good for ln 2 / lambda of them. lambda is the largest Lyapunov
 * exponent, which a tangent vector (lyapunov.h) tells in a second way. */
#ifndef VERIFY_HORIZON_LADDER_H
#define VERIFY_HORIZON_LADDER_H

#include "measure/horizon.h"
#include "measure/interval.h"

/* Arithmetics from coarse to fine, and the finer one that each is held against. The names belong to the caller. */
struct horizon_ladder {
	size_t count;
	const char *const *arithmetics;
	const char *reference;
};

/* Fills `horizons` (room for the ladder's count), each from the scene as it is. False as horizon_find; when the watch
 * stopped it, the last of them are marked as stopped. */
bool horizon_ladder_climb(const struct horizon_ladder *ladder, const struct touchstone_scene *scene,
						  const struct touchstone_limits *limits, const struct watch *watch, struct horizon *horizons,
						  char error[160]);

/* How a tangent vector grew in binary64 by `stable`, after so many events per particle in which it turned to where it
 * grows most. */
struct tangent_growth {
	double growth;       /* of the logarithm of its length */
	double per_particle; /* events in which it did, */
	double time;         /* and how long they took */
};

/* False with `error` empty when stopped, or with one line in `error`. */
bool tangent_grow(const struct touchstone_scene *scene, uint64_t seed, double turning, double growing,
				  const struct watch *watch, struct tangent_growth *growth, char error[160]);

/* A mean with its standard error (NaN where there are fewer than two). */
struct estimate {
	double value, error;
	size_t count;
};
struct estimate estimate_mean(const double *values, size_t count);

/* ln 2 over a slope per bit: an exponent, with its error. */
struct estimate estimate_exponent(struct estimate slope);

#endif
