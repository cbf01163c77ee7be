/* What late times and far places do to a gas (design, section 4): one vessel (vessel.h) in several situations, in both
 * forms of time and place. */
#ifndef VERIFY_TIME_PLACE_H
#define VERIFY_TIME_PLACE_H

#include <jansson.h>

#include "measure/course.h"
#include "measure/impact.h"

/* When a vessel begins, how wide the box is in which it stands far out, and the arithmetic it runs in. */
struct situation {
	const char *arithmetic, *name;
	double clock, box;
};
enum { SITUATIONS = 12, FORMS = 2 /* enum touchstone_form */ };
extern const struct situation situations[SITUATIONS];

/* What is seen of a vessel in a situation, or of several together. Each runs for VESSEL_TIME, so short that no clock
 * that began at 0 has lost a bit that matters. */
enum { VESSEL_TIME = 4, MOST_VESSELS = 400 };
struct sight {
	uint64_t contacts, below;               /* truly below the contact distance */
	double sum, squares;                    /* of the true separation less contact, in ulp of the arithmetic */
	uint64_t doubling[2][IMPACT_DOUBLINGS]; /* as in struct impact_histogram */
	uint64_t three_body, encounters;        /* as in struct three_body */
	size_t vessels;
	double horizon[MOST_VESSELS]; /* of each: events per particle, against mpfr:256 */
};

/* Measures the vessel of a seed in all situations: an array, for each situation and form in turn. NULL when stopped,
 * with `error` empty, or with one line in `error`. */
json_t *time_place_measure(uint64_t seed, const struct watch *watch, char error[160]);

/* Adds what that has measured of one situation and form. */
void time_place_add(struct sight *sight, const json_t *measured, size_t situation, enum touchstone_form form);

/* Of the separation, in ulp; NaN of none. */
double time_place_deviation(const struct sight *sight);

#endif
