/* Campaigns that are killed go on; ranks of MPI come to the numbers of threads. */
#include <ctype.h>
#include <signal.h>
#include <sys/stat.h>
#include <time.h>

#include "campaign_samples.h"

/* What was finished stays as it is, and more comes behind it. */
static void assert_goes_on(const char *text, const char *longer)
{
	if (strncmp(text, longer, strlen(text)) != 0) fail_msg("something finished was made again or lost: %s", longer);
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

int main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(a_killed_shard_goes_on),
		cmocka_unit_test(ranks_agree),
		cmocka_unit_test(a_killed_rank_goes_on),
		cmocka_unit_test(without_a_module_ranks_are_skipped),
	};
	return cmocka_run_group_tests(tests, set_up, tear_down);
}
