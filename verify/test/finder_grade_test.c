/* Grades of finders: right answers get no fault, planted faults are counted in their class, quantiles are exact. */
#include "measure/finder_grade.h"

#include "oracle_inputs.h"

enum { QUESTIONS = 20000 };

/* Questions of one shape with their exact answers, rounded to nearest. */
struct sheet {
	enum touchstone_shape shape;
	double number[QUESTIONS][TOUCHSTONE_MOST_NUMBERS], exact[QUESTIONS], answer[QUESTIONS];
	enum oracle_event event[QUESTIONS];
};
static struct sheet sheet;
static struct oracle *oracle;

static void fill_sheet(enum touchstone_shape shape)
{
	sheet.shape = shape;
	for (size_t k = 0; k < QUESTIONS;) {
		struct oracle_query query;
		families[below(FAMILIES)](&query);
		if ((int)query.shape != (int)shape) continue;
		struct oracle_time time = oracle_solve(oracle, &query);
		memcpy(sheet.number[k], query.number, sizeof sheet.number[k]);
		sheet.event[k] = time.event;
		sheet.answer[k] = sheet.exact[k] = oracle_round(oracle, &time, MPFR_RNDN);
		k++;
	}
}

static struct finder_grade grade_sheet(void)
{
	struct finder_grade grade = finder_grade_new(sheet.shape);
	assert_true(finder_grade_add(&grade, oracle, 0, (void *)sheet.number, sheet.answer, QUESTIONS, false));
	assert_int_equal(finder_grade_cases(&grade) + grade.count[FINDER_UNDEFINED], QUESTIONS);
	assert_int_equal(grade.ulp.count, grade.count[FINDER_FOUND]);
	return grade;
}

static void right_answers_have_no_fault(void **state)
{
	(void)state;
	for (int shape = 0; shape < TOUCHSTONE_SHAPES; shape++) {
		fill_sheet((enum touchstone_shape)shape);
		struct finder_grade grade = grade_sheet();
		for (int class = FINDER_MISSED; class < FINDER_CLASSES; class ++) {
			assert_int_equal(grade.count[class], 0);
			assert_false(grade.example[class].there);
		}
		assert_true(grade.count[FINDER_FOUND] > QUESTIONS / 10);
		assert_true(grade.count[FINDER_RIGHTLY_NEVER] > 0);
		assert_true(finder_quantile(&grade.ulp, 1) <= 0.5);
		assert_true(finder_quantile(&grade.ulp, 1) == grade.worst_ulp);
		finder_grade_free(&grade);
	}
}

/* Flights whose times are doubles: nothing is left to be off by. */
static void exact_answers_are_all_zeros(void **state)
{
	(void)state;
	struct finder_grade grade = finder_grade_new(TOUCHSTONE_BALL_BALL);
	for (int k = 0; k < 2000; k++) {
		double time = 1 + below(1000), contact = 1 + below(100), speed = 1 + below(50);
		double number[1][TOUCHSTONE_MOST_NUMBERS] = {{contact + speed * time, 0, 0, -speed, 0, 0, contact}};
		assert_true(finder_grade_add(&grade, oracle, (uint64_t)k, (void *)number, &time, 1, false));
	}
	assert_int_equal(grade.count[FINDER_FOUND], 2000);
	assert_int_equal(grade.gap.count, 2000);
	assert_true(finder_quantile(&grade.ulp, 1) == 0 && finder_quantile(&grade.gap, 1) == 0);
	assert_false(grade.example[FINDER_FOUND].there);
	finder_grade_free(&grade);
}

/* Spoils the answer to a question in a random way, and says in which class it now belongs. */
static enum finder_class spoil(size_t k)
{
	bool never = sheet.event[k] == ORACLE_NEVER;
	switch (below(12)) {
	case 0:
		sheet.answer[k] = NAN;
		return FINDER_NAN;
	case 1:
		sheet.answer[k] = below(2) ? -uniform(1e-300, 1) : -INFINITY;
		return FINDER_NEGATIVE;
	case 2:
		sheet.answer[k] = never ? uniform(0, 1) : INFINITY;
		return never ? FINDER_PHANTOM : sheet.exact[k] == INFINITY ? FINDER_FOUND : FINDER_MISSED;
	case 3:
		sheet.number[k][below(2)] = below(2) ? NAN : INFINITY;
		return FINDER_UNDEFINED;
	case 4:
		if (sheet.answer[k] == 0) sheet.answer[k] = -0.0;
		break;
	default:
		break;
	}
	return never ? FINDER_RIGHTLY_NEVER : FINDER_FOUND;
}

static void planted_faults_are_counted_in_their_class(void **state)
{
	(void)state;
	for (int shape = 0; shape < TOUCHSTONE_SHAPES; shape++) {
		uint64_t expected[FINDER_CLASSES] = {0}, first[FINDER_CLASSES] = {0};
		fill_sheet((enum touchstone_shape)shape);
		for (size_t k = 0; k < QUESTIONS; k++) {
			enum finder_class class = spoil(k);
			if (expected[class]++ == 0) first[class] = k;
		}
		struct finder_grade grade = grade_sheet();
		for (int class = 0; class < FINDER_CLASSES; class ++) {
			assert_int_equal(grade.count[class], expected[class]);
			const struct finder_example *example = &grade.example[class];
			if (class == FINDER_FOUND) continue;
			assert_true(example->there == (expected[class] > 0));
			if (!example->there) continue;
			assert_true(example->question == first[class]);
			assert_memory_equal(example->number, sheet.number[first[class]], sizeof example->number);
			assert_true(same_double(example->answer, sheet.answer[first[class]]));
		}
		finder_grade_free(&grade);
	}
}

/* Off by whole ulps, once by more than elsewhere. */
static void the_worst_error_is_found_with_its_question(void **state)
{
	(void)state;
	fill_sheet(TOUCHSTONE_HALF_SPACE);
	size_t worst = QUESTIONS;
	for (size_t k = 0; k < QUESTIONS; k++) {
		bool ordinary = sheet.event[k] == ORACLE_LATER && sheet.exact[k] > 1e-300 && sheet.exact[k] < 1e300;
		if (ordinary) sheet.answer[k] = steps_away(sheet.exact[k], below(9) - 4);
		if (ordinary && (worst == QUESTIONS || below(50) == 0)) worst = k;
	}
	sheet.answer[worst] = steps_away(sheet.exact[worst], 12);
	struct finder_grade grade = grade_sheet();
	assert_true(grade.worst_ulp >= 11.5 && grade.worst_ulp <= 24.5); /* steps above a power of two are two ulp below */
	assert_int_equal(grade.example[FINDER_FOUND].question, worst);
	finder_grade_free(&grade);
}

static int ascending(const void *one, const void *other)
{
	double x = *(const double *)one, y = *(const double *)other;
	return (x > y) - (x < y);
}

static void quantiles_match_sorting(void **state)
{
	(void)state;
	static const double shares[] = {0, 0.001, 0.25, 0.5, 0.9, 0.999, 1};
	static double sorted[3000], shuffled[3000];
	for (int round = 0; round < 300; round++) {
		size_t count = (size_t)below(round < 100 ? 12 : 3000) + 1;
		for (size_t i = 0; i < count; i++)
			sorted[i] = shuffled[i] = below(4) == 0 ? below(3) : below(50) == 0 ? INFINITY : uniform(0, 1);
		qsort(sorted, count, sizeof *sorted, ascending);
		struct finder_values values = {shuffled, count, count};
		for (size_t s = 0; s < sizeof shares / sizeof *shares; s++) {
			double found = finder_quantile(&values, shares[s]);
			size_t not_above = 0, below_it = 0;
			for (size_t i = 0; i < count; i++) not_above += sorted[i] <= found, below_it += sorted[i] < found;
			assert_true((double)not_above >= shares[s] * (double)count);
			assert_true(below_it == 0 || (double)below_it < shares[s] * (double)count);
		}
		assert_true(finder_quantile(&values, 1) == sorted[count - 1]);
		assert_true(finder_quantile(&values, 0.5) == sorted[(count - 1) / 2]);
	}
	assert_true(isnan(finder_quantile(&(struct finder_values){0}, 0.5)));
}

/* However the questions are dealt out to threads, the grade is one and the same. */
static void parts_make_the_whole_in_any_order(void **state)
{
	(void)state;
	fill_sheet(TOUCHSTONE_BALL_PLANE);
	for (size_t k = 0; k < QUESTIONS; k++) {
		if (below(3) == 0) sheet.answer[k] = steps_away(sheet.answer[k], below(3));
		spoil(k);
	}
	struct finder_grade whole = grade_sheet(), backwards = finder_grade_new(sheet.shape);
	for (size_t end = QUESTIONS; end > 0;) {
		size_t count = (size_t)below(3000) + 1, first = end > count ? end - count : 0;
		struct finder_grade part = finder_grade_new(sheet.shape);
		assert_true(finder_grade_add(&part, oracle, first, (void *)(sheet.number + first), sheet.answer + first,
									 end - first, false));
		assert_true(finder_grade_merge(&backwards, &part));
		finder_grade_free(&part);
		end = first;
	}
	assert_memory_equal(whole.count, backwards.count, sizeof whole.count);
	for (int class = 0; class < FINDER_CLASSES; class ++)
		assert_int_equal(whole.example[class].question, backwards.example[class].question);
	for (double share = 0; share <= 1; share += 1.0 / 64) {
		assert_true(finder_quantile(&whole.ulp, share) == finder_quantile(&backwards.ulp, share));
		double gap = finder_quantile(&whole.gap, share);
		assert_true(gap == finder_quantile(&backwards.gap, share));
	}
	finder_grade_free(&whole);
	finder_grade_free(&backwards);
}

/* Threefold numbers tie exactly; answers that differ by a step do not. */
static void broken_ties_and_orders_are_counted(void **state)
{
	(void)state;
	uint64_t broken = 0, pairs = 0;
	fill_sheet(TOUCHSTONE_HALF_SPACE);
	for (size_t k = 0; k + 1 < QUESTIONS; k += 2) {
		for (int i = 0; i < TOUCHSTONE_MOST_NUMBERS; i++) {
			sheet.number[k][i] = i == 0 ? below(4) : -1 - below(3);
			sheet.number[k + 1][i] = 3 * sheet.number[k][i];
		}
		bool later = below(4) == 0; /* and some are no tie at all: the second takes longer */
		if (later) sheet.number[k + 1][0] += 1;
		sheet.answer[k] = sheet.number[k][0] / -sheet.number[k][1];
		sheet.answer[k + 1] = sheet.number[k + 1][0] / -sheet.number[k + 1][1];
		pairs++;
		int fault = below(4);
		if (fault == 0) sheet.answer[k] = steps_away(sheet.answer[k + 1], 1);
		if (fault == 1) sheet.answer[k + 1] = NAN;
		if (fault == 2 && !later) sheet.answer[k] = sheet.answer[k + 1] = 7; /* wrong, but tied */
		broken += fault <= 1;
	}
	struct finder_grade grade = finder_grade_new(sheet.shape);
	assert_true(finder_grade_add(&grade, oracle, 0, (void *)sheet.number, sheet.answer, QUESTIONS, true));
	assert_int_equal(grade.pairs, pairs);
	assert_int_equal(grade.misordered, broken);
	finder_grade_free(&grade);
}

/* What is promised is held against each answer it is about, and against no other. */
static void broken_claims_are_counted(void **state)
{
	(void)state;
	const double head_on[TOUCHSTONE_MOST_NUMBERS] = {3, 0, 0, -1, 0, 0, 1};         /* at 2; D = b^2 / 9 */
	const double far_off[TOUCHSTONE_MOST_NUMBERS] = {0x1p70, 0, 0, -1, 0, 0, 1};    /* beyond the claim */
	const double fine[TOUCHSTONE_MOST_NUMBERS] = {3, 0x1.00001p-3, 0, -1, 0, 0, 1}; /* 21 bits are not enough for it */
	const double near_miss[TOUCHSTONE_MOST_NUMBERS] = {3, 1, 0, -1, 0, 0, 1};       /* D = 0 */
	const double long_wait[TOUCHSTONE_MOST_NUMBERS] = {0x1p70, 0, 0, -0x1p-70, 0, 0, 1}; /* 2^140, less 1 in 2^70 */
	const struct touchstone_claim boundless = {0, INFINITY, 0, 0.5, true, true, true, true};
	const struct touchstone_claim modest = {0x1p-60, 0x1p60, 1, 2, false, false, false, false};
	const struct touchstone_claim nothing = {0x1p-60, 0x1p60, 0, INFINITY, false, false, false, false};
	const struct touchstone_claim bold = {0x1p-60, 0x1p60, 0, 2, true, true, true, true};
	const struct touchstone_claim all_but_close = {0x1p-60, 0x1p60, 40, 2, true, true, true, true};
	const struct {
		const struct touchstone_claim *claim;
		const char *arithmetic;
		int bits;
		const double *number;
		double answer;
		bool broken;
	} cases[] = {
		{&bold, "binary64", 53, head_on, 2, false},
		{&bold, "binary64", 53, head_on, 2 + 0x1p-50, false},
		{&bold, "binary64", 53, head_on, 2 + 0x1.8p-50, true},
		{&bold, "binary32", 24, head_on, 2 + 0x1.8p-50, false},
		{&bold, "binary32", 24, head_on, 2 + 0x1p-21, false},
		{&bold, "binary32", 24, head_on, 2 + 0x1.1p-21, true},
		{&bold, "binary128", 113, head_on, 2 + 0x1.8p-50, true},
		{&bold, "binary64", 53, head_on, INFINITY, true},
		{&bold, "binary64", 53, head_on, -1, true},
		{&bold, "binary64", 53, head_on, NAN, true},
		{&nothing, "binary64", 53, head_on, 7, false},
		{&nothing, "binary64", 53, head_on, INFINITY, false},
		{&nothing, "binary64", 53, head_on, -1, false},
		{&nothing, "binary64", 53, head_on, NAN, false},
		{&modest, "binary64", 53, head_on, 7, false}, /* D is no more than half of b^2 */
		{&all_but_close, "binary64", 53, head_on, 7, true},
		{&all_but_close, "binary64", 53, near_miss, 3, false},
		{&all_but_close, "binary64", 53, near_miss, NAN, true},
		{&bold, "binary64", 53, near_miss, 3, true},
		{&bold, "binary64", 53, near_miss, INFINITY, false},
		{&boundless, "binary64", 53, long_wait, INFINITY, true},
		{&boundless, "binary32", 24, long_wait, INFINITY, false}, /* it has no such number */
		{&boundless, "binary32", 24, long_wait, NAN, true},
		{&boundless, "binary32", 24, head_on, INFINITY, true},
		{&bold, "binary64", 53, far_off, 1, false},
		{&bold, "binary64", 53, far_off, NAN, false},
		{&bold, "binary64", 53, fine, NAN, true},
		{&bold, "mpfr:21", 21, fine, NAN, true},
		{&bold, "mpfr:20", 20, fine, NAN, false},
	};
	for (size_t c = 0; c < sizeof cases / sizeof *cases; c++) {
		const struct finder_claim claim = {*cases[c].claim, cases[c].arithmetic, cases[c].bits};
		struct finder_grade grade = finder_grade_new(TOUCHSTONE_BALL_BALL);
		grade.claim = &claim;
		assert_true(finder_grade_add(&grade, oracle, 41, (void *)cases[c].number, &cases[c].answer, 1, false));
		if (grade.broken != cases[c].broken || grade.breach.there != cases[c].broken)
			fail_msg("case %zu: broken %d, not %d", c, (int)grade.broken, (int)cases[c].broken);
		if (grade.breach.there) assert_int_equal(grade.breach.question, 41);
		finder_grade_free(&grade);
	}
	char words[200];
	finder_claim_words(&(struct finder_claim){all_but_close, "binary64", 53}, words);
	assert_string_equal(words,
						"at most 2 ulp, no miss, no phantom, nothing negative, no NaN, where |D| > 2^-40 b^2, for "
						"numbers from 8.67e-19 to 1.15e+18");
}

static struct finder_grade grade_one(enum touchstone_shape shape, const double number[TOUCHSTONE_MOST_NUMBERS],
									 double answer)
{
	double numbers[1][TOUCHSTONE_MOST_NUMBERS];
	memcpy(numbers[0], number, sizeof numbers[0]);
	struct finder_grade grade = finder_grade_new(shape);
	assert_true(finder_grade_add(&grade, oracle, 0, (void *)numbers, &answer, 1, false));
	return grade;
}

static void gaps_are_those_of_contacts(void **state)
{
	(void)state;
	static const struct {
		enum touchstone_shape shape;
		double number[TOUCHSTONE_MOST_NUMBERS], answer;
		double gap; /* NaN: there is none to speak of */
	} cases[] = {
		{TOUCHSTONE_BALL_BALL, {3, 0, 0, -1, 0, 0, 1}, 2, 0},
		{TOUCHSTONE_BALL_BALL, {3, 0, 0, -1, 0, 0, 1}, 1.75, 0.25},
		{TOUCHSTONE_BALL_BALL, {3, 0, 0, -1, 0, 0, 1}, 2.125, 0.125},
		{TOUCHSTONE_BALL_BALL, {0.5, 0, 0, -1, 0, 0, 1}, 0, NAN},      /* overlapped: ends now, at no contact */
		{TOUCHSTONE_BALL_BALL, {3, 0, 0, -1, 0, 0, 1}, INFINITY, NAN}, /* missed */
		{TOUCHSTONE_BALL_LEAVE, {0, 0, 0, 1, 0, 0, 2}, 2.5, 0.5},
		{TOUCHSTONE_BALL_LEAVE, {5, 3, 0, -2, 0, 0, 1}, 2.5, NAN}, /* never inside: the closest approach */
		{TOUCHSTONE_BALL_PLANE, {2, 0, -1, 0}, 1, 1.5},
		{TOUCHSTONE_BALL_PLANE, {-1, 1, -1, 0}, 1, NAN}, /* overlapped: the peak */
		{TOUCHSTONE_HALF_SPACE, {1, -1}, 0.5, 0.5},
	};
	for (size_t c = 0; c < sizeof cases / sizeof *cases; c++) {
		struct finder_grade grade = grade_one(cases[c].shape, cases[c].number, cases[c].answer);
		double gap = finder_quantile(&grade.gap, 1);
		if (gap != cases[c].gap && !(isnan(gap) && isnan(cases[c].gap)))
			fail_msg("case %zu: gap %g, not %g", c, gap, cases[c].gap);
		finder_grade_free(&grade);
	}
}

static int begin(void **state)
{
	(void)state;
	oracle = oracle_create();
	return oracle ? 0 : -1;
}

static int end(void **state)
{
	(void)state;
	oracle_destroy(oracle);
	return 0;
}

int main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(right_answers_have_no_fault),
		cmocka_unit_test(exact_answers_are_all_zeros),
		cmocka_unit_test(planted_faults_are_counted_in_their_class),
		cmocka_unit_test(the_worst_error_is_found_with_its_question),
		cmocka_unit_test(quantiles_match_sorting),
		cmocka_unit_test(parts_make_the_whole_in_any_order),
		cmocka_unit_test(broken_ties_and_orders_are_counted),
		cmocka_unit_test(broken_claims_are_counted),
		cmocka_unit_test(gaps_are_those_of_contacts),
	};
	seed_inputs();
	int failed = cmocka_run_group_tests(tests, begin, end);
	mpfr_free_cache();
	return failed;
}
