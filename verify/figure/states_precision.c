/* How often positions contradict the tracked state, over the precision of the arithmetic. */
#include "figure/step_gas.h"

#include <math.h>
#include <stdio.h>

#include "measure/interval.h"

static const struct rung {
	const char *arithmetic;
	int bits;
} ladder[] = {{"short:14", 14}, {"short:16", 16}, {"short:18", 18}, {"short:20", 20}, {"short:22", 22},
			  {"binary32", 24}, {"mpfr:32", 32},  {"binary64", 53}, {"mpfr:106", 106}};
enum { RUNGS = sizeof ladder / sizeof *ladder, SCENES = 2, PARTICLES = 1372 };

size_t states_precision_gases(bool full, struct step_gas *gases)
{
	for (int r = 0; r < RUNGS; r++)
		for (int g = 0; g < SCENES; g++) {
			bool slow = ladder[r].bits == 32 || ladder[r].bits > 53;
			gases[SCENES * r + g] = (struct step_gas){.shoulder = g,
													  .particles = PARTICLES,
													  .form = TOUCHSTONE_RELATIVE,
													  .arithmetic = ladder[r].arithmetic,
													  .method = "stable",
													  .equilibrate = 20,
													  .events = (full ? 4000000 : 80000) / (slow ? 8 : 1)};
		}
	return RUNGS * SCENES;
}

/* What the figure and the fits are of: a kind, or the two rare ones together. */
static const struct curve {
	const char *label;
	enum inconsistency_kind kind, with;
} curves[] = {
	{"its own pair, executed", INCONSISTENT_EXECUTED, INCONSISTENT_EXECUTED},
	{"its own pair, when found", INCONSISTENT_FOUND, INCONSISTENT_FOUND},
	{"any pair, by another's event", INCONSISTENT_LATER, INCONSISTENT_OTHERS},
};
enum { CURVES = sizeof curves / sizeof *curves };

static uint64_t hits(const struct curve *curve, const struct inconsistency *inconsistency)
{
	return inconsistency->count[curve->kind] + (curve->with != curve->kind ? inconsistency->count[curve->with] : 0);
}

/* One curve of one scene, and the line through its logarithms; returns how many points it has. */
static size_t draw(struct result_figure figure, const struct curve *curve, int scene,
				   const struct step_gas_outcome *outcomes, struct line_fit *fit)
{
	double x[RUNGS], y[RUNGS];
	size_t points = 0;
	char label[80];
	snprintf(label, sizeof label, "%s, %s", scene ? "shoulder" : "well", curve->label);
	struct figure_series series = figure_series(figure, label, SERIES_POINTS);
	for (int r = 0; r < RUNGS; r++) {
		const struct inconsistency *inconsistency = &outcomes[SCENES * r + scene].inconsistency;
		uint64_t count = hits(curve, inconsistency);
		if (!count) continue;
		struct interval interval = interval_of_rate(count, (double)inconsistency->events);
		double rate = (double)count / (double)inconsistency->events;
		x[points] = ladder[r].bits, y[points++] = log2(rate);
		series_row(series, (double[]){ladder[r].bits, rate, interval.low, interval.high});
	}
	if (points > 2) *fit = fit_line(x, y, points);
	return points;
}

static void add_table(struct result *result, const struct step_gas_outcome *outcomes)
{
	static const char *const columns[] = {"scene",    "arithmetic", "events",
										  "executed", "found",      "after",
										  "later",    "others",     "later and others per event (95 %)",
										  NULL};
	struct result_table table =
		result_table(result, "Inconsistencies by precision",
					 "How often, as in the first table; 1372 particles, the stable method.", columns);
	for (int g = 0; g < SCENES; g++)
		for (int r = 0; r < RUNGS; r++) {
			const struct inconsistency *inconsistency = &outcomes[SCENES * r + g].inconsistency;
			if (!inconsistency->events) continue;
			uint64_t rare = hits(&curves[CURVES - 1], inconsistency);
			struct interval interval = interval_of_rate(rare, (double)inconsistency->events);
			table_row(table);
			table_text(table, "%s", g ? "square-shoulder" : "square-well");
			table_text(table, "%s", ladder[r].arithmetic);
			table_count(table, inconsistency->events);
			for (int kind = 0; kind < INCONSISTENCIES; kind++) table_count(table, inconsistency->count[kind]);
			table_text(table, "%.3g (%.2g to %.2g)", (double)rare / (double)inconsistency->events, interval.low,
					   interval.high);
		}
}

void states_precision_tell(struct result *result, const struct step_gas *gases, const struct step_gas_outcome *outcomes)
{
	(void)gases;
	static const char *const columns[] = {"x", "y", "low", "high", NULL};
	struct result_figure figure = result_figure(
		result,
		&(struct figure_frame){
			.name = "precision",
			.kind = "curves",
			.title = "Inconsistencies per event, by precision",
			.caption = "A pair at its step by its own event is on the wrong side of it nearly every other time, in any "
					   "arithmetic. Any other pair is so by the rounding of its flight alone, and that falls with "
					   "every bit; where no point stands, none was seen. Bars: 95 %.",
			.alternative = "Two groups of level points between a tenth and a half, and one that falls by half a decade "
						   "per two bits or so until nothing is seen.",
			.x = {"significand bits", 0, {0, 0}},
			.y = {"per event", 10, {0, 0}},
			.columns = columns,
		});
	for (int c = 0; c < CURVES; c++)
		for (int g = 0; g < SCENES; g++) {
			struct line_fit fit = {0};
			size_t points = draw(figure, &curves[c], g, outcomes, &fit);
			if (c < CURVES - 1 || points < 3) continue;
			static const double reported[] = {1.4e-7, 2.6e-7};
			result_note(
				result,
				"%s: pairs made inconsistent by another's event are 2^(%.2f %+.3f bits) per event (standard "
				"error of the slope %.2g, %zu precisions): %.2g in binary64 if the line goes on, and %.1f bits for "
				"the %.2g that the paper reports.",
				g ? "Shoulder" : "Well", fit.intercept, fit.slope, fit.slope_error, points,
				exp2(fit.intercept + 53 * fit.slope), (log2(reported[g]) - fit.intercept) / fit.slope, reported[g]);
		}
	add_table(result, outcomes);
}
