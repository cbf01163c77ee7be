/* The command chart, as a user meets it. No time is asserted. */
#include <math.h>
#include <signal.h>

#include "own_folder.h"
#include "program.h"

static const char HEADING[] = "kind,name,arithmetic,ns,cost_ratio,error_bits,horizon\n";
#define FEW \
	"chart --cases 100 --starts 2 --method stable --method naive --method kahan --arith binary32 --arith binary64"

struct row {
	char kind[16], name[32], arithmetic[32];
	double number[4];
};

static double field(const char **at)
{
	char *end;
	double value = strtod(*at, &end);
	bool empty = end == *at;
	assert_true(*end == ',' || *end == '\n');
	*at = end + 1;
	return empty ? NAN : value;
}

static size_t read_csv(const char *text, struct row *rows, size_t room)
{
	size_t count = 0;
	if (strncmp(text, HEADING, strlen(HEADING)) != 0) fail_msg("heading: %s", text);
	for (const char *line = strchr(text, '\n') + 1; *line; count++) {
		assert_true(count < room);
		struct row *row = &rows[count];
		int length;
		assert_int_equal(sscanf(line, "%15[^,],%31[^,],%31[^,],%n", row->kind, row->name, row->arithmetic, &length), 3);
		line += length;
		for (int n = 0; n < 4; n++) row->number[n] = field(&line);
	}
	return count;
}

static void the_csv_is_as_agreed(void **state)
{
	(void)state;
	struct said said = program_run(FEW " --csv -");
	struct row rows[20];
	if (said.status != 0) fail_msg("status %d: %s", said.status, said.err);
	assert_string_equal(said.err, "");
	assert_int_equal(read_csv(said.out, rows, 20), 3 * 2 + 2 * 2); /* kahan runs no engine */
	for (int r = 0; r < 10; r++) {
		bool engine = r >= 6, coarse = r % 2 == 0;
		const double *number = rows[r].number;
		assert_string_equal(rows[r].kind, engine ? "engine" : "finder");
		assert_string_equal(rows[r].arithmetic, coarse ? "binary32" : "binary64");
		assert_true(isfinite(number[0]) && number[1] > 0);
		assert_true(isnan(number[2]) == engine && isnan(number[3]) != engine);
		double worth = engine ? number[3] : number[2];
		assert_true(coarse ? worth > 0 : worth > rows[r - 1].number[engine ? 3 : 2]);
	}
	said_free(&said);
}

/* But for times, the numbers do not depend on the number of threads. */
static void numbers_do_not_depend_on_threads(void **state)
{
	(void)state;
	struct row rows[2][4];
	for (int run = 0; run < 2; run++) {
		struct said said = program_run("chart --method rounded --arith binary64 --arith mpfr:70 --cases 50 --starts 2 "
									   "--csv - --seed 5 --threads %d",
									   1 + 2 * run);
		assert_int_equal(said.status, 0);
		assert_int_equal(read_csv(said.out, rows[run], 4), 4);
		said_free(&said);
	}
	for (int r = 0; r < 4; r++)
		for (int n = 2; n < 4; n++) {
			double one = rows[0][r].number[n], three = rows[1][r].number[n];
			assert_true(one == three || (isnan(one) && isnan(three)));
		}
	assert_true(rows[0][0].number[2] >= 53 && rows[0][1].number[2] >= 70);
	assert_true(rows[0][2].number[3] < rows[0][3].number[3]);
}

/* Little time means fewer questions, and still every number. */
static void seconds_are_kept_to(void **state)
{
	(void)state;
	struct row rows[2];
	struct said said = program_run("chart --full --seconds 1 --method naive --arith binary32 --csv -");
	assert_int_equal(said.status, 0);
	assert_int_equal(read_csv(said.out, rows, 2), 2);
	assert_true(rows[0].number[2] > 10 && rows[1].number[3] > 0.5);
	said_free(&said);
}

static void the_chart_becomes_a_page(void **state)
{
	(void)state;
	struct said said = program_run(FEW " --results %s/results", folder);
	if (said.status != 0) fail_msg("status %d: %s", said.status, said.err);
	assert_non_null(strstr(said.out, "Finders, harvested questions"));
	assert_non_null(strstr(said.out, "Finders, hand-made questions"));
	assert_non_null(strstr(said.out, "Engines, 500 elastic hard spheres"));
	said_free(&said);
	said = program_run("report --results %s/results --output %s/report", folder, folder);
	if (said.status != 0 || *said.err) fail_msg("status %d: %s", said.status, said.err);
	said_free(&said);
	char *report;
	assert_true(asprintf(&report, "%s/report", folder) > 0);
	char *svg = folder_text(report, "chart-bits.svg"), *page = folder_text(report, "chart.html");
	char *csv = folder_text(report, "chart-bits.csv");
	static const char *const methods[] = {"stable", "naive", "kahan"};
	for (int m = 0; m < 3; m++) {
		char mark[120], grades[40];
		snprintf(mark, sizeof mark, "xlink:href=\"grade-%s.html\"><title>%s in binary64\n", methods[m], methods[m]);
		if (!strstr(svg, mark)) fail_msg("no mark: %s", mark);
		snprintf(grades, sizeof grades, "grade-%s.html", methods[m]);
		assert_int_equal(folder_count(report, grades), 1);
	}
	assert_non_null(strstr(svg, "bits right in 99.9 % of the answers"));
	assert_non_null(strstr(page, "data=\"chart-bits.svg\""));
	assert_non_null(strstr(csv, "harvested questions,throughput,stable,stable binary64,"));
	static const char *const files[] = {"chart-bits.pdf", "chart-faults.svg", "chart-faults.pdf", "chart-engines.svg",
										"chart-engines.pdf"};
	for (size_t f = 0; f < sizeof files / sizeof *files; f++) assert_int_equal(folder_count(report, files[f]), 1);
	free(csv);
	free(page);
	free(svg);
	free(report);
}

/* Stopped by a signal, it tells what was measured by then. */
static void an_interrupt_keeps_what_is_done(void **state)
{
	(void)state;
	char *csv, *results;
	assert_true(asprintf(&csv, "%s/stopped.csv", folder) > 0 && asprintf(&results, "%s/stopped", folder) > 0);
	pid_t process = fork();
	if (process == 0) {
		if (!freopen("/dev/null", "w", stdout) || !freopen("/dev/null", "w", stderr)) _exit(99);
		execl(TOUCHSTONE_PROGRAM, TOUCHSTONE_PROGRAM, "chart", "--full", "--csv", csv, "--results", results, NULL);
		_exit(99);
	}
	for (int wait = 0; wait < 1000 && folder_count(folder, "stopped") == 0; wait++) usleep(10000);
	usleep(500000);
	kill(process, SIGINT);
	assert_int_equal(program_status(process), 130);
	struct row rows[200];
	char *text = folder_text(folder, "stopped.csv"), *chart = folder_text(results, "chart.json");
	assert_true(read_csv(text, rows, 200) > 50);
	assert_non_null(strstr(chart, "\"complete\": false"));
	free(chart);
	free(text);
	free(results);
	free(csv);
}

static void bad_usage_is_one_line(void **state)
{
	(void)state;
	static const struct {
		const char *arguments, *words;
	} wrong[] = {
		{"stable", "chart: 'stable' is too much"},
		{"--method fastest", "fastest"},
		{"--arith decimal", "no arithmetic 'decimal'"},
		{"--arith mpfr:600", "mpfr:600"},
		{"--seconds 0", "--seconds: '0'; accepted: seconds"},
		{"--seconds soon", "--seconds: 'soon'"},
		{"--cases 0", "--cases: '0'"},
		{"--starts 0", "--starts: '0'"},
		{"--seed -1", "--seed: '-1'"},
		{"--threads 0", "--threads: '0'"},
		{"--csv nowhere/file.csv", "nowhere/file.csv"},
		{"--results /dev/null/results", "/dev/null/results"},
	};
	for (size_t w = 0; w < sizeof wrong / sizeof *wrong; w++)
		program_refused(program_run("chart %s", wrong[w].arguments), wrong[w].words);
}

int main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(the_csv_is_as_agreed),
		cmocka_unit_test(numbers_do_not_depend_on_threads),
		cmocka_unit_test(seconds_are_kept_to),
		cmocka_unit_test(the_chart_becomes_a_page),
		cmocka_unit_test(an_interrupt_keeps_what_is_done),
		cmocka_unit_test(bad_usage_is_one_line),
	};
	return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
