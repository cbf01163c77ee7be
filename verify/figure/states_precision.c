/* How often positions contradict the tracked state, over the precision of the arithmetic. */
#include "figure/step_gas.h"

#include <math.h>
#include <stdio.h>

#include "measure/interval.h"
#include "measure/rate_fit.h"

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
													  .events = (full ? 1000000 : 80000) / (slow ? 8 : 1)};
		}
	return RUNGS * SCENES;
}

/* What the figure and the fits are of: a kind, or the two rare ones together. */
static const struct curve {
	const char *label;
	enum inconsistency_kind kind, with;
} curves[] = {
	{"its own pair, executed", INCONSISTENT_EXECUTED, INCONSISTENT_EXECUTED},
	{"any pair, by another's event", INCONSISTENT_LATER, INCONSISTENT_OTHERS},
};
enum { CURVES = sizeof curves / sizeof *curves };

static uint64_t hits(const struct curve *curve, const struct inconsistency *inconsistency)
{
	return inconsistency->count[curve->kind] + (curve->with != curve->kind ? inconsistency->count[curve->with] : 0);
}

/* One curve of one scene. */
static void draw(struct result_figure figure, const struct curve *curve, int scene,
				 const struct step_gas_outcome *outcomes)
{
	char label[80];
	snprintf(label, sizeof label, "%s, %s", scene ? "shoulder" : "well", curve->label);
	struct figure_series series = figure_series(figure, label, SERIES_POINTS);
	for (int r = 0; r < RUNGS; r++) {
		const struct inconsistency *inconsistency = &outcomes[SCENES * r + scene].inconsistency;
		uint64_t count = hits(curve, inconsistency);
		if (!count) continue;
		struct interval interval = interval_of_rate(count, (double)inconsistency->events);
		series_row(series, (double[]){ladder[r].bits, (double)count / (double)inconsistency->events, interval.low,
									  interval.high});
	}
}

/* The rare ones as a multiple of the roundoff: of all precisions together, also where none was seen. */
static void extrapolate(struct result *result, struct result_figure figure, int scene,
						const struct step_gas_outcome *outcomes)
{
	static const double reported[] = {1.4e-7, 2.6e-7};
	struct rung_count rung[RUNGS];
	double exposure = 0;
	uint64_t count = 0;
	for (int r = 0; r < RUNGS; r++) {
		const struct inconsistency *inconsistency = &outcomes[SCENES * r + scene].inconsistency;
		uint64_t seen = hits(&curves[CURVES - 1], inconsistency);
		rung[r] = (struct rung_count){ladder[r].bits, (double)inconsistency->events, seen};
		count += seen;
		exposure += ldexp((double)inconsistency->events, -ladder[r].bits);
	}
	if (!count) return;
	double factor = (double)count / exposure, paper = reported[scene];
	struct interval interval = interval_of_rate(count, exposure);
	struct rate_fit fit = rate_fit(rung, RUNGS, 1);
	struct figure_series series = figure_series(
		figure, scene ? "shoulder, proportional to the roundoff" : "well, proportional to the roundoff", SERIES_LINE);
	for (int bits = ladder[0].bits; bits <= 54; bits += 10)
		series_row(series, (double[]){bits, ldexp(factor, -bits), NAN, NAN});
	result_note(
		result,
		"%s: if they are proportional to the roundoff, pairs made inconsistent by another's event come to %.3g "
		"times 2^-bits per event (95 %%: %.3g to %.3g; %llu seen): %.2g in binary64. (With the exponent left free "
		"it is %.2f, standard error %.2f.) The paper's %.2g is what they come to with %.1f significant bits (%.1f to "
		"%.1f), not far from binary32's 24.",
		scene ? "Shoulder" : "Well", factor, interval.low, interval.high, (unsigned long long)count, ldexp(factor, -53),
		fit.exponent, rate_fit_exponent_error(&fit), paper, log2(factor / paper), log2(interval.low / paper),
		log2(interval.high / paper));
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
					   "every bit; where no point stands, none was seen. Bars: 95 %. Lines: proportional to the "
					   "roundoff, fitted to all precisions together.",
			.alternative = "Points level between a tenth and a half, and below them two lines that fall by half with "
						   "every bit.",
			.x = {"significand bits", 0, {0, 0}},
			.y = {"per event", 10, {0, 0}},
			.columns = columns,
		});
	for (int c = 0; c < CURVES; c++)
		for (int g = 0; g < SCENES; g++) draw(figure, &curves[c], g, outcomes);
	for (int g = 0; g < SCENES; g++) extrapolate(result, figure, g, outcomes);
	add_table(result, outcomes);
}
