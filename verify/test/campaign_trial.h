/* A campaign of quick pieces, kept in this program's folder, for tests. */
#ifndef VERIFY_TEST_CAMPAIGN_TRIAL_H
#define VERIFY_TEST_CAMPAIGN_TRIAL_H

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <sys/stat.h>
#include <time.h>

#include <cmocka.h>

#include "campaign/campaign.h"
#include "own_folder.h"
#include "scene/random.h"

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

static inline void write_key(void *context, size_t piece, char key[CAMPAIGN_KEY])
{
	const struct trial *trial = context;
	snprintf(key, CAMPAIGN_KEY, "piece=%zu seed=%llu", piece, (unsigned long long)trial->seed);
}

static inline double cost(void *context, size_t piece)
{
	(void)context;
	return 1 + (double)(piece % 7);
}

static inline json_t *make(void *context, size_t piece, const struct campaign_watch *watch, char error[CAMPAIGN_ERROR])
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

static inline json_t *run(struct trial *trial, const char *where, int threads, char error[CAMPAIGN_ERROR])
{
	struct campaign campaign = {"trial", PIECES, write_key, cost, make, trial};
	struct campaign_setup setup = {.folder = where, .threads = threads, .stop = &trial->stop};
	return campaign_run(&campaign, &setup, error);
}

/* Runs it to its end, and leaves of each result what its key determines. */
static inline json_t *finish(struct trial *trial, const char *where, int threads)
{
	char error[CAMPAIGN_ERROR];
	json_t *results = run(trial, where, threads, error), *result;
	if (!results) fail_msg("%s", error);
	size_t index;
	assert_int_equal(campaign_finished(results), PIECES);
	json_array_foreach(results, index, result) json_object_del(result, "made");
	return results;
}

static inline char *store_text(void)
{
	return folder_text(folder, "trial.pieces");
}

static inline void forget(void)
{
	campaign_forget("trial", folder);
	assert_int_equal(folder_count(folder, ""), 0);
}

/* The store goes on from what it holds, and comes to the numbers of a campaign that was never disturbed. */
static inline void assert_goes_on(int at_most)
{
	struct trial undisturbed = fresh, trial = fresh;
	json_t *expected = finish(&undisturbed, NULL, 1), *results = finish(&trial, folder, 2);
	assert_true(json_equal(expected, results));
	if (trial.made > at_most) fail_msg("%d pieces were made again, where %d were missing", trial.made, at_most);
	json_decref(expected);
	json_decref(results);
}

#endif
