/* The filter before the exact oracle: answers in twice double precision with a proven bound, or says that it cannot. */
#ifndef VERIFY_ORACLE_FILTER_H
#define VERIFY_ORACLE_FILTER_H

#include "oracle/oracle.h"

/* Each returns false when the filter cannot tell, and then leaves what it would fill in undefined. */

/* Fills the event of `time` and its estimate. */
bool filter_solve(const struct oracle_query *query, struct oracle_time *time);

/* Of a, b, c and b^2 - a c, turned so that a >= 0. */
bool filter_signs(const struct oracle_query *query, int signs[ORACLE_SIGNS]);

bool filter_round(const struct oracle_estimate *estimate, mpfr_rnd_t direction, double *rounded);

/* -1 or 1. */
bool filter_compare(const struct oracle_estimate *first, const struct oracle_estimate *second, int *order);

/* |got - estimate| / ulp to a relative 2^-30; `got` is finite. */
bool filter_error(const struct oracle_estimate *estimate, double got, double *ulps);

#endif
