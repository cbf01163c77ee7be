/* The chart as a result for the report: words, figures, and all their numbers. */
#include "command/charting.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "display.h"
#include "result.h"

/* ---- tables */

static void add_finder_table(struct result *result, const struct chart_plan *plan, const struct chart *chart,
							 enum family_origin origin)
{
	static const char *const heads[] = {"method",       "arithmetic",   "frontier",    "ns per call",
										"latency, ns",  "times stable", "bits 99.9 %", "bits 50 %",
										"least bits",   "questions",    "missed",      "phantom",
										"95 % of both", "negative",     "nan",         NULL};
	char title[80];
	snprintf(title, sizeof title, "Finders, %s",
			 origin == FAMILY_HARVESTED ? "harvested questions" : "hand-made questions");
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

static void add_engine_table(struct result *result, const struct chart_plan *plan, const struct chart *chart)
{
	static const char *const heads[] = {"method",       "arithmetic",           "bits",         "frontier",
										"ns per event", "times stable",         "horizon",      "deviation",
										"start states", "without a difference", "held against", NULL};
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

/* One that lies on a frontier. */
struct best {
	const struct finder *finder;
	double nanoseconds, worth;
};

static int compare_best(const void *one, const void *other)
{
	double x = ((const struct best *)one)->nanoseconds, y = ((const struct best *)other)->nanoseconds;
	return (x > y) - (x < y);
}

/* The frontier of finders by throughput on harvested questions, or that of engines; returns how many there are. */
static size_t find_best(const struct chart_plan *plan, const struct chart *chart, bool engines, struct best *best)
{
	size_t found = 0;
	for (size_t f = 0; !engines && f < plan->finder_count; f++) {
		const struct chart_side *side = &chart->finders[f][FAMILY_HARVESTED];
		if (side->best_bits[0]) best[found++] = (struct best){&plan->finders[f], side->throughput, side->bits};
	}
	for (size_t e = 0; engines && e < plan->engine_count; e++) {
		const struct chart_engine *engine = &chart->engines[e];
		if (engine->best) best[found++] = (struct best){&plan->engines[e], engine->nanoseconds, engine->horizon.mean};
	}
	qsort(best, found, sizeof *best, compare_best);
	return found;
}

/* A paragraph that goes along a frontier. */
static void add_best(struct result *result, const struct chart_plan *plan, const struct chart *chart, bool engines)
{
	struct best *best = calloc(plan->finder_count + plan->engine_count, sizeof *best);
	size_t count = best ? find_best(plan, chart, engines, best) : 0, size;
	char *words = NULL, nanoseconds[DISPLAY_ROOM], worth[DISPLAY_ROOM];
	FILE *stream = count ? open_memstream(&words, &size) : NULL;
	for (size_t b = 0; stream && b < count; b++) {
		display_number(nanoseconds, best[b].nanoseconds, 3);
		display_number(worth, best[b].worth, 3);
		fprintf(stream, "%s%s %s (%s ns, %s %s)", b ? "; " : "", best[b].finder->method, best[b].finder->arithmetic,
				nanoseconds, worth, engines ? "events" : "bits");
	}
	if (stream) fclose(stream);
	if (words)
		result_paragraph(result, "%s: %s.",
						 engines ? "Engines, by the cost of an event and the events per particle that can be trusted"
								 : "Finders than which none is both faster and better, on harvested questions",
						 words);
	free(words);
	free(best);
}

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
	add_best(result, plan, chart, false);
	add_best(result, plan, chart, true);
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
	chart_figures(result, plan, chart);
	for (int origin = CHART_ORIGINS - 1; origin >= 0; origin--)
		add_finder_table(result, plan, chart, (enum family_origin)origin);
	if (plan->engine_count) add_engine_table(result, plan, chart);
	return result;
}
