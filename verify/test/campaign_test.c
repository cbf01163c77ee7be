/* Campaigns: the same numbers on any number of threads, whatever stops or kills them on the way, and nothing twice. */
#include <errno.h>
#include <math.h>
#include <setjmp.h>
#include <signal.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <time.h>

#include <cmocka.h>

#include "campaign/campaign.h"
#include "campaign/piece_store.h"
#include "scene/random.h"
#include "test/folder.h"

static const uint64_t seed = 19891127;
static char *folder;

enum { PIECES = 60 };

/* A piece draws numbers from its own seed: quick, and different for each. */
struct trial {
	uint64_t seed;
	int made;       /* how often a piece was made in this process */
	int stop_after; /* then `stop` is raised; 0: never */
	volatile int stop;
	long nap;           /* nanoseconds per piece */
	size_t refused;     /* this one refuses; SIZE_MAX: none */
	size_t last;        /* piece begun last */
	bool longest_first; /* so it has been so far */
};

static void write_key(void *context, size_t piece, char key[CAMPAIGN_KEY])
{
	const struct trial *trial = context;
	snprintf(key, CAMPAIGN_KEY, "piece=%zu seed=%llu", piece, (unsigned long long)trial->seed);
}

static double cost(void *context, size_t piece)
{
	(void)context;
	return 1 + (double)(piece % 7);
}

static json_t *make(void *context, size_t piece, const struct campaign_watch *watch, char error[CAMPAIGN_ERROR])
{
	struct trial *trial = context;
	struct random_state random = random_seed(trial->seed + piece);
	if (trial->nap) nanosleep(&(struct timespec){0, trial->nap}, NULL);
	if (watch->stop && *watch->stop) return NULL;
	if (piece == trial->refused) return snprintf(error, CAMPAIGN_ERROR, "piece %zu will not", piece), NULL;
	watch->progress(watch, 0.5);
#pragma omp critical(trial)
	{
		if (trial->made++ > 0 && cost(NULL, piece) > cost(NULL, trial->last)) trial->longest_first = false;
		trial->last = piece;
		if (trial->made == trial->stop_after) trial->stop = 1;
	}
	return json_pack("{s:o, s:f, s:o, s:{s:I}}", "draw", campaign_number(random_uniform(&random) - 0.5), "third",
					 random_uniform(&random) / 3, "nothing", campaign_number(piece % 2 ? NAN : -INFINITY), "made",
					 "when", (json_int_t)(trial->made));
}

static const struct trial fresh = {.refused = SIZE_MAX, .longest_first = true, .seed = 1};

static json_t *run(struct trial *trial, const char *where, int threads, char error[CAMPAIGN_ERROR])
{
	struct campaign campaign = {"trial", PIECES, write_key, cost, make, trial};
	struct campaign_setup setup = {.folder = where, .threads = threads, .stop = &trial->stop};
	return campaign_run(&campaign, &setup, error);
}

/* Runs it to its end, and leaves of each result what its key determines. */
static json_t *finish(struct trial *trial, const char *where, int threads)
{
	char error[CAMPAIGN_ERROR];
	json_t *results = run(trial, where, threads, error), *result;
	if (!results) fail_msg("%s", error);
	size_t index;
	assert_int_equal(campaign_finished(results), PIECES);
	json_array_foreach(results, index, result) json_object_del(result, "made");
	return results;
}

static char *store_text(void)
{
	return folder_text(folder, "trial.pieces");
}

static void forget(void)
{
	campaign_forget("trial", folder);
	assert_int_equal(folder_count(folder, ""), 0);
}

/* The store goes on from what it holds, and comes to the numbers of a campaign that was never disturbed. */
static void assert_goes_on(int at_most)
{
	struct trial undisturbed = fresh, trial = fresh;
	json_t *expected = finish(&undisturbed, NULL, 1), *results = finish(&trial, folder, 2);
	assert_true(json_equal(expected, results));
	if (trial.made > at_most) fail_msg("%d pieces were made again, where %d were missing", trial.made, at_most);
	json_decref(expected);
	json_decref(results);
}

static void numbers_do_not_depend_on_threads(void **state)
{
	(void)state;
	struct trial one = fresh;
	json_t *expected = finish(&one, NULL, 1);
	assert_true(one.longest_first);
	assert_int_equal(one.made, PIECES);
	for (int threads = 2; threads <= 7; threads++) {
		struct trial trial = fresh;
		json_t *results = finish(&trial, threads % 2 ? folder : NULL, threads);
		assert_true(json_equal(expected, results));
		json_decref(results);
		if (threads % 2) forget();
	}
	struct trial other = fresh;
	other.seed = 2;
	json_t *results = finish(&other, NULL, 3);
	assert_false(json_equal(expected, results));
	json_decref(results);
	json_decref(expected);
}

static void a_stopped_campaign_goes_on(void **state)
{
	(void)state;
	char error[CAMPAIGN_ERROR];
	for (int threads = 1; threads <= 4; threads++) {
		struct trial trial = fresh;
		trial.stop_after = 5 * threads;
		json_t *results = run(&trial, folder, threads, error);
		assert_non_null(results);
		int finished = (int)campaign_finished(results);
		assert_true(finished >= trial.stop_after && finished < trial.stop_after + threads);
		json_decref(results);
		assert_goes_on(PIECES - finished);
		assert_goes_on(0);
		forget();
	}
}

static void a_refusing_piece_keeps_the_others(void **state)
{
	(void)state;
	char error[CAMPAIGN_ERROR];
	struct trial trial = fresh;
	trial.refused = 4;
	assert_null(run(&trial, folder, 2, error));
	assert_string_equal(error, "piece 4 will not");
	assert_int_equal(trial.made, PIECES - 1);
	assert_goes_on(1);
	forget();
}

/* Killed at random moments, again and again, until it is through: each call adds to what is there. */
static void killed_at_any_moment(void **state)
{
	(void)state;
	print_message("seed %llu\n", (unsigned long long)seed);
	struct random_state random = random_seed(seed);
	for (int kill_number = 0; kill_number < 6; kill_number++) {
		pid_t process = fork();
		if (process == 0) {
			struct trial trial = fresh;
			trial.nap = 500000;
			char error[CAMPAIGN_ERROR];
			run(&trial, folder, 1, error); /* one thread: a forked child may not have more */
			_exit(0);
		}
		nanosleep(&(struct timespec){0, (long)random_below(&random, 8000000)}, NULL);
		kill(process, SIGKILL);
		waitpid(process, NULL, 0);
	}
	char *text = store_text(), error[CAMPAIGN_ERROR], path[200];
	int lines = 0;
	for (char *c = text; c && *c; c++) lines += *c == '\n';
	free(text);
	snprintf(path, sizeof path, "%s/trial.pieces", folder);
	struct piece_store *store = piece_store_read(path, "trial", error);
	if (!store) fail_msg("%s", error);
	print_message("%d pieces in 6 lives\n", lines - 1);
	assert_int_equal(json_object_size(piece_store_lines(store)), lines - 1); /* none was made twice */
	piece_store_close(store, NULL);
	assert_goes_on(PIECES - lines + 1);
	forget();
}

static int said;
static char last_said[512];
static void hear(void *context, const char *line)
{
	(void)context;
	said++;
	snprintf(last_said, sizeof last_said, "%s", line);
}

/* Cut off at any byte, the store loses the line that was cut and no other; any byte changed costs one line. */
static void torn_and_damaged_lines(void **state)
{
	(void)state;
	struct random_state random = random_seed(seed + 1);
	struct trial trial = fresh;
	json_decref(finish(&trial, folder, 2));
	char *whole = store_text(), path[200], error[CAMPAIGN_ERROR];
	size_t length = strlen(whole), head = strcspn(whole, "\n") + 1;
	snprintf(path, sizeof path, "%s/trial.pieces", folder);
	for (int round = 0; round < 60; round++) {
		bool cut = round % 2;
		char *text = strdup(whole);
		size_t at = head + random_below(&random, length - head);
		int missing = 1;
		if (cut) {
			bool between = text[at - 1] == '\n';
			text[at] = '\0';
			missing = PIECES + 1;
			for (char *c = text; *c; c++) missing -= *c == '\n';
			said = between ? 1 : 0; /* nothing is to be said of a clean cut */
		} else {
			text[at] ^= text[at] == '\n' ? 1 : 4; /* never makes a new end of a line */
			said = 0;
			if (whole[at] == '\n') missing = at + 1 == length ? 1 : 2;
		}
		folder_put(folder, "trial.pieces", text);
		trial = fresh;
		struct campaign campaign = {"trial", PIECES, write_key, cost, make, &trial};
		json_t *results =
			campaign_run(&campaign, &(struct campaign_setup){.folder = folder, .threads = 1, .say = hear}, error);
		if (!results) fail_msg("%s, at byte %zu: %s", cut ? "cut" : "damaged", at, error);
		json_decref(results);
		assert_int_equal(trial.made, missing);
		if (said != 1) fail_msg("byte %zu: %d lines said, the last '%s'", at, said, last_said);
		free(text);
	}
	free(whole);
	assert_goes_on(0);
	forget();
}

static void refuses(const char *text, const char *words)
{
	struct trial trial = fresh;
	char error[CAMPAIGN_ERROR];
	folder_put(folder, "trial.pieces", text);
	if (run(&trial, folder, 1, error)) fail_msg("taken: %s", text);
	if (!strstr(error, words) || !strstr(error, "/trial.pieces: ")) fail_msg("not '%s': %s", words, error);
	char *after = store_text();
	assert_string_equal(after, text); /* somebody else's file stays as it is */
	free(after);
}

static char *lines_of(json_t *first, json_t *second, json_t *third)
{
	json_t *lines[] = {first, second, third};
	char *text = strdup("");
	for (int l = 0; l < 3 && lines[l]; l++) {
		char *line = piece_store_line(lines[l]), *longer;
		if (asprintf(&longer, "%s%s", text, line) < 0) abort();
		free(text), free(line), json_decref(lines[l]);
		text = longer;
	}
	return text;
}

static json_t *piece_line(int number, const char *revision)
{
	return json_pack("{s:s, s:s, s:{s:i}}", "key", "a", "revision", revision, "result", "n", number);
}

static void write_one_key(void *context, size_t piece, char key[CAMPAIGN_KEY])
{
	(void)context, (void)piece;
	snprintf(key, CAMPAIGN_KEY, "all the same");
}

static void strange_stores_are_refused(void **state)
{
	(void)state;
	refuses("title: a scene, not a store\n", "line 1 is not that of a store");
	char *text = lines_of(piece_store_head("other"), NULL, NULL);
	refuses(text, "campaign 'other'; accepted: of 'trial'");
	free(text);
	text = lines_of(json_pack("{s:s, s:i}", "campaign", "trial", "store", 9), NULL, NULL);
	refuses(text, "of version 9");
	free(text);
	text = lines_of(piece_store_head("trial"), piece_line(1, "r"), piece_line(2, "r"));
	refuses(text, "line 3 contradicts");
	free(text);
	forget();

	char error[CAMPAIGN_ERROR], path[200];
	snprintf(path, sizeof path, "%s/trial.pieces", folder);
	struct piece_store *busy = piece_store_open(path, "trial", error);
	struct trial trial = fresh;
	assert_null(run(&trial, folder, 1, error));
	assert_non_null(strstr(error, "another program is at this campaign"));
	piece_store_close(busy, NULL);
	forget();
	struct campaign alike = {"trial", 2, write_one_key, NULL, make, &trial};
	assert_null(campaign_run(&alike, &(struct campaign_setup){.threads = 1}, error));
	assert_string_equal(error, "trial: two pieces are called 'all the same'");
}

/* Where two revisions of the program differ, the later has the last word, or is asked alone. */
static void revisions_are_told_apart(void **state)
{
	(void)state;
	char *text = lines_of(piece_store_head("trial"), piece_line(1, "r"), piece_line(2, "s")), error[512], path[200];
	folder_put(folder, "trial.pieces", text);
	free(text);
	snprintf(path, sizeof path, "%s/trial.pieces", folder);
	struct piece_store *store = piece_store_read(path, NULL, error);
	assert_non_null(store);
	assert_int_equal(json_integer_value(json_object_get(piece_store_find(store, "a"), "n")), 2);
	assert_string_equal(piece_store_campaign(store), "trial");
	piece_store_close(store, NULL);

	struct trial trial = fresh;
	char key[CAMPAIGN_KEY];
	write_key(&trial, 0, key);
	json_t *line = json_pack("{s:s, s:s, s:{}}", "key", key, "revision", "older", "result");
	text = lines_of(piece_store_head("trial"), line, NULL);
	folder_put(folder, "trial.pieces", text);
	free(text);
	struct campaign campaign = {"trial", PIECES, write_key, cost, make, &trial};
	for (int this_revision = 0; this_revision < 2; this_revision++) {
		json_decref(campaign_run(
			&campaign, &(struct campaign_setup){.folder = folder, .threads = 1, .this_revision = this_revision},
			error));
		assert_int_equal(trial.made, PIECES - 1 + this_revision);
	}
	forget();
}

/* A disk that is full: one line, and all that was whole before is still there. */
static void a_full_disk(void **state)
{
	(void)state;
	struct trial trial = fresh;
	char error[CAMPAIGN_ERROR] = "";
	struct rlimit before, small;
	getrlimit(RLIMIT_FSIZE, &before);
	small = before, small.rlim_cur = 1000;
	signal(SIGXFSZ, SIG_IGN);
	setrlimit(RLIMIT_FSIZE, &small);
	json_t *results = run(&trial, folder, 2, error);
	setrlimit(RLIMIT_FSIZE, &before);
	assert_null(results);
	assert_non_null(strstr(error, "cannot be written: File too large"));
	char *text = store_text();
	assert_true(strlen(text) <= 1000 && strlen(text) > 200 && text[strlen(text) - 1] == '\n');
	int lines = 0;
	for (char *c = text; *c; c++) lines += *c == '\n';
	free(text);
	assert_goes_on(PIECES - lines + 1);
	forget();
}

static void numbers_come_back(void **state)
{
	(void)state;
	struct random_state random = random_seed(seed + 2);
	for (int i = 0; i < 1000; i++) {
		union {
			uint64_t bits;
			double value;
		} number = {random_below(&random, UINT64_MAX)};
		json_t *object = json_pack("{s:o}", "x", campaign_number(number.value));
		double back = campaign_value(object, "x");
		if (isnan(number.value) ? !isnan(back) : back != number.value || signbit(back) != signbit(number.value))
			fail_msg("%a came back as %a", number.value, back);
		json_decref(object);
	}
	json_t *empty = json_object();
	assert_true(isnan(campaign_value(empty, "x")));
	json_decref(empty);
}

static int set_up(void **state)
{
	(void)state;
	folder = folder_new();
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
		cmocka_unit_test(killed_at_any_moment), /* first: it forks, which threads would mind */
		cmocka_unit_test(numbers_do_not_depend_on_threads),
		cmocka_unit_test(a_stopped_campaign_goes_on),
		cmocka_unit_test(a_refusing_piece_keeps_the_others),
		cmocka_unit_test(torn_and_damaged_lines),
		cmocka_unit_test(strange_stores_are_refused),
		cmocka_unit_test(revisions_are_told_apart),
		cmocka_unit_test(a_full_disk),
		cmocka_unit_test(numbers_come_back),
	};
	return cmocka_run_group_tests(tests, set_up, tear_down);
}
