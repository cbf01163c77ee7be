/* What the file of a method claims of its finder, and whether an answer breaks it. */
#ifndef VERIFY_FINDER_CLAIM_H
#define VERIFY_FINDER_CLAIM_H

#include <stdbool.h>

#include "measure/finder_class.h"
#include "touchstone.h"

struct finder_claim {
	struct touchstone_claim claim;
	const char *arithmetic; /* that it is made for; the caller's */
	int bits;               /* of its significand */
};

/* Whether an answer of this class breaks the claim: never when the claim is not about the question. If there is an
 * event, `exact` is the double nearest to its time; if it was found, `ulp` is how far off, in ulp of binary64. Times
 * that lie beyond the range in which the arithmetic has its full precision are not held against it. */
bool finder_claim_broken(const struct finder_claim *claim, enum touchstone_shape shape,
						 const double number[TOUCHSTONE_MOST_NUMBERS], enum finder_class class, double exact,
						 double ulp);

/* The claim in words: "at most 4 ulp where |D| > 2^-40 b^2, never misses". */
void finder_claim_words(const struct finder_claim *claim, char words[200]);

#endif
