#include "measure/failure.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "measure/conservation.h"
#include "measure/deep_overlap.h"

enum {
	PATIENCE = 10, /* checks in which an overlap may clear */
	SPACING = 1024 /* checks from one state that is kept to the next */
};

/* A run under watch. */
struct run {
	const struct touchstone_scene *scene;
	struct touchstone_engine *engine;
	struct deep_overlaps overlaps;
	bool elastic;
	struct conservation begin;
	double brought; /* until then: see brought_in */
	double lowest;  /* energy, over its scale at the start and from there */
	double clock;   /* at the last check */
	bool keeps;     /* a state from which it may be repeated: */
	struct touchstone_snapshot kept;
};

static bool loses_nothing(struct touchstone_restitution law)
{
	return law.law == TOUCHSTONE_CONSTANT ? law.coefficient == 1 : law.coefficient == 0;
}

static bool is_elastic(const struct touchstone_scene *scene)
{
	bool elastic = loses_nothing(scene->restitution);
	for (size_t w = 0; w < scene->wall_count; w++) elastic &= loses_nothing(scene->walls[w].restitution);
	for (size_t p = 0; p < scene->potential_count; p++) elastic &= loses_nothing(scene->potentials[p].restitution);
	return elastic;
}

/* Energy, by kicks and thermal walls. */
static double brought_in(const struct touchstone_status *status)
{
	return status->kicked_energy + status->thermostat_energy;
}

static bool run_begin(struct run *run, const struct touchstone_scene *scene, double collisions, const char *arithmetic,
					  const char *method, const struct watch *watch, char error[160])
{
	struct touchstone_status status;
	*run = (struct run){.scene = scene, .elastic = is_elastic(scene)};
	run->engine = touchstone_create(scene, arithmetic, method, error);
	bool made = deep_overlaps_make(&run->overlaps, scene);
	if (run->engine && !made) snprintf(error, 160, "not enough memory");
	if (!run->engine || !made) return false;
	if (collisions > 0) course_equilibrate(run->engine, collisions, watch);
	touchstone_status(run->engine, &status);
	run->clock = status.time;
	run->begin = conservation_of(scene, run->engine);
	run->brought = brought_in(&status);
	return true;
}

static void run_forget(struct run *run)
{
	if (run->keeps) touchstone_snapshot_free(&run->kept);
	run->keeps = false;
}

static void run_end(struct run *run)
{
	run_forget(run);
	touchstone_destroy(run->engine);
	deep_overlaps_free(&run->overlaps);
}

/* Takes it back to the state that was kept, or to its start. */
static bool run_back(struct run *run, double collisions, const char *arithmetic, const char *method,
					 const struct watch *watch, char error[160])
{
	const struct touchstone_scene *scene = run->scene;
	if (!run->keeps) {
		run_end(run);
		return run_begin(run, scene, collisions, arithmetic, method, watch, error);
	}
	touchstone_destroy(run->engine);
	run->engine = touchstone_restore(scene, arithmetic, method, &run->kept, error);
	run->lowest = 0;
	return run->engine;
}

static bool read_positions(struct run *run)
{
	bool finite = true;
	for (uint32_t p = 0; p < run->scene->particle_count; p++) {
		double velocity[3];
		double *position = run->overlaps.position[p];
		touchstone_state(run->engine, p, position, velocity);
		for (int axis = 0; axis < run->scene->dimensions; axis++)
			finite &= isfinite(position[axis]) && isfinite(velocity[axis]);
	}
	return finite;
}

__attribute__((format(printf, 4, 5))) static bool fail(const struct run *run, struct failure *failure,
													   enum failure_kind kind, const char *format, ...)
{
	struct touchstone_status status;
	touchstone_status(run->engine, &status);
	va_list arguments;
	va_start(arguments, format);
	vsnprintf(failure->text, sizeof failure->text, format, arguments);
	va_end(arguments);
	failure->kind = kind;
	failure->event = failure->events = status.events;
	failure->time = status.time;
	return true;
}

/* What kicks and thermal walls have brought in does not count. */
static bool judge_energy(struct run *run, const struct conservation *now, struct failure *failure)
{
	struct touchstone_status status;
	touchstone_status(run->engine, &status);
	double change = conservation_energy_drift(&run->begin, now);
	if (!isfinite(change)) return false; /* at rest from the start */
	change -= (brought_in(&status) - run->brought) / run->begin.energy_scale;
	run->lowest = fmin(run->lowest, change);
	double scale = fmax(1, now->energy_scale / run->begin.energy_scale);
	double gain = (run->elastic ? change : change - run->lowest) / scale;
	if (gain > failure_conserved)
		return fail(run, failure, FAILURE_GAINS_ENERGY, "the energy has risen by %.3g of its scale", gain);
	if (run->elastic && gain < -failure_conserved)
		return fail(run, failure, FAILURE_DRIFTS, "the energy has fallen by %.3g of its scale", -gain);
	return false;
}

/* Only particles act on particles along this axis, and by what a contact exchanges. */
static bool keeps_momentum(const struct touchstone_scene *scene, int axis)
{
	bool kicked = scene->convection.temperatures && axis == scene->dimensions - 1;
	bool keeps = scene->acceleration[axis] == 0 && scene->thermostat == 0 && !kicked;
	for (size_t w = 0; w < scene->wall_count; w++) keeps &= scene->walls[w].normal[axis] == 0;
	return keeps;
}

/* What a gas loses by cooling is energy, not momentum: the scale is that of its speeds now. */
static bool judge_momentum(const struct run *run, const struct conservation *now, struct failure *failure)
{
	for (int axis = 0; axis < run->scene->dimensions; axis++) {
		double change = fabs(now->momentum[axis][0] - run->begin.momentum[axis][0]) / now->momentum_scale;
		if (change > failure_conserved && keeps_momentum(run->scene, axis))
			return fail(run, failure, FAILURE_DRIFTS, "the momentum has changed by %.3g of its scale, along %c", change,
						"xyz"[axis]);
	}
	return false;
}

/* Judges the state of a run between events. An overlap is left in `deep`, to be judged later. */
static bool judge(struct run *run, struct failure *failure, struct deep_overlap *deep)
{
	struct touchstone_status status;
	touchstone_status(run->engine, &status);
	if (status.verdict == TOUCHSTONE_HALTED) return fail(run, failure, FAILURE_HALTS, "%s", status.reason);
	if (status.verdict == TOUCHSTONE_DIVERGED) return fail(run, failure, FAILURE_NOT_FINITE, "%s", status.reason);
	if (!read_positions(run)) return fail(run, failure, FAILURE_NOT_FINITE, "a coordinate is no longer finite");
	if (status.time < run->clock)
		return fail(run, failure, FAILURE_BACKWARDS, "the clock stands at %.9g and has been at %.9g", status.time,
					run->clock);
	if (deep_overlaps_find(&run->overlaps, failure_depth, deep))
		return fail(run, failure, FAILURE_PASSES, "particle %u is at %.3g of the contact distance from %s %u",
					deep->first, deep->depth, deep->wall ? "wall" : "particle", deep->second);
	const struct conservation now = conservation_of(run->scene, run->engine);
	if (judge_energy(run, &now, failure)) return true;
	if (status.verdict == TOUCHSTONE_COLLAPSED)
		return fail(run, failure, run->elastic ? FAILURE_LOOPS : FAILURE_REST, "%s", status.reason);
	return judge_momentum(run, &now, failure);
}

/* Advances by so many events, no further than the limits; false when nothing more is to be run. */
static bool advance(const struct run *run, uint64_t events, const struct touchstone_limits *limits,
					const struct watch *watch)
{
	struct touchstone_status before, after;
	touchstone_status(run->engine, &before);
	uint64_t left = limits->events - before.events;
	struct touchstone_limits part = {events < left ? events : left, limits->time, watch ? watch->stop : NULL};
	touchstone_run(run->engine, &part, NULL);
	touchstone_status(run->engine, &after);
	if (watch && watch->progress) watch->progress(watch->context, after.events - before.events, &after);
	return after.verdict == TOUCHSTONE_DONE && after.events < limits->events &&
		   after.events - before.events == part.events;
}

/* An overlap that stays is an entanglement. */
static void wait_for_parting(const struct run *run, const struct deep_overlap *deep, uint64_t stride,
							 const struct touchstone_limits *limits, const struct watch *watch, struct failure *failure)
{
	bool stays = true, goes_on = true;
	int checks = 0;
	for (; stays && goes_on && checks < PATIENCE; checks++) {
		goes_on = advance(run, stride, limits, watch);
		stays = read_positions((struct run *)run) && deep_overlaps_depth(&run->overlaps, deep) < 1;
	}
	if (stays && checks > 0 && !deep->wall) failure->kind = FAILURE_ENTANGLES;
}

/* Runs until something is wrong. Returns the number of events at the last check that found nothing. */
static uint64_t run_checked(struct run *run, uint64_t stride, const struct touchstone_limits *limits,
							const struct watch *watch, struct failure *failure)
{
	struct touchstone_status status;
	struct deep_overlap deep;
	uint64_t checks = 0;
	for (uint64_t good = 0;;) {
		bool goes_on = advance(run, stride, limits, watch);
		if (judge(run, failure, &deep)) {
			if (failure->kind == FAILURE_PASSES) wait_for_parting(run, &deep, stride, limits, watch, failure);
			return good;
		}
		touchstone_status(run->engine, &status);
		good = failure->events = status.events;
		run->clock = status.time;
		failure->stopped = watch && watch->stop && *watch->stop;
		if (!goes_on && !failure->stopped && good < limits->events && limits->time == INFINITY)
			fail(run, failure, FAILURE_OVER, "after %llu events, at t = %.9g", (unsigned long long)good, status.time);
		if (!goes_on || failure->stopped) return good;
		if (++checks % SPACING) continue;
		run_forget(run);
		run->keeps = touchstone_save(run->engine, &run->kept);
	}
}

/* The first event that shows what was found: the run again, event by event after the last good check. */
static void find_first(struct run *run, uint64_t good, const struct touchstone_limits *limits,
					   const struct watch *watch, struct failure *failure)
{
	struct failure first = {0};
	struct deep_overlap deep;
	const struct watch quiet = {watch ? watch->stop : NULL, NULL, NULL};
	struct touchstone_status status;
	touchstone_status(run->engine, &status);
	if (good > status.events) advance(run, good - status.events, limits, &quiet);
	touchstone_status(run->engine, &status);
	run->clock = status.time;
	if (judge(run, &first, &deep)) return;
	while (first.kind == FAILURE_NONE && advance(run, 1, limits, &quiet)) judge(run, &first, &deep);
	if (first.kind == FAILURE_NONE) judge(run, &first, &deep);
	if (first.kind == FAILURE_NONE) return;
	if (first.kind != FAILURE_PASSES || failure->kind != FAILURE_ENTANGLES) failure->kind = first.kind;
	failure->event = first.event;
	failure->time = first.time;
	memcpy(failure->text, first.text, sizeof failure->text);
}

bool failure_find(const struct touchstone_scene *scene, double collisions, const char *arithmetic, const char *method,
				  const struct touchstone_limits *limits, const struct watch *watch, struct failure *failure,
				  char error[160])
{
	struct run run;
	uint64_t stride = scene->particle_count / 2 + 1, good = 0;
	*failure = (struct failure){0};
	bool made = run_begin(&run, scene, collisions, arithmetic, method, watch, error);
	struct touchstone_limits until = *limits;
	if (made) {
		until.time += run.clock;
		good = run_checked(&run, stride, &until, watch, failure);
	}
	if (!made || failure_survived(failure)) {
		run_end(&run);
		if (failure->kind == FAILURE_REST) failure->event = 0;
		return made;
	}
	made = run_back(&run, collisions, arithmetic, method, watch, error);
	if (made) find_first(&run, good, &until, watch, failure);
	run_end(&run);
	return made;
}

const char *failure_word(enum failure_kind kind)
{
	static const char *const words[] = {"survives",  "rests",     "no events", "drifts", "gains energy", "penetrates",
										"entangles", "runs back", "loops",     "halts",  "not finite"};
	return words[kind];
}
