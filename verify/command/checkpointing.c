#include "command/checkpointing.h"

#include <argp.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "command/progress.h"
#include "store/checksum.h"
#include "store/scene_identity.h"

/* The start state, and how long it is equilibrated. */
static uint64_t identity_of(const struct run_plan *plan, const struct simulation *simulation)
{
	double equilibrate = plan->file->equilibrate;
	return checksum(scene_identity(&simulation->scene), &equilibrate, sizeof equilibrate);
}

/* What has been measured, by name, as it is kept. `each` is given each of them until it returns false. */
typedef bool visit(void *context, const char *name, enum touchstone_content content, size_t count, void *numbers);

static bool each_sum(struct conservation *conserved, visit *each, void *context)
{
	return each(context, "energy", TOUCHSTONE_DOUBLES, 2, conserved->energy) &&
		   each(context, "momentum", TOUCHSTONE_DOUBLES, 6, conserved->momentum) &&
		   each(context, "energy_scale", TOUCHSTONE_DOUBLES, 1, &conserved->energy_scale) &&
		   each(context, "momentum_scale", TOUCHSTONE_DOUBLES, 1, &conserved->momentum_scale);
}

static bool each_bar(struct impact_histogram *histogram, const char *name, visit *each, void *context)
{
	enum { BARS = sizeof histogram->bar / sizeof *histogram->bar };
	uint64_t sides[2] = {histogram->below, histogram->above};
	double sums[4] = {histogram->sum, histogram->sum_of_squares, histogram->least, histogram->most};
	char bars[24], of_sides[24], doublings[24], of_sums[24];
	snprintf(bars, sizeof bars, "%s_bars", name);
	snprintf(of_sides, sizeof of_sides, "%s_sides", name);
	snprintf(doublings, sizeof doublings, "%s_doublings", name);
	snprintf(of_sums, sizeof of_sums, "%s_sums", name);
	bool all = each(context, bars, TOUCHSTONE_COUNTS, BARS, histogram->bar) &&
			   each(context, of_sides, TOUCHSTONE_COUNTS, 2, sides) &&
			   each(context, doublings, TOUCHSTONE_COUNTS, 2 * IMPACT_DOUBLINGS, histogram->doubling) &&
			   each(context, of_sums, TOUCHSTONE_DOUBLES, 4, sums);
	histogram->below = sides[0], histogram->above = sides[1];
	histogram->sum = sums[0], histogram->sum_of_squares = sums[1];
	histogram->least = sums[2], histogram->most = sums[3];
	return all;
}

static bool each_impact(struct impact *impact, visit *each, void *context)
{
	return each(context, "impacts", TOUCHSTONE_COUNTS, 1, &impact->count) &&
		   each(context, "impacts_forced", TOUCHSTONE_COUNTS, 1, &impact->forced) &&
		   each_bar(&impact->measured, "measured", each, context) && each_bar(&impact->exact, "exact", each, context);
}

static bool each_three_body(struct three_body *three_body, visit *each, void *context)
{
	uint64_t counts[4] = {three_body->contacts, three_body->overlapping, three_body->events, three_body->encounters};
	double depths[2] = {three_body->depth, three_body->deepest};
	bool all = each(context, "three_body_counts", TOUCHSTONE_COUNTS, 4, counts) &&
			   each(context, "three_body_depths", TOUCHSTONE_DOUBLES, 2, depths) &&
			   each(context, "three_body_trios", TOUCHSTONE_COUNTS, three_body->particles, three_body->trio);
	three_body->contacts = counts[0], three_body->overlapping = counts[1];
	three_body->events = counts[2], three_body->encounters = counts[3];
	three_body->depth = depths[0], three_body->deepest = depths[1];
	return all;
}

static bool each_of_run(struct outcome *outcome, visit *each, void *context)
{
	return each(context, "time_begun", TOUCHSTONE_DOUBLES, 1, &outcome->time_begun) &&
		   each(context, "wall_seconds", TOUCHSTONE_DOUBLES, 1, &outcome->wall_seconds);
}

static bool put(void *checkpoint, const char *name, enum touchstone_content content, size_t count, void *numbers)
{
	return checkpoint_put(checkpoint, name, content, count, numbers);
}

static bool get(void *checkpoint, const char *name, enum touchstone_content content, size_t count, void *numbers)
{
	return checkpoint_get(checkpoint, name, content, count, numbers);
}

/* ------------------------------------------------------------------ writing */

/* Fills a checkpoint that is all zero; false when out of memory. */
static bool fill(const struct checkpointing *checkpointing, struct checkpoint *checkpoint)
{
	const struct run_plan *plan = checkpointing->plan;
	struct outcome *outcome = checkpointing->outcome;
	uint64_t measuring = checkpointing->measuring;
	unsigned measured = measuring ? plan->measures : 0;
	snprintf(checkpoint->program, CHECKPOINT_NAME, "%s", argp_program_version);
	snprintf(checkpoint->scene, CHECKPOINT_NAME, "%s", plan->file->name);
	snprintf(checkpoint->arithmetic, CHECKPOINT_NAME, "%s", plan->file->arithmetic);
	snprintf(checkpoint->method, CHECKPOINT_NAME, "%s", plan->file->method);
	checkpoint->seed = outcome->seed;
	checkpoint->identity = identity_of(plan, checkpointing->simulation);
	checkpoint->state_version = TOUCHSTONE_STATE_VERSION;
	if (measuring) outcome->wall_seconds = progress_clock() - outcome->clock_begun;
	return touchstone_save(checkpointing->simulation->engine, &checkpoint->state) &&
		   put(checkpoint, "measuring", TOUCHSTONE_COUNTS, 1, &measuring) && each_of_run(outcome, put, checkpoint) &&
		   (!(measured & RUN_CONSERVATION) || each_sum(&outcome->conserved[0], put, checkpoint)) &&
		   (!(measured & RUN_IMPACT) || each_impact(outcome->impact, put, checkpoint)) &&
		   (!(measured & RUN_THREE_BODY) || each_three_body(&outcome->three_body, put, checkpoint));
}

static void write_one(void *context)
{
	const struct checkpointing *checkpointing = context;
	struct outcome *outcome = checkpointing->outcome;
	struct checkpoint checkpoint = {0};
	double clock = progress_clock();
	if (!fill(checkpointing, &checkpoint))
		snprintf(outcome->error, STORE_ERROR, "%.200s: not enough memory for a checkpoint",
				 checkpointing->plan->checkpoint);
	else if (checkpoint_write(checkpointing->plan->checkpoint, &checkpoint, outcome->error))
		outcome->checkpoints++;
	outcome->checkpoint_seconds += progress_clock() - clock;
	checkpoint_free(&checkpoint);
}

void checkpointing_begin(struct checkpointing *checkpointing, bool measuring)
{
	checkpointing->measuring = measuring;
	if (!checkpointing->plan->checkpoint) return;
	checkpointing->simulation->pause[PAUSE_CHECKPOINT] = (struct simulation_pause){write_one, checkpointing};
}

void checkpointing_end(struct simulation *simulation)
{
	const struct simulation_pause *pause = &simulation->pause[PAUSE_CHECKPOINT];
	if (pause->look) pause->look(pause->context);
}

/* ------------------------------------------------------------------ resuming */

__attribute__((format(printf, 3, 4))) static bool blame(const struct run_plan *plan, char error[STORE_ERROR],
														const char *format, ...)
{
	char text[STORE_ERROR - 204];
	va_list arguments;
	va_start(arguments, format);
	vsnprintf(text, sizeof text, format, arguments);
	va_end(arguments);
	snprintf(error, STORE_ERROR, "%.200s: %s", plan->resume, text);
	text_one_line(error);
	return false;
}

bool checkpointing_fits(const struct run_plan *plan, const struct simulation *simulation, char error[STORE_ERROR])
{
	const struct checkpoint *resumed = plan->resumed;
	const struct scene_file *file = plan->file;
	if (strncmp(resumed->arithmetic, file->arithmetic, CHECKPOINT_NAME - 1) != 0)
		return blame(plan, error, "a checkpoint of a run in %s, not %s; accepted: the same arithmetic",
					 resumed->arithmetic, file->arithmetic);
	if (strncmp(resumed->method, file->method, CHECKPOINT_NAME - 1) != 0)
		return blame(plan, error, "a checkpoint of a run by %s, not %s; accepted: the same method", resumed->method,
					 file->method);
	if (resumed->identity == identity_of(plan, simulation)) return true;
	return blame(plan, error,
				 "a checkpoint of another scene: %s, with seed %llu; accepted: the same scene, settings and seed",
				 resumed->scene, (unsigned long long)resumed->seed);
}

unsigned checkpointing_measures(const struct checkpoint *checkpoint)
{
	uint64_t count, counts[4];
	double scale;
	return (checkpoint_get(checkpoint, "impacts", TOUCHSTONE_COUNTS, 1, &count) ? RUN_IMPACT : 0) |
		   (checkpoint_get(checkpoint, "three_body_counts", TOUCHSTONE_COUNTS, 4, counts) ? RUN_THREE_BODY : 0) |
		   (checkpoint_get(checkpoint, "energy_scale", TOUCHSTONE_DOUBLES, 1, &scale) ? RUN_CONSERVATION : 0);
}

bool checkpointing_resume(struct checkpointing *checkpointing, bool *measuring, char error[STORE_ERROR])
{
	const struct run_plan *plan = checkpointing->plan;
	struct checkpoint *resumed = (struct checkpoint *)plan->resumed; /* for reading only */
	struct outcome *outcome = checkpointing->outcome;
	struct touchstone_status status;
	uint64_t begun;
	touchstone_status(checkpointing->simulation->engine, &status);
	if (!get(resumed, "measuring", TOUCHSTONE_COUNTS, 1, &begun) || !each_of_run(outcome, get, resumed))
		return blame(plan, error, "the checkpoint does not say how far the run had come");
	*measuring = begun;
	outcome->resumed = true;
	outcome->resumed_from = begun ? status.events : 0;
	if (!begun && plan->limits.events > 0) return true;
	if (status.events > plan->limits.events || !begun)
		return blame(plan, error, "the run had come to %llu events; accepted: --events of at least as many",
					 (unsigned long long)status.events);
	if (status.time - outcome->time_begun > plan->limits.time)
		return blame(plan, error, "the run had come to a time of %g; accepted: --time of at least as much",
					 status.time - outcome->time_begun);
	const char *lacking = NULL;
	outcome->conservation = plan->measures & RUN_CONSERVATION;
	if (outcome->conservation && !each_sum(&outcome->conserved[0], get, resumed)) lacking = "conservation";
	if (plan->measures & RUN_IMPACT && !each_impact(outcome->impact, get, resumed)) lacking = "impact";
	if (plan->measures & RUN_THREE_BODY && !each_three_body(&outcome->three_body, get, resumed)) lacking = "three-body";
	if (lacking)
		return blame(plan, error, "%s was not measured from the beginning; accepted: --measure without it", lacking);
	return true;
}
