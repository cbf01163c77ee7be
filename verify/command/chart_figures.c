/* The chart's figures: speed against accuracy, with the frontier. */
#include "command/charting.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "display.h"
#include "result.h"

static const char *const columns[] = {"x", "y", "low", "high", "best", NULL};
static const char *const origins[CHART_ORIGINS] = {"hand-made questions", "harvested questions"};
static const char *const ways[2] = {"throughput", "latency"};

/* A point of a figure, for all kinds of points. */
struct spot {
	double x, y, low, high;
	bool best, named; /* on the frontier; with its name beside it */
	const struct finder *finder;
};

/* How far up a value stands on its axis; a share of zero has a place of its own at the bottom. */
static double height(double y, bool logarithmic)
{
	return !logarithmic ? y : y > 0 ? log10(y) : -8;
}

static int compare_spots(const void *one, const void *other)
{
	double x = (*(struct spot *const *)one)->x, y = (*(struct spot *const *)other)->x;
	return (x > y) - (x < y);
}

/* Where a spot is, as a part of what all of them take up. */
struct place {
	double across, up;
};

static struct place place_of(const struct spot *spot, const struct spot *spots, size_t count, bool logarithmic)
{
	double left = INFINITY, right = -INFINITY, bottom = INFINITY, top = -INFINITY;
	for (size_t s = 0; s < count; s++) {
		if (isnan(spots[s].x) || isnan(spots[s].y)) continue;
		left = fmin(left, log(spots[s].x)), right = fmax(right, log(spots[s].x));
		bottom = fmin(bottom, height(spots[s].y, logarithmic)), top = fmax(top, height(spots[s].y, logarithmic));
	}
	return (struct place){(log(spot->x) - left) / (right - left),
						  (height(spot->y, logarithmic) - bottom) / (top - bottom)};
}

/* Whether the name of a spot would lie over that of one further left: a letter takes a fiftieth of the width. */
static bool crowded(const struct spot *spot, const struct spot *left, const struct spot *spots, size_t count,
					bool logarithmic)
{
	struct place here = place_of(spot, spots, count, logarithmic), there = place_of(left, spots, count, logarithmic);
	size_t letters = strlen(left->finder->method) + 1 + strlen(left->finder->arithmetic);
	return here.across - there.across < 0.02 * (double)letters && fabs(here.up - there.up) < 0.055;
}

/* Finds the best, from left to right, and which of them to name. `best` has room for all; returns how many they are. */
static size_t name_spots(struct spot *spots, size_t count, bool logarithmic, struct spot **best)
{
	size_t found = 0;
	for (size_t s = 0; s < count; s++)
		if (spots[s].best) best[found++] = &spots[s];
	qsort(best, found, sizeof(struct spot *), compare_spots);
	for (size_t b = 0; b < found; b++) {
		best[b]->named = true;
		for (size_t left = 0; left < b && best[b]->named; left++)
			best[b]->named = !(best[left]->named && crowded(best[b], best[left], spots, count, logarithmic));
	}
	return found;
}

static void add_spot(struct figure_series series, const struct spot *spot, const char *title)
{
	char link[100];
	snprintf(link, sizeof link, "grade-%s.html", spot->finder->method);
	char *name;
	if (asprintf(&name, "%s %s", spot->finder->method, spot->finder->arithmetic) < 0) return;
	series_row(series, (double[]){spot->x, spot->y, spot->low, spot->high, spot->best});
	series_mark(series, &(struct series_mark){name, title, link, spot->named});
	free(name);
}

/* The staircase through the best. */
static void add_frontier(struct result_figure figure, struct spot *const *best, size_t count, const char *row,
						 const char *column)
{
	struct figure_series series = figure_series(figure, "frontier", SERIES_LINE);
	series_panel(series, row, column, NULL);
	for (size_t b = 0; b < count; b++) series_row(series, (double[]){best[b]->x, best[b]->y, NAN, NAN, 1});
}

/* ---- finders */

struct panel {
	const struct chart_plan *plan;
	const struct chart *chart;
	bool faults;
	int origin, way;
};

static struct spot finder_spot(const struct panel *panel, size_t f)
{
	const struct chart_side *side = &panel->chart->finders[f][panel->origin];
	double share = side->cases ? (double)(side->missed + side->phantom) / (double)side->cases : NAN;
	return (struct spot){
		.x = panel->way ? side->latency : side->throughput,
		.y = panel->faults ? share : side->bits,
		.low = panel->faults ? side->faults.low : NAN,
		.high = panel->faults ? side->faults.high : NAN,
		.best = panel->faults ? side->best_rate[panel->way] : side->best_bits[panel->way],
		.finder = &panel->plan->finders[f],
	};
}

static char *finder_words(const struct finder *finder, const struct chart_side *side)
{
	char *words, cases[DISPLAY_ROOM];
	display_count(cases, (json_int_t)side->cases);
	return asprintf(&words,
					"%s in %s\n%.3g ns per call one after the other, %.3g ns of latency; %.3g times `stable` in "
					"binary64\n%.4g bits right in 99.9 %% of the answers, %.4g in half of them\n%" PRIu64
					" missed and %" PRIu64 " phantom in %s questions",
					finder->method, finder->arithmetic, side->throughput, side->latency, side->times_stable, side->bits,
					side->median, side->missed, side->phantom, cases) < 0
			   ? NULL
			   : words;
}

static void add_panel(struct result_figure figure, const struct panel *panel)
{
	const struct chart_plan *plan = panel->plan;
	const char *row = origins[panel->origin], *column = ways[panel->way];
	struct spot *spots = calloc(plan->finder_count + 1, sizeof *spots);
	struct spot **best = calloc(plan->finder_count + 1, sizeof(struct spot *));
	size_t count = spots && best ? plan->finder_count : 0;
	struct figure_series series = {0};
	for (size_t f = 0; f < count; f++) spots[f] = finder_spot(panel, f);
	size_t found = name_spots(spots, count, panel->faults, best);
	for (size_t f = 0; f < count; f++) {
		const struct finder *finder = &plan->finders[f];
		char *words = finder_words(finder, &panel->chart->finders[f][panel->origin]);
		if (f == 0 || strcmp(finder->method, finder[-1].method) != 0) {
			series = figure_series(figure, finder->method, SERIES_POINTS);
			series_panel(series, row, column, NULL);
		}
		add_spot(series, &spots[f], words);
		free(words);
	}
	add_frontier(figure, best, found, row, column);
	free(best);
	free(spots);
}

static void add_finders(struct result *result, const struct chart_plan *plan, const struct chart *chart, bool faults)
{
	struct result_figure figure = result_figure(
		result,
		&(struct figure_frame){
			.name = faults ? "faults" : "bits",
			.kind = "frontier",
			.title = faults ? "Finders: speed against missed and phantom events" : "Finders: speed against bits",
			.caption = faults ? "The same finders and times, against the share of questions whose event they miss or "
								"make up, with its 95 % interval (Clopper and Pearson). Lower is better."
							  : "Each point is a method in an arithmetic. Across, the time of a call: one after the "
								"other as fast as may be (throughput), and each waiting for the answer to the one "
								"before (latency). Up, how many bits 99.9 % of the answers have right. The line is "
								"the frontier: what lies on it is beaten by nothing that is both faster and better; "
								"the others are faint. Rest the pointer on a point for its numbers, click for the "
								"method's grades.",
			.alternative = faults ? "Four panels of points, time of a call across, share of faults up, with the "
									"frontier from upper left to lower right."
								  : "Four panels of points, time of a call across, bits up, with the frontier from "
									"lower left to upper right. The table has all numbers.",
			.x = {"nanoseconds per call", 10, {0, 0}},
			.y = {faults ? "share of questions missed or phantom" : "bits right in 99.9 % of the answers",
				  faults ? 10 : 0,
				  {0, 0}},
			.columns = columns,
		});
	for (int origin = CHART_ORIGINS - 1; origin >= 0; origin--)
		for (int way = 0; way < 2; way++) add_panel(figure, &(struct panel){plan, chart, faults, origin, way});
}

/* ---- engines */

static char *engine_words(const struct finder *finder, const struct chart_engine *engine)
{
	char *words;
	return asprintf(
			   &words,
			   "%s in %s: %d bits\n%.4g ns per event, %.3g times `stable` in binary64\n%.4g events per particle to "
			   "be trusted, deviation %.2g over %zu start states",
			   finder->method, finder->arithmetic, engine->bits, engine->nanoseconds, engine->times_stable,
			   engine->horizon.mean, engine->horizon.deviation, engine->horizon.count) < 0
			   ? NULL
			   : words;
}

static void add_engine_points(struct result_figure figure, const struct chart_plan *plan, const struct chart *chart)
{
	struct spot *spots = calloc(plan->engine_count, sizeof *spots);
	struct spot **best = calloc(plan->engine_count, sizeof(struct spot *));
	size_t count = spots && best ? plan->engine_count : 0;
	struct figure_series series = {0};
	for (size_t e = 0; e < count; e++) {
		const struct chart_engine *engine = &chart->engines[e];
		double mean = engine->horizon.mean, deviation = engine->horizon.deviation;
		spots[e] = (struct spot){engine->nanoseconds, mean,  mean - deviation, mean + deviation,
								 engine->best,        false, &plan->engines[e]};
	}
	size_t found = name_spots(spots, count, false, best);
	for (size_t e = 0; e < count; e++) {
		const struct finder *finder = &plan->engines[e];
		char *words = engine_words(finder, &chart->engines[e]);
		if (e == 0 || strcmp(finder->method, finder[-1].method) != 0) {
			series = figure_series(figure, finder->method, SERIES_POINTS);
			series_panel(series, "", "", NULL);
		}
		add_spot(series, &spots[e], words);
		free(words);
	}
	add_frontier(figure, best, found, "", "");
	free(best);
	free(spots);
}

static void add_engines(struct result *result, const struct chart_plan *plan, const struct chart *chart)
{
	struct result_figure figure = result_figure(
		result,
		&(struct figure_frame){
			.name = "engines",
			.kind = "frontier",
			.title = "Engines: what an event costs, and how long a run can be trusted",
			.caption = "Each point is the whole engine in an arithmetic. Up, the horizon: how many events a mean "
					   "particle takes part in before the sequence of events differs from that of the same start "
					   "state in an arithmetic of at least twice the bits; bars are one standard deviation over the "
					   "start states. Errors grow exponentially, so the horizon grows in proportion to the bits.",
			.alternative = "Points with error bars, time of an event across, horizon up: more bits, later "
						   "differences, at a higher price.",
			.x = {"nanoseconds per event", 10, {0, 0}},
			.y = {"events per particle to be trusted", 0, {0, 0}},
			.columns = columns,
		});
	add_engine_points(figure, plan, chart);
}

void chart_figures(struct result *result, const struct chart_plan *plan, const struct chart *chart)
{
	for (int faults = 0; faults < 2; faults++) add_finders(result, plan, chart, faults);
	if (plan->engine_count) add_engines(result, plan, chart);
}
