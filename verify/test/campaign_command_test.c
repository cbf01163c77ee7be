/* `touchstone campaign` and `touchstone merge`, as a user meets them: the same numbers from threads, shards and ranks,
 * whatever is killed on the way. */
#include <ctype.h>
#include <errno.h>
#include <signal.h>
#include <sys/stat.h>
#include <time.h>

#include "campaign/piece_store.h"
#include "program.h"

static char *folder;
static json_t *expected; /* the runs of the small campaign, made by one thread */

enum { RUNS = 12 };

static const char small[] = "title: small\n"
							"scene: hard-spheres\n"
							"set: {particles: 32, start.temperature: 2}\n"
							"grid:\n"
							"  density: [0.2, 0.4]\n"
							"  arithmetic: [binary64, 'short:12']\n"
							"seeds: [1..2, 7]\n"
							"events: 3e3\n"
							"measures: [impact, conservation]\n";

/* Slow enough to be killed on the way, for each run some 50 ms. */
static const char slow[] = "scene: hard-spheres\n"
						   "set: {particles: 32, equilibrate: 0, arithmetic: mpfr:100}\n"
						   "grid: {density: [0.2, 0.4]}\n"
						   "seeds: 1..6\n"
						   "events: 5000\n";

/* What the keys determine of the runs, which `from` holds. */
static json_t *runs_of(json_t *from)
{
	json_t *runs = json_incref(json_object_get(from, "runs")), *run;
	size_t r;
	json_array_foreach(runs, r, run) json_object_del(run, "made");
	json_decref(from);
	return runs;
}

static json_t *finish(const char *where, const char *name)
{
	struct said said =
		program_run("campaign %s/%s.yaml --results %s/%s --threads 2 --json -", folder, name, folder, where);
	return runs_of(program_json(said, 0));
}

/* How long a text is that `text` begins with and `longer` goes on from; -1 when it does not. */
static void assert_goes_on(const char *text, const char *longer)
{
	if (strncmp(text, longer, strlen(text)) != 0) fail_msg("something finished was made again or lost: %s", longer);
}

static void threads_shards_and_merges_agree(void **state)
{
	(void)state;
	static const int order[][3] = {{1, 2, 3}, {3, 1, 2}};
	for (int way = 0; way < 2; way++) {
		char name[20], path[200];
		snprintf(name, sizeof name, "shards%d", way);
		for (int s = 0; s < 3; s++) {
			struct said said = program_run("campaign %s/small.yaml --results %s/%s --shard %d/3 --threads %d", folder,
										   folder, name, order[way][s], 1 + way);
			if (said.status != 0 || !strstr(said.err, "4 of 4 runs")) fail_msg("%s%s", said.out, said.err);
			said_free(&said);
		}
		snprintf(path, sizeof path, "%s/%s/small", folder, name);
		for (int again = 0; again < 2; again++) {
			struct said said =
				program_run("merge %s.pieces %s-%d-of-3.pieces %s-%d-of-3.pieces %s-%d-of-3.pieces", path, path,
							order[1 - way][0], path, order[1 - way][1], path, order[1 - way][2]);
			assert_int_equal(said.status, 0);
			if (!strstr(said.out, again ? "12 pieces, 0 of them new" : "12 pieces, 12 of them new"))
				fail_msg("%s", said.out);
			said_free(&said);
		}
		char *merged = folder_text(folder, way ? "shards1/small.pieces" : "shards0/small.pieces");
		json_t *runs = finish(name, "small");
		char *after = folder_text(folder, way ? "shards1/small.pieces" : "shards0/small.pieces");
		assert_string_equal(merged, after); /* nothing was left to make */
		assert_true(json_equal(runs, expected));
		struct said said = program_run("campaign %s/small.yaml --results %s/%s --shard 1/5", folder, folder, name);
		assert_non_null(strstr(said.err, "0 of 0 runs")); /* nor for a shard of another size */
		said_free(&said);
		json_decref(runs);
		free(merged);
		free(after);
	}
}

static void pieces_are_what_run_tells(void **state)
{
	(void)state;
	assert_int_equal(json_array_size(expected), RUNS);
	const json_t *last = json_array_get(expected, RUNS - 1);
	json_t *run = program_json(program_run("run hard-spheres --set particles=32 --set start.temperature=2 --events 3e3 "
										   "--set density=0.4 --arithmetic short:12 --seed 7 --measure "
										   "impact,conservation --json -"),
							   0);
	static const char *const same[] = {"digest", "seed", "arithmetic", "impact", "conservation", "events", "verdict"};
	for (size_t s = 0; s < sizeof same / sizeof *same; s++)
		if (!json_equal(json_object_get(run, same[s]), json_object_get(last, same[s]))) fail_msg("%s differs", same[s]);
	assert_string_equal(json_text(json_object_get(last, "point"), "arithmetic"), "short:12");
	json_decref(run);
}

/* Mean, deviation and count of a point are those of its rows. */
static void tables_hold_what_runs_tell(void **state)
{
	(void)state;
	json_t *runs = finish("tables", "small");
	char *table = folder_text(folder, "tables/small-runs.csv"),
		 *points = folder_text(folder, "tables/small-points.csv");
	assert_int_equal(program_lines(table), 1 + RUNS);
	assert_int_equal(program_lines(points), 1 + 4);
	double time[3], mean = 0;
	for (size_t s = 0; s < 3; s++) mean += (time[s] = json_number(json_array_get(runs, 3 + s), "time")) / 3;
	size_t column = 0, at = 0;
	char *rest, *line = strtok_r(points, "\n", &rest);
	for (char *cell, *cells = line; (cell = strsep(&cells, ",")); at++)
		if (strcmp(cell, "time") == 0) column = at;
	line = strtok_r(NULL, "\n", &rest), line = strtok_r(NULL, "\n", &rest); /* density 0.2, short:12 */
	assert_int_equal(strncmp(line, "0.2,short:12,3,3,0,0,0,", 23), 0);
	double told[3];
	for (at = 0; at < column + 3; at++) {
		char *cell = strsep(&line, ",");
		if (at >= column) told[at - column] = atof(cell);
	}
	double squares = 0;
	for (int s = 0; s < 3; s++) squares += (time[s] - mean) * (time[s] - mean) / 2;
	assert_true(told[0] / mean > 1 - 1e-12 && told[0] / mean < 1 + 1e-12);
	assert_true(told[1] * told[1] / squares > 1 - 1e-9 && told[1] * told[1] / squares < 1 + 1e-9);
	assert_true(told[2] == 3);
	json_decref(runs);
	free(table);
	free(points);
	struct said said = program_run("report --results %s/tables --output %s/page", folder, folder);
	if (said.status != 0) fail_msg("%s", said.err);
	said_free(&said);
}

/* ------------------------------------------------------------------ kills */

static pid_t launch(char *words[])
{
	pid_t process = fork();
	if (process > 0) return process;
	if (!freopen("/dev/null", "r", stdin) || !freopen("/dev/null", "w", stdout)) _exit(99);
	char log[200];
	snprintf(log, sizeof log, "%s/log", folder);
	if (!freopen(log, "w", stderr)) _exit(99);
	execvp(words[0], words);
	_exit(99);
}

/* Waits until a store has at least so many lines. */
static void wait_for_lines(const char *name, size_t lines)
{
	for (int naps = 0; naps < 4000; naps++) {
		char *text = folder_text(folder, name);
		size_t there = text ? program_lines(text) : 0;
		free(text);
		if (there >= lines) return;
		nanosleep(&(struct timespec){0, 5000000}, NULL);
	}
	fail_msg("%s has not %zu lines after 20 s", name, lines);
}

static void a_killed_shard_goes_on(void **state)
{
	(void)state;
	char file[200], results[200];
	snprintf(file, sizeof file, "%s/slow.yaml", folder);
	snprintf(results, sizeof results, "%s/killed", folder);
	char *words[] = {TOUCHSTONE_PROGRAM, "campaign", file,        "--results", results,
					 "--shard",          "2/2",      "--threads", "1",         NULL};
	for (size_t lines = 2; lines <= 3; lines++) {
		pid_t process = launch(words);
		wait_for_lines("killed/slow-2-of-2.pieces", lines);
		kill(process, SIGKILL);
		waitpid(process, NULL, 0);
	}
	char *before = folder_text(folder, "killed/slow-2-of-2.pieces");
	char *whole_end = strrchr(before, '\n');
	whole_end[1] = '\0';
	assert_true(program_lines(before) < 7); /* it was killed before its end */
	struct said said = program_run("campaign %s --results %s --shard 2/2", file, results);
	assert_int_equal(said.status, 0);
	said_free(&said);
	char *after = folder_text(folder, "killed/slow-2-of-2.pieces");
	assert_goes_on(before, after);
	assert_int_equal(program_lines(after), 7);
	free(before);
	free(after);
}

/* ------------------------------------------------------------------ ranks */

static bool no_ranks(void)
{
	static int there = -1;
	if (there < 0) there = system("mpirun --version >/dev/null 2>&1") == 0 && access(TOUCHSTONE_MPI, F_OK) == 0;
	if (!there) print_message("skipped: no mpirun, or no mpicc when this was built\n");
	return !there;
}

static pid_t launch_ranks(const char *count, char *file, char *results, char *json)
{
	/* Open MPI keeps memory until the end of the program, which a leak checker would complain about. */
	setenv("ASAN_OPTIONS", "detect_leaks=0", 1);
	char *words[] = {"mpirun",
					 "--oversubscribe",
					 "--allow-run-as-root",
					 "-n",
					 (char *)count,
					 TOUCHSTONE_PROGRAM,
					 "campaign",
					 file,
					 "--results",
					 results,
					 json ? "--json" : NULL,
					 json,
					 NULL};
	pid_t process = launch(words);
	unsetenv("ASAN_OPTIONS");
	return process;
}

static void ranks_agree(void **state)
{
	(void)state;
	if (no_ranks()) skip();
	char file[200], results[200], path[240];
	snprintf(file, sizeof file, "%s/small.yaml", folder);
	for (int count = 2; count <= 4; count += 2) {
		char number[12];
		snprintf(number, sizeof number, "%d", count);
		snprintf(results, sizeof results, "%s/ranks%d", folder, count);
		snprintf(path, sizeof path, "%s/runs.json", folder);
		int status = program_status(launch_ranks(number, file, results, path));
		char *log = folder_text(folder, "log");
		if (status != 0 || !strstr(log, "12 of 12 runs")) fail_msg("status %d: %s", status, log);
		json_t *runs = runs_of(json_load_file(path, 0, NULL));
		assert_true(json_equal(runs, expected));
		json_decref(runs);
		free(log);
	}
}

/* The process that is this rank of a job; 0 when there is none. */
static pid_t process_of_rank(pid_t job, int rank)
{
	DIR *all = opendir("/proc");
	pid_t found = 0;
	char wanted[40];
	snprintf(wanted, sizeof wanted, "OMPI_COMM_WORLD_RANK=%d", rank);
	for (struct dirent *entry; all && !found && (entry = readdir(all));) {
		char stat_path[300], words[4000] = "";
		int parent = 0;
		if (!isdigit((unsigned char)*entry->d_name)) continue;
		snprintf(stat_path, sizeof stat_path, "/proc/%s/stat", entry->d_name);
		FILE *stream = fopen(stat_path, "r");
		if (!stream || fscanf(stream, "%*d (%*[^)]) %*c %d", &parent) != 1) parent = 0;
		if (stream) fclose(stream);
		if (parent != job) continue;
		snprintf(stat_path, sizeof stat_path, "/proc/%s/environ", entry->d_name);
		size_t length = (stream = fopen(stat_path, "r")) ? fread(words, 1, sizeof words - 1, stream) : 0;
		if (stream) fclose(stream);
		for (char *word = words; word < words + length; word += strlen(word) + 1)
			if (strcmp(word, wanted) == 0) found = (pid_t)atoi(entry->d_name);
	}
	if (all) closedir(all);
	return found;
}

static void a_killed_rank_goes_on(void **state)
{
	(void)state;
	if (no_ranks()) skip();
	char file[200], results[200];
	snprintf(file, sizeof file, "%s/slow.yaml", folder);
	snprintf(results, sizeof results, "%s/ranks", folder);
	for (int rank = 0; rank < 2; rank++) {
		pid_t job = launch_ranks("2", file, results, NULL);
		wait_for_lines("ranks/slow.pieces", 3 + 2 * (size_t)rank);
		pid_t process = process_of_rank(job, rank);
		if (process > 0) kill(process, SIGKILL);
		int status = program_status(job);
		char *log = folder_text(folder, "log"), words[40];
		snprintf(words, sizeof words, "process rank %d", rank);
		if (status != 137 || !strstr(log, words)) fail_msg("rank %d killed: status %d, %s", rank, status, log);
		free(log);
	}
	char *before = folder_text(folder, "ranks/slow.pieces");
	strrchr(before, '\n')[1] = '\0';
	assert_true(program_lines(before) >= 5 && program_lines(before) < 1 + RUNS);
	json_t *runs = finish("ranks", "slow"), *undisturbed = finish("alone", "slow");
	char *after = folder_text(folder, "ranks/slow.pieces");
	assert_goes_on(before, after);
	assert_true(json_equal(runs, undisturbed));
	json_decref(runs);
	json_decref(undisturbed);
	free(before);
	free(after);
}

/* ------------------------------------------------------------------ refusals */

static void bad_campaigns_have_a_line(void **state)
{
	(void)state;
	static const struct {
		const char *text, *words;
	} wrong[] = {
		{"", "bad.yaml:1: empty"},
		{"scene: hard-spheres\nspeed: 3\n", "bad.yaml:2: unknown key 'speed'; accepted: title"},
		{"seeds: 1..3\n", "bad.yaml:1: scene: not given"},
		{"scene: nowhere\n", "bad.yaml:1: scene: 'nowhere': no such file"},
		{"scene: hard-spheres\nevents: many\n", "bad.yaml:2: events: events: 'many'"},
		{"scene: hard-spheres\nset: {seed: 3}\n", "bad.yaml:2: set: has a seed; accepted: in `seeds`"},
		{"scene: hard-spheres\nset: {particles: 0}\n", "bad.yaml:2: set.particles: particles: '0'"},
		{"scene: hard-spheres\ngrid:\n  density: 0.5\n", "bad.yaml:3: grid.density: no list of values"},
		{"scene: hard-spheres\ngrid:\n  density: [0.5,\n     -1]\n", "bad.yaml:4: grid.density[1]: density: '-1'"},
		{"scene: hard-spheres\ngrid:\n  density: [0.5, 0.5]\n", "bad.yaml:3: grid.density: '0.5' is there twice"},
		{"scene: hard-spheres\ngrid:\n  colour: [red]\n", "bad.yaml:3: grid.colour[0]: unknown key 'colour'"},
		{"scene: hard-spheres\ngrid:\n  method: [stable,\n    magic]\n", "bad.yaml:4: grid.method[1]: "},
		{"scene: hard-spheres\nseeds: 3..1\n", "bad.yaml:2: seeds: '3..1'; accepted: whole numbers"},
		{"scene: hard-spheres\nseeds: [1, 1]\n", "bad.yaml:2: seeds: 1 is there twice"},
		{"scene: hard-spheres\nseeds: 1..1e9\n", "bad.yaml:2: seeds: makes more than 1000000 runs"},
		{"scene: hard-spheres\nmeasures: [speed]\n", "bad.yaml:2: measures[0]: 'speed' is unknown"},
		{"scene: hard-spheres\ngrid: &a {density: [*a]}\n", "bad.yaml:1: YAML alias unsupported"},
		{"scene: hard-spheres\ngrid: {density: [[[[[[[[[[1]]]]]]]]]]}\n", "density: more than can be said on one line"},
		{"scene: [hard-spheres\n", "not YAML"},
	};
	for (size_t w = 0; w < sizeof wrong / sizeof *wrong; w++) {
		folder_put(folder, "bad.yaml", wrong[w].text);
		program_refused(program_run("campaign %s/bad.yaml --results %s/bad", folder, folder), wrong[w].words);
	}
	assert_int_equal(folder_count(folder, "bad"), 1); /* no results */
	program_refused(program_run("campaign none"), "none: no such file, nor in ");
	program_refused(program_run("campaign"), "no campaign");
	program_refused(program_run("campaign a b"), "a second campaign");
	program_refused(program_run("campaign a --shard 5/4"), "--shard: '5/4'");
	program_refused(program_run("campaign %s/small.yaml --shard 1/4 --json -", folder), "--json");
	program_refused(program_run("merge one"), "nothing to merge");
	program_refused(program_run("merge %s/out.pieces %s/bad.yaml", folder, folder), "bad.yaml: ");
	assert_int_equal(folder_count(folder, "out.pieces"), 0);
}

static void contradictions_are_findings(void **state)
{
	(void)state;
	for (int store = 0; store < 2; store++) {
		json_t *lines[] = {
			piece_store_head("c"), json_pack("{s:s, s:s, s:{s:i}}", "key", "a", "revision", "r", "result", "n", store),
			json_pack("{s:s, s:s, s:{s:i}}", "key", store ? "b" : "c", "revision", "r", "result", "n", 5)};
		char *text = NULL, name[20];
		size_t length;
		FILE *stream = open_memstream(&text, &length);
		for (int l = 0; l < 3; l++) {
			char *line = piece_store_line(lines[l]);
			fputs(line, stream);
			free(line);
			json_decref(lines[l]);
		}
		fclose(stream);
		snprintf(name, sizeof name, "c%d.pieces", store);
		folder_put(folder, name, text);
		free(text);
	}
	struct said said = program_run("merge %s/c.pieces %s/c0.pieces %s/c1.pieces", folder, folder, folder);
	assert_int_equal(said.status, 1);
	assert_non_null(strstr(said.err, "contradict each other: a"));
	assert_non_null(strstr(said.out, "2 pieces, 2 of them new; 1 contradicted and not taken over"));
	said_free(&said);
	said = program_run("merge %s/c0.pieces %s/c1.pieces", folder, folder); /* one that has it keeps it */
	assert_int_equal(said.status, 1);
	assert_non_null(strstr(said.out, "3 pieces, 1 of them new"));
	said_free(&said);
}

static void without_a_module_ranks_are_skipped(void **state)
{
	(void)state;
	char program[200], file[200], results[200], command[600];
	snprintf(program, sizeof program, "%s/touchstone", folder);
	snprintf(command, sizeof command, "cp %s %s", TOUCHSTONE_PROGRAM, program);
	assert_int_equal(system(command), 0);
	snprintf(file, sizeof file, "%s/small.yaml", folder);
	snprintf(results, sizeof results, "%s/skipped", folder);
	char *words[] = {program, "campaign", file, "--results", results, NULL};
	setenv("OMPI_COMM_WORLD_RANK", "0", 1);
	int status = program_status(launch(words));
	unsetenv("OMPI_COMM_WORLD_RANK");
	char *log = folder_text(folder, "log");
	if (status != 77 || !strstr(log, "built without MPI")) fail_msg("status %d: %s", status, log);
	free(log);
	assert_int_equal(folder_count(folder, "skipped"), 0);
}

static int set_up(void **state)
{
	(void)state;
	folder = folder_new();
	folder_put(folder, "small.yaml", small);
	folder_put(folder, "slow.yaml", slow);
	expected = finish("threads", "small");
	return 0;
}

static int tear_down(void **state)
{
	(void)state;
	json_decref(expected);
	folder_remove(folder);
	return 0;
}

int main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(threads_shards_and_merges_agree),
		cmocka_unit_test(pieces_are_what_run_tells),
		cmocka_unit_test(tables_hold_what_runs_tell),
		cmocka_unit_test(a_killed_shard_goes_on),
		cmocka_unit_test(ranks_agree),
		cmocka_unit_test(a_killed_rank_goes_on),
		cmocka_unit_test(bad_campaigns_have_a_line),
		cmocka_unit_test(contradictions_are_findings),
		cmocka_unit_test(without_a_module_ranks_are_skipped),
	};
	return cmocka_run_group_tests(tests, set_up, tear_down);
}
