#include "command/outcome.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>

#include "command/checkpointing.h"
#include "command/command.h"
#include "command/frames.h"
#include "command/interrupt.h"
#include "measure/course.h"

static const char *const verdicts[] = {
	[TOUCHSTONE_DONE] = "done",
	[TOUCHSTONE_COLLAPSED] = "collapsed",
	[TOUCHSTONE_HALTED] = "halted",
	[TOUCHSTONE_DIVERGED] = "diverged",
};

const char *outcome_verdict(const struct outcome *outcome)
{
	return outcome->interrupted ? "interrupted" : verdicts[outcome->status.verdict];
}

/* Gives the outcome a reason in words of our own. */
__attribute__((format(printf, 2, 3))) static void reason(struct outcome *outcome, const char *format, ...)
{
	va_list arguments;
	va_start(arguments, format);
	vsnprintf(outcome->status.reason, sizeof outcome->status.reason, format, arguments);
	va_end(arguments);
}

/* Elastic collisions until the start is forgotten. False when it did not get through. */
static bool equilibrate(struct outcome *outcome, const struct run_plan *plan, struct simulation *simulation,
						struct simulation_progress *progress, uint64_t *executed)
{
	struct touchstone_status begun;
	touchstone_status(simulation->engine, &begun);
	uint64_t wanted = course_events(plan->file->equilibrate, outcome->particles);
	struct touchstone_limits limits = {.events = wanted - begun.events, .time = INFINITY};
	uint64_t then = plan->limits.events < UINT64_MAX ? plan->limits.events : 0;
	touchstone_elastic(simulation->engine, true);
	outcome->interrupted = !simulation_advance(simulation, &limits, NULL, progress, then);
	touchstone_elastic(simulation->engine, false);
	touchstone_status(simulation->engine, &outcome->status);
	*executed = outcome->status.events - begun.events;
	if (!outcome->interrupted && outcome->status.verdict == TOUCHSTONE_DONE) return true;
	checkpointing_end(simulation);
	uint64_t events = outcome->status.events;
	char why[sizeof outcome->status.reason];
	memcpy(why, outcome->status.reason, sizeof why);
	touchstone_recount(simulation->engine);
	touchstone_status(simulation->engine, &outcome->status);
	if (outcome->interrupted)
		reason(outcome, "stopped by a signal after %llu events of equilibration", (unsigned long long)events);
	else
		reason(outcome, "during equilibration: %.130s", why);
	outcome->time_begun = outcome->status.time;
	return false;
}

/* Counting begins here. */
static void begin_measuring(struct outcome *outcome, const struct run_plan *plan, struct simulation *simulation)
{
	touchstone_recount(simulation->engine);
	touchstone_status(simulation->engine, &outcome->status);
	outcome->conservation = plan->measures & RUN_CONSERVATION;
	outcome->time_begun = outcome->status.time;
	if (outcome->conservation) outcome->conserved[0] = conservation_of(&simulation->scene, simulation->engine);
}

/* Shows an event to all that look on. */
static void see(void *context, struct touchstone_engine *engine, const struct touchstone_event *event)
{
	struct outcome *outcome = context;
	if (outcome->impact) impact_see(outcome->impact, engine, event);
	if (outcome->three_bodies) three_body_see(&outcome->three_body, engine, event);
	if (!outcome->states) return;
	inconsistency_see(&outcome->states->inconsistency, engine, event);
	misreading_see(&outcome->states->misreading, engine, event);
}

static void see_test(void *context, struct touchstone_engine *engine, const struct touchstone_test *test)
{
	struct states_outcome *states = context;
	inconsistency_test(&states->inconsistency, engine, test);
	misreading_test(&states->misreading, engine, test);
}

static void measure(struct outcome *outcome, const struct run_plan *plan, struct simulation *simulation,
					struct simulation_progress *progress, uint64_t before)
{
	struct touchstone_observer observer = {see, outcome};
	bool observed = outcome->impact || outcome->three_bodies || outcome->states;
	struct touchstone_limits limits = plan->limits;
	touchstone_status(simulation->engine, &outcome->status);
	if (limits.events < UINT64_MAX) limits.events -= outcome->status.events;
	limits.time += outcome->time_begun;
	if (outcome->states) {
		misreading_begin(&outcome->states->misreading, &simulation->scene, simulation->engine);
		outcome->states->listener =
			(struct touchstone_listener){see_test, outcome->states, inconsistency_reach, INFINITY, 0};
		touchstone_observe_tests(simulation->engine, &outcome->states->listener);
	}
	const struct touchstone_observer *look = observed ? &observer : NULL;
	if (plan->trace) limits.stop = interrupt_flag();
	outcome->clock_begun = progress_clock() - outcome->wall_seconds;
	outcome->interrupted = plan->trace ? !trace_run(&outcome->trace, simulation->engine, &limits, look)
									   : !simulation_advance(simulation, &limits, look, progress, before);
	checkpointing_end(simulation);
	outcome->wall_seconds = progress_clock() - outcome->clock_begun;
	touchstone_status(simulation->engine, &outcome->status);
	if (outcome->interrupted)
		reason(outcome, "stopped by a signal after %llu events, at t = %.17g",
			   (unsigned long long)outcome->status.events, outcome->status.time);
	else if (outcome->status.verdict == TOUCHSTONE_DONE && outcome->status.events < plan->limits.events &&
			 limits.time == INFINITY)
		reason(outcome, "no event is left after t = %.17g", outcome->status.time);
	for (size_t w = 0; w < outcome->virtual_wall_count; w++) touchstone_flux(simulation->engine, w, outcome->fluxes[w]);
	if (outcome->conservation) outcome->conserved[1] = conservation_of(&simulation->scene, simulation->engine);
}

/* The same run once more, watched for what goes wrong. */
static void judge(struct outcome *outcome, const struct run_plan *plan, const struct simulation *simulation)
{
	const struct watch watch = {interrupt_flag(), NULL, NULL};
	char why[160];
	outcome->failed = !failure_find(&simulation->scene, plan->file->equilibrate, plan->file->arithmetic,
									plan->file->method, &plan->limits, &watch, &outcome->failure, why);
	if (outcome->failed) snprintf(outcome->error, STORE_ERROR, "%s", why);
	outcome->interrupted = outcome->failure.stopped;
}

/* Where the run parts from the same in a finer arithmetic; before it begins, both get one start. */
static bool compare(struct outcome *outcome, const struct run_plan *plan, struct simulation *simulation,
					struct simulation_progress *progress, uint64_t *executed)
{
	struct touchstone_limits limits = plan->limits;
	bool anew = outcome->status.events > 0;
	if (anew && !simulation_begin_anew(simulation, plan->file, outcome->error)) return false;
	limits.time += simulation->scene.clock;
	uint64_t then = plan->limits.events < UINT64_MAX ? plan->limits.events : 0;
	if (!simulation_horizon(simulation, plan->file, plan->against, &limits, progress, *executed + then,
							&outcome->horizon, outcome->error))
		return false;
	outcome->compared = true;
	*executed += outcome->horizon.events;
	return true;
}

/* Makes room for what is measured; false without. */
static bool begin_measures(struct outcome *outcome, const struct run_plan *plan)
{
	int bits = arithmetic_bits(plan->file->arithmetic);
	unsigned measures = plan->measures;
	if (measures & RUN_IMPACT && !(outcome->impact = malloc(sizeof *outcome->impact))) return false;
	if (outcome->impact) impact_begin(outcome->impact, bits);
	if (measures & RUN_THREE_BODY) outcome->three_bodies = three_body_begin(&outcome->three_body, outcome->particles);
	if (measures & RUN_THREE_BODY && !outcome->three_bodies) return false;
	if (!(measures & RUN_STATES)) return true;
	outcome->states = calloc(1, sizeof *outcome->states);
	return outcome->states && inconsistency_begin(&outcome->states->inconsistency, bits, outcome->particles);
}

/* From a start state to an outcome. */
static void find(struct outcome *outcome, const struct run_plan *plan, struct simulation *simulation,
				 struct simulation_progress *progress)
{
	outcome->failed = !begin_measures(outcome, plan);
	if (outcome->failed) {
		snprintf(outcome->error, STORE_ERROR, "out of memory");
		return;
	}
	size_t walls = simulation->scene.virtual_wall_count;
	outcome->fluxes = calloc(walls + 1, sizeof *outcome->fluxes);
	outcome->virtual_wall_count = outcome->fluxes ? walls : 0;
	struct checkpointing checkpointing = {.plan = plan, .outcome = outcome, .simulation = simulation};
	bool measuring = false;
	outcome->failed = plan->resumed && !checkpointing_resume(&checkpointing, &measuring, outcome->error);
	if (outcome->failed) return;
	struct frames frames;
	bool framed = plan->xyz && frames_begin(&frames, simulation, plan->xyz, outcome->error);
	outcome->failed = plan->xyz && !framed;
	if (outcome->failed) return;
	simulation->every = plan->every;
	checkpointing_begin(&checkpointing, measuring);
	uint64_t before = 0;
	if (!measuring) {
		measuring = plan->limits.events == 0 || equilibrate(outcome, plan, simulation, progress, &before);
		if (measuring && plan->against && plan->limits.events > 0)
			measuring = compare(outcome, plan, simulation, progress, &before);
		if (measuring && plan->trace && !trace_begin(&outcome->trace, simulation->engine))
			snprintf(outcome->error, STORE_ERROR, "out of memory");
		outcome->failed = *outcome->error && !outcome->checkpoints;
		if (measuring && !outcome->failed) begin_measuring(outcome, plan, simulation);
	}
	checkpointing.measuring = measuring;
	if (framed && plan->every && measuring && !outcome->failed) frames_follow(&frames);
	if (measuring && !outcome->failed) measure(outcome, plan, simulation, progress, before);
	bool judged = plan->measures & RUN_FAILURE;
	if (judged && !outcome->interrupted && !outcome->failed) judge(outcome, plan, simulation);
	if (framed && outcome->failed) frames_drop(&frames);
	if (framed && !outcome->failed) frames_end(&frames, outcome->error);
}

void outcome_find(struct outcome *outcome, const struct run_plan *plan, uint64_t seed,
				  struct simulation_progress *progress)
{
	*outcome = (struct outcome){.seed = seed, .particles = plan->file->recipe.particle_count};
	outcome->interrupted = interrupted();
	if (outcome->interrupted) {
		reason(outcome, "stopped by a signal before it began");
		return;
	}
	struct simulation simulation;
	outcome->failed = !simulation_prepare(&simulation, plan->file, seed, outcome->error);
	if (outcome->failed) return;
	outcome->particles = simulation.scene.particle_count;
	const struct checkpoint *resumed = plan->resumed;
	outcome->failed = (resumed && !checkpointing_fits(plan, &simulation, outcome->error)) ||
					  !simulation_start(&simulation, plan->file, resumed ? &resumed->state : NULL, outcome->error);
	if (!outcome->failed) find(outcome, plan, &simulation, progress);
	simulation_close(&simulation);
}

void outcome_free(struct outcome *outcome)
{
	if (outcome->states) {
		inconsistency_end(&outcome->states->inconsistency);
		misreading_end(&outcome->states->misreading);
	}
	free(outcome->states);
	three_body_end(&outcome->three_body);
	free(outcome->impact);
	free(outcome->fluxes);
	trace_free(&outcome->trace);
}

uint64_t outcome_peak_memory(void)
{
	struct rusage usage;
	getrusage(RUSAGE_SELF, &usage);
	return (uint64_t)usage.ru_maxrss * 1024;
}

struct impact *outcome_impact(const struct outcome *outcomes, size_t count)
{
	struct impact *together = NULL;
	for (size_t o = 0; o < count; o++) {
		if (!outcomes[o].impact) continue; /* not begun */
		if (together)
			impact_merge(together, outcomes[o].impact);
		else if ((together = malloc(sizeof *together)))
			*together = *outcomes[o].impact;
	}
	return together;
}

bool outcome_three_body(const struct outcome *outcomes, size_t count, struct three_body *together)
{
	bool measured = false;
	*together = (struct three_body){0};
	for (size_t o = 0; o < count; o++) {
		if (outcomes[o].three_bodies) three_body_merge(together, &outcomes[o].three_body);
		measured |= outcomes[o].three_bodies;
	}
	return measured;
}
