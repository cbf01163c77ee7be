/* The course of a run: an engine made for a scene, elastic equilibration, then events in slices, so that a run can be
 * watched and stopped. */
#ifndef VERIFY_COURSE_H
#define VERIFY_COURSE_H

#include "touchstone.h"

struct course {
	double equilibrate; /* elastic collisions per particle before counting starts */
	struct touchstone_limits limits;
	const struct touchstone_observer *observer;       /* of what is counted; may be NULL */
	const volatile int *stop;                         /* non-zero: stop after the slice at hand; may be NULL */
	void (*progress)(void *context, uint64_t events); /* told how many more events were executed; may be NULL */
	void *context;
};

struct course_end {
	struct touchstone_status status;
	bool stopped;   /* before it had come to an end */
	double seconds; /* of wall time, for what was counted */
};

/* Runs an engine through a course. May be called again with `equilibrate` 0 to go on. */
struct course_end course_run(struct touchstone_engine *engine, const struct course *course);

/* Seconds on a clock that never jumps. */
double course_clock(void);

#endif
