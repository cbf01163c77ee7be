/* How a rate falls with the bits carried: counts k of n events at P bits are taken for Poisson variables of mean
 * n 2^(intercept - exponent P), and the line is the one that makes them most likely. */
#ifndef VERIFY_RATE_FIT_H
#define VERIFY_RATE_FIT_H

#include "measure/interval.h"

/* What was counted on one rung of the ladder. */
struct rung_count {
	double bits, events;
	uint64_t count;
};

struct rate_fit {
	size_t rungs;            /* those with events, whether anything was counted there or not */
	double exponent;         /* alpha in rate ~ 2^(-alpha P); NaN when there are not two rungs with counts */
	double intercept;        /* log2 of the rate at 0 bits */
	double covariance[2][2]; /* of intercept and exponent */
	double dispersion; /* by how much counts scatter more than Poisson variables do; 1 or more, and in the covariance */
};

/* `burst`: in how many counts one independent cause shows on average; 1 or more. The errors are those of counts that
 * come in such bursts, or of the scatter around the line where that is larger. */
struct rate_fit rate_fit(const struct rung_count *rung, size_t rungs, double burst);

/* The rate at so many bits, with 95 % confidence in the line. */
double rate_fit_at(const struct rate_fit *fit, double bits, struct interval *interval);
double rate_fit_exponent_error(const struct rate_fit *fit); /* standard error */

#endif
