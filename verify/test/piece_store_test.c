/* Stores of pieces: cut off, damaged, of others, of another revision, on a full disk. */
#include <signal.h>
#include <sys/resource.h>

#include "campaign/piece_store.h"
#include "campaign_trial.h"
#include "figure/figure_campaign.h"

static const uint64_t seed = 19891128;

static int said;
static char last_said[512];
static void hear(void *context, const char *line)
{
	(void)context;
	said++;
	snprintf(last_said, sizeof last_said, "%s", line);
}

/* A writer may be killed before its first line is whole: there are no pieces then, and nothing is amiss. */
static void a_store_may_have_no_line_yet(void **state)
{
	(void)state;
	char path[200], error[CAMPAIGN_ERROR];
	json_t *first = piece_store_head("trial");
	char *line = piece_store_line(first);
	json_decref(first);
	snprintf(path, sizeof path, "%s/trial.pieces", folder);
	while (*line) {
		line[strlen(line) - 1] = '\0';
		folder_put(folder, "trial.pieces", line);
		struct piece_store *store = piece_store_read(path, "trial", error);
		if (!store) fail_msg("%zu bytes: %s", strlen(line), error);
		assert_int_equal(piece_store_note_count(store), 1);
		assert_null(piece_store_campaign(store));
		assert_int_equal(json_object_size(piece_store_lines(store)), 0);
		piece_store_close(store, NULL);
	}
	free(line);
	assert_goes_on(PIECES);
	forget();
}

/* Cut off at any byte, the store loses the line that was cut and no other; any byte changed costs one line. */
static void torn_and_damaged_lines(void **state)
{
	(void)state;
	struct random_state random = random_seed(seed);
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
		const struct figure_setup setup = {.folder = folder, .threads = 1, .any_revision = !this_revision};
		json_decref(figure_campaign_run(&campaign, &setup, error));
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

int main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(torn_and_damaged_lines),
		cmocka_unit_test(a_store_may_have_no_line_yet),
		cmocka_unit_test(strange_stores_are_refused),
		cmocka_unit_test(revisions_are_told_apart),
		cmocka_unit_test(a_full_disk),
	};
	return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
