/* From a history to pages: every measure over time, what was found worse marked, each point leading to its audit.
 * TOUCHSTONE_NIGHTS=365 takes as many nights as a year has, and tells how large the history is and how long it takes.
 */
#include <jansson.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>

#include <cmocka.h>

#include "audit/trends.h"
#include "command/progress.h"
#include "page.h"
#include "scene/random.h"
#include "test/folder.h"

enum { SEED = 20261122, CHECKS = 13, MEASURES = 3, USUAL_NIGHTS = 20, BAD_NIGHTS = 4 };

static char error[REPORT_ERROR];

static void must(bool done)
{
	if (!done) fail_msg("%s", error);
}

static unsigned nights(void)
{
	const char *wanted = getenv("TOUCHSTONE_NIGHTS");
	return wanted ? (unsigned)atoi(wanted) : USUAL_NIGHTS;
}

static struct measurement measure(struct random_state *random, int m, double factor)
{
	struct sample sample = {0};
	for (int k = 0; k < 4; k++) sample_add(&sample, factor * (100 + 3 * random_normal(random)));
	if (m == 0) return measurement_proportion(49900 + random_below(random, 200), 100000);
	if (m == 1) return measurement_sample(MEASURE_TIMING, &sample);
	return measurement_word(factor > 1 ? "beef" : "f00d");
}

/* A history of that many nights; on the last ones, the timing and the word of the last check are worse. */
static void fill(const char *path)
{
	static const char *const names[MEASURES] = {"below_contact", "nanoseconds_per_event", "digest"};
	struct random_state random = random_seed(SEED);
	struct history *history = history_open(path, true, error);
	if (!history) fail_msg("%s", error);
	for (unsigned n = 0; n < nights(); n++) {
		char date[24], revision[24], check_name[24];
		bool bad = n + BAD_NIGHTS >= nights();
		time_t night = 1767236400 + 86400 * (time_t)n; /* 2026-01-01, 03:00 */
		strftime(date, sizeof date, "%Y-%m-%dT%H:%M:%SZ", gmtime(&night));
		snprintf(revision, sizeof revision, "%07x", 0x1000000 + n);
		const struct history_audit audit = {date, "standard", revision, "gcc 12", "a machine", n};
		int64_t id;
		must(history_begin(history, &audit, &id, error));
		for (int c = 0; c < CHECKS; c++) {
			struct history_measure measures[MEASURES];
			snprintf(check_name, sizeof check_name, "check-%d", c);
			for (int m = 0; m < MEASURES; m++)
				measures[m] = (struct history_measure){names[m], WORSE_MORE,
													   measure(&random, m, bad && c == CHECKS - 1 ? 1.3 : 1)};
			const struct history_check check = {check_name, "as it is", n, 10, false, measures, MEASURES};
			must(history_add(history, id, &check, error));
		}
		const struct history_finding findings[] = {{check_name, names[1], "1.3 times <what> it was"},
												   {check_name, names[2], "beef, not f00d"}};
		must(history_end(history, id, "complete", 130, findings, bad ? 2 : 0, error));
	}
	history_close(history);
}

static json_t *read_json(const char *folder, const char *name)
{
	char *text = folder_text(folder, name);
	json_t *json = text ? json_loads(text, 0, NULL) : NULL;
	if (!json) fail_msg("%s: no JSON", name);
	free(text);
	return json;
}

static size_t rows_of(const json_t *figure, size_t series)
{
	return json_array_size(json_object_get(json_array_get(json_object_get(figure, "series"), series), "rows"));
}

static void pages_show_every_measure(void **state)
{
	(void)state;
	char *folder = folder_new(), *path, *results, *report;
	struct stat size;
	assert_true(asprintf(&path, "%s/history.db", folder) > 0);
	assert_true(asprintf(&results, "%s/results", folder) > 0);
	assert_true(asprintf(&report, "%s/report", folder) > 0);
	fill(path);
	assert_int_equal(stat(path, &size), 0);
	double began = progress_clock();
	struct history *history = history_open(path, false, error);
	must(history && trends_write(history, results, error));
	history_close(history);
	must(report_write(results, report, error));
	assert_string_equal(error, ""); /* all figures are drawn */
	print_message("%u nights of %d measures: %lld bytes; pages drawn in %.1f s\n", nights(), CHECKS * MEASURES,
				  (long long)size.st_size, progress_clock() - began);

	json_t *last = read_json(results, "trend-check-12.json"), *first = read_json(results, "trend-check-0.json");
	const json_t *figures = json_object_get(last, "figures");
	assert_int_equal(json_array_size(figures), 2);
	const json_t *timing = json_array_get(figures, 1);
	assert_int_equal(rows_of(timing, 1), nights() - BAD_NIGHTS);
	assert_int_equal(rows_of(timing, 2), BAD_NIGHTS);
	assert_int_equal(rows_of(timing, 0), nights() - 2); /* two good nights make a band */
	assert_int_equal(rows_of(json_array_get(json_object_get(first, "figures"), 1), 2), 0);
	const json_t *words = json_object_get(json_array_get(json_object_get(last, "tables"), 0), "rows");
	assert_int_equal(json_array_size(words), 2); /* as it began, and as it became */
	json_decref(last);
	json_decref(first);

	char link[40], *svg = folder_text(report, "trend-check-12-measure-2.svg"), name[40];
	snprintf(link, sizeof link, "audit-%u.html", nights());
	snprintf(name, sizeof name, "audit-%u.html", nights());
	if (!svg || !strstr(svg, link) || !strstr(svg, "audits.html")) fail_msg("points lead nowhere: %s", link);
	char *page = folder_text(report, name), *overview = folder_text(report, "audits.html");
	assert_true(page && strstr(page, "1.3 times &lt;what&gt; it was") && strstr(page, "check-0"));
	assert_true(overview && strstr(overview, "beef, not f00d"));
	free(svg);
	free(page);
	free(overview);
	if (getenv("TOUCHSTONE_KEEP"))
		print_message("kept in %s\n", folder), free(folder);
	else
		folder_remove(folder);
	free(path);
	free(results);
	free(report);
}

/* A history of one night, and one of an audit that has only begun. */
static void few_nights_make_pages_too(void **state)
{
	(void)state;
	char *folder = folder_new(), *path;
	assert_true(asprintf(&path, "%s/history.db", folder) > 0);
	for (int measured = 0; measured < 2; measured++) {
		const struct history_audit audit = {"2026-11-22T03:00:00Z", "standard", "", "gcc 12", "a machine", 1};
		const struct history_measure measure = {"phantom", WORSE_MORE, measurement_proportion(0, 100)};
		const struct history_check check = {"check", "as it is", 1, 10, false, &measure, 1};
		int64_t id;
		struct history *history = history_open(path, true, error);
		must(history && history_begin(history, &audit, &id, error));
		if (measured) must(history_add(history, id, &check, error));
		must(trends_write(history, folder, error) && report_write(folder, folder, error));
		history_close(history);
		json_t *audits = read_json(folder, "audits.json");
		assert_int_equal(json_array_size(json_object_get(audits, "tables")), 2);
		json_decref(audits);
		assert_int_equal(folder_count(folder, "trend-check.html"), measured);
	}
	free(path);
	folder_remove(folder);
}

int main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(pages_show_every_measure),
		cmocka_unit_test(few_nights_make_pages_too),
	};
	return cmocka_run_group_tests(tests, NULL, NULL);
}
