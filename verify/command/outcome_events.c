/* The events of a run one by one, and what goes wrong in it: for people and as JSON. */
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

static void print_trace(const struct trace *trace, int dimensions)
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

static json_t *trace_json(const struct trace *trace, int dimensions)
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

void outcome_print_events(const struct run_plan *plan, const struct outcome *outcomes, size_t count)
{
	for (size_t o = 0; plan->measures & RUN_FAILURE && o < count; o++) {
		const struct failure *failure = &outcomes[o].failure;
		if (failure->event)
			outcome_row("judged", "%s: event %llu, t = %.9g: %s", failure_word(failure->kind),
						(unsigned long long)failure->event, failure->time, failure->text);
		else
			outcome_row("judged", "%s", failure_word(failure->kind));
	}
	if (plan->trace) print_trace(&outcomes->trace, plan->file->recipe.dimensions);
}

void outcome_set_events(json_t *run, const struct run_plan *plan, const struct outcome *outcome)
{
	const struct failure *failure = &outcome->failure;
	if (plan->trace) json_object_set_new(run, "trace", trace_json(&outcome->trace, plan->file->recipe.dimensions));
	if (!(plan->measures & RUN_FAILURE)) return;
	json_t *event = failure->event ? json_integer((json_int_t)failure->event) : json_null();
	json_t *time = failure->event && isfinite(failure->time) ? json_real(failure->time) : json_null();
	json_object_set_new(run, "failure",
						json_pack("{s:s, s:b, s:o, s:o, s:s}", "what", failure_word(failure->kind), "survived",
								  failure_survived(failure), "event", event, "time", time, "text", failure->text));
}
