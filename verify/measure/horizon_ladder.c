#include "measure/horizon_ladder.h"

#include <math.h>

#include "measure/lyapunov.h"

bool horizon_ladder_climb(const struct horizon_ladder *ladder, const struct touchstone_scene *scene,
						  const struct touchstone_limits *limits, const struct watch *watch, struct horizon *horizons,
						  char error[160])
{
	for (size_t rung = 0; rung < ladder->count; rung++)
		if (!horizon_find(scene, "stable", ladder->arithmetics[rung], ladder->reference, limits, watch, &horizons[rung],
						  error))
			return false;
	return true;
}

/* So many more events per particle; false when stopped. */
static bool go_on(struct touchstone_engine *engine, double per_particle, struct lyapunov *lyapunov,
				  const struct watch *watch, struct touchstone_status *status)
{
	touchstone_status(engine, status);
	const struct touchstone_limits limits = {.events = course_events(per_particle, status->count), .time = INFINITY};
	bool through = course_run(engine, &limits, &(struct touchstone_observer){lyapunov_see, lyapunov}, watch);
	touchstone_status(engine, status);
	return through;
}

/* Events that a mean particle has taken part in. */
static double shared(const struct touchstone_status *status)
{
	uint64_t pairs = status->collisions + status->captures + status->releases + status->bounces;
	return (double)(status->events + pairs) / status->count;
}

bool tangent_grow(const struct touchstone_scene *scene, uint64_t seed, double turning, double growing,
				  const struct watch *watch, struct tangent_growth *growth, char error[160])
{
	struct touchstone_engine *engine = touchstone_create(scene, "binary64", "stable", error);
	struct lyapunov *lyapunov = engine ? lyapunov_begin(scene, seed, error) : NULL;
	struct touchstone_status begun, ended;
	bool through = false;
	if (lyapunov) {
		*error = '\0';
		through = go_on(engine, turning, lyapunov, watch, &begun);
		double before = lyapunov_growth(lyapunov, begun.time);
		through = through && go_on(engine, growing, lyapunov, watch, &ended);
		if (through)
			*growth = (struct tangent_growth){lyapunov_growth(lyapunov, ended.time) - before,
											  shared(&ended) - shared(&begun), ended.time - begun.time};
	}
	lyapunov_free(lyapunov);
	touchstone_destroy(engine);
	return through;
}

struct estimate estimate_mean(const double *values, size_t count)
{
	struct estimate estimate = {NAN, NAN, count};
	double sum = 0, squares = 0;
	for (size_t k = 0; k < count; k++) sum += values[k];
	if (count) estimate.value = sum / (double)count;
	for (size_t k = 0; k < count; k++) squares += pow(values[k] - estimate.value, 2);
	if (count > 1) estimate.error = sqrt(squares / (double)(count - 1) / (double)count);
	return estimate;
}

struct estimate estimate_exponent(struct estimate slope)
{
	double exponent = log(2) / slope.value;
	return (struct estimate){exponent, exponent * slope.error / slope.value, slope.count};
}
