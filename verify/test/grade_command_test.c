/* The command grade, as a user meets it. */
#include <math.h>
#include <signal.h>

#include "own_folder.h"
#include "program.h"
#include "touchstone.h"

#define PLUGIN(name) TOUCHSTONE_PLUGINS "/" name ".so"

enum { COLUMNS = 14 };
static const char HEADING[] = "method,arithmetic,shape,family,cases,missed,phantom,negative,nan,median_ulp,p999_ulp,"
							  "max_ulp,worst_input,ns_per_call\n";

/* One line of comma-separated values, taken apart. */
struct csv_row {
	char *field[COLUMNS];
};
enum {
	METHOD,
	ARITHMETIC,
	SHAPE,
	FAMILY,
	CASES,
	MISSED,
	PHANTOM,
	NEGATIVE,
	NOT_A_NUMBER,
	MEDIAN,
	P999,
	MAX,
	WORST,
	NS
};

/* Takes the text apart in place; returns how many rows there are. */
static size_t read_csv(char *text, struct csv_row *rows, size_t room)
{
	size_t count = 0;
	char *rest;
	if (strncmp(text, HEADING, strlen(HEADING)) != 0) fail_msg("heading: %s", text);
	for (char *line = strtok_r(text + strlen(HEADING), "\n", &rest); line; line = strtok_r(NULL, "\n", &rest)) {
		assert_true(count < room);
		for (int c = 0; c < COLUMNS; c++) rows[count].field[c] = strsep(&line, ",");
		assert_true(rows[count].field[NS] && !line);
		count++;
	}
	return count;
}

/* The text without its last column, which is a time. */
static char *without_times(char *text)
{
	char *to = text;
	for (char *line = text, *next; *line; line = next) {
		char *end = strchr(line, '\n'), *comma = end;
		next = end + 1;
		while (*comma != ',') comma--;
		memmove(to, line, (size_t)(comma - line));
		to += comma - line;
		*to++ = '\n';
	}
	*to = '\0';
	return text;
}

static struct said run_well(const char *arguments)
{
	struct said said = program_run("%s", arguments);
	if (said.status != 0) fail_msg("%s: status %d: %s", arguments, said.status, said.err);
	return said;
}

/* The correctly rounded method makes no fault on any family, and is off by no more than half an ulp. */
static void the_best_method_has_a_clean_sheet(void **state)
{
	(void)state;
	struct csv_row rows[100];
	struct said said = run_well("grade rounded --cases 500 --csv -");
	size_t count = read_csv(said.out, rows, 100);
	assert_true(count > 40);
	for (size_t r = 0; r < count; r++) {
		char *const *field = rows[r].field;
		assert_string_equal(field[METHOD], "rounded");
		assert_string_equal(field[ARITHMETIC], "binary64");
		assert_string_equal(field[CASES], "500");
		for (int c = MISSED; c <= NOT_A_NUMBER; c++) assert_string_equal(field[c], "0");
		if (*field[MAX] && !(strtod(field[MAX], NULL) <= 0.5)) fail_msg("%s: %s ulp", field[FAMILY], field[MAX]);
		assert_true(strtod(field[MEDIAN], NULL) <= strtod(field[P999], NULL));
		assert_true(*field[NS] && strtod(field[NS], NULL) >= 0);
	}
	assert_string_equal(said.err, "");
	said_free(&said);
}

/* The largest error can be replayed from the line that reports it. */
static void the_worst_input_is_as_bad_as_reported(void **state)
{
	(void)state;
	struct csv_row rows[4];
	struct said said = run_well("grade stable --shape ball-ball --family dense --cases 3000 --csv -");
	assert_int_equal(read_csv(said.out, rows, 4), 1);
	double reported = strtod(rows[0].field[MAX], NULL), replayed;
	struct said again = program_run("replay --method stable --arithmetic binary64 %s", rows[0].field[WORST]);
	const char *last = strrchr(again.out, ' ');
	assert_int_equal(again.status, 0);
	assert_true(last && sscanf(last, "%lf", &replayed) == 1);
	assert_true(reported > 1 && fabs(replayed - reported) <= 0.005 * reported);
	said_free(&said);
	said_free(&again);
}

static void grades_do_not_depend_on_threads(void **state)
{
	(void)state;
	const char *const arguments = "grade stable naive --arithmetic binary64 --arithmetic binary32 --shape ball-ball "
								  "--family grazing --family ties --cases 40000 --seed 7 --csv -";
	char *one, *three = NULL;
	assert_true(asprintf(&one, "%s --threads 1", arguments) > 0 && asprintf(&three, "%s --threads 3", arguments) > 0);
	struct said first = run_well(one), second = run_well(three);
	assert_int_equal(program_lines(first.out), 1 + 2 * 2 * 2);
	assert_string_equal(without_times(first.out), without_times(second.out));
	said_free(&first);
	said_free(&second);
	free(one);
	free(three);
}

static void questions_of_a_file_are_answered(void **state)
{
	(void)state;
	folder_put(folder, "some.txt",
			   "# of all kinds\nball-ball 3 0 0 -1 0 0 1\nhalf-space 1 -3\nball-ball 3 0 0 1 0 0 1\n\n"
			   "ball-ball nan 0 0 1 0 0 1\nball-plane 2 0 -1 0\nhalf-space 1 inf\n");
	struct said said = program_run("grade stable --inputs %s/some.txt --answers -", folder);
	assert_int_equal(said.status, 0);
	static const char *const lines[] = {"line,method,answer,exact\n", "\n2,stable,0x1p+1,0x1p+1\n",
										"\n4,stable,inf,inf\n", "\n7,stable,0x1p+1,0x1p+1\n",
										"\n3,stable,0x1.5555555555555p-2,0x1.5555555555555p-2\n"};
	for (size_t l = 0; l < sizeof lines / sizeof *lines; l++)
		if (!strstr(said.out, lines[l])) fail_msg("not there: %s%s", lines[l], said.out);
	assert_int_equal(program_lines(said.out), 7);
	assert_true(strstr(said.out, ",nan\n") != NULL); /* what is not finite has no exact answer */
	said_free(&said);

	said = program_run("grade stable --inputs %s/some.txt --csv %s/some.csv --answers %s/some.answers", folder, folder,
					   folder);
	assert_int_equal(said.status, 0);
	assert_non_null(strstr(said.out, "ball-ball, hand-made questions\n"));
	assert_non_null(strstr(said.out, "1 ball-ball questions of some hold an infinity or a NaN"));
	char *csv = folder_text(folder, "some.csv"), *answers = folder_text(folder, "some.answers");
	struct csv_row rows[4];
	assert_int_equal(read_csv(csv, rows, 4), 3);
	assert_string_equal(rows[0].field[FAMILY], "some");
	assert_string_equal(rows[0].field[CASES], "2");
	assert_int_equal(program_lines(answers), 7);
	free(csv);
	free(answers);
	said_free(&said);
}

static void several_arithmetics_are_told_apart(void **state)
{
	(void)state;
	folder_put(folder, "third.txt", "half-space 1 -3\n");
	struct said said = program_run(
		"grade stable --inputs %s/third.txt --arithmetic binary32 --arithmetic mpfr:200 --answers -", folder);
	assert_int_equal(said.status, 0);
	assert_non_null(strstr(said.out, "1,stable binary32,0x1.555556p-2,0x1.5555555555555p-2\n"));
	assert_non_null(strstr(said.out, "1,stable mpfr:200,0x1.5555555555555p-2,0x1.5555555555555p-2\n"));
	said_free(&said);
}

static void all_methods_are_graded_where_they_can(void **state)
{
	(void)state;
	struct csv_row rows[100];
	struct said said = run_well("grade all --family near-contact --cases 200 --csv -");
	size_t count = read_csv(said.out, rows, 100), methods = 0;
	for (size_t n = 0; touchstone_finder_name(n); n++) {
		bool found = false;
		for (size_t r = 0; r < count; r++) found |= strcmp(rows[r].field[METHOD], touchstone_finder_name(n)) == 0;
		assert_true(found);
		methods++;
	}
	assert_true(methods >= 9 && count > methods && count <= 4 * methods);
	said_free(&said);
}

/* ---- plug-ins */

/* The worked example of the README: the textbook's formula, right on easy questions. */
static void the_example_is_graded(void **state)
{
	(void)state;
	static const char *const plugins[] = {PLUGIN("example"), PLUGIN("example_cxx")};
	for (int p = 0; p < 2; p++) {
		struct csv_row rows[4];
		struct said said =
			program_run("grade --plugin %s --family dense --family grazing --cases 2000 --csv -", plugins[p]);
		if (said.status != 0) fail_msg("status %d: %s", said.status, said.err);
		assert_int_equal(read_csv(said.out, rows, 4), 2);
		for (int c = MISSED; c <= NOT_A_NUMBER; c++) assert_string_equal(rows[0].field[c], "0");
		assert_string_equal(rows[0].field[METHOD], strrchr(plugins[p], '/') + 1);
		assert_true(strtod(rows[0].field[MAX], NULL) > 1);
		assert_true(strtod(rows[1].field[MISSED], NULL) > 0 && strtod(rows[1].field[PHANTOM], NULL) > 0);
		assert_true(*rows[0].field[NS]);
		said_free(&said);
	}
}

static void faults_of_a_plugin_are_findings(void **state)
{
	(void)state;
	static const struct {
		const char *contact, *finding;
	} faults[] = {
		{"101", "faulty.so is ended by SIGSEGV (Segmentation fault) at line 2 of faults: ball-ball 0x1.c2p+8 "},
		{"102", "faulty.so does not come to an end at line 2 of faults"},
		{"103", "faulty.so answers 1 of 3 questions with what is no time"},
		{"104", "faulty.so answers 1 of 3 questions with what is no time"},
		{"106", "faulty.so ends the process with status "},
		{"107", "faulty.so is ended by SIGUSR1"},
		{"108", "faulty.so is ended by SIGABRT (Aborted)"},
		{"111", "faulty.so is ended by SIGABRT (Aborted), though not when asked nothing else, at line 2"},
	};
	for (size_t f = 0; f < sizeof faults / sizeof *faults; f++) {
		char text[200];
		snprintf(text, sizeof text, "ball-ball 3 0 0 -1 0 0 1\nball-ball 450 0 0 -1 0 0 %s\nball-ball 5 0 0 -1 0 0 1\n",
				 faults[f].contact);
		folder_put(folder, "faults.txt", text);
		struct said said =
			program_run("grade --plugin %s --inputs %s/faults.txt --patience 0.3", PLUGIN("faulty"), folder);
		if (said.status != 1 || !strstr(said.out, faults[f].finding))
			fail_msg("%s: status %d: %s%s", faults[f].contact, said.status, said.out, said.err);
		said_free(&said);
		said = program_run("grade --plugin %s --inputs %s/faults.txt --patience 0.3 --answers -", PLUGIN("faulty"),
						   folder);
		assert_int_equal(said.status, 1);
		assert_non_null(strstr(said.err, faults[f].finding));
		assert_non_null(strstr(said.out, "1,faulty.so,0x1p+1,0x1p+1\n2,faulty.so,"));
		assert_non_null(strstr(said.out, "3,faulty.so,0x1p+2,0x1p+2\n"));
		said_free(&said);
	}
}

/* What a plug-in prints does not end up among the data. */
static void a_noisy_plugin_is_not_heard(void **state)
{
	(void)state;
	folder_put(folder, "noise.txt", "ball-ball 110 0 0 -1 0 0 109\n");
	struct said said = program_run("grade --plugin %s --inputs %s/noise.txt --answers -", PLUGIN("faulty"), folder);
	assert_int_equal(said.status, 0);
	assert_string_equal(said.out, "line,method,answer,exact\n1,faulty.so,0x1p+0,0x1p+0\n");
	said_free(&said);
}

static void a_symbol_may_have_any_name(void **state)
{
	(void)state;
	folder_put(folder, "one.txt", "ball-ball 3 0 0 -1 0 0 1\n");
	struct said said = program_run("grade --plugin %s:another_name --shape ball-ball --inputs %s/one.txt --answers -",
								   PLUGIN("faulty"), folder);
	assert_int_equal(said.status, 0);
	assert_string_equal(said.out, "line,method,answer,exact\n1,faulty.so:another_name,0x1p+1,0x1p+1\n");
	said_free(&said);
}

/* ---- interruption, results and bad input */

/* Stopped by a signal, it tells what was done by then. */
static void an_interrupt_keeps_what_is_done(void **state)
{
	(void)state;
	char *csv, *answers;
	assert_true(asprintf(&csv, "%s/stopped.csv", folder) > 0 && asprintf(&answers, "%s/stopped.answers", folder) > 0);
	pid_t process = fork();
	if (process == 0) {
		if (!freopen("/dev/null", "w", stdout) || !freopen("/dev/null", "w", stderr)) _exit(99);
		execl(TOUCHSTONE_PROGRAM, TOUCHSTONE_PROGRAM, "grade", "stable", "--cases", "1e8", "--family", "at-rest",
			  "--threads", "1", "--csv", csv, "--answers", answers, NULL);
		_exit(99);
	}
	for (int wait = 0; wait < 1000 && folder_count(folder, "stopped.answers") == 0; wait++) usleep(10000);
	usleep(300000);
	kill(process, SIGINT);
	assert_int_equal(program_status(process), 130);
	char *rows = folder_text(folder, "stopped.csv");
	assert_true(rows && program_lines(rows) >= 1);
	assert_int_equal(folder_count(folder, "stopped"), 2);
	remove(answers);
	free(rows);
	free(csv);
	free(answers);
}

static void grades_become_a_page(void **state)
{
	(void)state;
	struct said said =
		program_run("grade stable naive --plugin %s --cases 300 --results %s/results", PLUGIN("example"), folder);
	assert_int_equal(said.status, 1); /* where squares overflow, the example says nan */
	said_free(&said);
	said = program_run("report --results %s/results --output %s/report", folder, folder);
	assert_int_equal(said.status, 0);
	said_free(&said);
	char *report, *page;
	assert_true(asprintf(&report, "%s/report", folder) > 0);
	page = folder_text(report, "grade.html");
	static const char *const parts[] = {"ball-ball, hand-made questions", "ball-ball, harvested questions",
										"class=\"shade level-4\"",        "<span>0.5 ulp</span>",
										"touchstone grade stable naive",  "example.so"};
	for (size_t p = 0; p < sizeof parts / sizeof *parts; p++)
		if (!strstr(page, parts[p])) fail_msg("not on the page: %s", parts[p]);
	free(page);
	free(report);
}

static void bad_usage_is_one_line(void **state)
{
	(void)state;
	static const struct {
		const char *arguments, *words;
	} wrong[] = {
		{"", "grade: no method"},
		{"fastest", "fastest"},
		{"stable --arithmetic decimal", "no arithmetic 'decimal'"},
		{"stable --shape cube", "--shape: 'cube'; accepted: ball-ball, ball-leave, ball-plane, half-space"},
		{"stable --family easy", "--family: 'easy'; accepted: all, or one that `touchstone list families` has"},
		{"stable --cases 0", "--cases: '0'; accepted: a whole number"},
		{"stable --cases 1e99", "--cases: '1e99'"},
		{"stable --seed x", "--seed: 'x'"},
		{"stable --threads 0", "--threads: '0'"},
		{"stable --patience 0", "--patience: '0'; accepted: seconds"},
		{"stable --inputs nowhere.txt", "nowhere.txt"},
		{"stable --inputs Makefile", "is no shape; accepted: ball-ball"},
		{"stable --csv - --answers -", "only one of them"},
		{"stable --csv nowhere/file.csv", "nowhere/file.csv"},
		{"stable --shape half-space --family grazing", "no question"},
		{"--plugin nowhere.so", "--plugin: nowhere.so: cannot be read"},
		{"--plugin Makefile", "--plugin: Makefile: no ELF file"},
		{"--plugin " PLUGIN("strange"), "has no function touchstone_ball_ball"},
		{"--plugin " PLUGIN("faulty") ":nothing", "has no function nothing"},
	};
	for (size_t w = 0; w < sizeof wrong / sizeof *wrong; w++)
		program_refused(program_run("grade %s", wrong[w].arguments), wrong[w].words);
	folder_put(folder, "wrong.txt", "half-space 1 -3\nball-ball 1 2 3 4 5 6 0x7g\n");
	program_refused(program_run("grade stable --inputs %s/wrong.txt", folder), "wrong.txt:2: '0x7g' is no number");
	struct said said = program_run("grade --plugin %s", PLUGIN("unloadable"));
	assert_int_equal(said.status, 1);
	assert_non_null(strstr(said.err, "unloadable.so: is ended by SIGABRT (Aborted) while it is loaded"));
	said_free(&said);
}

int main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(the_best_method_has_a_clean_sheet),
		cmocka_unit_test(the_worst_input_is_as_bad_as_reported),
		cmocka_unit_test(grades_do_not_depend_on_threads),
		cmocka_unit_test(questions_of_a_file_are_answered),
		cmocka_unit_test(several_arithmetics_are_told_apart),
		cmocka_unit_test(all_methods_are_graded_where_they_can),
		cmocka_unit_test(the_example_is_graded),
		cmocka_unit_test(faults_of_a_plugin_are_findings),
		cmocka_unit_test(a_noisy_plugin_is_not_heard),
		cmocka_unit_test(a_symbol_may_have_any_name),
		cmocka_unit_test(an_interrupt_keeps_what_is_done),
		cmocka_unit_test(grades_become_a_page),
		cmocka_unit_test(bad_usage_is_one_line),
	};
	return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
