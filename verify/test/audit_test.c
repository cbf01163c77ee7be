/* The command audit, as a nightly job meets it. */
#include <signal.h>
#include <sqlite3.h>
#include <time.h>

#include "program.h"

static char *folder;
static const char suite[] =
	"title: Small\n"
	"checks:\n"
	"  - name: ball\n"
	"    weight: 3\n"
	"    scene: bouncing-ball\n"
	"    measures: [{measure: digest, same_in: 'mpfr:53'}, {measure: verdict, equal: collapsed}]\n"
	"  - name: gas\n"
	"    weight: 2\n"
	"    scene: hard-spheres\n"
	"    set: [particles=108, equilibrate=1]\n"
	"    events: 3000\n"
	"    seeds: 3\n"
	"    measures:\n"
	"      - {measure: below_contact, at_least: 0.3, at_most: 0.7}\n"
	"      - {measure: energy_drift, at_most: 1e-12}\n"
	"      - {measure: deepest_overlap}\n"
	"      - {measure: nanoseconds_per_event}\n"
	"  - name: finder\n"
	"    grade: stable\n"
	"    family: dense\n"
	"    cases: 1000\n"
	"    measures: [{measure: missed, at_most: 0}, {measure: largest_ulp}]\n";
enum { MEASURES = 8 };

static void put(const char *name, const char *text)
{
	folder_put(folder, name, text);
}

static struct said audit(const char *options)
{
	return program_run("audit --suite %s/suite.yaml %s", folder, options);
}

static json_t *audit_read(const char *options, int status)
{
	char arguments[300];
	snprintf(arguments, sizeof arguments, "%s --history %s/history.db --json -", options, folder);
	return program_json(audit(arguments), status);
}

static const json_t *measure_of(const json_t *json, const char *check, const char *measure)
{
	const json_t *one, *found;
	size_t c, m;
	json_array_foreach(json_object_get(json, "checks"), c, one)
	{
		if (strcmp(json_text(one, "check"), check) != 0) continue;
		json_array_foreach(json_object_get(one, "measures"), m,
						   found) if (strcmp(json_text(found, "measure"), measure) == 0) return found;
	}
	fail_msg("no measure %s of %s", measure, check);
	return NULL;
}

static void execute(const char *sql)
{
	char path[200];
	sqlite3 *database;
	snprintf(path, sizeof path, "%s/history.db", folder);
	assert_int_equal(sqlite3_open(path, &database), SQLITE_OK);
	assert_int_equal(sqlite3_exec(database, sql, NULL, NULL, NULL), SQLITE_OK);
	sqlite3_close(database);
}

/* Audits of the same program agree; what was different once is a regression, told with its size and since when, until
 * it is accepted. */
static void regressions_are_told_until_accepted(void **state)
{
	(void)state;
	json_t *json = audit_read("--seed 1 --revision first", 0);
	assert_string_equal(json_text(json, "schema"), "touchstone-audit-1");
	assert_true(json_number(json, "audit") == 1 && json_number(json, "tests") == MEASURES);
	const json_t *below = measure_of(json, "gas", "below_contact");
	double fraction = json_number(below, "value");
	assert_true(json_number(below, "count") == 9000 && fraction > 0.3 && fraction < 0.7);
	assert_null(json_object_get(below, "chance"));
	json_decref(json);

	for (int seed = 2; seed <= 5; seed++) {
		char options[60];
		snprintf(options, sizeof options, "--seed %d --revision r%d", seed, seed);
		json_decref(audit_read(options, 0));
	}
	json = audit_read("--seed 1", 0);
	assert_true(json_number(measure_of(json, "gas", "below_contact"), "references") == 5);
	assert_true(json_number(measure_of(json, "ball", "digest"), "chance") == 1);
	json_decref(json);

	/* As if all audits so far had found other digests, and hardly any contact below. */
	execute("UPDATE measure SET word = 'f00d' WHERE name = 'digest';"
			"UPDATE measure SET hits = 3000 WHERE name = 'below_contact'");
	for (int night = 0; night < 2; night++) {
		json = audit_read("--seed 1 --revision worse", 1);
		assert_true(json_number(json, "failures") == 2);
		const json_t *digest = measure_of(json, "ball", "digest");
		assert_non_null(strstr(json_text(digest, "regression"), "not f00d, since "));
		assert_non_null(strstr(json_text(digest, "regression"), night ? "since audit 7 of " : "since tonight"));
		below = measure_of(json, "gas", "below_contact");
		assert_non_null(strstr(json_text(below, "regression"), "times what it was"));
		assert_non_null(strstr(json_text(below, "regression"), night ? "audit 7 of 20" : "tonight"));
		assert_non_null(strstr(json_text(below, "regression"), night ? "revision worse" : ""));
		json_decref(json);
	}
	struct said table = program_run("audit --suite %s/suite.yaml --history %s/history.db", folder, folder);
	assert_int_equal(table.status, 1);
	assert_non_null(strstr(table.out, "regression: ball: digest: "));
	assert_non_null(strstr(table.out, "false alarms stated at 0.001 an audit"));
	said_free(&table);

	json_decref(audit_read("--accept ball", 1)); /* the gas is as bad as before */
	json_decref(audit_read("--accept all", 0));
	json_decref(audit_read("--seed 1", 0));
	program_refused(audit("--accept bull"), "--accept: 'bull'; accepted: all, or the name of a check");
}

/* Two audits begin a history together, and both are in it, whole. */
static void two_at_once_are_both_kept(void **state)
{
	(void)state;
	char text[2][300], *words[PROGRAM_WORDS];
	pid_t audits[2];
	for (int a = 0; a < 2; a++) {
		snprintf(text[a], sizeof text[a],
				 "audit --suite %s/suite.yaml --seed %d --history %s/history.db --json %s/%d.json", folder, a + 1,
				 folder, folder, a);
		program_words(text[a], words);
		if ((audits[a] = fork()) != 0) continue;
		if (!freopen("/dev/null", "w", stdout)) _exit(99);
		execv(words[0], words);
		_exit(99);
	}
	for (int a = 0; a < 2; a++) assert_int_equal(program_status(audits[a]), 0);
	json_t *json = audit_read("--seed 3", 0);
	assert_true(json_number(json, "audit") == 3);
	assert_true(json_number(measure_of(json, "gas", "below_contact"), "references") == 2);
	json_decref(json);
}

/* A threshold that is not kept is a finding without any history. */
static void thresholds_need_no_history(void **state)
{
	(void)state;
	put("halting.yaml", "checks:\n  - name: naive\n    scene: three-body\n    method: naive\n"
						"    measures: [{measure: verdict, equal: done}]\n");
	struct said said = program_run("audit --suite %s/halting.yaml", folder);
	assert_int_equal(said.status, 1);
	assert_non_null(strstr(said.out, "threshold: naive: verdict: halted, where done is asked for"));
	said_free(&said);
}

/* What a machine reads: XML that is sound, with a case for each measure, and its failures counted. */
static void junit_is_written(void **state)
{
	(void)state;
	put("mixed.yaml",
		"checks:\n  - name: naive\n    scene: three-body\n    method: naive\n    weight: 2\n"
		"    measures: [{measure: verdict, equal: '<done> & \"so\"'}]\n"
		"  - name: ball\n    scene: bouncing-ball\n    measures: [{measure: digest}, {measure: verdict}]\n");
	char command[300];
	struct said said = program_run("audit --suite %s/mixed.yaml --junit %s/audit.xml", folder, folder);
	assert_int_equal(said.status, 1);
	said_free(&said);
	snprintf(command, sizeof command,
			 "test \"$(xmllint --xpath 'concat(count(/testsuites/testsuite/testcase), \" \", "
			 "/testsuites/testsuite/@tests, \" \", /testsuites/testsuite/@failures, \" \", "
			 "count(//testcase[@classname=\"touchstone.mixed.naive\"]/failure[@message]))' %s/audit.xml)\" = '3 3 1 1'",
			 folder);
	assert_int_equal(system(command), 0);
	program_refused(program_run("audit --suite %s/mixed.yaml --junit %s/absent/audit.xml", folder, folder),
					"absent/audit.xml: cannot be written");
}

static double clock_seconds(void)
{
	struct timespec now;
	clock_gettime(CLOCK_MONOTONIC, &now);
	return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

static const char *state_of(const json_t *json, size_t check)
{
	return json_text(json_array_get(json_object_get(json, "checks"), check), "state");
}

/* A check that cannot fit is left out, and told; one that turns out not to fit is stopped when the budget is over. */
static void budgets_are_kept(void **state)
{
	(void)state;
	put("long.yaml", "checks:\n  - name: short\n    weight: 9\n    scene: cradle\n    measures: [{measure: verdict}]\n"
					 "  - name: long\n    weight: 5\n    scene: hard-spheres\n    events: 1e8\n"
					 "    set: [particles=500, equilibrate=0]\n    measures: [{measure: verdict}]\n"
					 "  - name: last\n    scene: cradle\n    measures: [{measure: verdict}]\n");
	char options[300];
	const char *budget = getenv("TOUCHSTONE_MEMCHECK") ? "20s" : "1s"; /* there all takes fifty times longer */
	double began = clock_seconds();
	json_t *json = program_json(
		program_run("audit --suite %s/long.yaml --budget %s --history %s/history.db --json -", folder, budget, folder),
		0);
	assert_true(clock_seconds() - began < 20 * atof(budget));
	assert_string_equal(state_of(json, 0), "done");
	assert_string_equal(state_of(json, 1), "not reached"); /* trying a fiftieth of it took the whole budget */
	assert_string_equal(state_of(json, 2), "not reached");
	assert_true(json_number(json, "skipped") == 2);
	json_decref(json);

	/* The history says that it takes no time, and is wrong. */
	snprintf(options, sizeof options,
			 "INSERT INTO checked (audit, name, definition, seed, seconds, accepted) SELECT 1, 'long', "
			 "'scene hard-spheres particles=500 equilibrate=0 events=1e8, 1 seeds', 1, 0.01, 0");
	execute(options);
	execute("UPDATE audit SET machine = (SELECT machine FROM audit LIMIT 1)");
	json = program_json(
		program_run("audit --suite %s/long.yaml --budget %s --history %s/history.db --json -", folder, budget, folder),
		0);
	assert_string_equal(state_of(json, 1), "stopped");
	assert_string_equal(state_of(json, 2), "not reached");
	assert_string_equal(json_text(json, "state"), "complete");
	json_decref(json);
}

/* Ctrl-C: what was done is kept, as of an audit that no other is held against. */
static void interrupting_keeps_what_is_done(void **state)
{
	(void)state;
	put("long.yaml", "checks:\n  - name: short\n    weight: 9\n    scene: cradle\n    measures: [{measure: verdict}]\n"
					 "  - name: long\n    weight: 5\n    scene: hard-spheres\n    events: 1e12\n"
					 "    set: [particles=500, equilibrate=0]\n    measures: [{measure: verdict}]\n");
	char text[400], *words[PROGRAM_WORDS];
	snprintf(text, sizeof text, "audit --suite %s/long.yaml --history %s/history.db --json %s/out.json", folder, folder,
			 folder);
	program_words(text, words);
	pid_t process = fork();
	if (process == 0) {
		if (!freopen("/dev/null", "w", stdout)) _exit(99);
		execv(words[0], words);
		_exit(99);
	}
	char *path;
	sqlite3 *database;
	assert_true(asprintf(&path, "%s/history.db", folder) > 0);
	for (int waited = 0, stored = 0; !stored; waited++) { /* until the first check is in the history */
		assert_true(waited < 3000);
		usleep(10000);
		sqlite3_stmt *statement = NULL;
		if (sqlite3_open_v2(path, &database, SQLITE_OPEN_READONLY, NULL) == SQLITE_OK &&
			sqlite3_prepare_v2(database, "SELECT 1 FROM checked", -1, &statement, NULL) == SQLITE_OK)
			stored = sqlite3_step(statement) == SQLITE_ROW;
		sqlite3_finalize(statement);
		sqlite3_close(database);
	}
	usleep(200000);
	kill(process, SIGINT);
	assert_int_equal(program_status(process), 130);
	free(path);
	char *told = folder_text(folder, "out.json");
	json_t *json = json_loads(told, 0, NULL);
	assert_string_equal(json_text(json, "state"), "interrupted");
	assert_string_equal(state_of(json, 0), "done");
	assert_string_equal(state_of(json, 1), "stopped");
	json_decref(json);
	free(told);
	put("short.yaml",
		"checks:\n  - name: short\n    weight: 9\n    scene: cradle\n    measures: [{measure: verdict}]\n");
	json = program_json(program_run("audit --suite %s/short.yaml --history %s/history.db --json -", folder, folder), 0);
	assert_null(json_object_get(measure_of(json, "short", "verdict"), "chance"));
	json_decref(json);
}

static void bad_words_are_refused(void **state)
{
	(void)state;
	program_refused(audit("--budget soon"), "--budget: 'soon'; accepted: a time above 0");
	program_refused(audit("--budget -3m"), "--budget: '-3m'");
	program_refused(audit("--seed 1.5"), "--seed: '1.5'; accepted: a whole number");
	program_refused(audit("more"), "'more' is too much");
	program_refused(audit("--json - --junit -"), "only one of them");
	program_refused(program_run("audit --suite nightly"), "--suite: 'nightly' is no file, nor a suite in ");
	program_refused(program_run("audit --suite %s/suite.yaml --history %s/absent/history.db", folder, folder),
					"absent/history.db: cannot be");
	program_refused(program_run("audit --suite %s/suite.yaml --history %s/suite.yaml", folder, folder),
					"suite.yaml: is no database; accepted: a history that `touchstone audit` wrote");
	program_refused(program_run("report --history %s/history.db", folder), "history.db: cannot be read: No such file");
	put("broken.yaml", "checks:\n  - name: ball\n    scene: bouncing-ball\n    measures: [{measure: speed}]\n");
	program_refused(program_run("audit --suite %s/broken.yaml", folder),
					"broken.yaml:4: checks[0].measures[0].measure");
}

static int set_up(void **state)
{
	(void)state;
	folder = folder_new();
	put("suite.yaml", suite);
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
#define IN_FOLDER(test) cmocka_unit_test_setup_teardown(test, set_up, tear_down)
	const struct CMUnitTest tests[] = {
		IN_FOLDER(regressions_are_told_until_accepted),
		IN_FOLDER(two_at_once_are_both_kept),
		IN_FOLDER(thresholds_need_no_history),
		IN_FOLDER(junit_is_written),
		IN_FOLDER(budgets_are_kept),
		IN_FOLDER(interrupting_keeps_what_is_done),
		IN_FOLDER(bad_words_are_refused),
	};
	return cmocka_run_group_tests(tests, NULL, NULL);
}
