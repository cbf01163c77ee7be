/* The horizon of trust (design, section 5.6): for how many events a run in an arithmetic takes the course that a much
 * finer one takes, over the bits carried; and its slope, the largest Lyapunov exponent, found in two ways. */
#include "figure/figure.h"

#include "campaign/campaign.h"
#include "measure/horizon_ladder.h"
#include "measure/start_state.h"
#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* From the first of FITTED on, a run's start is a gas: below, rounding the start state moves spheres far into one
 * another. */
static const char *const ladder_names[] = {"short:8",  "short:10", "short:12", "short:14",  "short:16", "short:18",
										   "short:20", "short:22", "binary32", "mpfr:32",   "mpfr:40",  "binary64",
										   "extended", "mpfr:80",  "twin",     "binary128", "mpfr:160", "mpfr:200"};
enum { MOST_RUNGS = sizeof ladder_names / sizeof *ladder_names, FITTED_FROM = 24, DENSITIES = 3, MOST_STARTS = 40 };
static const double equilibrate = 20; /* elastic collisions per particle */
static const double turning = 30;     /* events per particle after which a tangent vector grows as it will */

/* How much is measured. The boxes are such that the places of every arithmetic tile them exactly: all rungs run the
 * same scene. */
struct sizes {
	const struct figure_setup *setup;
	size_t spheres;
	double box[DENSITIES];
	size_t starts;
	double growing; /* events per particle that a tangent vector is followed */
	size_t rungs;
	const char *rung[MOST_RUNGS];
	double bits[MOST_RUNGS];
};

static double density_of(const struct sizes *sizes, size_t d)
{
	return (double)sizes->spheres / pow(sizes->box[d], 3);
}

/* What comes of one start state. */
struct start {
	bool done;
	struct horizon horizon[MOST_RUNGS];
	struct tangent_growth tangent;
};

/* ------------------------------------------------------------------ pieces: one start state each */

static uint64_t seed_of(const struct sizes *sizes, size_t piece)
{
	return sizes->setup->seed + piece % sizes->starts;
}

static void piece_key(void *context, size_t piece, char key[CAMPAIGN_KEY])
{
	const struct sizes *sizes = context;
	snprintf(key, CAMPAIGN_KEY, "spheres=%zu box=%g seed=%" PRIu64 " finest=%s growing=%g", sizes->spheres,
			 sizes->box[piece / sizes->starts], seed_of(sizes, piece), sizes->rung[sizes->rungs - 1], sizes->growing);
}

/* The denser, the more events until two arithmetics part. */
static double piece_cost(void *context, size_t piece)
{
	return density_of(context, piece / ((const struct sizes *)context)->starts);
}

static json_t *start_json(const struct sizes *sizes, const struct horizon *horizon, const struct tangent_growth *growth)
{
	json_t *horizons = json_array();
	for (size_t rung = 0; rung < sizes->rungs; rung++)
		json_array_append_new(horizons,
							  json_pack("{s:s, s:I, s:f, s:f, s:b}", "arithmetic", sizes->rung[rung], "events",
										(json_int_t)horizon[rung].events, "per_particle", horizon[rung].per_particle,
										"time", horizon[rung].time, "differ", horizon[rung].differ));
	return json_pack("{s:o, s:{s:f, s:f, s:f}}", "horizons", horizons, "tangent", "growth", growth->growth,
					 "per_particle", growth->per_particle, "time", growth->time);
}

static struct start start_of_json(const struct sizes *sizes, const json_t *json)
{
	struct start start = {.done = json_is_object(json)};
	for (size_t rung = 0; start.done && rung < sizes->rungs; rung++) {
		const json_t *one = json_array_get(json_object_get(json, "horizons"), rung);
		start.horizon[rung] = (struct horizon){
			.events = (uint64_t)json_integer_value(json_object_get(one, "events")),
			.per_particle = json_real_value(json_object_get(one, "per_particle")),
			.time = json_real_value(json_object_get(one, "time")),
			.differ = json_is_true(json_object_get(one, "differ")),
		};
	}
	const json_t *tangent = json_object_get(json, "tangent");
	start.tangent.growth = json_real_value(json_object_get(tangent, "growth"));
	start.tangent.per_particle = json_real_value(json_object_get(tangent, "per_particle"));
	start.tangent.time = json_real_value(json_object_get(tangent, "time"));
	return start;
}

static json_t *make_piece(void *context, size_t piece, const struct campaign_watch *watch, char error[CAMPAIGN_ERROR])
{
	const struct sizes *sizes = context;
	struct scene_recipe recipe = start_spheres(sizes->spheres, 0);
	for (int axis = 0; axis < 3; axis++) recipe.box[axis] = sizes->box[piece / sizes->starts];
	const struct watch look = {.stop = watch->stop};
	const struct touchstone_limits limits = {.events = course_events(10000, sizes->spheres), .time = INFINITY};
	const struct horizon_ladder ladder = {sizes->rungs, sizes->rung, "mpfr:256"};
	struct touchstone_scene scene;
	struct horizon horizon[MOST_RUNGS];
	struct tangent_growth growth;
	char why[160];
	bool made = start_scene(&recipe, seed_of(sizes, piece), equilibrate, &look, &scene, why);
	bool good = made && horizon_ladder_climb(&ladder, &scene, &limits, &look, horizon, why) &&
				!horizon[sizes->rungs - 1].stopped;
	if (good) {
		watch->progress(watch, 0.95);
		good = tangent_grow(&scene, seed_of(sizes, piece), turning, sizes->growing, &look, &growth, why);
	}
	if (made) scene_free(&scene);
	bool stopped = watch->stop && *watch->stop;
	snprintf(error, CAMPAIGN_ERROR, "%s", good || stopped ? "" : why);
	return good && !stopped ? start_json(sizes, horizon, &growth) : NULL;
}

/* ------------------------------------------------------------------ what they say together */

/* Of one density. */
struct finding {
	size_t starts;
	struct estimate horizon[MOST_RUNGS], time[MOST_RUNGS];
	double deviation[MOST_RUNGS], intercept;
	struct estimate slope;         /* events per particle for each bit */
	struct estimate by_slope[2];   /* exponents per event per particle, and per unit of time: from the slope, */
	struct estimate by_tangent[2]; /* and from the tangent vector */
};

static struct finding find(const struct sizes *sizes, const struct start *starts)
{
	struct finding finding = {0};
	double values[MOST_STARTS], times[MOST_STARTS], slopes[2][MOST_STARTS], grown[2][MOST_STARTS], intercepts = 0;
	size_t first = 0;
	while (sizes->bits[first] < FITTED_FROM) first++;
	for (size_t s = 0; s < sizes->starts; s++) {
		if (!starts[s].done) continue;
		double per_particle[MOST_RUNGS], time[MOST_RUNGS];
		for (size_t rung = 0; rung < sizes->rungs; rung++) {
			per_particle[rung] = starts[s].horizon[rung].per_particle;
			time[rung] = starts[s].horizon[rung].time;
		}
		struct line_fit line = fit_line(sizes->bits + first, per_particle + first, sizes->rungs - first);
		slopes[0][finding.starts] = line.slope;
		slopes[1][finding.starts] = fit_line(sizes->bits + first, time + first, sizes->rungs - first).slope;
		grown[0][finding.starts] = starts[s].tangent.growth / starts[s].tangent.per_particle;
		grown[1][finding.starts++] = starts[s].tangent.growth / starts[s].tangent.time;
		intercepts += line.intercept;
	}
	finding.intercept = intercepts / (double)finding.starts;
	finding.slope = estimate_mean(slopes[0], finding.starts);
	for (int unit = 0; unit < 2; unit++) {
		finding.by_slope[unit] = estimate_exponent(estimate_mean(slopes[unit], finding.starts));
		finding.by_tangent[unit] = estimate_mean(grown[unit], finding.starts);
	}
	for (size_t rung = 0; rung < sizes->rungs; rung++) {
		size_t count = 0;
		for (size_t s = 0; s < sizes->starts; s++) {
			if (!starts[s].done) continue;
			values[count] = starts[s].horizon[rung].per_particle;
			times[count++] = starts[s].horizon[rung].time;
		}
		finding.horizon[rung] = estimate_mean(values, count);
		finding.time[rung] = estimate_mean(times, count);
		finding.deviation[rung] = finding.horizon[rung].error * sqrt((double)count);
	}
	return finding;
}

/* How many standard errors two estimates are apart. */
static double apart(struct estimate one, struct estimate other)
{
	return (one.value - other.value) / hypot(one.error, other.error);
}

static size_t rung_named(const struct sizes *sizes, const char *name)
{
	size_t rung = 0;
	while (strcmp(sizes->rung[rung], name) != 0) rung++;
	return rung;
}

/* ------------------------------------------------------------------ telling */

static void add_claims(struct result *result, const struct sizes *sizes, const struct finding *findings)
{
	for (size_t d = 0; d < DENSITIES; d++) {
		struct estimate slope = findings[d].by_slope[0], tangent = findings[d].by_tangent[0];
		double errors = apart(slope, tangent);
		char quantity[120], reported[120], why[200];
		snprintf(quantity, sizeof quantity, "largest Lyapunov exponent at density %.3g, from the slope of the horizon",
				 density_of(sizes, d));
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
static double highest(const struct sizes *sizes, const struct finding *findings)
{
	double high = 1;
	for (size_t d = 0; d < DENSITIES; d++)
		for (size_t rung = 0; rung < sizes->rungs; rung++)
			high = fmax(high, findings[d].horizon[rung].value + findings[d].deviation[rung]);
	return 1.05 * high;
}

static void add_figure(struct result *result, const struct sizes *sizes, const struct finding *findings)
{
	static const char *const columns[] = {"x", "y", "low", "high", NULL};
	struct result_figure figure = result_figure(
		result, &(struct figure_frame){
					.name = "horizon",
					.kind = "curves",
					.title = "Events per particle that can be trusted, over the bits carried",
					.caption = "Points: mean over the start states, with bars of one standard deviation from state to "
							   "state. Lines: fitted to all from 24 bits on, and, dashed, with the slope that tangent "
							   "vectors predict: the two ways lie on one another. Coarser arithmetics fall below "
							   "the line, since rounding the start state itself already pushes spheres into one "
							   "another.",
					.alternative = "Three straight rising lines of points, the densest gas highest; for each a fitted "
								   "line and a dashed one from tangent vectors, which coincide.",
					.x = {"significand bits", 0, {0, 0}},
					.y = {"events per particle until the sequences differ", 0, {0, highest(sizes, findings)}},
					.columns = columns,
				});
	double last = sizes->bits[sizes->rungs - 1], middle = (FITTED_FROM + last) / 2;
	for (size_t d = 0; d < DENSITIES; d++) {
		const struct finding *finding = &findings[d];
		if (!finding->starts) continue;
		char label[3][80];
		double slopes[2] = {finding->slope.value, log(2) / finding->by_tangent[0].value};
		double height = finding->intercept + finding->slope.value * middle;
		snprintf(label[0], sizeof label[0], "density %.3g", density_of(sizes, d));
		snprintf(label[1], sizeof label[1], "density %.3g, fitted: exponent %.4f", density_of(sizes, d),
				 finding->by_slope[0].value);
		snprintf(label[2], sizeof label[2], "density %.3g, tangent vectors: %.4f", density_of(sizes, d),
				 finding->by_tangent[0].value);
		for (int way = 0; way < 2; way++) {
			struct figure_series line = figure_series(figure, label[1 + way], SERIES_LINE);
			for (int end = 0; end < 2; end++) {
				double bits = end ? last : FITTED_FROM;
				series_row(line, (double[]){bits, height + slopes[way] * (bits - middle), NAN, NAN});
			}
		}
		struct figure_series points = figure_series(figure, label[0], SERIES_POINTS);
		for (size_t rung = 0; rung < sizes->rungs; rung++) {
			double mean = finding->horizon[rung].value, spread = finding->deviation[rung];
			series_row(points, (double[]){sizes->bits[rung], mean, mean - spread, mean + spread});
		}
	}
}

static void add_tables(struct result *result, const struct sizes *sizes, const struct finding *findings)
{
	static const char *const columns[] = {
		"arithmetic", "bits", "density", "start states", "events per particle", "standard deviation", "time", NULL};
	static const char *const exponents[] = {
		"density", "start states", "per", "from the slope", "error", "from tangent vectors", "error", "apart", NULL};
	struct result_table table = result_table(
		result, "Lyapunov exponents",
		"Natural logarithm; errors are standard errors over start states; apart in combined standard errors.",
		exponents);
	for (size_t d = 0; d < DENSITIES; d++)
		for (int unit = 0; unit < 2 && findings[d].starts; unit++) {
			struct estimate slope = findings[d].by_slope[unit], tangent = findings[d].by_tangent[unit];
			table_row(table);
			table_number(table, density_of(sizes, d));
			table_count(table, findings[d].starts);
			table_text(table, "%s", unit ? "unit of time" : "event per particle");
			table_number(table, slope.value);
			table_number(table, slope.error);
			table_number(table, tangent.value);
			table_number(table, tangent.error);
			table_text(table, "%.2f", apart(slope, tangent));
		}
	table = result_table(result, "Horizons", "Mean over the start states, and spread from state to state.", columns);
	for (size_t d = 0; d < DENSITIES; d++)
		for (size_t rung = 0; rung < sizes->rungs && findings[d].starts; rung++) {
			table_row(table);
			table_text(table, "%s", sizes->rung[rung]);
			table_number(table, sizes->bits[rung]);
			table_number(table, density_of(sizes, d));
			table_count(table, findings[d].starts);
			table_number(table, findings[d].horizon[rung].value);
			table_number(table, findings[d].deviation[rung]);
			table_number(table, findings[d].time[rung].value);
		}
}

static void add_summary(struct result *result, const struct sizes *sizes, const struct finding *findings)
{
	size_t rung = rung_named(sizes, "binary64");
	for (size_t d = 0; d < DENSITIES; d++)
		if (findings[d].starts > 1)
			result_paragraph(
				result,
				"At density %.3g, binary64 can be trusted for %.1f events per particle (standard deviation "
				"%.1f over %zu start states), until t = %.3g; each further bit is good for %.2f more.",
				density_of(sizes, d), findings[d].horizon[rung].value, findings[d].deviation[rung], findings[d].starts,
				findings[d].time[rung].value, findings[d].slope.value);
	result_paragraph(
		result,
		"%zu elastic hard spheres of diameter and mass 1 at kT = 1 in a periodic box, equilibrated for %g "
		"collisions per particle. Each start state, as doubles, is run in each arithmetic side by side with "
		"256 bits until the sequences of events, told by kind and particles, first differ.",
		sizes->spheres, equilibrate);
	result_note(result,
				"The second way: in each start state a tangent vector is carried along in binary64 for %g events per "
				"particle, after %g in which it turns to where it grows most.",
				sizes->growing, turning);
	result_note(result, "Two events far apart in space but close in time may change places long before any particle "
						"meets another than it would have; so the horizon falls, slowly, with the number of particles. "
						"The slope does not depend on it.");
}

/* What one's machine has of the ladder, down to the finest that is wanted. */
static struct sizes choose(const struct figure_setup *setup)
{
	struct sizes quick = {setup, 108, {10, 6, 5}, 20, 200, 0, {0}, {0}};
	struct sizes full = {setup, 500, {17, 10, 8.25}, MOST_STARTS, 1000, 0, {0}, {0}};
	struct sizes sizes = setup->full ? full : quick;
	char error[160];
	size_t most = setup->full ? MOST_RUNGS : MOST_RUNGS - 1;
	for (size_t k = 0; k < most; k++) {
		int bits = horizon_bits(ladder_names[k], error);
		if (!bits) continue;
		sizes.rung[sizes.rungs] = ladder_names[k];
		sizes.bits[sizes.rungs++] = bits;
	}
	return sizes;
}

struct result *figure_horizon(const struct figure_setup *setup, char error[512])
{
	struct sizes sizes = choose(setup);
	const size_t pieces = DENSITIES * sizes.starts;
	const struct campaign campaign = {"horizon", pieces, piece_key, piece_cost, make_piece, &sizes};
	json_t *results = campaign_run(&campaign,
								   &(struct campaign_setup){.folder = setup->folder,
															.this_revision = true,
															.threads = setup->threads,
															.stop = setup->stop,
															.progress = setup->progress,
															.context = setup->context},
								   error);
	if (!results) return NULL;
	struct start *starts = calloc(pieces, sizeof *starts);
	struct result *result = starts ? result_new("horizon", "How long can a run be trusted?") : NULL;
	if (!result) {
		snprintf(error, 512, "not enough memory");
		json_decref(results);
		free(starts);
		return NULL;
	}
	struct finding finding[DENSITIES];
	bool all = true;
	for (size_t p = 0; p < pieces; p++) starts[p] = start_of_json(&sizes, json_array_get(results, p));
	for (size_t d = 0; d < DENSITIES; d++) {
		finding[d] = find(&sizes, starts + d * sizes.starts);
		all = all && finding[d].starts > 1;
	}
	add_summary(result, &sizes, finding);
	if (all) add_claims(result, &sizes, finding);
	add_figure(result, &sizes, finding);
	add_tables(result, &sizes, finding);
	size_t finished = campaign_finished(results);
	if (finished < pieces)
		result_incomplete(result, "interrupted after %zu of %zu start states; the next call goes on from there",
						  finished, pieces);
	json_decref(results);
	free(starts);
	return result;
}
