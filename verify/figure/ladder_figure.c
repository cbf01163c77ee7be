/* How what goes wrong falls with the bits carried, followed down to binary64 and held against the 2014 paper. */
#include "figure/figure.h"

#include "figure/ladder.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Three-body events over bits, with their lines followed to 53, where the paper's own figures stand. */
static void add_rates(struct result *result, const struct ladder *ladder)
{
	static const char *const columns[] = {"bits", "error", "low", "high", NULL};
	struct result_figure figure = result_figure(
		result,
		&(struct figure_frame){
			.name = "three-body",
			.kind = "scaling",
			.title = "Three-body events over the bits carried",
			.caption = "Restitution and density in parentheses. Late clock: binary64 with absolute times that begin at "
					   "2^(53 - bits), so that so many bits are left below 1. The lines are those of the table, for "
					   "gases near collapse of little meaning. A rung without a count has no point; the lines know of "
					   "it. Where binary64 itself shows none, the upper end of its exact 95 % interval stands at 53 "
					   "bits.",
			.alternative = "Rates on a logarithmic axis against bits, with straight lines that fall by about half with "
						   "each bit, and pass far below the paper's figures at 53 bits.",
			.x = {"significand bits", 0, {0, 0}},
			.y = {"three-body events per event", 2, {0x1p-56, 1}},
			.columns = columns,
		});
	for (int lane = 0; lane < LADDER_LANES; lane++) {
		char label[64];
		struct figure_series series = figure_series(figure, ladder_label(ladder, lane, label), SERIES_POINTS);
		for (int r = 0; r < LADDER_RUNGS; r++) {
			const struct gas_tally *tally = &ladder->tally[lane * LADDER_RUNGS + r];
			if (!tally->three_body.events || !gas_lasted(tally)) continue;
			struct interval interval;
			double rate = three_body_rate(&tally->three_body, &interval);
			series_row(series, (double[]){ladder_bits(&ladder->point[lane * LADDER_RUNGS + r]), rate, interval.low,
										  interval.high});
		}
		series_row(series, (double[]){53, NAN, NAN, NAN}); /* so that the line is drawn so far */
		struct rate_fit fit = ladder_fit(ladder, lane, LADDER_EVENTS);
		series_fit(series, -fit.exponent, fit.intercept);
	}
	struct figure_series none = figure_series(figure, "none seen in binary64: at most", SERIES_POINTS);
	for (int lane = 0; lane < LADDER_LANES; lane++) {
		const struct gas_tally *direct = ladder_binary64(ladder, lane);
		struct interval interval;
		if (!direct || direct->three_body.events) continue;
		three_body_rate(&direct->three_body, &interval);
		series_row(none, (double[]){53, interval.high, 0, interval.high});
	}
	struct figure_series paper = figure_series(figure, "2014 paper, dilute elastic and inelastic", SERIES_POINTS);
	series_row(paper, (double[]){53, 1e-9, NAN, NAN});
	series_row(paper, (double[]){53, 1e-6, NAN, NAN});
}

static void add_depths(struct result *result, const struct ladder *ladder)
{
	static const char *const columns[] = {"bits", "error", "most", NULL};
	struct result_figure figure = result_figure(
		result,
		&(struct figure_frame){
			.name = "depth",
			.kind = "scaling",
			.title = "Depth of overlaps at impact over the bits carried",
			.caption = "Mean over the collisions below contact, about half of all. The deepest are in the tables.",
			.alternative = "Mean depths on a logarithmic axis against bits; all fall by half with each bit.",
			.x = {"significand bits", 0, {0, 0}},
			.y = {"depth in diameters", 2, {0, 0}},
			.columns = columns,
		});
	for (int lane = 0; lane < LADDER_LANES; lane++) {
		char label[64];
		size_t rungs;
		struct figure_series series = figure_series(figure, ladder_label(ladder, lane, label), SERIES_POINTS);
		for (int r = 0; r < LADDER_RUNGS; r++) {
			const struct gas_tally *tally = &ladder->tally[lane * LADDER_RUNGS + r];
			if (!tally->three_body.overlapping || !gas_lasted(tally)) continue;
			series_row(series, (double[]){ladder_bits(&ladder->point[lane * LADDER_RUNGS + r]),
										  ladder_measured(tally, LADDER_DEPTH), tally->three_body.deepest});
		}
		struct line_fit line = ladder_line(ladder, lane, LADDER_DEPTH, &rungs);
		series_fit(series, line.slope, line.intercept);
	}
}

/* ------------------------------------------------------------------ claims */

/* What the paper's run would show at the end, if times were absolute: its clock then, 10^9 collisions of 13 500 spheres
 * at density 0.1, by Enskog's collision rate. */
static double paper_clock(void)
{
	static const double density = 0.1, collisions = 1e9, spheres = 13500;
	double packing = M_PI * density / 6, at_contact = (1 - packing / 2) / pow(1 - packing, 3);
	return 2 * collisions / spheres / (4 * density * sqrt(M_PI) * at_contact);
}

static void claim_elastic(struct result *result, const struct ladder *ladder)
{
	struct rate_fit fit = ladder_fit(ladder, 0, LADDER_EVENTS),
					late = ladder_fit(ladder, LADDER_LANES - 1, LADDER_EVENTS);
	const struct gas_tally *direct = ladder_binary64(ladder, 0);
	struct interval interval, late_interval, counted = {0, INFINITY};
	if (isnan(fit.exponent) || isnan(late.exponent) || !direct) return;
	three_body_rate(&direct->three_body, &counted);
	double rate = rate_fit_at(&fit, 53, &interval), bits = 53 - log2(paper_clock());
	double late_rate = rate_fit_at(&late, bits, &late_interval);
	bool differs = interval.high < 5e-10, late_differs = late_interval.high < 5e-10;
	char shown[200], why[700];
	snprintf(shown, sizeof shown, "%.2g by the line (95 %%: %.2g to %.2g), exponent %.3f ± %.3f", rate, interval.low,
			 interval.high, fit.exponent, rate_fit_exponent_error(&fit));
	snprintf(
		why, sizeof why,
		"The paper's figure is %sconfirmed. Counted in binary64 itself: %llu in %.3g events, so at most %.2g. With "
		"absolute times, as the paper's programs may have had them, rounding grows with the clock: at t = %.2g, where "
		"10^9 collisions of its 13 500 spheres end, the line through late clocks gives %.2g (%.2g to %.2g), %s. "
		"A single event in the 10^9 of the paper's runs would be printed as 1e-9; its count is not printed.",
		differs ? "not " : "", (unsigned long long)direct->three_body.events, (double)direct->three_body.contacts,
		counted.high, paper_clock(), late_rate, late_interval.low, late_interval.high,
		late_differs ? "which is too low as well" : "which comes near");
	result_claim(result, &(struct result_claim){
							 .quantity = "three-body events per event in binary64, dilute and elastic",
							 .reported = "about 1e-9",
							 .where = "2014, section 3 and fig. 5",
							 .measured = rate,
							 .interval = {interval.low, interval.high},
							 .interval_means = "95 %, of the line",
							 .shown = shown,
							 .count = direct->three_body.contacts,
							 .verdict = differs                ? RESULT_DIFFERS
										: interval.high < 1e-8 ? RESULT_AGREES
															   : RESULT_NOT_COMPARABLE,
							 .why = why,
						 });
}

/* Appends what binary64 itself shows of a lane: "(0.5, 0.5): none in 1e+09, at most 3.7e-09". */
static void append_direct(char *shown, size_t size, const struct ladder *ladder, int lane)
{
	const struct three_body *direct = &ladder_binary64(ladder, lane)->three_body;
	char label[64];
	struct interval interval;
	size_t length = strlen(shown);
	double rate = three_body_rate(direct, &interval);
	length += (size_t)snprintf(shown + length, size - length, "%s%s: ", length ? "; " : "",
							   ladder_label(ladder, lane, label));
	if (direct->events)
		snprintf(shown + length, size - length, "%llu in %.3g, %.2g (%.2g to %.2g)", (unsigned long long)direct->events,
				 (double)direct->contacts, rate, interval.low, interval.high);
	else
		snprintf(shown + length, size - length, "none in %.3g, at most %.2g", (double)direct->contacts, interval.high);
}

/* Three orders more: the inelastic gas with the highest rate in binary64 itself or, where none has one, with the least
 * that is known of it. */
static void claim_inelastic(struct result *result, const struct ladder *ladder)
{
	struct interval interval = {-1, -1};
	double rate = -1;
	uint64_t count = 0;
	char shown[400] = "";
	for (int lane = 0; lane < LADDER_LANES; lane++) {
		const struct gas_tally *direct = ladder_binary64(ladder, lane);
		if (ladder_late(lane) || ladder->point[lane * LADDER_RUNGS].restitution == 1) continue;
		if (!direct) return;
		struct interval here;
		double rate_here = three_body_rate(&direct->three_body, &here);
		if (rate_here > rate || (rate_here == rate && here.high > interval.high)) rate = rate_here, interval = here;
		count += direct->three_body.contacts;
		append_direct(shown, sizeof shown, ladder, lane);
	}
	bool agrees = interval.low > 1e-7 && interval.high<1e-5, differs = interval.low> 1e-5 || interval.high < 1e-7;
	result_claim(result,
				 &(struct result_claim){
					 .quantity = "three-body events per event in binary64, inelastic",
					 .reported = "three orders of magnitude above 1e-9",
					 .where = "2014, section 3 and fig. 5",
					 .measured = rate,
					 .interval = {interval.low, interval.high},
					 .interval_means = "95 %, Garwood, of events as if they were independent",
					 .shown = shown,
					 .count = count,
					 .verdict = agrees    ? RESULT_AGREES
								: differs ? RESULT_DIFFERS
										  : RESULT_NOT_COMPARABLE,
					 .why = "The interval is that of the gas with the highest rate. There is no one rate of inelastic "
							"gases: as long as nothing clusters they have as few as elastic ones; near collapse, where "
							"the times between events shrink until rounding is all that is left of them, they stay "
							"frequent however fine the arithmetic is, and come in bursts. Figure 5 has the plane.",
				 });
}

void ladder_tell(struct result *result, const struct ladder *ladder)
{
	result_paragraph(result,
					 "The same gases in arithmetics of 8 to 53 bits: %zu hard spheres in a periodic box, the stable "
					 "method, kept warm by "
					 "exact changes of the unit of time. What goes wrong in binary64 too rarely to be counted is "
					 "counted where it is "
					 "frequent and followed down a line.",
					 ladder->point[0].particles);
	claim_elastic(result, ladder);
	claim_inelastic(result, ladder);
	add_rates(result, ladder);
	add_depths(result, ladder);
	ladder_tables(result, ladder);
	result_note(
		result,
		"Gases settle for 20 elastic and, where they are inelastic, 20 inelastic collisions per particle "
		"before counting. A gas that collapses is followed by another start state; its last ten to twenty "
		"collisions per particle are dropped. So of a gas that always collapses in the end what is counted is the "
		"mean over its life.");
	result_note(
		result,
		"The stable method has an answer for every state, so that no gas halted; the column shows that this was "
		"looked at.");
}

struct result *figure_ladder(const struct figure_setup *setup, char error[512])
{
	struct ladder *ladder = calloc(1, sizeof *ladder);
	struct result *result = result_new("ladder", "How many bits does it take?");
	bool stopped = false, good = ladder && result;
	if (!good) snprintf(error, 512, "not enough memory");
	if (good) {
		ladder_choose(ladder, setup->full);
		good = gas_points_measure("ladder", setup, ladder->point, LADDER_POINTS, ladder->tally, &stopped, error);
	}
	if (good) {
		ladder_tell(result, ladder);
		if (stopped) result_incomplete(result, "stopped before all rungs were measured; run again to go on");
	}
	free(ladder);
	if (good) return result;
	result_free(result);
	return NULL;
}
