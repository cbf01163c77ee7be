#include "measure/finder_bits.h"

#include <math.h>
#include <stdlib.h>

#include "measure/finder_grade.h"

enum { GUARD = 64 /* bits beyond those of the finest arithmetic */ };
static const double least_time = 0x1p-562;

struct finder_truth {
	enum touchstone_shape shape;
	const double (*numbers)[TOUCHSTONE_MOST_NUMBERS];
	size_t room, count;
	struct oracle_time *time;
	bool *asked; /* whether the question is one the oracle takes, and its answer one that doubles can tell */
	mpfr_t *exact;
	double (*answer)[TOUCHSTONE_MOST_TERMS];
	mpfr_t got, larger;
};

struct finder_truth *finder_truth_create(size_t room, int bits)
{
	struct finder_truth *truth = calloc(1, sizeof *truth);
	if (!truth) return NULL;
	mpfr_inits2(bits + GUARD, truth->got, truth->larger, (mpfr_ptr)0);
	truth->time = calloc(room, sizeof *truth->time);
	truth->asked = calloc(room, sizeof *truth->asked);
	truth->exact = calloc(room, sizeof *truth->exact);
	truth->answer = calloc(room, sizeof *truth->answer);
	if (!truth->time || !truth->asked || !truth->exact || !truth->answer) {
		finder_truth_destroy(truth);
		return NULL;
	}
	for (; truth->room < room; truth->room++) mpfr_init2(truth->exact[truth->room], bits + GUARD);
	return truth;
}

void finder_truth_destroy(struct finder_truth *truth)
{
	if (!truth) return;
	for (size_t k = 0; k < truth->room; k++) mpfr_clear(truth->exact[k]);
	mpfr_clears(truth->got, truth->larger, (mpfr_ptr)0);
	free(truth->time);
	free(truth->asked);
	free(truth->exact);
	free(truth->answer);
	free(truth);
}

void finder_truth_solve(struct finder_truth *truth, struct oracle *oracle, enum touchstone_shape shape,
						const double (*numbers)[TOUCHSTONE_MOST_NUMBERS], size_t count)
{
	truth->shape = shape;
	truth->numbers = numbers;
	truth->count = count;
	for (size_t k = 0; k < count; k++) {
		struct oracle_query query = finder_question(shape, numbers[k]);
		truth->asked[k] = oracle_accepts(&query);
		if (!truth->asked[k]) continue;
		truth->time[k] = oracle_solve(oracle, &query);
		oracle_round_mpfr(oracle, truth->exact[k], &truth->time[k], MPFR_RNDN);
		truth->asked[k] = truth->time[k].event != ORACLE_LATER || mpfr_cmp_d(truth->exact[k], least_time) >= 0;
	}
}

void finder_bits_begin(struct finder_bits *bits)
{
	*bits = (struct finder_bits){.least = INFINITY};
}

/* Bits of `got` against an exact answer; uses both working numbers. */
static double bits_of(mpfr_t got, mpfr_t larger, const mpfr_t exact)
{
	if (mpfr_equal_p(got, exact)) return INFINITY;
	mpfr_max(larger, got, exact, MPFR_RNDN);
	mpfr_sub(got, got, exact, MPFR_RNDA);
	mpfr_div(got, got, larger, MPFR_RNDA);
	long exponent;
	double fraction = fabs(mpfr_get_d_2exp(&exponent, got, MPFR_RNDA));
	return fmax(0, -log2(fraction) - (double)exponent);
}

static void count_answer(struct finder_bits *bits, double found)
{
	double level = floor(FINDER_BITS_STEP * found);
	bits->count[level < FINDER_BITS_LEVELS - 1 ? (size_t)level : FINDER_BITS_LEVELS - 1]++;
	bits->found++;
	bits->least = fmin(bits->least, found);
}

bool finder_bits_add(struct finder_bits *bits, struct finder_truth *truth, struct oracle *oracle,
					 const char *arithmetic, const char *method, char error[160])
{
	if (!touchstone_find_terms(arithmetic, method, truth->shape, truth->numbers, truth->count, truth->answer, error))
		return false;
	for (size_t k = 0; k < truth->count; k++) {
		const double *answer = truth->answer[k];
		double ulp = 0;
		if (!truth->asked[k] || finder_classify(oracle, &truth->time[k], answer[0], &ulp) != FINDER_FOUND) continue;
		mpfr_set_d(truth->got, answer[0], MPFR_RNDN);
		for (int term = 1; term < TOUCHSTONE_MOST_TERMS && answer[term] != 0; term++)
			mpfr_add_d(truth->got, truth->got, answer[term], MPFR_RNDN);
		count_answer(bits, answer[0] == INFINITY ? INFINITY : bits_of(truth->got, truth->larger, truth->exact[k]));
	}
	return true;
}

double finder_bits_of_share(const struct finder_bits *bits, double share)
{
	if (bits->found == 0) return NAN;
	double spared = floor((1 - share) * (double)bits->found * (1 + 1e-12)); /* may have fewer */
	uint64_t below = 0;
	for (int level = 0; level < FINDER_BITS_LEVELS - 1; level++) {
		below += bits->count[level];
		if ((double)below > spared) return fmax((double)level / FINDER_BITS_STEP, bits->least);
	}
	return INFINITY;
}
