/* Suites: those that come with the program load; whatever is wrong with one is said on one line, with its place; and
 * thresholds are kept or not. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "audit/audit.h"
#include "scene/random.h"
#include "test/folder.h"

enum { SEED = 20261122 };

static char *folder, path[200], error[STORE_ERROR];

static void suites_of_the_house_load(void **state)
{
	(void)state;
	static const char *const names[] = {"cases/suites/standard.yaml", "cases/suites/thorough.yaml"};
	for (int n = 0; n < 2; n++) {
		struct suite *suite = suite_open(names[n], "cases", error);
		if (!suite) fail_msg("%s", error);
		assert_true(suite->check_count > 10 && suite->false_alarms == 1e-3);
		unsigned kinds = 0;
		for (size_t c = 0; c < suite->check_count; c++) {
			kinds |= 1u << suite->checks[c].kind;
			assert_true(c == 0 || suite->checks[c].weight <= suite->checks[c - 1].weight);
			assert_true(suite->checks[c].measure_count > 0);
		}
		assert_int_equal(kinds, 7);
		suite_close(suite);
	}
}

/* A text of which one line may be another. */
static const char *const lines[] = {
	"title: Small",
	"checks:",
	"  - name: ball",
	"    weight: 2",
	"    scene: cradle",
	"    events: 20",
	"    seeds: 2",
	"    measures:",
	"      - {measure: digest, same_in: \"mpfr:53\"}",
	"  - name: grade",
	"    grade: stable",
	"    family: dense",
	"    cases: 1000",
	"    measures: [{measure: missed, at_most: 0}]",
	"  - name: halts",
	"    figure: fig7",
	"    measures: [{measure: proportion, claim: naive ball}]",
};
enum { LINES = sizeof lines / sizeof *lines };

static struct suite *open_with(int line, const char *other)
{
	char text[2000] = "";
	for (int l = 0; l < LINES; l++) strcat(strcat(text, l + 1 == line ? other : lines[l]), "\n");
	folder_put(folder, "suite.yaml", text);
	return suite_open(path, "cases", error);
}

static void what_is_wrong_is_said_with_its_place(void **state)
{
	(void)state;
	static const struct {
		int line, blamed;
		const char *other, *words;
	} faults[] = {
		{3, 3, "  - name: A ball", "checks[0].name: 'A ball'; accepted: letters"},
		{3, 4, "  - weight: 3", "given twice"},
		{4, 4, "    weight: heavy", "checks[0].weight: 'heavy'; accepted: a number, 0 to 1e+09"},
		{4, 4, "    wieght: 2", "unknown key 'wieght'; accepted: name, weight"},
		{4, 4, "    family: dense", "means nothing beside `scene`"},
		{5, 5, "    scene: cradel", "'cradel' is no file, nor a case"},
		{5, 3, "    seed: 3", "accepted: one of scene, grade and figure"},
		{6, 5, "    events: -1", "checks[0].scene: --set events=-1: events: '-1'; accepted: "},
		{6, 5, "    method: fast", "checks[0].scene: --set method=fast"},
		{7, 7, "    seeds: 65", "'65'; accepted: a whole number, 1 to 64"},
		{9, 9, "      - {measure: digset}", "measures[0].measure: 'digset'; accepted: digest, verdict, below_contact"},
		{9, 9, "      - {measure: digest, at_most: 3}", "digest is a word; accepted: equal"},
		{9, 9, "      - {measure: digest, same_in: mpfr}", "measures[0].same_in: --set arithmetic=mpfr"},
		{9, 9, "      - {measure: energy_drift, same_in: binary64}", "for a digest"},
		{9, 9, "      - {measure: energy_drift, equal: 3}", "energy_drift is a number; accepted: at_most"},
		{9, 9, "      - {measure: energy_drift, worse: bigger}", "'bigger' is unknown; accepted: more, less, either"},
		{9, 9, "      - {measure: energy_drift, claim: x}", "means nothing here"},
		{10, 10, "  - name: ball", "'ball' is another check's"},
		{11, 11, "    grade: guarded-not", "checks[1].grade: "},
		{12, 12, "    family: dence", "'dence'; accepted: one that `touchstone list families` has"},
		{12, 10, "    weight: 1", "checks[1].family: missing"},
		{13, 13, "    cases: 10", "'10'; accepted: a whole number, 100 to"},
		{14, 14, "    measures: []", "0 entries; accepted: 1 to 100"},
		{14, 14, "    measures: [{measure: missed}, {measure: missed}]", "measured already"},
		{14, 14, "    measures: [{measure: missed, at_most: none}]", "'none'; accepted: a number"},
		{16, 16, "    figure: fig99", "'fig99'; accepted: one that `touchstone list figures` has"},
		{13, 13, "    size: full", "means nothing beside `grade`"},
		{16, 17, "    figure: fig7\n    size: huge", "'huge'; accepted: quick, full"},
		{17, 17, "    measures: [{measure: proportion}]", "claim: missing; accepted: words of a claim"},
		{1, 1, "false_alarms: 0.5", "accepted: a number, 1e-09 to 0.1"},
		{14, 14, "    measures: 3", "one value; accepted: a list"},
	};
	struct suite *suite = open_with(0, "");
	if (!suite) fail_msg("%s", error);
	assert_true(suite->check_count == 3 && strcmp(suite->checks[0].name, "ball") == 0);
	assert_non_null(strstr(suite->checks[0].definition, "scene cradle events=20, 2 seeds"));
	suite_close(suite);
	for (size_t f = 0; f < sizeof faults / sizeof *faults; f++) {
		char place[240];
		snprintf(place, sizeof place, "%s:%d: ", path, faults[f].blamed);
		suite = open_with(faults[f].line, faults[f].other);
		if (suite) fail_msg("taken: %s", faults[f].other);
		if (!strstr(error, faults[f].words) || strchr(error, '\n') || strncmp(error, place, strlen(place)) != 0)
			fail_msg("'%s': not %s... %s: %s", faults[f].other, place, faults[f].words, error);
	}
}

/* Whatever the bytes: a suite, or a message of one line. */
static void damaged_suites_are_refused(void **state)
{
	(void)state;
	enum { DAMAGED = 500 };
	print_message("seed %d\n", SEED);
	struct random_state random = random_seed(SEED);
	unsigned refused = 0;
	for (int d = 0; d < DAMAGED; d++) {
		char text[2000] = "";
		for (int l = 0; l < LINES; l++) strcat(strcat(text, lines[l]), "\n");
		for (int flips = 0; flips < 3; flips++)
			text[random_below(&random, strlen(text))] = " \n:-[]{}'\"#ab09"[random_below(&random, 15)];
		folder_put(folder, "suite.yaml", text);
		struct suite *suite = suite_open(path, "cases", error);
		refused += !suite;
		assert_true(suite || (*error && !strchr(error, '\n')));
		suite_close(suite);
	}
	assert_true(refused > DAMAGED / 4);
}

static const char *judge(const struct suite_measure *asked, struct measurement measured, const char *other,
						 const struct night *nights, size_t count)
{
	static char fault[AUDIT_TEXT];
	struct check_value value = {.measured = measured};
	snprintf(value.other, sizeof value.other, "%s", other);
	threshold_judge(asked, &value, nights, count, fault);
	return fault;
}

static void thresholds_are_kept_or_not(void **state)
{
	(void)state;
	struct suite_measure none = {.at_most = NAN, .at_least = NAN, .at_most_times = NAN, .at_least_times = NAN};
	struct suite_measure asked = none;
	struct measurement seven = measurement_proportion(7, 100);
	assert_string_equal(judge(&asked, seven, "", NULL, 0), "");
	assert_false(threshold_asks(&none));
	asked.at_most = 0.07, asked.at_least = 0.07;
	assert_true(threshold_asks(&asked));
	assert_string_equal(judge(&asked, seven, "", NULL, 0), "");
	assert_string_equal(judge(&asked, measurement_proportion(8, 100), "", NULL, 0),
						"0.08, where at most 0.07 is asked for");
	assert_string_equal(judge(&asked, measurement_proportion(6, 100), "", NULL, 0),
						"0.06, where at least 0.07 is asked for");
	assert_true(*judge(&asked, measurement_proportion(0, 0), "", NULL, 0)); /* no value keeps no limit */

	/* The last ten good nights: 0.1 each, but 0.9 before them, and one bad one. */
	struct night nights[20];
	for (int n = 0; n < 20; n++)
		nights[n] = (struct night){n, 1, n != 15, measurement_proportion(n < 9 || n == 15 ? 90 : 10, 100)};
	asked = none, asked.at_most_times = 1.5, asked.at_least_times = 0.5;
	assert_false(threshold_asks(&asked)); /* nothing, where no night was before */
	assert_string_equal(judge(&asked, measurement_proportion(15, 100), "", nights, 20), "");
	assert_string_equal(judge(&asked, measurement_proportion(16, 100), "", nights, 20),
						"0.16, where at most 1.5 times 0.1 is asked for, the median of 10 good nights");
	assert_true(*judge(&asked, measurement_proportion(4, 100), "", nights, 20));
	assert_string_equal(judge(&asked, measurement_proportion(99, 100), "", nights, 0), ""); /* no night yet */

	asked = none, asked.equal = "done";
	assert_true(threshold_asks(&asked));
	assert_string_equal(judge(&asked, measurement_word("done"), "", NULL, 0), "");
	assert_string_equal(judge(&asked, measurement_word("halted"), "", NULL, 0), "halted, where done is asked for");
	asked = none, asked.same_in = "mpfr:53";
	assert_true(threshold_asks(&asked));
	assert_string_equal(judge(&asked, measurement_word("f00d"), "f00d", NULL, 0), "");
	assert_string_equal(judge(&asked, measurement_word("f00d"), "beef", NULL, 0), "f00d, but beef in mpfr:53");
}

static int set_up(void **state)
{
	(void)state;
	folder = folder_new();
	snprintf(path, sizeof path, "%s/suite.yaml", folder);
	return 0;
}

static int tear_down(void **state)
{
	(void)state;
	folder_remove(folder);
	return 0;
}

int main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(suites_of_the_house_load),
		cmocka_unit_test(what_is_wrong_is_said_with_its_place),
		cmocka_unit_test(damaged_suites_are_refused),
		cmocka_unit_test(thresholds_are_kept_or_not),
	};
	return cmocka_run_group_tests(tests, set_up, tear_down);
}
