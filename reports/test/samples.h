/* Results with plausible numbers, one figure of every kind among them, and text that is hard on whoever prints it. */
#ifndef REPORTS_TEST_SAMPLES_H
#define REPORTS_TEST_SAMPLES_H

#include "result.h"

#include <math.h>
#include <stdio.h>

static const char HOSTILE[] = "a < b & \"c\" 'd' {{title}} `id` @x ^{y} \\ <script>";

/* Bars of one floating-point number each around a contact distance of 1: half as wide below it as above. */
static void histogram_panel(struct result_figure figure, const char *row, const char *column, double spread,
							double below, double shift)
{
	char note[60];
	snprintf(note, sizeof note, "%.1f %% below contact", 100 * below);
	struct figure_series measured = figure_series(figure, "as measured", SERIES_BARS);
	struct figure_series exact = figure_series(figure, "exact", SERIES_LINE);
	series_panel(measured, row, column, note);
	series_panel(exact, row, column, NULL);
	for (int steps = -9; steps <= 6; steps++) {
		double left = steps > 0 ? (steps - 0.5) * 0x1p-52 : (steps - 0.5) * 0x1p-53;
		double right = steps < 0 ? (steps + 0.5) * 0x1p-53 : (steps + 0.5) * 0x1p-52;
		double middle = (left + right) / 2;
		double height = exp(-middle * middle / (2 * spread * spread)) / (spread * sqrt(2 * M_PI));
		series_row(measured, (double[]){left, right, height, steps});
		height *= exp(shift * middle / spread);
		series_row(exact, (double[]){left, right, height, steps});
	}
}

static struct result *histogram_result(void)
{
	struct result *result = result_new("fig3", "Separation at impact");
	result_paragraph(result, "13 500 hard spheres under periodic boundary conditions, three densities and three "
							 "restitutions, 1.2 million collisions each. Half of all collisions happen below contact.");
	result_paragraph(result, "The separation is counted in numbers of the working arithmetic, and again exactly.");
	result_claim(result,
				 &(struct result_claim){.quantity = "collisions executed below contact, elastic",
										.reported = "about half of all collisions",
										.where = "2014, section 3 and fig. 3",
										.measured = 0.49823,
										.interval = {0.49772, 0.49874},
										.interval_means = "95 %, Clopper-Pearson",
										.count = 1200000,
										.verdict = RESULT_AGREES,
										.why = "One half lies within two standard deviations at every density."});
	result_claim(result,
				 &(struct result_claim){.quantity = "mean separation on impact",
										.reported = "at contact",
										.where = "2014, section 3",
										.measured = 1.42e-17,
										.interval = {1.31e-17, 1.53e-17},
										.unit = "contact distances",
										.count = 1200000,
										.verdict = RESULT_DIFFERS,
										.why = "The mean lies an eighth of a step outside contact: steps are twice as "
											   "wide there, and rounding to even prefers them."});
	result_claim(result, &(struct result_claim){.quantity = "collisions counted",
												.reported = "1e9",
												.where = "2014, fig. 3",
												.measured = NAN,
												.shown = "1.2 million per histogram",
												.verdict = RESULT_NOT_COMPARABLE,
												.why = "This is the quick run; --full counts as many as the paper."});
	static const char *const columns[] = {"left", "right", "height", "steps", NULL};
	struct result_figure figure = result_figure(
		result,
		&(struct figure_frame){
			.name = "separation",
			.kind = "impact-histogram",
			.title = "Separation at impact, one bar per floating-point number",
			.caption = "Each bar spans the real numbers that one floating-point number stands for. Contact is a power "
					   "of two, so that the numbers lie twice as close below it as above.",
			.alternative = "Nine histograms, each a bell around contact, wider when collisions are less elastic.",
			.x = {.label = "(|r| − σ) / σ"},
			.y = {.label = "fraction of collisions"},
			.columns = columns});
	const char *const densities[] = {"density 0.1", "density 0.5", "density 0.9"};
	const char *const restitutions[] = {"restitution 1", "restitution 0.9", "restitution 0.5"};
	for (int row = 0; row < 3; row++)
		for (int column = 0; column < 3; column++)
			histogram_panel(figure, densities[row], restitutions[column], 1.4e-16 * (1 + 0.4 * column + 0.2 * row),
							0.4982 - 0.01 * column, 0.1 * row);
	static const char *const headings[] = {"density",         "restitution", "collisions", "mean",
										   "largest overlap", "in hex",      NULL};
	struct result_table table =
		result_table(result, "Moments of the separation", "In units of the contact distance.", headings);
	for (int row = 0; row < 9; row++) {
		table_row(table);
		table_number(table, 0.1 + 0.4 * (row / 3));
		table_number(table, row % 3 == 0 ? 1 : row % 3 == 1 ? 0.9 : 0.5);
		table_count(table, 1200000 + (uint64_t)row);
		table_number(table, row == 4 ? NAN : -1.42e-17 * row);
		table_number(table, row == 8 ? INFINITY : 9.99e-16 + row * 1e-16);
		table_hex(table, 9.99e-16 + row * 1e-16);
	}
	result_note(result, "Separations are taken before the impulse.");
	result_made_by(result, "touchstone reproduce fig3 --quick --seed 7", 64.2, "0123abc");
	return result;
}

/* A ball of restitution 1/2 under unit gravity, dropped at time 0 from height 1, for so many bounces. */
static void bounce(struct figure_series series, int bounces, bool halts)
{
	double start = -sqrt(2), length = 2 * sqrt(2), left = 2 * length;
	for (int bounce = 0; bounce < bounces; bounce++) {
		int points = bounce < 4 ? 80 : 24;
		for (int i = bounce == 0 ? points / 2 : 0; i <= points; i++) {
			double along = length * i / points;
			series_row(series, (double[]){start + along, along * (length - along) / 2, left - along});
		}
		start += length;
		left -= length;
		length /= 2;
	}
	if (halts) series_row(series, (double[]){start, -1e-16, left});
}

static struct result *trajectory_result(void)
{
	struct result *result = result_new("fig7", "A ball comes to rest");
	result_paragraph(result,
					 "A ball of diameter 1 falls on a plate and loses half its speed at every bounce. The stable "
					 "method follows it into rest; the naive one halts.");
	result_incomplete(result, "Stopped after 312 000 of 1 000 000 plates.");
	static const char *const columns[] = {"time", "height", "remaining", NULL};
	struct result_figure figure = result_figure(
		result,
		&(struct figure_frame){
			.name = "height",
			.kind = "trajectory",
			.title = "Height over time",
			.caption =
				"Left the whole flight, right its end. The cross marks where the naive method has no next event.",
			.alternative = "A bouncing ball whose bounces shrink by a quarter each time.",
			.x = {.label = "time since the drop"},
			.y = {.label = "height over the plate / diameter"},
			.columns = columns});
	bounce(figure_series(figure, "stable", SERIES_LINE), 40, false);
	bounce(figure_series(figure, "naive, halts after 27 events", SERIES_ENDS), 27, true);

	static const char *const bits[] = {"bits", "error", NULL};
	figure = result_figure(
		result, &(struct figure_frame){.name = "rest-time",
									   .kind = "scaling",
									   .title = "Error of the rest time over the bits carried",
									   .caption = "The last bounces are as small as the square root of the roundoff.",
									   .alternative = "A falling straight line of slope one half.",
									   .x = {.label = "significand bits"},
									   .y = {.label = "relative error of the rest time", .logarithmic = 2},
									   .columns = bits});
	struct figure_series stable = figure_series(figure, "stable", SERIES_POINTS);
	struct figure_series naive = figure_series(figure, "compensated", SERIES_POINTS);
	for (int p = 8; p <= 512; p *= 2) {
		series_row(stable, (double[]){p, exp2(-0.5 * p + 0.7 * sin(p))});
		series_row(naive, (double[]){p, exp2(-0.55 * p - 3 + 0.7 * cos(p))});
	}
	series_fit(stable, -0.5, 0.1);
	series_fit(naive, -0.55, -3);
	result_made_by(result, "touchstone reproduce fig7", 3725, NULL);
	return result;
}

static struct result *generic_result(void)
{
	struct result *result = result_new("costs", HOSTILE);
	result_paragraph(result, "%s", HOSTILE);
	static const char *const bars[] = {"category", "value", "low", "high", NULL};
	static const char *const variants[] = {"as printed", "flight by halves", "root of the quotient", "fused", HOSTILE,
										   NULL};
	struct result_figure figure = result_figure(result, &(struct figure_frame){.name = "orders",
																			   .kind = "bars",
																			   .title = HOSTILE,
																			   .caption = HOSTILE,
																			   .alternative = HOSTILE,
																			   .x = {.label = HOSTILE},
																			   .y = {.label = "plates that halt / %"},
																			   .columns = bars,
																			   .categories = variants});
	struct figure_series first = figure_series(figure, HOSTILE, SERIES_BARS);
	struct figure_series second = figure_series(figure, "binary32", SERIES_BARS);
	for (int i = 0; i < 5; i++) {
		series_row(first, (double[]){i, 9.5 * i, 9.5 * i - 1, 9.5 * i + 1.5});
		series_row(second, (double[]){i, 38 - 7 * i, NAN, NAN});
	}
	static const char *const curve[] = {"x", "y", "low", "high", NULL};
	figure = result_figure(result, &(struct figure_frame){.name = "drift",
														  .kind = "curves",
														  .title = "Drift of the energy",
														  .caption = "It stays below the bound.",
														  .alternative = "Two curves that rise slowly.",
														  .x = {.label = "collisions", .logarithmic = 10},
														  .y = {.label = "relative drift", .logarithmic = 10},
														  .columns = curve});
	struct figure_series line = figure_series(figure, "bound", SERIES_LINE);
	struct figure_series points = figure_series(figure, "measured", SERIES_POINTS);
	for (double x = 1e3; x < 2e6; x *= 2) {
		series_row(line, (double[]){x, 1e-18 * x, NAN, NAN});
		series_row(points, (double[]){x, 1e-17 * sqrt(x), 0.7e-17 * sqrt(x), 1.4e-17 * sqrt(x)});
	}
	figure_series(figure, "nothing", SERIES_POINTS);
	static const char *const headings[] = {HOSTILE, "empty", NULL};
	struct result_table table = result_table(result, HOSTILE, HOSTILE, headings);
	table_row(table), table_text(table, "%s", HOSTILE), table_anchor(table, "here"), table_number(table, NAN);
	table_row(table), table_text(table, "row"), table_shaded(table, 2, "%s", HOSTILE), table_link(table, "here");
	result_claim(result, &(struct result_claim){.quantity = HOSTILE,
												.reported = HOSTILE,
												.where = HOSTILE,
												.measured = 1,
												.unit = HOSTILE,
												.verdict = RESULT_DIFFERS,
												.why = HOSTILE});
	result_note(result, "%s", HOSTILE);
	result_made_by(result, HOSTILE, 0.25, HOSTILE);
	return result;
}

#endif
