/* The course of a run: slices of events short enough to be watched and stopped, and elastic equilibration before. */
#ifndef VERIFY_COURSE_H
#define VERIFY_COURSE_H

#include "touchstone.h"

/* Who looks on. All parts may be 0. */
struct watch {
	const volatile int *stop; /* non-zero: stop after the slice at hand */
	/* Told after each slice how many more events were executed, and where the run now is. */
	void (*progress)(void *context, uint64_t more, const struct touchstone_status *now);
	void *context;
};

/* Runs an engine until a limit is reached or the verdict is no longer DONE: true; or until it is stopped: false. Slices
 * last about a tenth of a second, whatever the arithmetic. */
bool course_run(struct touchstone_engine *engine, const struct touchstone_limits *limits,
				const struct touchstone_observer *observer, const struct watch *watch);

/* Elastic collisions, so many per particle; then counting starts. False when stopped on the way. */
bool course_equilibrate(struct touchstone_engine *engine, double collisions, const struct watch *watch);

/* Events in which each of so many particles has so many collisions: two particles share one. */
uint64_t course_events(double collisions, size_t particles);

#endif
