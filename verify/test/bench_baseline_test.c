/* What the benchmark makes of its numbers: the stored run they are held against, tables, the result for the report. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "bench/bench_result.h"
#include "bench/table.h"
#include "provenance.h"
#include "scene/random.h"
#include "test/folder.h"

enum { SEED = 20221104 };

static char error[REPORT_ERROR];

/* ------------------------------------------------------------------ the stored run */

static struct row *random_rows(struct random_state *random, size_t count)
{
	struct row *rows = calloc(count, sizeof *rows);
	for (size_t r = 0; r < count; r++) {
		snprintf(rows[r].name, ROW_NAME, "row %zu \"of\" many", r);
		for (int q = 0; q < QUANTITIES; q++) {
			double part[3] = {exp(20 * random_normal(random)), 1 - random_uniform(random), 1 + random_uniform(random)};
			bool there = random_below(random, 3) > 0;
			rows[r].value[q] =
				there ? (struct spread){part[0], part[0] * part[1], part[0] * part[2]} : spread_exact(NAN);
		}
	}
	return rows;
}

/* A document with what a baseline keeps of one. */
static json_t *document_of(json_t *machine)
{
	return json_pack("{s: o, s: s, s: s, s: s, s: s}", "machine", machine, "date", "2024-05-01T12:00:00Z", "revision",
					 "39dc0da", "command", "make bench", "title", "not kept");
}

static char *path_in(const char *folder, const char *name)
{
	char *path;
	assert_true(asprintf(&path, "%s/%s", folder, name) > 0);
	return path;
}

static void every_number_comes_back(void **state)
{
	(void)state;
	print_message("seed %d\n", SEED);
	enum { COUNT = 40 };
	struct random_state random = random_seed(SEED);
	struct row *rows = random_rows(&random, COUNT);
	char *folder = folder_new(), *path = path_in(folder, "new/base.json"), made[100];
	json_t *machine = provenance(), *document = document_of(json_incref(machine));
	struct baseline *baseline;
	assert_int_equal(baseline_read(path, machine, &baseline, error), BASELINE_ABSENT);
	assert_null(baseline);
	if (!baseline_write(path, document, rows, COUNT, error)) fail_msg("%s", error);
	if (baseline_read(path, machine, &baseline, error) != BASELINE_SOUND) fail_msg("%s", error);
	for (int r = 0; r < COUNT; r++)
		for (enum quantity q = 0; q < QUANTITIES; q++) {
			struct spread sent = rows[r].value[q], back = baseline_value(baseline, rows[r].name, q);
			assert_true(isnan(sent.median) ? isnan(back.median) : memcmp(&sent, &back, sizeof sent) == 0);
			double ratio = baseline_ratio(baseline, &rows[r], q);
			assert_true(isnan(sent.median) ? isnan(ratio) : ratio == 1);
		}
	assert_true(isnan(baseline_value(baseline, "another row", NANOSECONDS).median));
	assert_true(isnan(baseline_ratio(NULL, &rows[0], NANOSECONDS)));
	assert_string_equal(baseline_made(baseline, made), "2024-05-01T12:00:00Z, revision 39dc0da, make bench");
	baseline_free(baseline);
	json_decref(document);
	json_decref(machine);
	free(rows);
	free(path);
	folder_remove(folder);
}

static void expect_damaged(const char *text, const char *part)
{
	char *folder = folder_new(), *path = path_in(folder, "b.json");
	json_t *machine = provenance();
	struct baseline *baseline;
	folder_put(folder, "b.json", text);
	enum baseline_state found = baseline_read(path, machine, &baseline, error);
	if (found != BASELINE_DAMAGED || baseline || !strstr(error, part) || !strstr(error, "b.json") ||
		strchr(error, '\n'))
		fail_msg("state %d, expected '%s', got '%s'", found, part, error);
	json_decref(machine);
	free(path);
	folder_remove(folder);
}

static void damaged_baselines_are_refused(void **state)
{
	(void)state;
	static const char head[] = "{\"schema\": \"touchstone-bench-1\", \"machine\": {}, \"rows\": ";
	struct random_state random = random_seed(SEED);
	struct row *rows = random_rows(&random, 3);
	char *folder = folder_new(), *path = path_in(folder, "whole.json"), text[300];
	json_t *document = document_of(provenance());
	assert_true(baseline_write(path, document, rows, 3, error));
	char *whole = folder_text(folder, "whole.json");
	for (size_t length = strlen(whole) - 2; length > 0; length -= length > 50 ? length / 31 : 1) {
		whole[length] = '\0';
		expect_damaged(whole, "b.json:");
	}
	expect_damaged("", "damaged baseline");
	expect_damaged("{\"schema\": \"touchstone-bench-1\",\n\"rows\": ]", "b.json:2: damaged baseline");
	expect_damaged("[]", "the schema is not 'touchstone-bench-1'");
	expect_damaged("{\"schema\": \"touchstone-result-1\"}", "the schema is not 'touchstone-bench-1'");
	expect_damaged("{\"schema\": \"touchstone-bench-1\"}", "it names no machine");
	static const char *const faults[][2] = {
		{"{}", "rows is not a list"},
		{"[{}]", "rows[0] has no name"},
		{"[{\"name\": 3}]", "rows[0] has no name"},
		{"[{\"name\": \"a\"}, {\"name\": \"b\", \"seconds\": 3}]", "rows[1]: seconds is not three positive numbers"},
		{"[{\"name\": \"a\", \"seconds\": [1, 1]}]", "rows[0]: seconds is not three"},
		{"[{\"name\": \"a\", \"seconds\": [1, null, 1]}]", "rows[0]: seconds is not three"},
		{"[{\"name\": \"a\", \"seconds\": [0, 0, 0]}]", "rows[0]: seconds is not three"},
		{"[{\"name\": \"a\", \"seconds\": [1, 1, \"inf\"]}]", "rows[0]: seconds is not three"},
		{"[{\"name\": \"a\", \"bytes_per_particle\": [1, 2, 3]}]", "rows[0]: bytes_per_particle is not three"},
	};
	for (size_t f = 0; f < sizeof faults / sizeof *faults; f++) {
		snprintf(text, sizeof text, "%s%s}", head, faults[f][0]);
		expect_damaged(text, faults[f][1]);
	}
	json_t *machine = provenance();
	struct baseline *baseline;
	assert_int_equal(baseline_read(folder, machine, &baseline, error), BASELINE_DAMAGED); /* a folder is no file */
	assert_non_null(strstr(error, folder));
	json_decref(machine);
	json_decref(document);
	free(whole);
	free(rows);
	free(path);
	folder_remove(folder);
}

static void other_machines_do_not_compare(void **state)
{
	(void)state;
	static const struct {
		const char *key, *value;
		enum baseline_state state;
	} changes[] = {
		{"processor", "\"abacus\"", BASELINE_FOREIGN}, {"cores", "4096", BASELINE_FOREIGN},
		{"memory_bytes", "1", BASELINE_FOREIGN},       {"compiler", "\"cc\"", BASELINE_SOUND},
		{"system", "\"unix\"", BASELINE_SOUND},
	};
	struct random_state random = random_seed(SEED);
	struct row *rows = random_rows(&random, 1);
	char *folder = folder_new(), *path = path_in(folder, "base.json");
	for (size_t c = 0; c < sizeof changes / sizeof *changes; c++) {
		json_t *machine = provenance(), *document = document_of(json_deep_copy(machine));
		json_object_set_new(json_object_get(document, "machine"), changes[c].key,
							json_loads(changes[c].value, JSON_DECODE_ANY, NULL));
		struct baseline *baseline;
		assert_true(baseline_write(path, document, rows, 1, error));
		assert_int_equal(baseline_read(path, machine, &baseline, error), changes[c].state);
		assert_true(baseline ? changes[c].state == BASELINE_SOUND : strstr(error, "from another machine") != NULL);
		baseline_free(baseline);
		json_decref(document);
		json_decref(machine);
	}
	free(rows);
	free(path);
	folder_remove(folder);
}

/* ------------------------------------------------------------------ tables and pages */

/* Findings as if all had been measured: point p takes (p + 1) times as long in one repetition as in another. */
static struct findings *some_findings(void)
{
	struct findings *findings = malloc(sizeof *findings);
	struct effort effort = effort_of(false);
	findings_begin(findings, &effort);
	for (int p = 0; p < POINTS; p++) {
		struct engine_cost *cost = &findings->engine[p];
		for (unsigned repetition = 1; repetition <= effort.repetitions; repetition++) {
			sample_add(&cost->event, 100.0 * (p + 1) * repetition);
			sample_add(&cost->start_up, 0.25 * repetition);
		}
		cost->bytes = 200;
		cost->instructions = point_counted(&points[p], &effort) ? 1000 + p : NAN;
	}
	for (int i = 0; i < 5; i++) sample_add(&findings->drop, 1.5);
	for (int i = 0; i < 5; i++) sample_add(&findings->speed_up[0], 1.75);
	return findings;
}

static char *printed(void (*print)(FILE *stream, const void *what), const void *what)
{
	char *text;
	size_t size;
	FILE *stream = open_memstream(&text, &size);
	assert_non_null(stream);
	print(stream, what);
	fclose(stream);
	return text;
}

struct two_rows {
	struct row rows[2];
	const struct baseline *baseline;
};

static void print_rows(FILE *stream, const void *what)
{
	const struct two_rows *two = what;
	table_rows(stream, two->rows, 2, two->baseline);
}

static void assert_line(const char *text, const char *line)
{
	if (!strstr(text, line)) fail_msg("no line '%s' in\n%s", line, text);
}

static void rows_are_printed(void **state)
{
	(void)state;
	struct two_rows two = {.rows = {{.name = "engine"}, {.name = "balls"}}};
	for (int r = 0; r < 2; r++)
		for (int q = 0; q < QUANTITIES; q++) two.rows[r].value[q] = spread_exact(NAN);
	two.rows[0].value[NANOSECONDS] = (struct spread){512.25, 500, 530};
	two.rows[0].value[INSTRUCTIONS] = spread_exact(12345.6);
	two.rows[0].value[START_UP] = (struct spread){0.0125, 0.01, 0.02};
	two.rows[1].value[SECONDS] = (struct spread){1.5, 1.25, 2};
	char *text = printed(print_rows, &two);
	assert_line(text, "stored run (there is none yet)");
	assert_line(text,
				"\nengine                                        512.2         500..530        -      12346        "
				"-          -        -     0.0125        -\n");
	assert_line(text, "\nballs                                           1.5          1.25..2        - s\n");
	free(text);

	char *folder = folder_new(), *path = path_in(folder, "base.json");
	json_t *machine = provenance(), *document = document_of(json_incref(machine));
	struct baseline *baseline;
	assert_true(baseline_write(path, document, two.rows, 2, error));
	assert_int_equal(baseline_read(path, machine, &baseline, error), BASELINE_SOUND);
	two.baseline = baseline;
	two.rows[0].value[NANOSECONDS].median /= 2;
	two.rows[1].value[SECONDS].median *= 1.25;
	text = printed(print_rows, &two);
	assert_line(text, "stored run of 2024-05-01T12:00:00Z, revision 39dc0da, make bench:");
	assert_line(text,
				"\nengine                                        256.1         500..530    0.500      12346    1.000"
				"          -        -     0.0125    1.000\n");
	assert_line(text, "\nballs                                         1.875          1.25..2    1.250 s\n");
	free(text);
	baseline_free(baseline);
	json_decref(document);
	json_decref(machine);
	free(path);
	folder_remove(folder);
}

static void print_demands(FILE *stream, const void *what)
{
	struct demand demands[DEMANDS];
	findings_demands(what, demands);
	table_demands(stream, demands, DEMANDS);
}

static void demands_are_held_against_findings(void **state)
{
	(void)state;
	struct findings *findings = some_findings();
	struct demand demands[DEMANDS];
	findings_demands(findings, demands);
	double twin = point_of("hard-spheres", 2916, 0.5, "twin", "cells") + 1.0;
	double binary64 = point_of("hard-spheres", 2916, 0.5, "binary64", "cells") + 1.0;
	bool found = false;
	for (int d = 0; d < DEMANDS; d++) {
		const struct demand *demand = &demands[d];
		if (strcmp(demand->what, "an event in twin, over binary64") == 0)
			found = demand->found.median == twin / binary64 && demand->found.low == demand->found.high;
		if (!isnan(demand->found.median))
			assert_int_equal(demand_met(demand), (demand->found.median <= demand->limit) == demand->at_most ||
													 demand->found.median == demand->limit);
	}
	assert_true(found);
	char *text = printed(print_demands, findings);
	assert_line(text,
				"\ntwo runs on two cores, times one: 13 500 spheres                 1.75                -  at least "
				"1.8: not met\n");
	assert_line(text,
				"\nseconds until 10^6 balls have come to rest                        1.5                -  at most "
				"2\n");
	assert_null(strstr(text, "108 000")); /* not measured */
	free(text);

	assert_true(findings_agree(findings));
	findings->engine[point_of("hard-spheres", 2916, 0.5, "mpfr:113", "cells")].digest = 7;
	assert_true(findings_agree(findings));
	findings->engine[point_of("hard-spheres", 2916, 0.5, "mpfr:113", "unsieved")].digest = 8;
	assert_false(findings_agree(findings));
	free(findings);
}

/* A sound result, whatever is missing; its curves run from left to right. */
static void results_are_sound(void **state)
{
	(void)state;
	char *folder = folder_new(), *path = path_in(folder, "base.json");
	struct findings *findings = some_findings();
	struct row rows[ROWS];
	struct baseline *baseline;
	json_t *machine = provenance(), *document = document_of(json_incref(machine));
	findings_rows(findings, rows);
	assert_true(baseline_write(path, document, rows, ROWS, error));
	assert_int_equal(baseline_read(path, machine, &baseline, error), BASELINE_SOUND);
	for (int variant = 0; variant < 4; variant++) {
		struct effort effort = effort_of(true);
		if (variant == 2) snprintf(findings->uncounted, sizeof findings->uncounted, "valgrind is away");
		if (variant == 3) findings_begin(findings, &effort), findings->stopped = true;
		findings_rows(findings, rows);
		struct result *result = bench_result(findings, rows, variant == 1 ? baseline : NULL);
		assert_non_null(result);
		if (!result_write(result, folder, error)) fail_msg("%s", error);
		const json_t *figures = json_object_get(result_document(result), "figures"), *figure, *series, *row;
		size_t f, s, r, seen = 0;
		json_array_foreach(figures, f, figure) json_array_foreach(json_object_get(figure, "series"), s, series)
		{
			double last = -1;
			json_array_foreach(json_object_get(series, "rows"), r, row)
			{
				double x = json_number_value(json_array_get(row, 0));
				assert_true(x > last);
				last = x;
				seen++;
			}
		}
		static const size_t expected[] = {21, 32, 21, 0}; /* 5 sizes, 6 densities, 10 precisions; the first two again */
		assert_int_equal(seen, expected[variant]);
		result_free(result);
	}
	baseline_free(baseline);
	json_decref(document);
	json_decref(machine);
	free(findings);
	free(path);
	folder_remove(folder);
}

int main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(every_number_comes_back),           cmocka_unit_test(damaged_baselines_are_refused),
		cmocka_unit_test(other_machines_do_not_compare),     cmocka_unit_test(rows_are_printed),
		cmocka_unit_test(demands_are_held_against_findings), cmocka_unit_test(results_are_sound),
	};
	return cmocka_run_group_tests(tests, NULL, NULL);
}
