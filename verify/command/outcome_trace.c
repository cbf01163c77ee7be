/* The events of a run, one by one: as a table for people and as JSON. */
#include "command/outcome.h"

#include <math.h>
#include <stdio.h>

static const char *const kinds[] = {"contact", "wall", "capture", "release", "bounce", "crossing"};

/* What is to be noticed about an event. */
static const char *remark(const struct trace_event *event)
{
	return event->stabilising ? "stabilising" : event->backwards ? "backwards" : "";
}

static void print_velocity(const struct trace_body *body, int dimensions)
{
	for (int axis = 0; axis < dimensions; axis++) printf("%s%.17g", axis ? ", " : "  (", body->velocity[axis]);
	putchar(')');
}

void outcome_trace_print(const struct trace *trace, int dimensions)
{
	printf("\n%6s  %-8s  %9s  %24s  %12s  %24s  %11s  %-11s  %s\n", "event", "kind", "between", "time", "wait",
		   "separation", "ulp over it", "", "velocities after");
	for (size_t e = 0; e < trace->count; e++) {
		const struct trace_event *one = &trace->events[e];
		const struct touchstone_event *event = &one->event;
		bool wall = event->kind == TOUCHSTONE_WALL;
		char between[32];
		snprintf(between, sizeof between, "%u %s%u", event->first, wall ? "wall " : "", event->second);
		printf("%6zu  %-8s  %9s  %24.17g  %12.4g  %24.17g  %11lld  %-11s", e + 1, kinds[event->kind], between,
			   event->time, one->wait, event->distance, (long long)event->steps, remark(one));
		print_velocity(&one->body[0], dimensions);
		if (!wall) print_velocity(&one->body[1], dimensions);
		putchar('\n');
	}
	if (trace->exhausted) puts("memory ran out: the last events are missing");
	putchar('\n');
}

static json_t *vector(const double *values, int dimensions)
{
	json_t *list = json_array();
	for (int axis = 0; axis < dimensions; axis++)
		json_array_append_new(list, isfinite(values[axis]) ? json_real(values[axis]) : json_null());
	return list;
}

json_t *outcome_trace_json(const struct trace *trace, int dimensions)
{
	json_t *list = json_array();
	for (size_t e = 0; e < trace->count; e++) {
		const struct trace_event *one = &trace->events[e];
		const struct touchstone_event *event = &one->event;
		json_t *positions = json_array(), *velocities = json_array();
		for (int p = 0; p < (event->kind == TOUCHSTONE_WALL ? 1 : 2); p++) {
			json_array_append_new(positions, vector(one->body[p].position, dimensions));
			json_array_append_new(velocities, vector(one->body[p].velocity, dimensions));
		}
		json_array_append_new(list, json_pack("{s:s, s:[I, I], s:f, s:f, s:f, s:I, s:b, s:b, s:o, s:o}", "kind",
											  kinds[event->kind], "between", (json_int_t)event->first,
											  (json_int_t)event->second, "time", event->time, "wait", one->wait,
											  "separation", event->distance, "steps", (json_int_t)event->steps,
											  "stabilising", one->stabilising, "backwards", one->backwards, "positions",
											  positions, "velocities", velocities));
	}
	return list;
}
