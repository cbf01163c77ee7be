#include "figure/ladder.h"

#include <math.h>
#include <stdio.h>

/* The gas at restitution 0.3 collapses, in binary64 after some 3 10^5 events of 500 spheres and sooner in coarser
 * arithmetics (`reproduce ladder --full`, tables of the rungs), so that many of them follow one another. */
static const struct {
	double restitution, density;
	int starts;
} gases[LADDER_LANES] = {{1, 0.1, 0}, {1, 0.5, 0}, {0.9, 0.5, 0}, {0.5, 0.5, 0}, {0.3, 0.5, 2000}, {1, 0.1, 0}};

/* Events of a point. Full: dozens of three-body events or more on each rung down to 22 bits, and no rung more than ten
 * minutes of a core; but inelastic gases in binary64 are to show them directly, should they be as frequent as the paper
 * says. */
static const struct rung {
	const char *arithmetic;
	int bits;
	uint64_t quick, full;
} rungs[LADDER_RUNGS] = {
	{"short:8", 8, 2000, 20000},        {"short:10", 10, 10000, 200000},     {"short:12", 12, 100000, 2000000},
	{"short:14", 14, 200000, 10000000}, {"short:16", 16, 200000, 10000000},  {"short:18", 18, 150000, 30000000},
	{"short:20", 20, 150000, 30000000}, {"short:22", 22, 150000, 50000000},  {"binary32", 24, 200000, 100000000},
	{"short:25", 25, 100000, 20000000}, {"mpfr:25", 25, 10000, 1000000},     {"mpfr:32", 32, 10000, 1000000},
	{"mpfr:40", 40, 10000, 1000000},    {"binary64", 53, 200000, 100000000},
};
enum { FINEST_LATE = 8 }; /* late clocks stand in for the rungs up to this one; they are as fast as binary64 is */
static const uint64_t late_quick = 200000, late_full = 20000000, inelastic_full = 1000000000;

void ladder_choose(struct ladder *ladder, bool full)
{
	for (int lane = 0; lane < LADDER_LANES; lane++)
		for (int r = 0; r < LADDER_RUNGS; r++) {
			const struct rung *rung = &rungs[r];
			struct gas_point *point = &ladder->point[lane * LADDER_RUNGS + r];
			*point = (struct gas_point){
				.density = gases[lane].density,
				.restitution = gases[lane].restitution,
				.arithmetic = rung->arithmetic,
				.bits = rung->bits,
				.particles = full ? 500 : 256,
				.events = full ? rung->full : rung->quick,
				.starts = gases[lane].starts,
			};
			if (full && r == LADDER_RUNGS - 1 && point->restitution < 1) point->events = inelastic_full;
			if (!ladder_late(lane)) continue;
			point->arithmetic = "binary64";
			point->bits = 53;
			point->form = TOUCHSTONE_ABSOLUTE;
			point->clock = ldexp(1, 53 - rung->bits);
			point->events = full ? late_full : late_quick;
			if (r > FINEST_LATE) point->events = 0;
		}
}

const char *ladder_label(const struct ladder *ladder, int lane, char label[64])
{
	const struct gas_point *point = &ladder->point[lane * LADDER_RUNGS];
	snprintf(label, 64, "(%g, %g)%s", point->restitution, point->density, ladder_late(lane) ? ", late clock" : "");
	return label;
}

double ladder_bits(const struct gas_point *point)
{
	return point->clock > 0 ? point->bits - log2(point->clock) : point->bits;
}

const char *const ladder_quantities[LADDER_QUANTITIES] = {"three-body events", "three-body encounters",
														  "repeated events", "entangled pairs"};

uint64_t ladder_count(const struct gas_tally *tally, enum ladder_quantity quantity)
{
	const uint64_t counts[LADDER_QUANTITIES] = {tally->three_body.events, tally->three_body.encounters, tally->repeated,
												tally->entangled};
	return counts[quantity];
}

struct rate_fit ladder_fit(const struct ladder *ladder, int lane, enum ladder_quantity quantity)
{
	struct rung_count rung[LADDER_RUNGS];
	size_t used = 0;
	double events = 0, encounters = 0;
	for (int r = 0; r < LADDER_RUNGS; r++) {
		const struct gas_point *point = &ladder->point[lane * LADDER_RUNGS + r];
		const struct gas_tally *tally = &ladder->tally[lane * LADDER_RUNGS + r];
		if (ladder_bits(point) >= 53 || !gas_lasted(tally)) continue;
		rung[used++] =
			(struct rung_count){ladder_bits(point), (double)tally->three_body.contacts, ladder_count(tally, quantity)};
		events += (double)tally->three_body.events;
		encounters += (double)tally->three_body.encounters;
	}
	bool bursts = quantity != LADDER_ENCOUNTERS && encounters > 0;
	return rate_fit(rung, used, bursts ? events / encounters : 1);
}

const char *const ladder_measures[LADDER_MEASURES] = {"mean depth of overlaps", "deepest overlap",
													  "energy drift in 10^6 events"};

double ladder_measured(const struct gas_tally *tally, enum ladder_measure measure)
{
	const struct three_body *three_body = &tally->three_body;
	if (!three_body->overlapping) return NAN;
	const double values[LADDER_MEASURES] = {three_body->depth / (double)three_body->overlapping, three_body->deepest,
											fabs(tally->drift) / (double)three_body->contacts * 1e6};
	return values[measure];
}

struct line_fit ladder_line(const struct ladder *ladder, int lane, enum ladder_measure measure, size_t *rungs)
{
	double x[LADDER_RUNGS], y[LADDER_RUNGS];
	*rungs = 0;
	for (int r = 0; r < LADDER_RUNGS; r++) {
		const struct gas_point *point = &ladder->point[lane * LADDER_RUNGS + r];
		const struct gas_tally *tally = &ladder->tally[lane * LADDER_RUNGS + r];
		if (ladder_bits(point) >= 53 || !gas_lasted(tally) || !(ladder_measured(tally, measure) > 0)) continue;
		x[*rungs] = ladder_bits(point);
		y[(*rungs)++] = log2(ladder_measured(tally, measure));
	}
	return *rungs < 3 ? (struct line_fit){NAN, NAN, NAN} : fit_line(x, y, *rungs);
}

const struct gas_tally *ladder_binary64(const struct ladder *ladder, int lane)
{
	const struct gas_tally *tally = &ladder->tally[lane * LADDER_RUNGS + LADDER_RUNGS - 1];
	return ladder_late(lane) || !tally->three_body.contacts ? NULL : tally;
}

double ladder_reported(const struct ladder *ladder, int lane)
{
	const struct gas_point *point = &ladder->point[lane * LADDER_RUNGS];
	if (ladder_late(lane)) return NAN;
	return point->restitution < 1 ? 1e-6 : point->density <= 0.1 ? 1e-9 : NAN;
}
