/* What the precision ladder tells, of counts drawn from rates that are known: binary64's own beside the lines. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <gsl/gsl_randist.h>
#include <gsl/gsl_rng.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "figure/ladder.h"

enum { SEED = 20140902, TRIALS = 100, GASES = LADDER_LANES - 1, DIRECT = LADDER_RUNGS - 1 };

static gsl_rng *dice;

static struct gas_tally *direct_tally(struct ladder *ladder, int lane)
{
	return &ladder->tally[lane * LADDER_RUNGS + DIRECT];
}

/* A tally of a point of which all is finished, with so many three-body events. */
static struct gas_tally tally_of(const struct gas_point *point, uint64_t count)
{
	return (struct gas_tally){
		.three_body = {.contacts = point->events,
					   .overlapping = point->events / 2,
					   .depth = ldexp((double)point->events, -point->bits),
					   .deepest = ldexp(10, -point->bits),
					   .events = count,
					   .encounters = count},
		.drift = 1e-9,
		.finished = point->events,
	};
}

/* The full ladder with counts drawn from rates that halve with each bit, but in binary64 itself, of inelastic gases,
 * from `inelastic` per event. */
static struct ladder *drawn(double inelastic)
{
	struct ladder *ladder = calloc(1, sizeof *ladder);
	assert_non_null(ladder);
	ladder_choose(ladder, true);
	for (int k = 0; k < LADDER_POINTS; k++) {
		const struct gas_point *point = &ladder->point[k];
		double rate = 4 * exp2(-ladder_bits(point));
		if (point->restitution < 1 && k % LADDER_RUNGS == DIRECT) rate = inelastic;
		ladder->tally[k] = tally_of(point, gsl_ran_poisson(dice, rate * (double)point->events));
	}
	return ladder;
}

static struct result *told(const struct ladder *ladder)
{
	struct result *result = result_new("ladder", "How many bits does it take?");
	assert_non_null(result);
	ladder_tell(result, ladder);
	return result;
}

/* The member of a result's list that has this title, or whatever `key` it goes by. */
static const json_t *find(const struct result *result, const char *list, const char *key, const char *name)
{
	size_t number;
	const json_t *one;
	json_array_foreach(json_object_get(result_document(result), list), number,
					   one) if (strcmp(json_string_value(json_object_get(one, key)), name) == 0) return one;
	fail_msg("no %s '%s'", list, name);
	return NULL;
}

/* The numbers in a cell's text, as many as there are up to three. */
static void numbers_of(const json_t *cell, double number[3])
{
	const char *text = json_string_value(cell);
	assert_non_null(text);
	for (int n = 0; n < 3; n++) {
		char *end;
		text += strcspn(text, "0123456789");
		number[n] = strtod(text, &end);
		text = end;
	}
}

static void assert_near(double shown, double value)
{
	if (fabs(shown - value) > 0.05 * value) fail_msg("%g is shown as %g", value, shown);
}

/* ------------------------------------------------------------------ sizes */

static void full_sizes_are_what_they_claim(void **state)
{
	(void)state;
	struct ladder quick, full;
	ladder_choose(&quick, false);
	ladder_choose(&full, true);
	for (int k = 0; k < LADDER_POINTS; k++) {
		const struct gas_point *point = &full.point[k];
		bool direct = k % LADDER_RUNGS == DIRECT && !ladder_late(k / LADDER_RUNGS);
		assert_true(point->events == 0 ? quick.point[k].events == 0 : point->events > quick.point[k].events);
		if (direct) assert_string_equal(point->arithmetic, "binary64");
		if (direct) assert_true(point->events >= (point->restitution < 1 ? 1000000000 : 100000000));
	}
}

/* ------------------------------------------------------------------ binary64 itself */

/* Each row has the count with its exact interval, and what line and paper let expect in as many events. */
static void direct_counts_stand_beside_what_is_expected(void **state)
{
	(void)state;
	for (int trial = 0; trial < TRIALS; trial++) {
		struct ladder *ladder = drawn(1e-10 * exp2(20 * gsl_rng_uniform(dice)));
		struct result *result = told(ladder);
		const json_t *rows = json_object_get(find(result, "tables", "title", "In binary64 itself"), "rows");
		assert_int_equal(json_array_size(rows), GASES);
		for (int lane = 0; lane < GASES; lane++) {
			const json_t *row = json_array_get(rows, (size_t)lane);
			const struct three_body *seen = &direct_tally(ladder, lane)->three_body;
			struct interval exact = interval_of_rate(seen->events, (double)seen->contacts), ignored;
			struct rate_fit fit = ladder_fit(ladder, lane, LADDER_EVENTS);
			double shown[3], reported = ladder_reported(ladder, lane);
			assert_int_equal(json_integer_value(json_array_get(row, 1)), seen->contacts);
			assert_int_equal(json_integer_value(json_array_get(row, 2)), seen->events);
			numbers_of(json_array_get(row, 3), shown);
			assert_near(shown[0], (double)seen->events / (double)seen->contacts);
			assert_near(shown[1], exact.low);
			assert_near(shown[2], exact.high);
			numbers_of(json_array_get(row, 5), shown);
			assert_near(shown[0], rate_fit_at(&fit, 53, &ignored) * (double)seen->contacts);
			if (isnan(reported)) {
				assert_string_equal(json_string_value(json_array_get(row, 7)), "-");
			} else {
				numbers_of(json_array_get(row, 7), shown);
				assert_near(shown[0], reported * (double)seen->contacts);
			}
		}
		result_free(result);
		free(ladder);
	}
}

/* A gas of which binary64 is not finished has no row, and without all of them there is no verdict. */
static void what_is_not_finished_is_left_out(void **state)
{
	(void)state;
	for (int lane = 0; lane < GASES; lane++) {
		struct ladder *ladder = drawn(0);
		bool inelastic = ladder->point[lane * LADDER_RUNGS].restitution < 1;
		*direct_tally(ladder, lane) = (struct gas_tally){0};
		struct result *result = told(ladder);
		const json_t *rows = json_object_get(find(result, "tables", "title", "In binary64 itself"), "rows");
		assert_int_equal(json_array_size(rows), GASES - 1);
		size_t claims = json_array_size(json_object_get(result_document(result), "claims"));
		assert_int_equal(claims, inelastic || lane == 0 ? 1 : 2);
		result_free(result);
		free(ladder);
	}
}

/* As frequent as the paper says, none in 10^9, and too few events to tell. */
static void verdicts_follow_the_counts(void **state)
{
	(void)state;
	static const char *const quantity = "three-body events per event in binary64, inelastic";
	static const struct {
		double rate, part; /* of the events finished */
		const char *verdict;
	} cases[] = {{1e-6, 1, "agrees"}, {0, 1, "differs"}, {3e-5, 1, "differs"}, {0, 1e-3, "not comparable"}};
	for (size_t c = 0; c < sizeof cases / sizeof *cases; c++) {
		struct ladder *ladder = drawn(cases[c].rate);
		for (int lane = 0; lane < GASES; lane++) {
			struct three_body *seen = &direct_tally(ladder, lane)->three_body;
			seen->contacts = (uint64_t)(cases[c].part * (double)seen->contacts);
		}
		struct result *result = told(ladder);
		const json_t *claim = find(result, "claims", "quantity", quantity);
		assert_string_equal(json_string_value(json_object_get(claim, "verdict")), cases[c].verdict);
		result_free(result);
		free(ladder);
	}
}

/* Where none was seen the figure has the upper end of the interval, and where some were, the rate. */
static void upper_ends_are_drawn_where_none_was_seen(void **state)
{
	(void)state;
	struct ladder *ladder = drawn(0);
	*direct_tally(ladder, 3) = tally_of(&ladder->point[3 * LADDER_RUNGS + DIRECT], 50);
	struct result *result = told(ladder);
	const json_t *figure = find(result, "figures", "name", "three-body"), *series, *row;
	size_t number, place, ends = 0;
	json_array_foreach(json_object_get(figure, "series"), number, series)
	{
		if (strncmp(json_string_value(json_object_get(series, "label")), "none seen", 9) != 0) continue;
		json_array_foreach(json_object_get(series, "rows"), place, row)
		{
			double high = json_number_value(json_array_get(row, 1));
			double events = ladder->point[(ends < 2 ? 0 : 2) * LADDER_RUNGS + DIRECT].restitution < 1 ? 1e9 : 1e8;
			assert_near(high, interval_of_rate(0, events).high);
			ends++;
		}
	}
	assert_int_equal(ends, GASES - 1);
	result_free(result);
	free(ladder);
}

int main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(full_sizes_are_what_they_claim),
		cmocka_unit_test(direct_counts_stand_beside_what_is_expected),
		cmocka_unit_test(what_is_not_finished_is_left_out),
		cmocka_unit_test(verdicts_follow_the_counts),
		cmocka_unit_test(upper_ends_are_drawn_where_none_was_seen),
	};
	dice = gsl_rng_alloc(gsl_rng_mt19937);
	gsl_rng_set(dice, SEED);
	printf("seed %d\n", SEED);
	int failed = cmocka_run_group_tests(tests, NULL, NULL);
	gsl_rng_free(dice);
	return failed;
}
