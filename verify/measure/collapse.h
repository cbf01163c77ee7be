/* Collapse (design, section 5.3; 2014 paper, section 5 and fig. 7): a ball over many plates, by a method and in one
 * order of evaluation. */
#ifndef VERIFY_COLLAPSE_H
#define VERIFY_COLLAPSE_H

#include <jansson.h>

#include "touchstone.h"

struct collapse {
	uint64_t plates;         /* tried */
	uint64_t halted, rested; /* what became of them; the rest used up the events they were given */
	double events_to_halt;   /* mean over those that halted */
	double events_to_rest;   /* mean over those that came to rest */
	double largest_error;    /* of the rest time against the exact one of the same start, in units of time */
	double worst_plate;      /* on which it is attained */
	double median_error;     /* of a sample of the plates that came to rest */
	double deepest;          /* most negative gap at the end, in diameters */
};

struct collapse_setup {
	const char *arithmetic, *method;
	unsigned order; /* of evaluation, see touchstone_drop_order */
	double gravity, restitution;
	uint64_t plates, seed;    /* plates are uniform in [0, 1) */
	int bits;                 /* of the plates: as many as the arithmetic has, and at least 53 */
	uint64_t most;            /* events of one ball after which to give up: it will not rest */
	const volatile int *stop; /* non-zero: come to an end with what is done; may be NULL */
};

/* Drops the balls. False, with one line in `error`, for unknown names. */
bool collapse_measure(const struct collapse_setup *setup, struct collapse *collapse, char error[160]);

/* The same as JSON that keeps every bit, owned by the caller; and back, all 0 for what is no object. */
json_t *collapse_json(const struct collapse *collapse);
struct collapse collapse_of_json(const json_t *json);

/* Error of a landing's time against sqrt(2 h / |g|) (1 + e) / (1 - e), h being the true height it fell from in the
 * working arithmetic: the difference is taken with enough bits and rounded once. */
double collapse_error(const struct touchstone_drop *drop, const struct touchstone_landing *landing);

#endif
