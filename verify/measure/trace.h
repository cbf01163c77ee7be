/* A run event by event (2014 paper, figs. 4 and 6): what each event was, and what it left.
 *
 * A stabilising event (2014 paper, section 4.1) is one of a pair that overlaps and is executed at once: no time has
 * passed since the later of the two had its last event, and the pair is nearer than contact in the working arithmetic.
 */
#ifndef VERIFY_TRACE_H
#define VERIFY_TRACE_H

#include "measure/course.h"

struct trace_body {
	double position[3], velocity[3];
};

struct trace_event {
	struct touchstone_event event;
	double wait;               /* since the later of the last events of its particles, or the start */
	bool stabilising;          /* wait is 0, and the pair overlaps */
	bool backwards;            /* wait is negative: the clock has gone back */
	struct trace_body body[2]; /* what it left of the first and of the second particle (zeros for a wall) */
};

struct trace {
	size_t count, room;
	struct trace_event *events;
	double *last;   /* per particle: time of its last event */
	bool exhausted; /* no memory for more: the last events are missing */
};

/* Begins a trace of an engine that is at the start of what is to be traced. False when there is no memory. */
bool trace_begin(struct trace *trace, const struct touchstone_engine *engine);
void trace_free(struct trace *trace); /* one that is all zeros is fine */

/* Executes one event and appends it to the trace. False when there is none, or a limit is reached: the engine's status
 * says why. Other observers may be told of it. */
bool trace_step(struct trace *trace, struct touchstone_engine *engine, const struct touchstone_limits *limits,
				const struct touchstone_observer *observer);

/* Steps until a limit is reached or the verdict is no longer DONE: true; or until an end is asked for: false. */
bool trace_run(struct trace *trace, struct touchstone_engine *engine, const struct touchstone_limits *limits,
			   const struct touchstone_observer *observer);

#endif
