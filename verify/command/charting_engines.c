/* The engines' half of the chart: what an event costs, and for how many events a run can be trusted. */
#include "command/charting.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "measure/call_time.h"
#include "measure/frontier.h"
#include "measure/start_state.h"

enum {
	TIMED = 400,                       /* events that are timed together */
	LONGEST = 1000 * CHART_SPHERES / 2 /* events after which two arithmetics are taken to be of one mind */
};
static const double equilibrate = 20; /* elastic collisions per particle */

static bool stopped(const struct chart_plan *plan)
{
	return plan->stop && *plan->stop;
}

/* An equilibrated gas. False with `error` empty when stopped. */
static bool make_scene(const struct chart_plan *plan, uint64_t seed, struct touchstone_scene *scene, char error[160])
{
	const struct scene_recipe recipe = start_spheres(CHART_SPHERES, 0.5);
	return start_scene(&recipe, seed, equilibrate, &(struct watch){.stop = plan->stop}, scene, error);
}

/* ---- horizons */

/* All engines, from one start state. */
static bool run_start(const struct chart_plan *plan, struct chart *chart, int start, char error[160])
{
	struct touchstone_scene scene;
	if (!make_scene(plan, plan->seed + (uint64_t)start, &scene, error)) return !*error;
	const struct touchstone_limits limits = {.events = LONGEST, .time = INFINITY};
	const struct watch watch = {.stop = plan->stop};
	bool good = true;
	for (size_t e = 0; good && e < plan->engine_count; e++) {
		struct chart_engine *engine = &chart->engines[e];
		good = horizon_find(&scene, plan->engines[e].method, plan->engines[e].arithmetic, engine->reference, &limits,
							&watch, &engine->horizons[start], error);
	}
	scene_free(&scene);
	return good;
}

/* Whether another start state may begin: of two there is always time. */
static bool time_left(const struct chart_plan *plan, int start, double began)
{
	return !stopped(plan) && (start < 2 || plan->seconds <= 0 || progress_clock() - began < plan->seconds);
}

static bool find_horizons(const struct chart_plan *plan, struct chart *chart, double began, char error[GRADING_ERROR])
{
	struct progress progress = progress_begin("horizons", "start states");
	bool good = true;
	int done = 0;
#pragma omp parallel for schedule(dynamic, 1) num_threads(plan->threads)
	for (int start = 0; start < plan->starts; start++) {
		char why[160];
		if (!time_left(plan, start, began)) continue;
		bool ran = run_start(plan, chart, start, why);
#pragma omp critical(chart_progress)
		{
			if (!ran) snprintf(error, GRADING_ERROR, "%s", why);
			good &= ran;
			progress_show(&progress, ++done, plan->starts);
		}
	}
	progress_end(&progress);
	for (size_t e = 0; e < plan->engine_count; e++) {
		struct horizon_spread *spread = &chart->engines[e].horizon;
		*spread = horizon_spread(chart->engines[e].horizons, (size_t)plan->starts);
		chart->starts = (int)spread->count > chart->starts ? (int)spread->count : chart->starts;
	}
	return good;
}

/* ---- times */

static void call_engine(void *context, size_t count)
{
	const struct touchstone_limits limits = {.events = count, .time = INFINITY};
	touchstone_run(context, &limits, NULL);
}

/* An engine that has come to its end takes no time that means anything. */
static double time_of(const struct call_time *callee)
{
	struct touchstone_status status;
	touchstone_status(callee->context, &status);
	return status.verdict == TOUCHSTONE_DONE ? callee->nanoseconds : NAN;
}

/* Times all engines from one start state, with `stable` in binary64 among them to compare with. */
static bool find_times(const struct chart_plan *plan, struct chart *chart, char error[GRADING_ERROR])
{
	size_t count = plan->engine_count;
	struct call_time *callee = calloc(count + 1, sizeof *callee);
	struct touchstone_scene scene;
	char why[160] = "out of memory";
	bool good = callee && make_scene(plan, plan->seed, &scene, why), made = good;
	for (size_t e = 0; good && e <= count; e++) {
		const char *arithmetic = e < count ? plan->engines[e].arithmetic : "binary64";
		const char *method = e < count ? plan->engines[e].method : "stable";
		callee[e] = (struct call_time){call_engine, touchstone_create(&scene, arithmetic, method, why), NAN};
		good = callee[e].context;
	}
	if (good) call_time_measure(callee, count + 1, TIMED);
	for (size_t e = 0; good && e < count; e++) {
		chart->engines[e].nanoseconds = time_of(&callee[e]);
		chart->engines[e].times_stable = chart->engines[e].nanoseconds / time_of(&callee[count]);
	}
	for (size_t e = 0; callee && e <= count; e++) touchstone_destroy(callee[e].context);
	if (made) scene_free(&scene);
	free(callee);
	snprintf(error, GRADING_ERROR, "%s", why);
	return good || !*why;
}

/* ---- the whole */

static bool prepare(const struct chart_plan *plan, struct chart *chart, char error[GRADING_ERROR])
{
	for (size_t e = 0; e < plan->engine_count; e++) {
		struct chart_engine *engine = &chart->engines[e];
		char why[160];
		engine->bits = horizon_bits(plan->engines[e].arithmetic, why);
		engine->nanoseconds = engine->times_stable = NAN;
		snprintf(engine->reference, sizeof engine->reference, "mpfr:%d", engine->bits > 128 ? 2 * engine->bits : 256);
		engine->horizons = calloc((size_t)plan->starts, sizeof *engine->horizons);
		snprintf(error, GRADING_ERROR, "out of memory");
		if (!engine->horizons) return false;
		for (int start = 0; start < plan->starts; start++) engine->horizons[start].stopped = true; /* until it ran */
	}
	return true;
}

static bool find_frontier(const struct chart_plan *plan, struct chart *chart)
{
	struct frontier_point *point = calloc(plan->engine_count + 1, sizeof *point);
	if (!point) return false;
	for (size_t e = 0; e < plan->engine_count; e++)
		point[e] = (struct frontier_point){chart->engines[e].nanoseconds, chart->engines[e].horizon.mean, false};
	frontier_find(point, plan->engine_count);
	for (size_t e = 0; e < plan->engine_count; e++) chart->engines[e].best = point[e].best;
	free(point);
	return true;
}

bool chart_engines(const struct chart_plan *plan, struct chart *chart, double began, char error[GRADING_ERROR])
{
	return prepare(plan, chart, error) && (stopped(plan) || find_times(plan, chart, error)) &&
		   find_horizons(plan, chart, began, error) && find_frontier(plan, chart);
}
