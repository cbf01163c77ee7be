/* Time and place (design, section 4): separations at impact, three-body events and the horizon of the same gas begun
 * late or put far away, in the papers' absolute form and in the one relative to pages and places. */
#include "figure/figure.h"

#include "figure/figure_campaign.h"
#include "measure/horizon_ladder.h"
#include "measure/three_body.h"
#include "measure/time_place.h"
#include "measure/vessel.h"
#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

static const char *const form_names[FORMS] = {"relative", "absolute"};
enum { BASE = 0, LATEST = 3, WIDEST = 5, HALF = SITUATIONS / 2 /* of either arithmetic */ };

struct sizes {
	const struct figure_setup *setup;
	size_t vessels;
};

/* ------------------------------------------------------------------ pieces: one vessel each, in all situations */

static void piece_key(void *context, size_t piece, char key[CAMPAIGN_KEY])
{
	const struct sizes *sizes = context;
	snprintf(key, CAMPAIGN_KEY, "spheres=%d time=%d seed=%" PRIu64, VESSEL_SPHERES, VESSEL_TIME,
			 sizes->setup->seed + piece);
}

static json_t *make_piece(void *context, size_t piece, const struct campaign_watch *watch, char error[CAMPAIGN_ERROR])
{
	const struct sizes *sizes = context;
	char why[160];
	json_t *list = time_place_measure(sizes->setup->seed + piece, &(struct watch){.stop = watch->stop}, why);
	bool stopped = watch->stop && *watch->stop;
	snprintf(error, CAMPAIGN_ERROR, "%s", list || stopped ? "" : why);
	return list ? json_pack("{s:o}", "situations", list) : NULL;
}

/* ------------------------------------------------------------------ telling */

typedef struct sight sights[SITUATIONS][FORMS];

/* Whether both sights have the same number in every bar. */
static bool alike(const struct sight *one, const struct sight *other)
{
	return one->contacts == other->contacts && memcmp(one->doubling, other->doubling, sizeof one->doubling) == 0 &&
		   one->sum == other->sum && one->squares == other->squares;
}

static void add_histograms(struct result *result, sights sight)
{
	static const char *const columns[] = {"left", "right", "height", NULL};
	enum { SHOWN = 34 };
	struct result_figure figure = result_figure(
		result,
		&(struct figure_frame){
			.name = "separations",
			.kind = "impact-histogram",
			.title = "Separation at impact, early and late, near and far, in either form (binary64)",
			.caption =
				"True separations of the working positions at the contacts of binary64, in doublings of the unit "
				"in the last place (2^-52 diameters): bars next to the middle are separations of less than "
				"one unit, the next ones of 1 to 2, of 2 to 4, and so on; overlaps to the left. In the relative "
				"form every row is the same, to the last count. In the absolute form the error grows with "
				"the last bit of the clock, and with that of the position.",
			.alternative = "Six rows of two histograms. In the right column all are equally narrow; in the left they "
						   "widen from a few units in the last place to 2^29 of them at t = 10^9.",
			.x = {"separation less contact distance: doublings of 2⁻⁵² diameters", 0, {-SHOWN, SHOWN}},
			.y = {"fraction of contacts", 0, {0, 0}},
			.columns = columns,
		});
	for (size_t s = 0; s < HALF; s++)
		for (int column = 0; column < FORMS; column++) {
			int form = column ? TOUCHSTONE_RELATIVE : TOUCHSTONE_ABSOLUTE;
			const struct sight *one = &sight[s][form];
			char note[60];
			snprintf(note, sizeof note, "deviation %.3g ulp", time_place_deviation(one));
			struct figure_series series = figure_series(figure, "exact", SERIES_BARS);
			series_panel(series, situations[s].name, form_names[form], note);
			for (int k = -SHOWN; k < SHOWN; k++) {
				uint64_t count = k < 0 ? one->doubling[0][-k - 1] : one->doubling[1][k];
				series_row(series, (double[]){k, k + 1, (double)count / (double)one->contacts});
			}
		}
}

static void add_horizons(struct result *result, sights sight)
{
	static const char *const columns[] = {"category", "value", "low", "high", NULL};
	const char *categories[HALF + 1] = {NULL};
	for (size_t s = 0; s < HALF; s++) categories[s] = situations[s].name;
	struct result_figure figure = result_figure(
		result,
		&(struct figure_frame){
			.name = "horizons",
			.kind = "bars",
			.title = "For how long binary64 can be trusted, early and late, near and far",
			.caption = "Mean over the vessels, with two standard errors: events per particle until the sequence "
					   "of events differs from that in 256 bits.",
			.alternative = "Bars of equal length for the relative form; for the absolute form they shrink as "
						   "the clock grows late, and a little as the box grows wide.",
			.x = {"", 0, {0, 0}},
			.y = {"events per particle", 0, {0, 0}},
			.columns = columns,
			.categories = categories,
		});
	for (int form = 0; form < FORMS; form++) {
		struct figure_series series = figure_series(figure, form_names[form], SERIES_BARS);
		for (size_t s = 0; s < HALF; s++) {
			struct estimate mean = estimate_mean(sight[s][form].horizon, sight[s][form].vessels);
			series_row(series,
					   (double[]){(double)s, mean.value, mean.value - 2 * mean.error, mean.value + 2 * mean.error});
		}
	}
}

static void add_table(struct result *result, sights sight, size_t first, const char *title)
{
	static const char *const columns[] = {"situation",       "form",
										  "contacts",        "below contact",
										  "deviation / ulp", "three-body events",
										  "encounters",      "encounters per contact, 95 %",
										  "horizon",         NULL};
	struct result_table table = result_table(
		result, title,
		"Deviation of the true separation at impact in ulp of the arithmetic; encounters of three bodies per contact "
		"as "
		"a Poisson interval (the events of one encounter come in a burst); horizon in events per particle against 256 "
		"bits, with its standard error over the vessels.",
		columns);
	for (size_t s = first; s < first + HALF; s++)
		for (int form = FORMS; form-- > 0;) {
			const struct sight *one = &sight[s][form];
			struct interval rate = interval_of_rate(one->encounters, (double)one->contacts);
			struct estimate horizon = estimate_mean(one->horizon, one->vessels);
			table_row(table);
			table_text(table, "%s", situations[s].name);
			table_text(table, "%s", form_names[form]);
			table_count(table, one->contacts);
			table_number(table, (double)one->below / (double)one->contacts);
			table_number(table, time_place_deviation(one));
			table_count(table, one->three_body);
			table_count(table, one->encounters);
			table_text(table, "%.2g to %.2g", rate.low, rate.high);
			table_text(table, "%.2f ± %.2f", horizon.value, horizon.error);
		}
}

static void claim_relative(struct result *result, sights sight)
{
	bool same = true;
	double widest = 0;
	for (size_t s = 0; s < SITUATIONS; s++) {
		const struct sight *base = &sight[s < HALF ? 0 : HALF][TOUCHSTONE_RELATIVE],
						   *one = &sight[s][TOUCHSTONE_RELATIVE];
		same = same && alike(one, base);
		widest = fmax(widest, time_place_deviation(one) / time_place_deviation(base));
	}
	result_claim(
		result, &(struct result_claim){
					.quantity = "spread of separations at impact in the relative form, late or far, over that at t = 0 "
								"in a box of 10",
					.reported = "1: the same at any time, in any box",
					.where = "what pages and places are for",
					.measured = widest,
					.unit = "times, the widest of all situations",
					.count = sight[BASE][TOUCHSTONE_RELATIVE].contacts,
					.verdict = same ? RESULT_AGREES : RESULT_DIFFERS,
					.why = same ? "All histograms are the same to the last count: the runs differ in nothing but the "
								  "number of the page and of the place."
								: "Some histogram differs; the table says which.",
				});
}

/* How far the absolute form's spread is from what the last bit of the clock, or of the position, lets expect: errors of
 * half a unit at most, uniform, so that one coordinate's deviation is ulp/sqrt(12). */
static void claim_absolute(struct result *result, sights sight)
{
	const struct sight *base = &sight[BASE][TOUCHSTONE_ABSOLUTE];
	double late = time_place_deviation(&sight[LATEST][TOUCHSTONE_ABSOLUTE]);
	double far = time_place_deviation(&sight[WIDEST][TOUCHSTONE_ABSOLUTE]), near = time_place_deviation(base);
	char shown[160];
	snprintf(shown, sizeof shown, "deviation %.3g ulp at t = 0 in a box of 10, %.3g at t = 10^9, %.3g in a box of 1000",
			 near, late, far);
	result_claim(result, &(struct result_claim){
							 .quantity = "spread of separations at impact in the absolute form, at t = 10^9 over t = 0",
							 .reported = "grows with the last bit of the clock, 2^-23 at 10^9 against 2^-51",
							 .where = "what is to be expected of one time since the start",
							 .measured = late / near,
							 .unit = "times",
							 .shown = shown,
							 .count = base->contacts,
							 .verdict = late > 1e6 * near && far > 10 * near ? RESULT_AGREES : RESULT_DIFFERS,
							 .why = "At t = 10^9 binary64 is what a little more than binary32 is at t = 0.",
						 });
}

static void claim_consequences(struct result *result, sights sight)
{
	struct estimate early = estimate_mean(sight[BASE][TOUCHSTONE_ABSOLUTE].horizon, sight[BASE][0].vessels);
	struct estimate late = estimate_mean(sight[LATEST][TOUCHSTONE_ABSOLUTE].horizon, sight[LATEST][0].vessels);
	const struct sight *base = &sight[HALF][TOUCHSTONE_ABSOLUTE], *old = &sight[HALF + LATEST][TOUCHSTONE_ABSOLUTE];
	struct interval rates[2] = {interval_of_rate(base->encounters, (double)base->contacts),
								interval_of_rate(old->encounters, (double)old->contacts)};
	result_paragraph(result,
					 "In the absolute form binary64 can be trusted for %.1f ± %.1f events per particle from t = 0 and "
					 "for %.1f ± %.1f "
					 "from t = 10^9; in the relative form for %.1f from either.",
					 early.value, early.error, late.value, late.error,
					 estimate_mean(sight[LATEST][TOUCHSTONE_RELATIVE].horizon, sight[LATEST][0].vessels).value);
	result_paragraph(result,
					 "Encounters of three bodies per contact, where binary32 lets them be counted, in the absolute "
					 "form: %.2g (%" PRIu64 " seen; 95 %%: %.2g to %.2g) from t = 0, %.2g (%" PRIu64
					 " seen; %.2g to %.2g) from t = 1000; in the relative form %" PRIu64 " were seen in either.",
					 (double)base->encounters / (double)base->contacts, base->encounters, rates[0].low, rates[0].high,
					 (double)old->encounters / (double)old->contacts, old->encounters, rates[1].low, rates[1].high,
					 sight[HALF + LATEST][TOUCHSTONE_RELATIVE].encounters);
}

static void tell(struct result *result, sights sight)
{
	size_t vessels = sight[BASE][0].vessels;
	if (vessels) {
		result_paragraph(
			result,
			"Separations at impact in binary64 lie within %.2g ulp of contact (standard deviation) at t = 0 "
			"and within %.2g ulp at t = 10^9, or %.3g ulp far out in a box of 1000 diameters, when one time "
			"counts from the start and one position through the box. With times counted from a page and "
			"positions from a place it is %.2g ulp always and everywhere.",
			time_place_deviation(&sight[BASE][TOUCHSTONE_ABSOLUTE]),
			time_place_deviation(&sight[LATEST][TOUCHSTONE_ABSOLUTE]),
			time_place_deviation(&sight[WIDEST][TOUCHSTONE_ABSOLUTE]),
			time_place_deviation(&sight[LATEST][TOUCHSTONE_RELATIVE]));
		claim_consequences(result, sight);
		claim_relative(result, sight);
		claim_absolute(result, sight);
		add_histograms(result, sight);
		add_horizons(result, sight);
		add_table(result, sight, 0, "Binary64, early and late, near and far");
		add_table(result, sight, HALF, "Binary32, which shows after 10^3 what binary64 shows after 5 x 10^11");
	}
	result_paragraph(result,
					 "%d elastic hard spheres of diameter and mass 1 at kT = 1 in a vessel %d diameters wide, which "
					 "begins at a late time, or stands %g or %g diameters from the middle of a box of 100 or 1000, on "
					 "every axis: the same gas, where only the numbers that say when and where are large. %zu vessels, "
					 "each for %d units of time.",
					 VESSEL_SPHERES, VESSEL_WIDTH, vessel_middle(100), vessel_middle(1000), vessels, VESSEL_TIME);
	result_note(result, "A box of 1000 diameters at this density would hold 5 x 10^8 spheres; a vessel far out in it "
						"shows what the numbers there do to the same contacts.");
	result_note(result, "Start states lie on a grid of 2^-42 diameters, so that doubles hold them exactly wherever the "
						"vessel is put; binary32 rounds them once more, in the absolute form coarsely where the vessel "
						"is far out.");
}

struct result *figure_time_place(const struct figure_setup *setup, char error[512])
{
	struct sizes sizes = {setup, setup->full ? MOST_VESSELS : 20};
	const struct campaign campaign = {"time-and-place", sizes.vessels, piece_key, NULL, make_piece, &sizes};
	json_t *results = figure_campaign_run(&campaign, setup, error);
	if (!results) return NULL;
	struct sight(*sight)[FORMS] = calloc(SITUATIONS, sizeof *sight);
	struct result *result = sight ? result_new("time-and-place", "Does it matter when and where?") : NULL;
	if (!result) {
		snprintf(error, 512, "not enough memory");
		json_decref(results);
		free(sight);
		return NULL;
	}
	for (size_t p = 0; p < sizes.vessels; p++) {
		const json_t *measured = json_object_get(json_array_get(results, p), "situations");
		for (size_t k = 0; measured && k < SITUATIONS * FORMS; k++)
			time_place_add(&sight[k / FORMS][k % FORMS], measured, k / FORMS, (enum touchstone_form)(k % FORMS));
	}
	tell(result, sight);
	size_t finished = campaign_finished(results);
	if (finished < sizes.vessels)
		result_incomplete(result, "interrupted after %zu of %zu vessels; the next call goes on from there", finished,
						  sizes.vessels);
	json_decref(results);
	free(sight);
	return result;
}
