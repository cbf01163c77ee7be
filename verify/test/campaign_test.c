/* Campaigns: the same numbers on any number of threads, whatever stops or kills them on the way, and nothing twice. */
#include <signal.h>
#include <sys/wait.h>

#include "campaign/piece_store.h"
#include "campaign_trial.h"

static const uint64_t seed = 19891127;

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

/* How many lines the store has, its first one included. */
static int lines_there(void)
{
	char *text = store_text();
	int lines = 0;
	for (char *c = text; c && *c; c++) lines += *c == '\n';
	free(text);
	return lines;
}

/* Killed at random moments, again and again: each call adds to what is there. Later ones live longer, so that on the
 * slowest machine there is something in the end. */
static void killed_at_any_moment(void **state)
{
	(void)state;
	print_message("seed %llu\n", (unsigned long long)seed);
	struct random_state random = random_seed(seed);
	char path[200], error[CAMPAIGN_ERROR];
	snprintf(path, sizeof path, "%s/trial.pieces", folder);
	int lives = 0;
	for (; lives < 6 || (lives < 42 && lines_there() == 0); lives++) {
		pid_t process = fork();
		if (process == 0) {
			struct trial trial = fresh;
			trial.nap = 500000;
			run(&trial, folder, 1, error); /* one thread: a forked child may not have more */
			_exit(0);
		}
		nanosleep(&(struct timespec){0, (long)random_below(&random, 8000000) << lives / 6}, NULL);
		kill(process, SIGKILL);
		waitpid(process, NULL, 0);
	}
	int lines = lines_there();
	struct piece_store *store = piece_store_read(path, "trial", error);
	if (!store) fail_msg("%s", error);
	print_message("%d pieces in %d lives\n", lines - 1, lives);
	assert_int_equal(json_object_size(piece_store_lines(store)), lines - 1); /* none was made twice */
	piece_store_close(store, NULL);
	assert_goes_on(PIECES - lines + 1);
	forget();
}

static void write_one_key(void *context, size_t piece, char key[CAMPAIGN_KEY])
{
	(void)context, (void)piece;
	snprintf(key, CAMPAIGN_KEY, "all the same");
}

static void pieces_have_keys_of_their_own(void **state)
{
	(void)state;
	struct trial trial = fresh;
	char error[CAMPAIGN_ERROR];
	struct campaign alike = {"trial", 2, write_one_key, NULL, make, &trial};
	assert_null(campaign_run(&alike, &(struct campaign_setup){.threads = 1}, error));
	assert_string_equal(error, "trial: two pieces are called 'all the same'");
}

static void numbers_come_back(void **state)
{
	(void)state;
	struct random_state random = random_seed(seed + 1);
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

int main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(killed_at_any_moment), /* first: it forks, which threads would mind */
		cmocka_unit_test(numbers_do_not_depend_on_threads),
		cmocka_unit_test(a_stopped_campaign_goes_on),
		cmocka_unit_test(a_refusing_piece_keeps_the_others),
		cmocka_unit_test(pieces_have_keys_of_their_own),
		cmocka_unit_test(numbers_come_back),
	};
	return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
