/* Gases of hard spheres as points of a campaign: each is one density, restitution and arithmetic, made in pieces that
 * differ in their start states, so that all cores have something to do and a stop loses little. */
#ifndef VERIFY_GAS_POINTS_H
#define VERIFY_GAS_POINTS_H

#include "figure/figure.h"
#include "measure/kept_gas.h"

struct gas_point {
	double density, restitution;
	const char *arithmetic;
	int bits; /* of it */
	size_t particles;
	uint64_t events; /* to be counted; the gases have settled before */
	int halvings;    /* of speeds, before the unit of time changes; 0 is 1 */
	int starts;      /* start states that a piece may use up, one after another as gases end; 0 is 8 */
	enum touchstone_form form;
	double clock;
};

/* What is counted of a point over all of its pieces that are finished. */
struct gas_tally {
	struct three_body three_body; /* without its list */
	uint64_t repeated, entangled, collapsed, halted, diverged, starts, recentred, dropped;
	double drift;      /* relative change of the energy, summed up */
	uint64_t finished; /* events that were to be counted in the finished pieces */
	double seconds;    /* of one core */
};

/* Measures all points, as the campaign `name`, into `tally`; `*stopped` tells whether some pieces are missing. False,
 * with one line in `error`, when that cannot be. */
bool gas_points_measure(const char *name, const struct figure_setup *setup, const struct gas_point *points,
						size_t count, struct gas_tally *tally, bool *stopped, char error[512]);

/* Whether the gases lasted: otherwise so many of them ended that what was counted is not what was to be counted. */
bool gas_lasted(const struct gas_tally *tally);

#endif
