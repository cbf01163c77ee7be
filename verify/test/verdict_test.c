/* What is said of a measure after some nights: whether it is worse, since when, by how much. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

#include "audit/verdict.h"

enum { NIGHTS = 60 };

static struct night nights[NIGHTS];

/* Audits 101, 102, ..., each with a seed of its own, all good. */
static void begin(void)
{
	for (int n = 0; n < NIGHTS; n++) nights[n] = (struct night){.audit = 101 + n, .seed = (uint64_t)n, .good = true};
}

static struct verdict judge(size_t count, enum measure_worse worse)
{
	struct verdict verdict = verdict_of(nights, count, worse), *one = &verdict;
	verdicts_judge(&one, 1, 1e-3);
	return verdict;
}

static struct measurement timing(double value)
{
	struct sample sample = {0};
	for (int k = -2; k <= 2; k++) sample_add(&sample, value * (1 + 0.01 * k));
	return measurement_sample(MEASURE_TIMING, &sample);
}

/* A slow night is no regression, four in a row are; and it was the first of them. */
static void timings_must_last(void **state)
{
	(void)state;
	begin();
	for (int n = 0; n < NIGHTS; n++) nights[n].measured = timing(100 + n * 7 % 10 + (n >= 50 ? 30 : 0));
	assert_false(judge(50, WORSE_MORE).worse);
	assert_false(judge(51, WORSE_MORE).worse);
	struct verdict verdict = judge(54, WORSE_MORE);
	assert_true(verdict.worse && verdict.nights == 4 && verdict.since == 151);
	char text[VERDICT_TEXT];
	verdict_change(&verdict, text);
	assert_true(verdict.now.value / verdict.before.value > 1.2 && verdict.now.value / verdict.before.value < 1.4);
	assert_non_null(strstr(text, "times what it was"));
	assert_false(judge(54, WORSE_LESS).worse);

	/* Found worse, those nights are no reference: the alarm lasts, and ends with what caused it. */
	nights[53].good = false;
	assert_true(judge(55, WORSE_MORE).worse);
	nights[54].good = false;
	nights[55].measured = timing(104);
	assert_false(judge(56, WORSE_MORE).worse);
}

static void counts_are_found_at_once(void **state)
{
	(void)state;
	begin();
	for (int n = 0; n < NIGHTS; n++) nights[n].measured = measurement_proportion(n < 40 ? 100 + (n & 7) : 170, 1000000);
	assert_false(judge(40, WORSE_MORE).worse);
	struct verdict verdict = judge(41, WORSE_MORE);
	assert_true(verdict.worse && verdict.since == 141 && verdict.nights == 1 && verdict.references == 40);
	assert_true(verdict.chance < 1e-6 && fabs(verdict.now.value - 1.7e-4) < 1e-12);
	assert_false(judge(41, WORSE_LESS).worse);
	assert_true(judge(41, WORSE_EITHER).worse);
	for (int n = 40; n < NIGHTS; n++) nights[n].good = false;
	verdict = judge(NIGHTS, WORSE_MORE);
	assert_true(verdict.worse && verdict.since == 141); /* weeks later */

	for (int n = 0; n < NIGHTS; n++) nights[n].measured = measurement_rate(n < 40 ? 7 : 40, 1000);
	verdict = judge(41, WORSE_MORE);
	assert_true(verdict.worse && verdict.since == 141);
}

/* A night too small a change to be seen shows when it has lasted. */
static void small_changes_add_up(void **state)
{
	(void)state;
	begin();
	for (int n = 0; n < NIGHTS; n++) {
		nights[n].measured = measurement_proportion(n < 50 ? 10000 : 10300, 1000000);
		if (n < 50) continue;
		struct verdict verdict = judge((size_t)n + 1, WORSE_EITHER);
		if (n == 50) assert_false(verdict.worse);
		if (n == 57) assert_true(verdict.worse && verdict.nights > 1 && verdict.since == 151);
	}
}

/* The same seed again is no new observation. */
static void repetitions_count_once(void **state)
{
	(void)state;
	begin();
	for (int n = 0; n < NIGHTS; n++) nights[n].seed = 1, nights[n].measured = measurement_proportion(100, 1000000);
	nights[59].measured = measurement_proportion(140, 1000000);
	struct verdict verdict = judge(NIGHTS, WORSE_MORE);
	assert_true(verdict.compared && verdict.references == 1 && !verdict.worse); /* 140 against 100, once */
	for (int n = 0; n < NIGHTS - 1; n++) nights[n].seed = 2 + (uint64_t)n;
	assert_true(judge(NIGHTS, WORSE_MORE).worse); /* 140 against 59 times 100 */
}

static void samples_are_ranked(void **state)
{
	(void)state;
	begin();
	for (int n = 0; n < 20; n++) {
		struct sample sample = {0};
		for (int k = 0; k < 6; k++) sample_add(&sample, (n == 19 ? 40 : 1) + (n * 6 + k) * 17 % 31);
		nights[n].measured = measurement_sample(MEASURE_SAMPLE, &sample);
	}
	assert_false(judge(19, WORSE_MORE).worse);
	struct verdict verdict = judge(20, WORSE_MORE);
	assert_true(verdict.worse && verdict.since == 120 && verdict.nights == 1);
}

static void words_are_equal_or_not(void **state)
{
	(void)state;
	begin();
	for (int n = 0; n < 10; n++) nights[n].seed = 1, nights[n].measured = measurement_word(n < 6 ? "f00d" : "beef");
	assert_false(judge(1, WORSE_EITHER).compared);
	assert_true(judge(6, WORSE_EITHER).compared && !judge(6, WORSE_EITHER).worse);
	struct verdict verdict = judge(7, WORSE_EITHER);
	char text[VERDICT_TEXT];
	assert_true(verdict.worse && verdict.since == 107);
	assert_string_equal(verdict_change(&verdict, text), "beef, not f00d");
	for (int n = 6; n < 9; n++) nights[n].good = false;
	assert_true(judge(10, WORSE_EITHER).worse && judge(10, WORSE_EITHER).since == 107);
	nights[6].seed = 2; /* nothing to hold it against */
	assert_false(judge(7, WORSE_EITHER).compared);
}

/* What has no earlier nights, and what is no number, is no regression. */
static void nothing_is_made_of_nothing(void **state)
{
	(void)state;
	begin();
	nights[0].measured = nights[1].measured = measurement_proportion(3, 0);
	assert_false(judge(1, WORSE_MORE).compared);
	assert_false(judge(2, WORSE_MORE).worse);
	struct sample none = {0};
	for (int n = 0; n < NIGHTS; n++) nights[n].measured = measurement_sample(MEASURE_TIMING, &none);
	assert_false(judge(NIGHTS, WORSE_MORE).worse);
	for (int n = 0; n < NIGHTS; n++) nights[n].good = n == NIGHTS - 1, nights[n].measured = timing(n);
	assert_false(judge(NIGHTS, WORSE_MORE).compared);
}

/* Holm: the smallest chance must pass by the number of tests, the next by one less. */
static void many_measures_share_the_false_alarms(void **state)
{
	(void)state;
	const double chances[] = {0.0004, 0.00024, 0.9, 0.00034}; /* at 0.001: bars 0.00025, 0.00033, 0.0005, 0.001 */
	struct verdict verdict[4], *all[4];
	for (int v = 0; v < 4; v++) {
		verdict[v] = (struct verdict){.compared = true, .chance = chances[v], .now = timing(1)};
		all[v] = &verdict[v];
	}
	verdicts_judge(all, 4, 1e-3);
	assert_true(verdict[1].worse && !verdict[0].worse && !verdict[2].worse && !verdict[3].worse);
	verdict[3].chance = 0.0003;
	verdicts_judge(all, 4, 1e-3);
	assert_true(verdict[1].worse && verdict[3].worse && verdict[0].worse && !verdict[2].worse);
}

int main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(timings_must_last),          cmocka_unit_test(counts_are_found_at_once),
		cmocka_unit_test(small_changes_add_up),       cmocka_unit_test(repetitions_count_once),
		cmocka_unit_test(samples_are_ranked),         cmocka_unit_test(words_are_equal_or_not),
		cmocka_unit_test(nothing_is_made_of_nothing), cmocka_unit_test(many_measures_share_the_false_alarms),
	};
	return cmocka_run_group_tests(tests, NULL, NULL);
}
