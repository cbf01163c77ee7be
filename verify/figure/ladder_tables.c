/* What the precision ladder found, in numbers. */
#include "figure/ladder.h"

#include <math.h>

static void add_rung(struct result_table table, const struct gas_point *point, const struct gas_tally *tally)
{
	const struct three_body *three_body = &tally->three_body;
	double contacts = (double)three_body->contacts, overlapping = (double)three_body->overlapping;
	double ulp = exp2(-ladder_bits(point)); /* the step of the numbers just below a contact distance of 1 */
	struct interval below = interval_of_proportion(three_body->overlapping, three_body->contacts), rate;
	double events = three_body_rate(three_body, &rate);
	table_text(table, "%s%s", point->arithmetic, point->clock > 0 ? ", absolute" : "");
	table_number(table, ladder_bits(point));
	table_count(table, three_body->contacts);
	table_text(table, "%.4f (%.4f to %.4f)", overlapping / contacts, below.low, below.high);
	table_text(table, "%.3g, %.3g", three_body->depth / overlapping / ulp, three_body->deepest / ulp);
	table_text(table, "%.2g, %.2g", three_body->depth / overlapping, three_body->deepest);
	table_text(table, "%llu: %.2g (%.2g to %.2g)", (unsigned long long)three_body->events, events, rate.low, rate.high);
	table_count(table, three_body->encounters);
	table_count(table, tally->repeated);
	table_count(table, tally->entangled);
	table_text(table, "%llu, %llu, %llu", (unsigned long long)tally->collapsed, (unsigned long long)tally->halted,
			   (unsigned long long)tally->diverged);
	if (point->restitution == 1)
		table_text(table, "%.2g", tally->drift / contacts * 1e6);
	else
		table_text(table, "cools");
}

static void add_lane(struct result *result, const struct ladder *ladder, int lane)
{
	static const char *const columns[] = {"arithmetic",
										  "bits",
										  "events",
										  "below contact (95 %)",
										  "depth in ulp: mean, most",
										  "depth in diameters: mean, most",
										  "three-body events (per event, 95 %)",
										  "encounters",
										  "repeated",
										  "entangled",
										  "gases collapsed, halted, diverged",
										  "energy drift in 10^6",
										  NULL};
	char title[160], label[64];
	snprintf(title, sizeof title, "The rungs: restitution and density %s", ladder_label(ladder, lane, label));
	struct result_table table = result_table(
		result, title,
		lane == 0
			? "Depths are those of overlaps at impact; ulp is 2^-bits, the step of the numbers just below contact. "
			  "Repeated: the same pair again, with no other event of either between. Entangled: a pair more "
			  "than 16 ulp deep at two looks in a row, ten collisions per particle apart."
			: NULL,
		columns);
	for (int r = 0; r < LADDER_RUNGS; r++) {
		const struct gas_tally *tally = &ladder->tally[lane * LADDER_RUNGS + r];
		if (!tally->three_body.contacts) continue;
		table_row(table);
		add_rung(table, &ladder->point[lane * LADDER_RUNGS + r], tally);
	}
}

static void add_fit(struct result_table table, const struct ladder *ladder, int lane, enum ladder_quantity quantity)
{
	char label[64];
	struct rate_fit fit = ladder_fit(ladder, lane, quantity);
	const struct gas_tally *direct = ladder_binary64(ladder, lane);
	struct interval interval;
	if (isnan(fit.exponent)) return;
	table_row(table);
	table_text(table, "%s", ladder_label(ladder, lane, label));
	table_text(table, "%s", ladder_quantities[quantity]);
	table_text(table, "%.3f ± %.3f", fit.exponent, rate_fit_exponent_error(&fit));
	table_count(table, fit.rungs);
	table_text(table, "%.2g", fit.dispersion);
	double rate = rate_fit_at(&fit, 53, &interval);
	if (rate_fit_exponent_error(&fit) < 0.3)
		table_text(table, "%.2g (%.2g to %.2g)", rate, interval.low, interval.high);
	else
		table_text(table, "no telling");
	if (direct) {
		uint64_t count = ladder_count(direct, quantity);
		interval = interval_of_rate(count, (double)direct->three_body.contacts);
		table_text(table, "%llu of %.3g: %.2g to %.2g", (unsigned long long)count, (double)direct->three_body.contacts,
				   interval.low, interval.high);
	} else {
		table_text(table, "-");
	}
}

static void add_line(struct result_table table, const struct ladder *ladder, int lane, enum ladder_measure measure)
{
	char label[64];
	size_t rungs;
	struct line_fit line = ladder_line(ladder, lane, measure, &rungs);
	const struct gas_tally *direct = ladder_binary64(ladder, lane);
	bool cools = ladder->point[lane * LADDER_RUNGS].restitution < 1, drifts = measure == LADDER_DRIFT;
	if (isnan(line.slope) || (drifts && (cools || ladder_late(lane)))) return;
	table_row(table);
	table_text(table, "%s", ladder_label(ladder, lane, label));
	table_text(table, "%s", ladder_measures[measure]);
	table_text(table, "%.3f ± %.3f", -line.slope, line.slope_error);
	table_count(table, rungs);
	table_text(table, "-");
	table_text(table, "%.2g", exp2(line.intercept + 53 * line.slope));
	if (direct)
		table_text(table, "%.2g", ladder_measured(direct, measure));
	else
		table_text(table, "-");
}

/* A rate, and how often it lets one see something in so many events. */
static void add_expected(struct result_table table, double rate, double events)
{
	for (int cell = 0; cell < 2; cell++)
		if (isnan(rate))
			table_text(table, "-");
		else
			table_text(table, "%.2g", cell ? rate * events : rate);
}

/* What binary64 itself shows, beside what the line through coarser arithmetics and the paper let expect. */
static void add_direct(struct result *result, const struct ladder *ladder)
{
	static const char *const columns[] = {"restitution, density", "events in binary64", "three-body events",
										  "per event (95 %)",     "by the line",        "lets expect",
										  "2014 paper",           "lets expect",        NULL};
	struct result_table table =
		result_table(result, "In binary64 itself",
					 "Runs in binary64, counted, with exact Poisson intervals (Garwood); beside them the rate that the "
					 "line through coarser arithmetics and the rate that the paper lets expect, and how many events "
					 "either would have shown in a run of this length.",
					 columns);
	for (int lane = 0; lane < LADDER_LANES; lane++) {
		const struct gas_tally *direct = ladder_binary64(ladder, lane);
		if (!direct) continue;
		char label[64];
		struct interval interval, line;
		struct rate_fit fit = ladder_fit(ladder, lane, LADDER_EVENTS);
		double contacts = (double)direct->three_body.contacts, reported = ladder_reported(ladder, lane);
		double rate = three_body_rate(&direct->three_body, &interval);
		table_row(table);
		table_text(table, "%s", ladder_label(ladder, lane, label));
		table_count(table, direct->three_body.contacts);
		table_count(table, direct->three_body.events);
		table_text(table, "%.2g (%.2g to %.2g)", rate, interval.low, interval.high);
		add_expected(table, rate_fit_at(&fit, 53, &line), contacts);
		add_expected(table, reported, contacts);
	}
}

void ladder_tables(struct result *result, const struct ladder *ladder)
{
	add_direct(result, ladder);
	static const char *const columns[] = {
		"restitution, density",      "what", "exponent", "rungs", "scatter", "at 53 bits, by the line (95 %)",
		"in binary64 itself (95 %)", NULL};
	struct result_table table =
		result_table(result, "How rates fall with the bits carried",
					 "rate ~ 2^(-exponent P), the most likely line for Poisson counts on all rungs below 53 bits; its "
					 "error allows for "
					 "events that come in bursts and for the scatter around the line (1: that of Poisson counts), but "
					 "not for a bend "
					 "beyond the rungs. Where the scatter is large there is no straight line to speak of. What is "
					 "counted nowhere, or on "
					 "one rung only, has none. Depths, in diameters, and drifts: lines of least squares.",
					 columns);
	for (int lane = 0; lane < LADDER_LANES; lane++) {
		for (int quantity = 0; quantity < LADDER_QUANTITIES; quantity++)
			add_fit(table, ladder, lane, (enum ladder_quantity)quantity);
		for (int measure = 0; measure < LADDER_MEASURES; measure++)
			add_line(table, ladder, lane, (enum ladder_measure)measure);
	}
	for (int lane = 0; lane < LADDER_LANES; lane++) add_lane(result, ladder, lane);
}
