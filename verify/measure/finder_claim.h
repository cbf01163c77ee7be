/* What the file of a method claims of its finder, and whether an answer breaks it. */
#ifndef VERIFY_FINDER_CLAIM_H
#define VERIFY_FINDER_CLAIM_H

#include <stdbool.h>

#include "measure/finder_class.h"
#include "touchstone.h"

struct finder_claim {
	struct touchstone_claim claim;
	int bits; /* significand bits of the arithmetic it is made for */
};

/* Whether an answer of this class, off by so many ulp of binary64 if it was found, breaks the claim: never when the
 * claim is not about the question. */
bool finder_claim_broken(const struct finder_claim *claim, enum touchstone_shape shape,
						 const double number[TOUCHSTONE_MOST_NUMBERS], enum finder_class class, double ulp);

/* The claim in words: "at most 4 ulp where |D| > 2^-40 b^2, never misses". */
void finder_claim_words(const struct finder_claim *claim, char words[200]);

#endif
