/* The horizon of trust (design, section 5.6): for how many events a run in an arithmetic takes the course that a much
 * finer one takes, over the bits carried; and its slope, the largest Lyapunov exponent, found in two ways. */
#include "figure/horizon_study.h"

#include <math.h>
#include <string.h>

/* How many standard errors two estimates are apart. */
static double apart(struct estimate one, struct estimate other)
{
	return (one.value - other.value) / hypot(one.error, other.error);
}

static size_t rung_named(const struct horizon_study *study, const char *name)
{
	size_t rung = 0;
	while (strcmp(study->rung[rung], name) != 0) rung++;
	return rung;
}

/* ------------------------------------------------------------------ telling */

static void add_claims(struct result *result, const struct horizon_study *study, const struct horizon_finding *findings)
{
	for (size_t d = 0; d < STUDY_DENSITIES; d++) {
		struct estimate slope = findings[d].by_slope[0], tangent = findings[d].by_tangent[0];
		double errors = apart(slope, tangent);
		char quantity[120], reported[120], why[200];
		snprintf(quantity, sizeof quantity, "largest Lyapunov exponent at density %.3g, from the slope of the horizon",
				 horizon_study_density(study, d));
		snprintf(reported, sizeof reported, "%.4f ± %.4f from tangent vectors", tangent.value, tangent.error);
		snprintf(why, sizeof why,
				 "The two are %.1f standard errors apart (%.1f %%); per unit of time %.4g ± %.2g against %.4g ± %.2g.",
				 fabs(errors), 100 * fabs(slope.value / tangent.value - 1), findings[d].by_slope[1].value,
				 findings[d].by_slope[1].error, findings[d].by_tangent[1].value, findings[d].by_tangent[1].error);
		result_claim(result, &(struct result_claim){
								 .quantity = quantity,
								 .reported = reported,
								 .where = "the exact tangent map: Dellago, Posch and Hoover 1996",
								 .measured = slope.value,
								 .interval = {slope.value - slope.error, slope.value + slope.error},
								 .interval_means = "standard error over start states",
								 .unit = "per event per particle, natural logarithm",
								 .count = slope.count,
								 .verdict = fabs(errors) < 3 ? RESULT_AGREES : RESULT_DIFFERS,
								 .why = why,
							 });
	}
}

/* Where the axis ends: over the highest bar. */
static double highest(const struct horizon_study *study, const struct horizon_finding *findings)
{
	double high = 1;
	for (size_t d = 0; d < STUDY_DENSITIES; d++)
		for (size_t rung = 0; rung < study->rungs; rung++)
			high = fmax(high, findings[d].horizon[rung].value + findings[d].deviation[rung]);
	return 1.05 * high;
}

static void add_figure(struct result *result, const struct horizon_study *study, const struct horizon_finding *findings)
{
	static const char *const columns[] = {"x", "y", "low", "high", NULL};
	struct result_figure figure = result_figure(
		result, &(struct figure_frame){
					.name = "horizon",
					.kind = "curves",
					.title = "Events per particle that can be trusted, over the bits carried",
					.caption = "Points: mean over the start states, with bars of one standard deviation from state to "
							   "state. Lines: fitted to all from 24 bits on, and, dashed, with the slope that tangent "
							   "vectors predict, with the exponents that they amount to: the two ways lie on one "
							   "another. Coarser arithmetics fall below "
							   "the line, since rounding the start state itself already pushes spheres into one "
							   "another.",
					.alternative = "Three straight rising lines of points, the densest gas highest; for each a fitted "
								   "line and a dashed one from tangent vectors, which coincide.",
					.x = {"significand bits", 0, {0, 0}},
					.y = {"events per particle until the sequences differ", 0, {0, highest(study, findings)}},
					.columns = columns,
				});
	double last = study->bits[study->rungs - 1], middle = (STUDY_FITTED_FROM + last) / 2;
	for (size_t d = 0; d < STUDY_DENSITIES; d++) {
		const struct horizon_finding *finding = &findings[d];
		if (!finding->starts) continue;
		char label[3][80];
		double slopes[2] = {finding->slope.value, log(2) / finding->by_tangent[0].value};
		double height = finding->intercept + finding->slope.value * middle;
		snprintf(label[0], sizeof label[0], "density %.3g", horizon_study_density(study, d));
		snprintf(label[1], sizeof label[1], "fitted at %.3g: %.4f", horizon_study_density(study, d),
				 finding->by_slope[0].value);
		snprintf(label[2], sizeof label[2], "tangents at %.3g: %.4f", horizon_study_density(study, d),
				 finding->by_tangent[0].value);
		for (int way = 0; way < 2; way++) {
			struct figure_series line = figure_series(figure, label[1 + way], SERIES_LINE);
			for (int end = 0; end < 2; end++) {
				double bits = end ? last : STUDY_FITTED_FROM;
				series_row(line, (double[]){bits, height + slopes[way] * (bits - middle), NAN, NAN});
			}
		}
		struct figure_series points = figure_series(figure, label[0], SERIES_POINTS);
		for (size_t rung = 0; rung < study->rungs; rung++) {
			double mean = finding->horizon[rung].value, spread = finding->deviation[rung];
			series_row(points, (double[]){study->bits[rung], mean, mean - spread, mean + spread});
		}
	}
}

static void add_exponents(struct result *result, const struct horizon_study *study,
						  const struct horizon_finding *findings)
{
	static const char *const columns[] = {
		"density", "start states", "per", "from the slope", "error", "from tangent vectors", "error", "apart", NULL};
	struct result_table table = result_table(
		result, "Lyapunov exponents",
		"Natural logarithm; errors are standard errors over start states; apart in combined standard errors.", columns);
	for (size_t d = 0; d < STUDY_DENSITIES; d++)
		for (int unit = 0; unit < 2 && findings[d].starts; unit++) {
			struct estimate slope = findings[d].by_slope[unit], tangent = findings[d].by_tangent[unit];
			table_row(table);
			table_number(table, horizon_study_density(study, d));
			table_count(table, findings[d].starts);
			table_text(table, "%s", unit ? "unit of time" : "event per particle");
			table_number(table, slope.value);
			table_number(table, slope.error);
			table_number(table, tangent.value);
			table_number(table, tangent.error);
			table_text(table, "%.2f", apart(slope, tangent));
		}
}

/* Down the arithmetics, across the densities. */
static void add_horizons(struct result *result, const struct horizon_study *study,
						 const struct horizon_finding *findings)
{
	char heading[2 * STUDY_DENSITIES][40];
	const char *columns[2 * STUDY_DENSITIES + 3] = {"arithmetic", "bits"};
	for (size_t d = 0; d < STUDY_DENSITIES; d++) {
		snprintf(heading[2 * d], sizeof heading[0], "density %.3g", horizon_study_density(study, d));
		snprintf(heading[2 * d + 1], sizeof heading[0], "until t");
		columns[2 + 2 * d] = heading[2 * d];
		columns[3 + 2 * d] = heading[2 * d + 1];
	}
	struct result_table table =
		result_table(result, "Horizons",
					 "Events per particle, mean and standard deviation from start state to start state; and the mean "
					 "time until which they last, in units in which diameter, mass and kT are 1.",
					 columns);
	for (size_t rung = 0; rung < study->rungs; rung++) {
		table_row(table);
		table_text(table, "%s", study->rung[rung]);
		table_number(table, study->bits[rung]);
		for (size_t d = 0; d < STUDY_DENSITIES; d++) {
			const struct horizon_finding *finding = &findings[d];
			table_text(table, "%.2f ± %.2f", finding->horizon[rung].value, finding->deviation[rung]);
			table_text(table, "%.3g", finding->time[rung].value);
		}
	}
}

static void add_summary(struct result *result, const struct horizon_study *study,
						const struct horizon_finding *findings)
{
	size_t rung = rung_named(study, "binary64");
	for (size_t d = 0; d < STUDY_DENSITIES; d++)
		if (findings[d].starts > 1)
			result_paragraph(
				result,
				"At density %.3g, binary64 can be trusted for %.1f events per particle (standard deviation "
				"%.1f over %zu start states), until t = %.3g; each further bit is good for %.2f more.",
				horizon_study_density(study, d), findings[d].horizon[rung].value, findings[d].deviation[rung],
				findings[d].starts, findings[d].time[rung].value, findings[d].slope.value);
	result_paragraph(
		result,
		"%zu elastic hard spheres of diameter and mass 1 at kT = 1 in a periodic box, equilibrated for %g "
		"collisions per particle. Each start state, as doubles, is run in each arithmetic side by side with "
		"256 bits until the sequences of events, told by kind and particles, first differ.",
		study->spheres, study->equilibrate);
	result_note(result,
				"The second way: in each start state a tangent vector is carried along in binary64 for %g events per "
				"particle, after %g in which it turns to where it grows most.",
				study->growing, study->turning);
	result_note(result, "Two events far apart in space but close in time may change places long before any particle "
						"meets another than it would have; so the horizon falls, slowly, with the number of particles. "
						"The slope does not depend on it.");
}

struct result *figure_horizon(const struct figure_setup *setup, char error[512])
{
	struct horizon_study study = horizon_study_choose(setup);
	struct horizon_finding finding[STUDY_DENSITIES];
	size_t finished, all;
	bool enough = true;
	if (!horizon_study_run(&study, finding, &finished, &all, error)) return NULL;
	struct result *result = result_new("horizon", "How long can a run be trusted?");
	if (!result) return snprintf(error, 512, "not enough memory"), NULL;
	for (size_t d = 0; d < STUDY_DENSITIES; d++) enough = enough && finding[d].starts > 1;
	add_summary(result, &study, finding);
	if (enough) add_claims(result, &study, finding);
	add_figure(result, &study, finding);
	add_exponents(result, &study, finding);
	if (enough) add_horizons(result, &study, finding);
	if (finished < all)
		result_incomplete(result, "interrupted after %zu of %zu start states; the next call goes on from there",
						  finished, all);
	return result;
}
