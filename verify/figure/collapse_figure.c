/* Section 5 and figure 7 of the 2014 paper: a ball comes to rest on a plate, or does not. */
#include "figure/figure.h"

#include "figure/figure_campaign.h"
#include "measure/collapse.h"
#include "measure/interval.h"
#include <math.h>
#include <stdlib.h>

static const double gravity = -1, restitution = 0.5; /* the paper's; its unit of time is set by gravity */
static const uint64_t patience = 4000;               /* events of one ball: at 512 bits it needs some 550 */

enum { ORDERS = TOUCHSTONE_DROP_ORDERS, METHODS = 2, VARIANTS = ORDERS * METHODS };
static const char *const methods[METHODS] = {"naive", "stable"};

/* Where the error of the rest time is looked for, from coarse to fine. */
static const struct rung {
	const char *arithmetic;
	int bits;
} ladder[] = {
	{"short:8", 8},     {"short:12", 12},  {"short:16", 16},  {"short:20", 20},  {"binary32", 24},
	{"mpfr:32", 32},    {"mpfr:42", 42},   {"binary64", 53},  {"extended", 64},  {"mpfr:80", 80},
	{"binary128", 113}, {"mpfr:160", 160}, {"mpfr:256", 256}, {"mpfr:384", 384}, {"mpfr:512", 512},
};
enum { RUNGS = sizeof ladder / sizeof *ladder };

/* The pieces: all variants in binary64, then each order of evaluation on each rung. */
enum { PIECES = VARIANTS + RUNGS * ORDERS };

struct sizes {
	const struct figure_setup *setup;
	uint64_t plates, ladder_plates;
};

static struct collapse_setup piece_setup(const struct sizes *sizes, size_t piece)
{
	bool variant = piece < VARIANTS;
	const struct rung *rung = variant ? &(struct rung){"binary64", 53} : &ladder[(piece - VARIANTS) / ORDERS];
	return (struct collapse_setup){.arithmetic = rung->arithmetic,
								   .method = variant ? methods[piece / ORDERS] : "stable",
								   .order = (unsigned)(piece % ORDERS), /* VARIANTS is a multiple of it */
								   .gravity = gravity,
								   .restitution = restitution,
								   .plates = variant ? sizes->plates : sizes->ladder_plates,
								   .seed = sizes->setup->seed,
								   .bits = rung->bits,
								   .most = patience,
								   .stop = sizes->setup->stop};
}

static void piece_key(void *context, size_t piece, char key[CAMPAIGN_KEY])
{
	struct collapse_setup one = piece_setup(context, piece);
	snprintf(key, CAMPAIGN_KEY, "arithmetic=%s method=%s order=%u plates=%llu seed=%llu", one.arithmetic, one.method,
			 one.order, (unsigned long long)one.plates, (unsigned long long)one.seed);
}

static json_t *make_piece(void *context, size_t piece, const struct campaign_watch *watch, char error[CAMPAIGN_ERROR])
{
	struct collapse_setup one = piece_setup(context, piece);
	struct collapse collapse;
	one.stop = watch->stop;
	if (!collapse_measure(&one, &collapse, error) || collapse.plates < one.plates) return NULL;
	return collapse_json(&collapse);
}

/* ------------------------------------------------------------------ orders of evaluation */

static void add_variants(struct result *result, const struct collapse *collapse)
{
	static const char *const columns[] = {"method",
										  "order of evaluation",
										  "plates",
										  "halted",
										  "95 % interval",
										  "events to the halt",
										  "came to rest",
										  "events to rest",
										  "largest error of rest time",
										  "median error",
										  "on the plate",
										  "deepest overlap at the end",
										  NULL};
	struct result_table table = result_table(
		result, "Orders of evaluation in binary64",
		"Plates uniform in [0, 1) with 53 bits. The rest time is held against sqrt(2h/|g|)(1+e)/(1-e) for the "
		"height h that the ball truly began at. Those neither halted nor at rest hop on for ever.",
		columns);
	for (int v = 0; v < VARIANTS; v++) {
		const struct collapse *one = &collapse[v];
		struct interval interval = interval_of_proportion(one->halted, one->plates);
		table_row(table);
		table_text(table, "%s", methods[v / ORDERS]);
		table_text(table, "%s", touchstone_drop_order((unsigned)(v % ORDERS)));
		table_count(table, one->plates);
		table_text(table, "%.3f %%", 100 * (double)one->halted / (double)one->plates);
		table_text(table, "%.3f to %.3f %%", 100 * interval.low, 100 * interval.high);
		table_number(table, one->halted ? one->events_to_halt : NAN);
		table_text(table, "%.3f %%", 100 * (double)one->rested / (double)one->plates);
		table_number(table, one->rested ? one->events_to_rest : NAN);
		table_number(table, one->rested ? one->largest_error : NAN);
		table_number(table, one->median_error);
		table_hex(table, one->worst_plate);
		table_number(table, one->deepest);
	}
}

static void add_claims(struct result *result, const struct collapse *collapse)
{
	double most = -1, events = NAN, deepest = 0;
	const struct collapse *worst = NULL;
	for (int v = 0; v < ORDERS; v++) {
		double halted = (double)collapse[v].halted / (double)collapse[v].plates;
		deepest = fmin(deepest, collapse[v].deepest);
		if (halted > most) most = halted, events = collapse[v].events_to_halt, worst = &collapse[v];
	}
	struct interval interval = interval_of_proportion(worst->halted, worst->plates);
	bool agrees = fabs(most - 0.5) < 0.05;
	result_claim(result,
				 &(struct result_claim){
					 .quantity = "plates on which the naive ball halts",
					 .reported = "about 50 % of 10^6",
					 .where = "2014, section 5",
					 .measured = most,
					 .interval = {interval.low, interval.high},
					 .interval_means = "95 %, Clopper and Pearson",
					 .count = worst->plates,
					 .verdict = agrees ? RESULT_AGREES : RESULT_DIFFERS,
					 .why = "The largest of six plausible orders of evaluation. The outcome hangs on the order: "
							"none halts where the contact position plate + s/2 is formed first, a quarter where "
							"the gap is (r - plate) - s/2. No order tried, and no arithmetic from binary32 to "
							"mpfr:512, gives a half; the paper does not print its own.",
				 });
	result_claim(result, &(struct result_claim){
							 .quantity = "events before the halt, mean",
							 .reported = "about 30 on average",
							 .where = "2014, section 5",
							 .measured = events,
							 .count = worst->halted,
							 .verdict = fabs(events - 30) < 5 ? RESULT_AGREES : RESULT_DIFFERS,
							 .why = "In the order of evaluation in which most plates halt.",
						 });
	result_claim(result, &(struct result_claim){
							 .quantity = "overlap with the plate",
							 .reported = "about 1e-16 diameters",
							 .where = "2014, section 5",
							 .measured = -deepest,
							 .unit = "diameters, the deepest",
							 .count = ORDERS * worst->plates,
							 .verdict = -deepest > 1e-17 && -deepest < 1e-15 ? RESULT_AGREES : RESULT_DIFFERS,
							 .why = "One spacing of the binary64 numbers below 1, in which the position is rounded.",
						 });
	double error = 0;
	uint64_t rested = 0, plates = 0;
	for (int v = ORDERS; v < VARIANTS; v++) {
		error = fmax(error, collapse[v].largest_error);
		rested += collapse[v].rested;
		plates += collapse[v].plates;
	}
	char shown[120];
	snprintf(shown, sizeof shown, "%.4f %% come to rest, rest time off by at most %.2g",
			 100 * (double)rested / (double)plates, error);
	result_claim(result,
				 &(struct result_claim){
					 .quantity = "the stable ball",
					 .reported = "approximates the exact collapse to the precision of the calculations",
					 .where = "2014, section 5",
					 .measured = error,
					 .unit = "units of time, the largest error",
					 .shown = shown,
					 .count = plates,
					 .verdict = rested == plates ? RESULT_AGREES : RESULT_DIFFERS,
					 .why = "Over all orders of evaluation in binary64. Where the gap is formed as "
							"(r - plate) - s/2 the error is of the size of the square root of the roundoff, as the "
							"last bounces are; with the contact position formed first, as the engine does, it is a "
							"few roundoffs, unless the flight is summed as (r + v t) + g/2 t^2.",
				 });
}

/* ------------------------------------------------------------------ height over time */

struct track {
	struct figure_series series;
	double time, speed; /* at the last bounce */
	bool first;
};

/* Draws the flight that ended with this bounce, then stands ready for the next. */
static void draw_flight(void *context, double time, double gap, double speed)
{
	enum { STEPS = 24 };
	struct track *track = context;
	double flight = time - track->time, start = track->first ? 0.5 : 0, up = track->first ? 0 : track->speed;
	if (!track->first) flight = fmin(flight, 2 * up); /* the clock cannot tell the last flights */
	double left = track->first ? 3 : 2 * up / (1 - restitution);
	for (int step = 0; step < STEPS; step++) {
		double s = flight * step / STEPS;
		series_row(track->series, (double[]){track->time + s, start + up * s - s * s / 2, left - s});
	}
	*track = (struct track){track->series, time, speed, false};
	(void)gap;
}

static bool add_trajectory(struct result *result, char error[512])
{
	static const char *const columns[] = {"time", "height", "remaining", NULL};
	struct touchstone_drop drop = {{0}, gravity, restitution, 2, 70};
	struct touchstone_landing landing = {.verdict = TOUCHSTONE_DONE};
	for (int i = 1; i < 1000 && landing.verdict != TOUCHSTONE_HALTED; i++) { /* a plate on which naive halts */
		drop.plate[0] = i / 1000.0;
		if (!touchstone_drop("binary64", "naive", &drop, 1, &landing, NULL, NULL, error)) return false;
	}
	struct result_figure figure = result_figure(
		result,
		&(struct figure_frame){
			.name = "trajectory",
			.kind = "trajectory",
			.title = "A ball of diameter 1 on a plate, restitution 1/2",
			.caption =
				"Left: height of the ball over the plate. Right: the same on logarithmic axes, against the time "
				"that remains until rest, so that each bounce has equal room. The naive finder halts at the cross, "
				"when the radicand of eq. 12 turns negative; the stable one goes on until time no longer advances.",
			.alternative = "Height over time: bounces halve in length. The naive curve ends in a cross, the stable one "
						   "goes on to the precision of the numbers.",
			.x = {"time", 0, {0, 0}},
			.y = {"height over the plate / diameters", 0, {0, 0}},
			.columns = columns,
		});
	static const char *const order[] = {"stable", "naive"};
	for (int m = 0; m < METHODS; m++) {
		char label[80];
		snprintf(label, sizeof label, "%s", order[m]);
		struct track track = {figure_series(figure, label, m ? SERIES_ENDS : SERIES_LINE), 0, 0, true};
		if (!touchstone_drop("binary64", order[m], &drop, 1, &landing, draw_flight, &track, error)) return false;
	}
	result_note(result, "Height over time is drawn for the plate at %a, where naive halts after %llu events.",
				drop.plate[0], (unsigned long long)landing.events);
	return true;
}

/* ------------------------------------------------------------------ error over precision */

static void add_scaling(struct result *result, struct collapse rung[RUNGS][ORDERS], uint64_t plates)
{
	static const char *const columns[] = {"bits", "error", "came to rest", NULL};
	struct result_figure figure = result_figure(
		result,
		&(struct figure_frame){
			.name = "scaling",
			.kind = "scaling",
			.title = "Largest error of the rest time, stable, by precision",
			.caption = "From short:8 to mpfr:512. With the gap formed as (r - plate) - s/2, as Algorithm 2 writes "
					   "it, half the bits are lost, because the last bounces are as small as the square root of the "
					   "roundoff; with the contact position formed first, as the engine does, hardly any, unless the "
					   "flight is summed as (r + v t) + g/2 t^2, whose second rounding can lift the ball.",
			.alternative = "Straight lines on a logarithmic scale: slopes of about -1/2 and -1 per bit.",
			.x = {"significand bits", 0, {0, 0}},
			.y = {"largest error of the rest time", 2, {0, 0}},
			.columns = columns,
		});
	static const char *const heads[] = {"order of evaluation", "slope", "standard error", "precisions", NULL};
	struct result_table table =
		result_table(result, "Error of the rest time against precision: log2(error) = slope x bits", NULL, heads);
	for (unsigned order = 0; order < ORDERS; order++) {
		double x[RUNGS], y[RUNGS];
		size_t points = 0;
		struct figure_series series = figure_series(figure, touchstone_drop_order(order), SERIES_POINTS);
		for (int r = 0; r < RUNGS; r++) {
			const struct collapse *one = &rung[r][order];
			if (!one->rested || !(one->largest_error > 0)) continue;
			x[points] = ladder[r].bits, y[points++] = log2(one->largest_error);
			series_row(series,
					   (double[]){ladder[r].bits, one->largest_error, (double)one->rested / (double)one->plates});
		}
		if (points < 3) continue;
		struct line_fit fit = fit_line(x, y, points);
		series_fit(series, fit.slope, fit.intercept);
		table_row(table);
		table_text(table, "%s", touchstone_drop_order(order));
		table_text(table, "%.4f", fit.slope);
		table_text(table, "%.4f", fit.slope_error);
		table_count(table, points);
	}
	result_note(result,
				"The errors against precision are the largest over %llu plates each, with as many random bits as "
				"the arithmetic tells apart.",
				(unsigned long long)plates);
}

struct result *figure_collapse(const struct figure_setup *setup, char error[512])
{
	struct sizes sizes = {setup, setup->full ? 1000000 : 100000, setup->full ? 2000 : 200};
	const struct campaign campaign = {"fig7", PIECES, piece_key, NULL, make_piece, &sizes};
	json_t *results = figure_campaign_run(&campaign, setup, error);
	if (!results) return NULL;
	struct collapse piece[PIECES]; /* those that were not finished have no plates */
	for (int p = 0; p < PIECES; p++) piece[p] = collapse_of_json(json_array_get(results, (size_t)p));
	size_t finished = campaign_finished(results);
	json_decref(results);

	struct result *result = result_new("fig7", "A ball comes to rest on a plate");
	bool all = true;
	for (int v = 0; v < VARIANTS; v++) all = all && piece[v].plates > 0;
	if (!result) return snprintf(error, 512, "not enough memory"), NULL;
	result_paragraph(result,
					 "A ball of diameter 1 falls from rest at one diameter over a plate and bounces with restitution "
					 "1/2 under g = -1. Exactly, it rests after infinitely many bounces at t = sqrt(2h/|g|)(1+e)/(1-e) "
					 "= 3. What it does in floating point hangs on where the plate is, on the method, and on the order "
					 "in which the formulas are evaluated: %llu plates for each.",
					 (unsigned long long)sizes.plates);
	if (all) add_claims(result, piece);
	bool good = add_trajectory(result, error);
	if (all) add_variants(result, piece);
	add_scaling(result, (struct collapse(*)[ORDERS])(piece + VARIANTS), sizes.ladder_plates);
	if (finished < PIECES)
		result_incomplete(result, "interrupted after %zu of %d measurements; the next call goes on from there",
						  finished, PIECES);
	if (good) return result;
	result_free(result);
	return NULL;
}
