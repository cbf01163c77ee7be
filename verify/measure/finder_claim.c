#include "measure/finder_claim.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "measure/exact_steps.h"

enum { DOUBLE_BITS = 53, WORDS = 200 };

/* Whether the arithmetic has the number: asked to take it as the distance of a half-space, it gives it back. */
static bool holds(const struct finder_claim *claim, double number)
{
	const double question[TOUCHSTONE_MOST_NUMBERS] = {number, -1};
	struct touchstone_steps steps;
	char why[160];
	return touchstone_find_steps(claim->arithmetic, "stable", TOUCHSTONE_HALF_SPACE, question, &steps, why) &&
		   steps.c == number;
}

/* Whether the arithmetic has all its bits for such a time. Where it has as many as a double, its range is as wide. */
static bool in_range(const struct finder_claim *claim, double time)
{
	if (claim->bits >= DOUBLE_BITS || time == 0) return true;
	return isfinite(time) && holds(claim, ldexp(1 + ldexp(1, 1 - claim->bits), ilogb(time)));
}

/* Whether the claim is about such numbers. */
static bool concerns(const struct finder_claim *claim, const double number[TOUCHSTONE_MOST_NUMBERS])
{
	for (int i = 0; i < TOUCHSTONE_MOST_NUMBERS; i++) {
		double size = fabs(number[i]);
		bool within = size == 0 || (size >= claim->claim.least && size <= claim->claim.most);
		if (!within || !holds(claim, number[i])) return false;
	}
	return true;
}

/* Whether |D| > 2^-bits b^2, exactly. */
static bool well_conditioned(const struct finder_claim *claim, enum touchstone_shape shape,
							 const double number[TOUCHSTONE_MOST_NUMBERS])
{
	if (claim->claim.discriminant_bits == 0 || !exact_step_formula(shape, STEP_DISCRIMINANT)) return true;
	struct exact_steps exact;
	mpq_t square;
	exact_steps_init(&exact, shape, number);
	mpq_init(square);
	mpq_mul(square, exact.value[STEP_B], exact.value[STEP_B]);
	mpq_div_2exp(square, square, (mp_bitcnt_t)claim->claim.discriminant_bits);
	mpq_abs(exact.value[STEP_DISCRIMINANT], exact.value[STEP_DISCRIMINANT]);
	bool well = mpq_cmp(exact.value[STEP_DISCRIMINANT], square) > 0;
	mpq_clear(square);
	exact_steps_clear(&exact);
	return well;
}

bool finder_claim_broken(const struct finder_claim *claim, enum touchstone_shape shape,
						 const double number[TOUCHSTONE_MOST_NUMBERS], enum finder_class class, double exact,
						 double ulp)
{
	const struct touchstone_claim *said = &claim->claim;
	double most_ulp = claim->bits < DOUBLE_BITS ? ldexp(said->most_ulp, DOUBLE_BITS - claim->bits) : said->most_ulp;
	switch (class) {
	case FINDER_NAN:
		return said->never_nan && concerns(claim, number);
	case FINDER_NEGATIVE:
		return said->never_negative && concerns(claim, number);
	case FINDER_MISSED:
		return said->never_misses && in_range(claim, exact) && concerns(claim, number) &&
			   well_conditioned(claim, shape, number);
	case FINDER_PHANTOM:
		return said->never_phantom && concerns(claim, number) && well_conditioned(claim, shape, number);
	case FINDER_FOUND:
		return ulp > most_ulp && in_range(claim, exact) && concerns(claim, number) &&
			   well_conditioned(claim, shape, number);
	case FINDER_RIGHTLY_NEVER:
	case FINDER_UNDEFINED:
		break;
	}
	return false;
}

void finder_claim_words(const struct finder_claim *claim, char words[WORDS])
{
	const struct touchstone_claim *said = &claim->claim;
	const struct {
		bool said;
		const char *words;
	} promises[] = {{said->never_misses, "no miss"},
					{said->never_phantom, "no phantom"},
					{said->never_negative, "nothing negative"},
					{said->never_nan, "no NaN"}};
	size_t length = 0;
	*words = '\0';
	if (said->most_ulp < INFINITY) length += (size_t)snprintf(words, WORDS, "at most %g ulp", said->most_ulp);
	for (int p = 0; p < 4; p++)
		if (promises[p].said)
			length += (size_t)snprintf(words + length, WORDS - length, "%s%s", length ? ", " : "", promises[p].words);
	if (said->discriminant_bits)
		length += (size_t)snprintf(words + length, WORDS - length, ", where |D| > 2^-%d b^2", said->discriminant_bits);
	if (said->most < INFINITY)
		snprintf(words + length, WORDS - length, ", for numbers from %.3g to %.3g", said->least, said->most);
}
