/* Figure 5 of the 2014 paper: how often three bodies meet, over restitution and density. */
#include "figure/figure.h"

#include "figure/gas_points.h"
#include "measure/interval.h"
#include <inttypes.h>
#include <math.h>
#include <stdlib.h>

/* The same plane in several arithmetics: the coarser, the more there is to see in a run. Never two in one curve. */
static const struct layer {
	const char *arithmetic;
	int bits;
	uint64_t quick, full; /* events of a point */
} layers[] = {{"short:12", 12, 20000, 400000}, {"binary32", 24, 100000, 20000000}, {"binary64", 53, 100000, 10000000}};

enum { LAYERS = 3, DENSITIES = 10, RESTITUTIONS = 9, PLANE = DENSITIES * RESTITUTIONS, CHANGES = 3 };
enum { POINTS = LAYERS * PLANE + CHANGES };
static const int halvings[CHANGES] = {1, 3, 6};

/* All that was measured. */
struct planes {
	struct gas_point point[POINTS];
	struct gas_tally tally[POINTS];
};

static size_t place(int layer, int density, int restitution)
{
	return (size_t)((layer * DENSITIES + density) * RESTITUTIONS + restitution);
}

static void choose_points(struct planes *planes, bool full)
{
	const size_t particles = full ? 4000 : 500;
	for (int l = 0; l < LAYERS; l++)
		for (int d = 0; d < DENSITIES; d++)
			for (int r = 0; r < RESTITUTIONS; r++)
				planes->point[place(l, d, r)] = (struct gas_point){
					.density = (d + 1) / 10.0,
					.restitution = (r + 2) / 10.0,
					.arithmetic = layers[l].arithmetic,
					.bits = layers[l].bits,
					.particles = particles,
					.events = full ? layers[l].full : layers[l].quick,
				};
	for (int c = 0; c < CHANGES; c++) {
		struct gas_point *point = &planes->point[LAYERS * PLANE + c];
		*point = planes->point[place(0, 4, 3)];
		point->events *= 5;
		point->halvings = halvings[c];
	}
}

static bool seen(const struct gas_tally *tally)
{
	return gas_lasted(tally) && tally->three_body.events > 0;
}

/* ------------------------------------------------------------------ figures */

static void write_power(char text[24], double rate)
{
	int power = (int)floor(log10(rate));
	double digit = rint(rate / pow(10, power));
	if (digit >= 10) digit = 1, power++;
	snprintf(text, 24, "%ge%d", digit, power);
}

static void add_map(struct result *result, const struct planes *planes, int layer)
{
	static const char *const columns[] = {"x", "y", "value", "low", "high", "contacts", "events", "encounters", NULL};
	const char *arithmetic = layers[layer].arithmetic;
	char name[40], title[120];
	snprintf(name, sizeof name, "map-%d", layers[layer].bits);
	snprintf(title, sizeof title, "Three-body events per event, in %s", arithmetic);
	struct result_figure figure = result_figure(
		result,
		&(struct figure_frame){
			.name = name,
			.kind = "map",
			.title = title,
			.caption = "A cell marked 0 has none in all its events: the table of the CSV has the upper end of "
					   "its interval. A cell marked with a cross belongs to gases that collapse: more than half "
					   "of the events that were to be counted never came, because infinitely many would have "
					   "to follow within a time that the clock cannot tell from none.",
			.alternative = "A map of rates over restitution, 0.2 to 1, and density, 0.1 to 1. They grow with "
						   "density and as restitution falls.",
			.x = {"restitution", 0, {0, 0}},
			.y = {"reduced density", 0, {0, 0}},
			.columns = columns,
		});
	struct figure_series series = figure_series(figure, arithmetic, SERIES_POINTS);
	for (int d = 0; d < DENSITIES; d++)
		for (int r = 0; r < RESTITUTIONS; r++) {
			size_t p = place(layer, d, r);
			const struct gas_tally *tally = &planes->tally[p];
			if (!tally->finished) continue;
			const struct three_body *three_body = &tally->three_body;
			struct interval interval;
			double rate = three_body_rate(three_body, &interval);
			char word[24] = "0";
			if (seen(tally)) write_power(word, rate);
			if (!gas_lasted(tally)) snprintf(word, sizeof word, "×");
			series_row(series,
					   (double[]){planes->point[p].restitution, planes->point[p].density, seen(tally) ? rate : NAN,
								  interval.low, interval.high, (double)three_body->contacts, (double)three_body->events,
								  (double)three_body->encounters});
			series_mark(series, &(struct series_mark){.name = word, .title = word, .shown = true});
		}
}

static void add_curves(struct result *result, const struct planes *planes, int layer)
{
	static const char *const columns[] = {"x", "y", "low", "high", NULL};
	static const int shown[] = {0, 2, 4, 6, 8};
	const char *arithmetic = layers[layer].arithmetic;
	char name[40], title[120], label[40];
	bool any = false;
	for (size_t p = place(layer, 0, 0); p < place(layer + 1, 0, 0); p++) any |= seen(&planes->tally[p]);
	if (!any) return;
	snprintf(name, sizeof name, "curves-%d", layers[layer].bits);
	snprintf(title, sizeof title, "The same along restitution, in %s", arithmetic);
	struct result_figure figure = result_figure(
		result,
		&(struct figure_frame){
			.name = name,
			.kind = "curves",
			.title = title,
			.caption =
				"Bars are exact 95 % intervals of Poisson counts. Points without a count, and gases that collapse, "
				"are left out.",
			.alternative = "Rates of three-body events against restitution, one curve for each of five densities.",
			.x = {"restitution", 0, {0.15, 1.05}},
			.y = {"three-body events per event", 10, {0, 0}},
			.columns = columns,
		});
	for (size_t s = 0; s < sizeof shown / sizeof *shown; s++) {
		snprintf(label, sizeof label, "density %.1f", (shown[s] + 1) / 10.0);
		struct figure_series series = figure_series(figure, label, SERIES_POINTS);
		for (int r = 0; r < RESTITUTIONS; r++) {
			size_t p = place(layer, shown[s], r);
			if (!seen(&planes->tally[p])) continue;
			struct interval interval;
			double rate = three_body_rate(&planes->tally[p].three_body, &interval);
			series_row(series, (double[]){planes->point[p].restitution, rate, interval.low, interval.high});
		}
	}
}

/* ------------------------------------------------------------------ tables and claims */

static void add_row(struct result_table table, const struct gas_point *point, const struct gas_tally *tally)
{
	const struct three_body *three_body = &tally->three_body;
	struct interval events, encounters;
	double rate = three_body_rate(three_body, &events), met = three_body_encounter_rate(three_body, &encounters);
	table_text(table, "%s", point->arithmetic);
	table_number(table, point->density);
	table_number(table, point->restitution);
	table_count(table, three_body->contacts);
	table_count(table, three_body->events);
	table_text(table, "%.2g (%.2g to %.2g)", rate, events.low, events.high);
	table_count(table, three_body->encounters);
	table_text(table, "%.2g (%.2g to %.2g)", met, encounters.low, encounters.high);
	table_count(table, tally->collapsed);
	table_count(table, tally->dropped);
}

static void add_table(struct result *result, const struct planes *planes)
{
	static const char *const columns[] = {"arithmetic",      "density",        "restitution", "events",
										  "three-body",      "per event",      "encounters",  "per event",
										  "gases collapsed", "events dropped", NULL};
	struct result_table table = result_table(
		result, "Some of the points",
		"Intervals by Garwood. An encounter is a three-body event that does not just follow another of the same three "
		"particles: the stabilising collisions that clear the overlap are three-body events too. What a gas did in the "
		"ten to twenty collisions per particle before it collapsed is dropped.",
		columns);
	static const int density[] = {0, 4, 9}, restitution[] = {8, 7, 3, 1};
	for (int l = 0; l < LAYERS; l++)
		for (size_t d = 0; d < sizeof density / sizeof *density; d++)
			for (size_t r = 0; r < sizeof restitution / sizeof *restitution; r++) {
				size_t p = place(l, density[d], restitution[r]);
				if (!planes->tally[p].three_body.contacts) continue;
				table_row(table);
				add_row(table, &planes->point[p], &planes->tally[p]);
			}
}

static void add_changes(struct result *result, const struct planes *planes)
{
	static const char *const columns[] = {"speeds may fall by", "events", "three-body", "per event", "95 %", NULL};
	struct result_table table = result_table(result, "Keeping a cooling gas warm does not matter",
											 "Density 0.5, restitution 0.5, short:12. When speeds have fallen so far, "
											 "the unit of time is changed by the same "
											 "power of two, which rounds nothing.",
											 columns);
	for (int c = 0; c < CHANGES; c++) {
		const struct gas_tally *tally = &planes->tally[LAYERS * PLANE + c];
		if (!tally->finished) continue;
		struct interval interval;
		double rate = three_body_rate(&tally->three_body, &interval);
		table_row(table);
		table_text(table, "2^%d", halvings[c]);
		table_count(table, tally->three_body.contacts);
		table_count(table, tally->three_body.events);
		table_text(table, "%.3g", rate);
		table_text(table, "%.3g to %.3g", interval.low, interval.high);
	}
}

/* The claim about dilute elastic gases, as far as runs in binary64 themselves can tell. */
static void claim_elastic(struct result *result, const struct planes *planes)
{
	struct three_body dilute = {0};
	struct interval interval;
	for (int d = 0; d < 3; d++) {
		const struct gas_tally *tally = &planes->tally[place(2, d, RESTITUTIONS - 1)];
		if (!tally->finished) return;
		three_body_merge(&dilute, &tally->three_body);
	}
	double rate = three_body_rate(&dilute, &interval);
	bool settled = interval.high < 5e-10 || interval.low > 2e-9;
	result_claim(result,
				 &(struct result_claim){
					 .quantity = "three-body events per event, dilute and elastic",
					 .reported = "about 1e-9",
					 .where = "2014, section 3 and fig. 5",
					 .measured = rate,
					 .interval = {interval.low, interval.high},
					 .interval_means = "95 %, Garwood",
					 .unit = "per event, in binary64, densities 0.1 to 0.3",
					 .count = dilute.contacts,
					 .verdict = settled ? RESULT_DIFFERS : RESULT_NOT_COMPARABLE,
					 .why = settled ? "Directly in binary64; the precision ladder has more."
									: "So few events cannot tell: the precision ladder (touchstone reproduce ladder) "
									  "measures the rate in coarser arithmetics and follows it down to 53 bits.",
				 });
}

/* The point of a layer at which gases that last have the highest rate, of inelastic ones; SIZE_MAX: nowhere, or some
 * are not finished. */
static size_t highest(const struct planes *planes, int layer, uint64_t *count)
{
	size_t where = SIZE_MAX;
	double most = 0;
	struct interval interval;
	for (size_t p = place(layer, 0, 0); p < place(layer + 1, 0, 0); p++) {
		const struct gas_tally *tally = &planes->tally[p];
		if (!tally->finished) return SIZE_MAX;
		if (planes->point[p].restitution == 1 || !seen(tally)) continue;
		double rate = three_body_rate(&tally->three_body, &interval);
		*count += tally->three_body.contacts;
		if (rate > most) most = rate, where = p;
	}
	return where;
}

static void claim_inelastic(struct result *result, const struct planes *planes)
{
	struct interval interval;
	uint64_t count = 0;
	const struct three_body *dilute = &planes->tally[place(0, 0, RESTITUTIONS - 1)].three_body;
	size_t coarse = highest(planes, 0, &count), fine = highest(planes, 2, &count);
	if (!dilute->events || coarse == SIZE_MAX || fine == SIZE_MAX) return;
	double elastic = three_body_rate(dilute, &interval);
	double most = three_body_rate(&planes->tally[coarse].three_body, &interval);
	double binary64 = three_body_rate(&planes->tally[fine].three_body, &interval);
	char shown[200];
	snprintf(
		shown, sizeof shown,
		"short:12: %.2g times (%.2g at restitution %g, density %g, against %.2g); binary64: %.2g at %g, %g, against "
		"none seen",
		most / elastic, most, planes->point[coarse].restitution, planes->point[coarse].density, elastic, binary64,
		planes->point[fine].restitution, planes->point[fine].density);
	result_claim(result,
				 &(struct result_claim){
					 .quantity = "how much more often in inelastic gases",
					 .reported = "three orders of magnitude",
					 .where = "2014, section 3 and fig. 5",
					 .measured = most / elastic,
					 .shown = shown,
					 .count = count,
					 .verdict = RESULT_DIFFERS,
					 .why = "There is no one ratio. In a gas that does not cluster the rate falls in proportion "
							"to the unit roundoff; in one that is near collapse it hardly does, for there the "
							"times between events shrink until rounding is all that is left of them. So the "
							"finer the arithmetic, the larger the ratio, and it has no upper end but collapse.",
				 });
}

struct result *figure_three_body(const struct figure_setup *setup, char error[512])
{
	struct planes *planes = calloc(1, sizeof *planes);
	struct result *result = result_new("fig5", "How often do three bodies meet?");
	bool stopped = false, good = planes && result;
	if (!good) snprintf(error, 512, "not enough memory");
	if (good) {
		choose_points(planes, setup->full);
		good = gas_points_measure("fig5", setup, planes->point, POINTS, planes->tally, &stopped, error);
	}
	if (good) {
		result_paragraph(
			result,
			"Two hard spheres that collide are left a few units in the last place apart or inside one another. If one "
			"of them meets a third before the overlap has cleared, three are in contact, which the model does not "
			"know. Counted are contacts after which one of the two particles overlaps its partner and a third, by "
			"their "
			"exact positions in the working arithmetic: %zu spheres in a periodic box, the stable method, %g elastic "
			"collisions per particle and then 20 inelastic ones before counting.",
			planes->point[0].particles, 20.0);
		result_paragraph(result, "In binary64 the rate is too low to be seen in runs like these, but where gases are "
								 "near collapse. So the same "
								 "plane is measured in short:12 and binary32 as well, each by itself. How the rate "
								 "falls with the bits carried "
								 "is measured by the precision ladder.");
		claim_elastic(result, planes);
		claim_inelastic(result, planes);
		for (int l = 0; l < LAYERS; l++) add_map(result, planes, l), add_curves(result, planes, l);
		add_table(result, planes);
		add_changes(result, planes);
		result_note(result,
					"Gases that cool are kept warm by changes of the unit of time by powers of two; the rounding "
					"of momentum, which does not cool, is taken away when it reaches 2^-6 of the speeds.");
		result_note(result, "A gas that collapses is followed by another start state, up to eight times.");
		if (stopped) result_incomplete(result, "stopped before all points were measured; run again to go on");
	}
	free(planes);
	if (good) return result;
	result_free(result);
	return NULL;
}
