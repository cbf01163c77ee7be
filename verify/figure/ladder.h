/* The precision ladder: the same gases in arithmetics from coarse to fine, so that rates too low to be seen in binary64
 * can be followed down to it. */
#ifndef VERIFY_LADDER_H
#define VERIFY_LADDER_H

#include "figure/gas_points.h"
#include "measure/rate_fit.h"

enum { LADDER_LANES = 6, LADDER_RUNGS = 14, LADDER_POINTS = LADDER_LANES * LADDER_RUNGS };

/* A gas, run on every rung. The last lane has one arithmetic and times that begin late: what is left of a time's bits
 * below 1 is what counts. */
struct ladder {
	struct gas_point point[LADDER_POINTS]; /* of each lane all rungs; those not used have no events */
	struct gas_tally tally[LADDER_POINTS];
};

/* Whether it is the lane of late clocks. */
static inline bool ladder_late(int lane)
{
	return lane == LADDER_LANES - 1;
}

void ladder_choose(struct ladder *ladder, bool full);
const char *ladder_label(const struct ladder *ladder, int lane, char label[64]);

/* Bits that a point carries below times and lengths of 1. */
double ladder_bits(const struct gas_point *point);

/* What is counted of a gas. */
enum ladder_quantity { LADDER_EVENTS, LADDER_ENCOUNTERS, LADDER_REPEATED, LADDER_ENTANGLED, LADDER_QUANTITIES };
extern const char *const ladder_quantities[LADDER_QUANTITIES];
uint64_t ladder_count(const struct gas_tally *tally, enum ladder_quantity quantity);

/* The line through all rungs of a lane below 53 bits on which gases lasted. */
struct rate_fit ladder_fit(const struct ladder *ladder, int lane, enum ladder_quantity quantity);

/* What is measured of a gas: depth of overlaps at impact in diameters, mean and deepest, and the relative change of the
 * energy in 10^6 events, of elastic gases. NaN where there is none. */
enum ladder_measure { LADDER_DEPTH, LADDER_DEEPEST, LADDER_DRIFT, LADDER_MEASURES };
extern const char *const ladder_measures[LADDER_MEASURES];
double ladder_measured(const struct gas_tally *tally, enum ladder_measure measure);

/* log2 of what is measured over bits, on all rungs of a lane below 53 bits on which gases lasted; `*rungs` of them, of
 * which fewer than 3 make no line. */
struct line_fit ladder_line(const struct ladder *ladder, int lane, enum ladder_measure measure, size_t *rungs);

/* The point of a lane in binary64 itself; NULL where it is not finished, and for late clocks. */
const struct gas_tally *ladder_binary64(const struct ladder *ladder, int lane);

/* Three-body events per event that the 2014 paper reports for gases like a lane's (section 3): about 1e-9 for dilute
 * elastic ones, three orders more for inelastic ones. NaN where it says nothing. */
double ladder_reported(const struct ladder *ladder, int lane);

/* Tables of what binary64 itself shows beside the lines and the paper, of all fits, and of all rungs. */
struct result;
void ladder_tables(struct result *result, const struct ladder *ladder);

/* All that there is to tell: summary, claims, figures and those tables (ladder_figure.c). */
void ladder_tell(struct result *result, const struct ladder *ladder);

#endif
