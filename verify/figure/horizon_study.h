/* What the figure of horizons rests on: many start states, each run in every arithmetic of a ladder against a much
 * finer one, and with a tangent vector. */
#ifndef VERIFY_HORIZON_STUDY_H
#define VERIFY_HORIZON_STUDY_H

#include "figure/figure.h"
#include "measure/horizon_ladder.h"

enum { STUDY_DENSITIES = 3, STUDY_RUNGS = 27, STUDY_STARTS = 40 };

/* Lines are fitted from so many bits on. With fewer, rounding the start state itself moves spheres far into one
 * another. */
enum { STUDY_FITTED_FROM = 24 };

/* How much is measured. The boxes are such that the places of every arithmetic tile them exactly: all rungs run the
 * same scene. */
struct horizon_study {
	const struct figure_setup *setup;
	size_t spheres, starts; /* start states for each box */
	double box[STUDY_DENSITIES];
	double equilibrate;      /* elastic collisions per particle before all */
	double turning, growing; /* events per particle in which a tangent vector turns, and is then followed */
	size_t rungs;
	const char *rung[STUDY_RUNGS]; /* arithmetics that this machine has */
	double bits[STUDY_RUNGS];
};
struct horizon_study horizon_study_choose(const struct figure_setup *setup);
double horizon_study_density(const struct horizon_study *study, size_t d);

/* What the start states of one density say together. Horizons and times: means over them, with standard errors. */
struct horizon_finding {
	size_t starts;
	struct estimate horizon[STUDY_RUNGS], time[STUDY_RUNGS];
	double deviation[STUDY_RUNGS]; /* of horizons, from start state to start state */
	struct estimate slope;         /* events per particle for each bit */
	double intercept;              /* of the fitted line */
	struct estimate by_slope[2];   /* exponents per event per particle and per unit of time: from the slope, */
	struct estimate by_tangent[2]; /* and from tangent vectors */
};

/* Measures what is missing of it, as a campaign; `finished` is how many start states are there of `all`. False with one
 * line in `error`. */
bool horizon_study_run(struct horizon_study *study, struct horizon_finding finding[STUDY_DENSITIES], size_t *finished,
					   size_t *all, char error[512]);

#endif
