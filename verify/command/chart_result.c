/* The chart as a result for the report: figures of speed against accuracy, and all their numbers. */
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
	bool best;
	const struct finder *finder;
};

static void add_spot(struct figure_series series, const struct spot *spot, const char *title)
{
	char link[100];
	snprintf(link, sizeof link, "grade-%s.html", spot->finder->method);
	char *name;
	if (asprintf(&name, "%s %s", spot->finder->method, spot->finder->arithmetic) < 0) return;
	series_row(series, (double[]){spot->x, spot->y, spot->low, spot->high, spot->best});
	series_mark(series, &(struct series_mark){name, title, link, spot->best});
	free(name);
}

static int compare_spots(const void *one, const void *other)
{
	double x = ((const struct spot *)one)->x, y = ((const struct spot *)other)->x;
	return (x > y) - (x < y);
}

/* The staircase through the best of them, which are moved about. */
static void add_frontier(struct result_figure figure, struct spot *spots, size_t count, const char *row,
						 const char *column)
{
	struct figure_series series = figure_series(figure, "frontier", SERIES_LINE);
	series_panel(series, row, column, NULL);
	qsort(spots, count, sizeof *spots, compare_spots);
	for (size_t s = 0; s < count; s++)
		if (spots[s].best) {
			series_row(series, (double[]){spots[s].x, spots[s].y, NAN, NAN, 1});
			series_mark(series, &(struct series_mark){"", "", NULL, false});
		}
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
	struct spot *spots = calloc(plan->finder_count + 1, sizeof *spots);
	struct figure_series series = {0};
	for (size_t f = 0; spots && f < plan->finder_count; f++) {
		const struct finder *finder = &plan->finders[f];
		if (f == 0 || strcmp(finder->method, finder[-1].method) != 0) {
			series = figure_series(figure, finder->method, SERIES_POINTS);
			series_panel(series, origins[panel->origin], ways[panel->way], NULL);
		}
		spots[f] = finder_spot(panel, f);
		char *words = finder_words(finder, &panel->chart->finders[f][panel->origin]);
		add_spot(series, &spots[f], words);
		free(words);
	}
	if (spots) add_frontier(figure, spots, plan->finder_count, origins[panel->origin], ways[panel->way]);
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

static void add_finder_table(struct result *result, const struct chart_plan *plan, const struct chart *chart,
							 enum family_origin origin)
{
	static const char *const heads[] = {"method",       "arithmetic",   "frontier",    "ns per call",
										"latency, ns",  "times stable", "bits 99.9 %", "bits 50 %",
										"least bits",   "questions",    "missed",      "phantom",
										"95 % of both", "negative",     "nan",         NULL};
	char title[80];
	snprintf(title, sizeof title, "Finders, %s", origins[origin]);
	struct result_table table =
		result_table(result, title,
					 "On the frontier of bits: t by throughput, l by latency. Missed and phantom together per "
					 "question, interval by Clopper and Pearson.",
					 heads);
	for (size_t f = 0; f < plan->finder_count; f++) {
		const struct chart_side *side = &chart->finders[f][origin];
		const double numbers[] = {side->throughput, side->latency, side->times_stable,
								  side->bits,       side->median,  side->least};
		table_row(table);
		table_text(table, "%s", plan->finders[f].method);
		table_text(table, "%s", plan->finders[f].arithmetic);
		table_text(table, "%s%s", side->best_bits[0] ? "t" : "", side->best_bits[1] ? "l" : "");
		for (int n = 0; n < 6; n++) table_number(table, numbers[n]);
		table_count(table, side->cases);
		table_count(table, side->missed);
		table_count(table, side->phantom);
		table_text(table, "%.2g to %.2g", side->faults.low, side->faults.high);
		table_count(table, side->negative);
		table_count(table, side->nan);
	}
}

/* ---- engines */

static void add_engine_points(struct result_figure figure, const struct chart_plan *plan, const struct chart *chart)
{
	struct spot *spots = calloc(plan->engine_count + 1, sizeof *spots);
	struct figure_series series = {0};
	for (size_t e = 0; spots && e < plan->engine_count; e++) {
		const struct finder *finder = &plan->engines[e];
		const struct chart_engine *engine = &chart->engines[e];
		double mean = engine->horizon.mean, deviation = engine->horizon.deviation;
		if (e == 0 || strcmp(finder->method, finder[-1].method) != 0) {
			series = figure_series(figure, finder->method, SERIES_POINTS);
			series_panel(series, "", "", NULL);
		}
		spots[e] = (struct spot){engine->nanoseconds, mean, mean - deviation, mean + deviation, engine->best, finder};
		char *words;
		if (asprintf(&words,
					 "%s in %s: %d bits\n%.4g ns per event, %.3g times binary64\n%.4g events per particle to be "
					 "trusted, deviation %.2g over %zu start states",
					 finder->method, finder->arithmetic, engine->bits, engine->nanoseconds, engine->times_stable, mean,
					 deviation, engine->horizon.count) < 0)
			break;
		add_spot(series, &spots[e], words);
		free(words);
	}
	if (spots) add_frontier(figure, spots, plan->engine_count, "", "");
	free(spots);
}

static void add_engines(struct result *result, const struct chart_plan *plan, const struct chart *chart)
{
	static const char *const heads[] = {"method",       "arithmetic",           "bits",         "frontier",
										"ns per event", "times binary64",       "horizon",      "deviation",
										"start states", "without a difference", "held against", NULL};
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
	struct result_table table = result_table(result, "Engines", NULL, heads);
	for (size_t e = 0; e < plan->engine_count; e++) {
		const struct chart_engine *engine = &chart->engines[e];
		const double numbers[] = {engine->nanoseconds, engine->times_stable, engine->horizon.mean,
								  engine->horizon.deviation};
		table_row(table);
		table_text(table, "%s", plan->engines[e].method);
		table_text(table, "%s", plan->engines[e].arithmetic);
		table_count(table, (uint64_t)engine->bits);
		table_text(table, "%s", engine->best ? "yes" : "");
		for (int n = 0; n < 4; n++) table_number(table, numbers[n]);
		table_count(table, engine->horizon.count);
		table_count(table, engine->horizon.open);
		table_text(table, "%s", engine->reference);
	}
}

/* ---- the whole */

static void add_words(struct result *result, const struct chart_plan *plan, const struct chart *chart)
{
	char cases[DISPLAY_ROOM];
	display_count(cases, (json_int_t)chart->cases);
	result_paragraph(
		result,
		"What finders of event times and whole engines cost, and what they are worth, measured on this machine: %zu "
		"methods in arithmetics, each asked %s questions of each family, and %zu engines from %d start states.",
		plan->finder_count, cases, plan->engine_count, chart->starts);
	result_paragraph(result,
					 "Questions made to be hard and questions harvested from runs of the engine are kept apart: shares "
					 "and bits among the former say nothing about how often a simulation meets them.");
	result_note(result,
				"An answer has -log2(|got - exact| / the larger of the two) bits right, infinitely many where "
				"it is exact and 0 where it is not even of the right size, or later than an event that is now. "
				"Answers are taken unrounded, in the arithmetic's own digits, and held against the exact time to "
				"64 bits more. Only events that are found have bits; missed and phantom ones are counted. "
				"Questions are binary64 numbers, and what a coarser arithmetic loses in reading them counts "
				"against it.");
	result_note(
		result,
		"Times are medians of 21 repetitions that take turns, of 2048 questions each, made beforehand, all "
		"families of an origin in turn, after one call to warm up; what the call takes with no question "
		"is subtracted. `stable` in binary64 is timed once more beside the others as their yardstick, so that its own "
		"ratio shows how well times repeat. `short:P` is computed in binary64 and rounded after each operation: its "
		"times "
		"are those of the imitation.");
	result_note(result,
				"Engines run %d elastic hard spheres at density 0.5, periodic, by the cells of the normal search, from "
				"states that an engine in binary64 has equilibrated. All of it fits into the caches, so that the "
				"arithmetic is what is seen. In the count of events per particle a collision counts for two particles. "
				"Where a start state showed no difference, the mean is too low.",
				CHART_SPHERES);
}

struct result *chart_result(const struct chart_plan *plan, const struct chart *chart)
{
	struct result *result = result_new("chart", "Speed against accuracy");
	if (!result) return NULL;
	add_words(result, plan, chart);
	if (chart->interrupted)
		result_incomplete(result, "interrupted: what has no number was not measured, and the frontier is that of the "
								  "others");
	for (int faults = 0; faults < 2; faults++) add_finders(result, plan, chart, faults);
	if (plan->engine_count) add_engines(result, plan, chart);
	for (int origin = CHART_ORIGINS - 1; origin >= 0; origin--)
		add_finder_table(result, plan, chart, (enum family_origin)origin);
	return result;
}
