/* Figure 3 of the 2014 paper: separations at impact of 13 500 hard spheres. */
#include "figure/figure.h"

#include "figure/figure_campaign.h"
#include "measure/course.h"
#include "measure/impact_json.h"
#include "measure/interval.h"
#include "scene/scene.h"
#include <inttypes.h>
#include <math.h>
#include <stdlib.h>

static const double densities[] = {0.1, 0.5, 0.9}, restitutions[] = {1, 0.9, 0.5};
enum { DENSITIES = 3, RESTITUTIONS = 3, FORMS = 2, POINTS = DENSITIES * RESTITUTIONS * FORMS, SPHERES = 13500 };

/* One run: a density, a restitution, a form of time and place. */
struct point {
	double density, restitution;
	enum touchstone_form form;
	uint64_t collisions;  /* wanted */
	struct impact impact; /* empty where there was no time for it */
	enum touchstone_verdict verdict;
	double time; /* at the end */
};

static const double equilibrate = 20; /* elastic collisions per particle */

static struct point piece_point(const struct figure_setup *setup, size_t piece)
{
	static const uint64_t paper = 1000000000, quick = 1000000;
	return (struct point){
		.form = piece < POINTS / FORMS ? TOUCHSTONE_ABSOLUTE : TOUCHSTONE_RELATIVE,
		.density = densities[piece / RESTITUTIONS % DENSITIES],
		.restitution = restitutions[piece % RESTITUTIONS],
		.collisions = setup->full ? paper : quick,
	};
}

static void piece_key(void *context, size_t piece, char key[CAMPAIGN_KEY])
{
	const struct figure_setup *setup = context;
	struct point point = piece_point(setup, piece);
	snprintf(key, CAMPAIGN_KEY,
			 "particles=%d density=%g restitution=%g form=%s equilibrate=%g collisions=%" PRIu64 " seed=%" PRIu64,
			 SPHERES, point.density, point.restitution, point.form == TOUCHSTONE_ABSOLUTE ? "absolute" : "relative",
			 equilibrate, point.collisions, setup->seed);
}

/* How far one run is. */
struct course {
	const struct campaign_watch *watch;
	double done, all; /* events */
};

static void advance(void *context, uint64_t events, const struct touchstone_status *now)
{
	struct course *course = context;
	(void)now;
	course->done += (double)events;
	course->watch->progress(course->watch, course->done / course->all);
}

static struct touchstone_engine *make_engine(const struct point *point, uint64_t seed, char error[CAMPAIGN_ERROR])
{
	static const struct scene_species ball = {1, {1, 1}};
	struct scene_recipe recipe = {
		.dimensions = 3,
		.particle_count = SPHERES,
		.density = point->density,
		.boundary_restitution = {TOUCHSTONE_CONSTANT, 1},
		.species_count = 1,
		.species = &ball,
		.restitution = {TOUCHSTONE_CONSTANT, point->restitution},
		.positions = SCENE_LATTICE,
		.velocities = SCENE_MAXWELL,
		.temperature = 1,
		.form = point->form,
	};
	struct touchstone_scene scene;
	struct scene_error wrong;
	if (!scene_build(&recipe, seed, &scene, &wrong)) {
		snprintf(error, CAMPAIGN_ERROR, "%s: %s", wrong.key, wrong.text);
		return NULL;
	}
	struct touchstone_engine *engine = touchstone_create(&scene, "binary64", "stable", error);
	scene_free(&scene);
	return engine;
}

static json_t *make_piece(void *context, size_t piece, const struct campaign_watch *look, char error[CAMPAIGN_ERROR])
{
	const struct figure_setup *setup = context;
	struct point point = piece_point(setup, piece);
	struct touchstone_engine *engine = make_engine(&point, setup->seed, error);
	if (!engine) return NULL;
	impact_begin(&point.impact, 53);
	struct course course = {look, 0, (double)point.collisions + equilibrate * SPHERES / 2};
	struct touchstone_observer observer = {impact_see, &point.impact};
	struct watch watch = {look->stop, advance, &course};
	struct touchstone_limits limits = {.events = point.collisions, .time = INFINITY};
	struct touchstone_status end;
	bool through = course_equilibrate(engine, equilibrate, &watch) && course_run(engine, &limits, &observer, &watch);
	touchstone_status(engine, &end);
	touchstone_destroy(engine);
	if (!through) return NULL;
	return json_pack("{s:o, s:i, s:o}", "impact", impact_to_json(&point.impact), "verdict", end.verdict, "time",
					 campaign_number(end.time));
}

/* Height of a bar: a fraction of the collisions per unit of separation, over the reals that one number stands for. */
static void add_bars(struct result_figure figure, const struct point *point, const struct impact_histogram *histogram,
					 const char *label, enum series_style style)
{
	enum { SHOWN = 10 };                                  /* numbers on either side of contact */
	static const double above = 0x1p-52, below = 0x1p-53; /* their spacing around a contact distance of 1 */
	char row[40], column[40], note[80];
	uint64_t inside = 0;
	for (int step = -SHOWN; step <= SHOWN; step++) inside += histogram->bar[IMPACT_REACH + step];
	snprintf(row, sizeof row, "density %g", point->density);
	snprintf(column, sizeof column, "restitution %g", point->restitution);
	snprintf(note, sizeof note, "%.1f %% below, %.1f %% in view",
			 100 * (double)point->impact.exact.below / (double)point->impact.count,
			 100 * (double)inside / (double)point->impact.count);
	struct figure_series series = figure_series(figure, label, style);
	series_panel(series, row, column, style == SERIES_BARS ? note : NULL);
	for (int step = -SHOWN; step <= SHOWN; step++) {
		double left = (step - 0.5) * (step > 0 ? above : below), right = (step + 0.5) * (step < 0 ? below : above);
		double fraction = (double)histogram->bar[IMPACT_REACH + step] / (double)point->impact.count;
		series_row(series, (double[]){left, right, fraction / (right - left)});
	}
}

static void add_figure(struct result *result, const struct point *points, enum touchstone_form form)
{
	static const char *const columns[] = {"left", "right", "height", NULL};
	bool absolute = form == TOUCHSTONE_ABSOLUTE;
	struct result_figure figure = result_figure(
		result,
		&(struct figure_frame){
			.name = absolute ? "absolute" : "relative",
			.kind = "impact-histogram",
			.title = absolute ? "Separation at impact, with absolute times and positions"
							  : "Separation at impact, with times and positions that keep their precision",
			.caption = absolute
						   ? "The same runs with one time since the start and one position within the box. Where a "
							 "gas is dilute the clock runs long between collisions, its last bit grows coarse, and "
							 "the histogram spreads far beyond what is in view."
						   : "Binary64, the stable method. One bar per floating-point number, as wide as the reals "
							 "it stands for: below contact the numbers are twice as dense, hence the step. Filled: "
							 "the distance as binary64 computes it. Line: the true distance of the same positions, "
							 "computed exactly and counted to the nearest number.",
			.alternative = "Nine histograms, densities 0.1, 0.5 and 0.9 down, restitutions 1, 0.9 and 0.5 across. All "
						   "are centred on contact; about half of each lies below it.",
			.x = {"separation less contact distance, in contact distances", 0, {0, 0}},
			.y = {"fraction of collisions per unit of separation", 0, {0, 0}},
			.columns = columns,
		});
	for (int i = 0; i < POINTS; i++) {
		const struct point *point = &points[i];
		if (point->form != form || !point->impact.count) continue;
		add_bars(figure, point, &point->impact.measured, "as computed", SERIES_BARS);
		add_bars(figure, point, &point->impact.exact, "exact", SERIES_LINE);
	}
}

static void add_table(struct result *result, const struct point *points)
{
	static const char *const columns[] = {
		"form",          "density", "restitution", "collisions", "ended",   "below, computed", "below, exact",
		"95 % interval", "mean",    "deviation",   "mode",       "deepest", "widest",          NULL};
	struct result_table table = result_table(
		result, "Impact separations",
		"Mean, deviation and extremes of the exact separation less contact, in ulp above contact (2^-52); the mode in "
		"representable numbers from contact, as computed; intervals by Clopper and Pearson.",
		columns);
	for (int i = 0; i < POINTS; i++) {
		const struct point *point = &points[i];
		const struct impact *impact = &point->impact;
		if (!impact->count) continue;
		static const char *const verdicts[] = {"limit", "collapsed", "halted", "diverged"};
		struct interval interval = interval_of_proportion(impact->exact.below, impact->count);
		table_row(table);
		table_text(table, "%s", point->form == TOUCHSTONE_ABSOLUTE ? "absolute" : "relative");
		table_number(table, point->density);
		table_number(table, point->restitution);
		table_count(table, impact->count);
		table_text(table, "%s, t = %.6g", verdicts[point->verdict], point->time);
		table_number(table, (double)impact->measured.below / (double)impact->count);
		table_number(table, (double)impact->exact.below / (double)impact->count);
		table_text(table, "%.5f to %.5f", interval.low, interval.high);
		table_number(table, impact_mean(&impact->exact, impact->count));
		table_number(table, impact_deviation(&impact->exact, impact->count));
		table_text(table, "%d", impact_mode(&impact->measured));
		table_number(table, impact->exact.least);
		table_number(table, impact->exact.most);
	}
}

static bool lies_at_contact(const struct impact *impact)
{
	double deviation = impact_deviation(&impact->exact, impact->count);
	return fabs(impact_mean(&impact->exact, impact->count)) < 0.1 * deviation &&
		   abs(impact_mode(&impact->measured)) <= fmax(1, deviation / 2);
}

/* Claims of the paper about all of its histograms together. */
static void add_claims(struct result *result, const struct point *points)
{
	struct impact all;
	impact_begin(&all, 53);
	bool centred = true, wider[FORMS] = {true, true};
	double spread[FORMS][DENSITIES][RESTITUTIONS], worst_mean = 0;
	for (int i = 0; i < POINTS; i++) {
		const struct impact *impact = &points[i].impact;
		int form = i / (DENSITIES * RESTITUTIONS), density = i / RESTITUTIONS % DENSITIES, law = i % RESTITUTIONS;
		if (!impact->count) return; /* interrupted before all were measured: nothing is claimed */
		impact_merge(&all, impact);
		spread[form][density][law] = impact_deviation(&impact->exact, impact->count);
		double mean = impact_mean(&impact->exact, impact->count) / spread[form][density][law];
		if (fabs(mean) > fabs(worst_mean)) worst_mean = mean;
		centred &= lies_at_contact(impact);
		if (law > 0) wider[form] &= spread[form][density][law] > 1.5 * spread[form][density][law - 1];
	}
	struct interval below = interval_of_proportion(all.exact.below, all.count);
	double fraction = (double)all.exact.below / (double)all.count;
	result_claim(result,
				 &(struct result_claim){
					 .quantity = "collisions executed below the contact distance",
					 .reported = "approximately half of all collisions",
					 .where = "2014, section 3 and fig. 3",
					 .measured = fraction,
					 .interval = {below.low, below.high},
					 .interval_means = "95 %",
					 .count = all.count,
					 .verdict = fabs(fraction - 0.5) < 0.05 ? RESULT_AGREES : RESULT_DIFFERS,
					 .why = "Of the true separations of the working positions, over all histograms of both forms. "
							"As computed in binary64 fewer lie strictly below, because the bar at contact itself "
							"takes its share; the table has both.",
				 });
	result_claim(result,
				 &(struct result_claim){
					 .quantity = "mean and mode of the separation at impact",
					 .reported = "correspond to the interaction diameter",
					 .where = "2014, section 3",
					 .measured = worst_mean,
					 .unit = "standard deviations from contact, the mean furthest off",
					 .count = all.count,
					 .verdict = centred ? RESULT_AGREES : RESULT_DIFFERS,
					 .why = centred ? "Every mean lies within a tenth of its standard deviation of contact, every "
									  "mode within one number or half a deviation."
									: "A mean lies a tenth of its deviation or more from contact, or a mode more "
									  "than half of one; the table says which.",
				 });
	char shown[200];
	snprintf(shown, sizeof shown,
			 "deviation at density 0.5, restitution 1, 0.9, 0.5: %.3g, %.3g, %.3g ulp (absolute: %.3g, %.3g, %.3g)",
			 spread[1][1][0], spread[1][1][1], spread[1][1][2], spread[0][1][0], spread[0][1][1], spread[0][1][2]);
	bool agrees = wider[0] || wider[1];
	result_claim(
		result,
		&(struct result_claim){
			.quantity = "spread of the histograms when collisions are inelastic",
			.reported = "the magnitude of these errors is significantly increased in inelastic systems",
			.where = "2014, section 3 and fig. 3",
			.measured = spread[1][1][2] / spread[1][1][0],
			.unit = "times the elastic deviation, at density 0.5 and restitution 0.5",
			.shown = shown,
			.count = all.count,
			.verdict = agrees ? RESULT_AGREES : RESULT_DIFFERS,
			.why = agrees ? "The deviation grows by half or more as restitution falls, at every density."
						  : "In a gas that cools freely the deviation does not grow with inelasticity: only the "
							"tails do (deepest and widest in the table). In the absolute form the last bit of the "
							"time grows as t, but speeds fall as 1/t (Haff's law), so the error of a position, "
							"which is their product, does not; per collision the cooling gas even has less error "
							"than the elastic one. The paper does not say whether its gases were driven.",
		});
}

struct result *figure_impact(const struct figure_setup *setup, char error[512])
{
	const struct campaign campaign = {"fig3", POINTS, piece_key, NULL, make_piece, (void *)setup};
	json_t *results = figure_campaign_run(&campaign, setup, error);
	if (!results) return NULL;
	struct point *points = calloc(POINTS, sizeof *points);
	struct result *result = result_new("fig3", "How far from contact do spheres collide?");
	size_t finished = campaign_finished(results);
	if (!points || !result) {
		snprintf(error, 512, "not enough memory");
		json_decref(results);
		free(points);
		result_free(result);
		return NULL;
	}
	for (size_t p = 0; p < POINTS; p++) {
		const json_t *found = json_array_get(results, p);
		points[p] = piece_point(setup, p);
		points[p].impact = impact_from_json(json_object_get(found, "impact"));
		points[p].verdict = (enum touchstone_verdict)json_integer_value(json_object_get(found, "verdict"));
		points[p].time = campaign_value(found, "time");
	}
	json_decref(results);
	result_paragraph(
		result,
		"%d hard spheres under periodic boundary conditions, run by the stable method in binary64; at each "
		"collision the distance of the two centres is compared with the contact distance 1: as binary64 "
		"computes it, and as it truly is.",
		SPHERES);
	result_paragraph(result,
					 "Start: face-centred cubic lattice, Maxwell velocities of temperature 1, %g elastic collisions "
					 "per particle before counting. Inelastic gases then cool freely.",
					 equilibrate);
	add_claims(result, points);
	add_figure(result, points, TOUCHSTONE_RELATIVE);
	add_figure(result, points, TOUCHSTONE_ABSOLUTE);
	add_table(result, points);
	result_note(result, "The paper does not say which densities and restitutions its histograms show, nor how long its "
						"gases ran before counting.");
	result_note(result, "The relative form counts times from a page that is turned and positions from the middle of a "
						"place; its rows in the table show how much of the spread the paper's absolute form brings.");
	if (finished < POINTS)
		result_incomplete(result, "interrupted after %zu of %d runs; the next call goes on from there", finished,
						  (int)POINTS);
	free(points);
	return result;
}
