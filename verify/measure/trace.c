#include "measure/trace.h"

#include <math.h>
#include <stdlib.h>

bool trace_begin(struct trace *trace, const struct touchstone_engine *engine)
{
	struct touchstone_status status;
	touchstone_status(engine, &status);
	*trace = (struct trace){.last = malloc(status.count * sizeof *trace->last)};
	for (uint32_t p = 0; trace->last && p < status.count; p++) trace->last[p] = status.time;
	return trace->last;
}

void trace_free(struct trace *trace)
{
	free(trace->events);
	free(trace->last);
	*trace = (struct trace){0};
}

/* Where events go on their way to the trace. */
struct witness {
	struct trace *trace;
	const struct touchstone_observer *other;
	bool seen;
};

static void see(void *context, struct touchstone_engine *engine, const struct touchstone_event *event)
{
	struct witness *witness = context;
	struct trace *trace = witness->trace;
	if (witness->other) witness->other->event(witness->other->context, engine, event);
	if (event->kind == TOUCHSTONE_CROSSING) return;
	if (trace->count == trace->room) {
		size_t room = 2 * trace->room + 64;
		struct trace_event *events = realloc(trace->events, room * sizeof *events);
		trace->exhausted = !events;
		if (!events) return;
		trace->events = events, trace->room = room;
	}
	bool pair = event->kind != TOUCHSTONE_WALL;
	double last = trace->last[event->first];
	if (pair) last = fmax(last, trace->last[event->second]);
	double wait = event->time - last;
	trace->events[trace->count++] = (struct trace_event){
		.event = *event,
		.wait = wait,
		.stabilising = event->kind == TOUCHSTONE_CONTACT && wait == 0 && event->steps < 0,
		.backwards = wait < 0,
	};
	trace->last[event->first] = event->time;
	if (pair) trace->last[event->second] = event->time;
	witness->seen = true;
}

bool trace_step(struct trace *trace, struct touchstone_engine *engine, const struct touchstone_limits *limits,
				const struct touchstone_observer *observer)
{
	struct witness witness = {trace, observer, false};
	const struct touchstone_limits one = {1, limits->time, limits->stop};
	touchstone_run(engine, &one, &(struct touchstone_observer){see, &witness});
	if (!witness.seen) return false;
	struct trace_event *event = &trace->events[trace->count - 1];
	int particles = event->event.kind == TOUCHSTONE_WALL ? 1 : 2;
	for (int p = 0; p < particles; p++)
		touchstone_state(engine, p ? event->event.second : event->event.first, event->body[p].position,
						 event->body[p].velocity);
	return true;
}

bool trace_run(struct trace *trace, struct touchstone_engine *engine, const struct touchstone_limits *limits,
			   const struct touchstone_observer *observer)
{
	struct touchstone_status status;
	touchstone_status(engine, &status);
	uint64_t left = limits->events;
	while (left > 0 && status.verdict == TOUCHSTONE_DONE) {
		if (limits->stop && *limits->stop) return false;
		if (!trace_step(trace, engine, limits, observer)) break;
		touchstone_status(engine, &status);
		left--;
	}
	return !(limits->stop && *limits->stop && left > 0);
}
