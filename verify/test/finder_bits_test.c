/* The bits of a finder's answers, against their definition; and unrounded answers against rounded ones. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <mpfr.h>
#include <stdlib.h>
#include <string.h>

#include "family/family.h"
#include "measure/finder_bits.h"
#include "test/long_double.h"
#include "touchstone.h"

enum { SEED = 20141015 };

static char error[160];

enum { QUESTIONS = 200 };
typedef double question[TOUCHSTONE_MOST_NUMBERS];

static const char *const arithmetics[] = {"short:12",  "binary32", "binary64", "extended", "twin",
										  "binary128", "mpfr:53",  "mpfr:113", "mpfr:400"};
enum { ARITHMETICS = sizeof arithmetics / sizeof *arithmetics };

static void draw_questions(const char *family, question number[QUESTIONS])
{
	if (!family_fill(family_named(family), TOUCHSTONE_BALL_BALL, SEED, 0, QUESTIONS, number, error))
		fail_msg("%s", error);
}

/* Unrounded answers, rounded to double, are the answers; they carry no more bits than their arithmetic. */
static void unrounded_answers_round_to_the_answers(void **state)
{
	(void)state;
	static const char *const families[] = {"dense", "grazing", "zeros", "any-doubles"};
	static double terms[QUESTIONS][TOUCHSTONE_MOST_TERMS], times[QUESTIONS];
	static const int bits[ARITHMETICS] = {12, 24, 53, 64, 0, 113, 53, 113, 400};
	question number[QUESTIONS];
	mpfr_t sum;
	mpfr_init2(sum, 1400);
	for (size_t f = 0; f < sizeof families / sizeof *families; f++) {
		draw_questions(families[f], number);
		for (int a = 0; a < ARITHMETICS; a++) {
			assert_true(touchstone_find(arithmetics[a], "stable", TOUCHSTONE_BALL_BALL, (void *)number, QUESTIONS,
										false, times, error));
			assert_true(touchstone_find_terms(arithmetics[a], "stable", TOUCHSTONE_BALL_BALL, (void *)number, QUESTIONS,
											  terms, error));
			for (int k = 0; k < QUESTIONS; k++) {
				bool both_nan = isnan(times[k]) && isnan(terms[k][0]);
				if (!both_nan && terms[k][0] != times[k])
					fail_msg("%s, %s: %a, not %a", families[f], arithmetics[a], terms[k][0], times[k]);
				mpfr_set_zero(sum, 1);
				for (int term = 0; term < TOUCHSTONE_MOST_TERMS; term++)
					mpfr_add_d(sum, sum, terms[k][term], MPFR_RNDN);
				if (bits[a] && mpfr_number_p(sum)) assert_true(mpfr_min_prec(sum) <= bits[a]);
			}
		}
	}
	mpfr_clear(sum);
	assert_false(touchstone_find_terms("decimal", "stable", TOUCHSTONE_BALL_BALL, NULL, 0, NULL, error));
	assert_false(touchstone_find_terms("binary64", "kahan", TOUCHSTONE_HALF_SPACE, NULL, 0, NULL, error));
}

/* The same by another way: bits of one answer from 2000 bits of MPFR, by the definition. */
static double slow_bits(const double *answer, const question number)
{
	enum { ENOUGH = 2000 };
	mpfr_t a, b, c, x, d;
	mpfr_inits2(ENOUGH, a, b, c, x, d, (mpfr_ptr)0);
	mpfr_set_d(c, -number[6], MPFR_RNDN);
	mpfr_mul_d(c, c, number[6], MPFR_RNDN);
	mpfr_set_zero(a, 1), mpfr_set_zero(b, 1);
	for (int axis = 0; axis < 3; axis++) {
		const double r = number[axis], v = number[3 + axis];
		mpfr_set_d(x, v, MPFR_RNDN), mpfr_mul_d(x, x, v, MPFR_RNDN), mpfr_add(a, a, x, MPFR_RNDN);
		mpfr_set_d(x, v, MPFR_RNDN), mpfr_mul_d(x, x, r, MPFR_RNDN), mpfr_add(b, b, x, MPFR_RNDN);
		mpfr_set_d(x, r, MPFR_RNDN), mpfr_mul_d(x, x, r, MPFR_RNDN), mpfr_add(c, c, x, MPFR_RNDN);
	}
	mpfr_sqr(d, b, MPFR_RNDN), mpfr_mul(x, a, c, MPFR_RNDN), mpfr_sub(d, d, x, MPFR_RNDN);
	mpfr_sqrt(d, d, MPFR_RNDN), mpfr_sub(d, d, b, MPFR_RNDN), mpfr_div(d, c, d, MPFR_RNDN); /* the exact time */
	mpfr_set_zero(x, 1);
	for (int term = 0; term < TOUCHSTONE_MOST_TERMS; term++) mpfr_add_d(x, x, answer[term], MPFR_RNDN);
	mpfr_max(a, x, d, MPFR_RNDN), mpfr_sub(x, x, d, MPFR_RNDN), mpfr_abs(x, x, MPFR_RNDN), mpfr_div(x, x, a, MPFR_RNDN);
	bool exact = mpfr_zero_p(x);
	mpfr_log2(x, x, MPFR_RNDN);
	double bits = exact ? INFINITY : fmax(0, -mpfr_get_d(x, MPFR_RNDN));
	mpfr_clears(a, b, c, x, d, (mpfr_ptr)0);
	return bits;
}

static void bits_are_those_of_the_definition(void **state)
{
	(void)state;
	struct oracle *oracle = oracle_create();
	struct finder_truth *truth = finder_truth_create(QUESTIONS, 400);
	struct finder_bits *bits = calloc(1, sizeof *bits);
	static double terms[QUESTIONS][TOUCHSTONE_MOST_TERMS];
	question number[QUESTIONS];
	assert_true(oracle && truth && bits);
	draw_questions("dense", number);
	for (int a = 0; a < ARITHMETICS; a++) {
		double least = INFINITY, before = -1;
		size_t found = 0;
		finder_bits_begin(bits);
		assert_true(isnan(finder_bits_of_share(bits, 0.5)));
		finder_truth_solve(truth, oracle, TOUCHSTONE_BALL_BALL, (void *)number, QUESTIONS);
		assert_true(finder_bits_add(bits, truth, oracle, arithmetics[a], "stable", error));
		touchstone_find_terms(arithmetics[a], "stable", TOUCHSTONE_BALL_BALL, (void *)number, QUESTIONS, terms, error);
		for (int k = 0; k < QUESTIONS; k++) {
			struct oracle_query query = {.shape = ORACLE_BALL_BALL};
			memcpy(query.number, number[k], sizeof query.number);
			if (oracle_solve(oracle, &query).event != ORACLE_LATER || terms[k][0] == INFINITY) continue;
			least = fmin(least, slow_bits(terms[k], number[k]));
			found++;
		}
		assert_int_equal(bits->found, found);
		assert_true(found > 10);
		if (!(fabs(bits->least - least) < 1e-6))
			fail_msg("%s: %.9g bits, not %.9g", arithmetics[a], bits->least, least);
		for (double share = 1; share > 0.05; share -= 0.1) { /* fewer answers, more bits */
			double now = finder_bits_of_share(bits, share);
			assert_true(now >= before && now >= least - 1e-6);
			before = now;
		}
		assert_true(fabs(finder_bits_of_share(bits, 1) - least) <= 1.0 / FINDER_BITS_STEP);
	}
	free(bits);
	finder_truth_destroy(truth);
	oracle_destroy(oracle);
}

/* Correct rounding in P bits is right to P bits, whatever the question. */
static void correct_rounding_has_all_its_bits(void **state)
{
	(void)state;
	static const struct {
		const char *arithmetic;
		int bits;
	} exact[] = {{"binary64", 53}, {"extended", 64}, {"binary128", 113}, {"mpfr:300", 300}};
	static const char *const families[] = {"grazing", "near-contact", "quadratics", "huge-times", "just-overlapping"};
	struct oracle *oracle = oracle_create();
	struct finder_truth *truth = finder_truth_create(QUESTIONS, 300);
	struct finder_bits *bits = calloc(1, sizeof *bits);
	question number[QUESTIONS];
	for (size_t e = 0; e < sizeof exact / sizeof *exact; e++) {
		if (!arithmetic_is_whole(exact[e].arithmetic)) continue;
		finder_bits_begin(bits);
		for (size_t f = 0; f < sizeof families / sizeof *families; f++) {
			draw_questions(families[f], number);
			finder_truth_solve(truth, oracle, TOUCHSTONE_BALL_BALL, (void *)number, QUESTIONS);
			assert_true(finder_bits_add(bits, truth, oracle, exact[e].arithmetic, "rounded", error));
		}
		print_message("rounded in %s: at least %.3f bits\n", exact[e].arithmetic, bits->least);
		assert_true(bits->least >= exact[e].bits && bits->least < exact[e].bits + 2);
	}
	free(bits);
	finder_truth_destroy(truth);
	oracle_destroy(oracle);
}

int main(void)
{
	print_message("seed %d\n", SEED);
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(unrounded_answers_round_to_the_answers),
		cmocka_unit_test(bits_are_those_of_the_definition),
		cmocka_unit_test(correct_rounding_has_all_its_bits),
	};
	return cmocka_run_group_tests(tests, NULL, NULL);
}
