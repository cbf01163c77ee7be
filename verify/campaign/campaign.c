#include "campaign/campaign.h"

#include <math.h>
#include <omp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "aside.h"
#include "campaign/courier.h"
#include "campaign/piece_store.h"
#include "campaign/work.h"

/* What the threads share; all of it is touched within the critical section `campaign` only. */
struct campaign_work {
	const struct campaign *campaign;
	const struct campaign_setup *setup;
	struct piece_store *store; /* or NULL */
	json_t *results;           /* of all pieces, null where missing */
	struct missing {
		size_t piece;
		double cost, part; /* part: how much of it is done */
	} * missing;
	size_t missing_count, taken, finished;
	double cost, done; /* of all that is missing */
	bool lost;         /* nothing more can be kept */
	size_t refused;    /* pieces */
	char *error;
};

static bool stopped(const struct campaign_work *work)
{
	return work->lost || (work->setup->stop && *work->setup->stop);
}

static double cost_of(const struct campaign *campaign, size_t piece)
{
	return campaign->cost ? campaign->cost(campaign->context, piece) : 1;
}

/* The longest first; what takes as long, in the order of the pieces. */
static int compare(const void *one, const void *other)
{
	const struct missing *a = one, *b = other;
	if (a->cost != b->cost) return a->cost > b->cost ? -1 : 1;
	return (a->piece > b->piece) - (a->piece < b->piece);
}

__attribute__((format(printf, 2, 3))) static void say(const struct campaign_work *work, const char *format, ...)
{
	char line[CAMPAIGN_ERROR];
	va_list arguments;
	va_start(arguments, format);
	vsnprintf(line, sizeof line, format, arguments);
	va_end(arguments);
	if (work->setup->say)
		work->setup->say(work->setup->context, line);
	else
		fprintf(stderr, "touchstone: %s\n", line);
}

/* What the store has of a piece, or NULL. `foreign` counts those that another revision of the program has made. */
static json_t *find(const struct campaign_work *work, const char *key, size_t *foreign)
{
	json_t *line = work->store ? json_object_get(piece_store_lines(work->store), key) : NULL;
	const char *revision = json_string_value(json_object_get(line, "revision"));
	bool ours = revision && strcmp(revision, piece_store_revision()) == 0;
	*foreign += line && !ours;
	return ours || !work->setup->this_revision ? json_object_get(line, "result") : NULL;
}

/* Takes from the store what it has, and lists the rest. */
static bool look_up(struct campaign_work *work)
{
	const struct campaign *campaign = work->campaign;
	json_t *seen = json_object();
	bool good = true;
	size_t foreign = 0;
	for (size_t piece = 0; good && piece < campaign->count; piece++) {
		char key[CAMPAIGN_KEY];
		campaign->key(campaign->context, piece, key);
		json_t *known = json_incref(find(work, key, &foreign));
		good = !json_object_get(seen, key);
		if (!good) snprintf(work->error, CAMPAIGN_ERROR, "%.40s: two pieces are called '%.400s'", campaign->name, key);
		json_object_set_new(seen, key, json_true());
		json_array_append_new(work->results, known ? known : json_null());
		if (known) continue;
		double cost = cost_of(campaign, piece);
		work->missing[work->missing_count++] = (struct missing){piece, cost, 0};
		work->cost += cost;
	}
	json_decref(seen);
	if (foreign > 0)
		say(work, "%s: %zu pieces were made by another revision of the program and are %s", campaign->name, foreign,
			work->setup->this_revision ? "made again" : "kept; remove the store to make them again");
	qsort(work->missing, work->missing_count, sizeof *work->missing, compare);
	return good;
}

/* Notes how much of one piece is done. */
static void advance(struct campaign_work *work, struct missing *missing, double part)
{
	work->done += missing->cost * (part - missing->part);
	missing->part = part;
	if (work->setup->progress) work->setup->progress(work->setup->context, work->done / work->cost);
}

static void report(const struct campaign_watch *watch, double part)
{
#pragma omp critical(campaign)
	advance(watch->work, &watch->work->missing[watch->piece], fmin(fmax(part, 0), 1));
}

/* ------------------------------------------------------------------ who makes it */

size_t work_piece(const struct campaign_work *work, long at)
{
	return work->missing[at].piece;
}

void work_key(const struct campaign_work *work, long at, char key[CAMPAIGN_KEY])
{
	work->campaign->key(work->campaign->context, work_piece(work, at), key);
}

long work_take(struct campaign_work *work)
{
	long at = WORK_NONE;
#pragma omp critical(campaign)
	if (!stopped(work) && work->taken < work->missing_count) at = (long)work->taken++;
	return at;
}

bool work_stopped(struct campaign_work *work)
{
	bool answer;
#pragma omp critical(campaign)
	answer = stopped(work);
	return answer;
}

bool work_over(struct campaign_work *work)
{
	bool answer;
#pragma omp critical(campaign)
	answer = work->finished == work->missing_count;
	return answer;
}

/* Of several errors the first is the one told. */
static void keep(struct campaign_work *work, long at, json_t *result, const char *error)
{
	work->finished++;
	advance(work, &work->missing[at], result || *error ? 1 : 0);
	if (!result) {
		if (*error && work->refused++ == 0) snprintf(work->error, CAMPAIGN_ERROR, "%s", error);
		return;
	}
	char key[CAMPAIGN_KEY];
	work_key(work, at, key);
	json_array_set_new(work->results, work_piece(work, at), result);
	if (work->store && !work->lost) work->lost = !piece_store_add(work->store, key, result, work->error);
}

void work_keep(struct campaign_work *work, long at, json_t *result, const char *error)
{
#pragma omp critical(campaign)
	keep(work, at, result, error);
}

/* What each thread does: takes a piece, makes it, keeps it, until none is left. */
static void labour(struct campaign_work *work)
{
	const struct campaign *campaign = work->campaign;
	for (long at; (at = work_take(work)) != WORK_NONE;) {
		struct campaign_watch watch = {work->setup->stop, report, work, (size_t)at};
		char error[CAMPAIGN_ERROR] = "";
		json_t *result = campaign->make(campaign->context, work_piece(work, at), &watch, error);
		work_keep(work, at, result, error);
	}
}

/* The thread that began is the one that may speak to other ranks. */
static void labour_together(struct campaign_work *work)
{
	const struct campaign_setup *setup = work->setup;
	bool ranks = setup->ranks && setup->rank_count > 1;
#pragma omp parallel num_threads(setup->threads + (ranks ? 1 : 0))
	{
		if (ranks && omp_get_thread_num() == 0)
			courier_serve(work, setup->ranks, setup->rank_count, setup->say, setup->context);
		else
			labour(work);
	}
}

/* ------------------------------------------------------------------ from begin to end */

static bool open_store(struct campaign_work *work)
{
	const struct campaign_setup *setup = work->setup;
	if (!setup->folder) return true;
	if (!aside_folder(setup->folder, work->error)) return false;
	char *path = campaign_store_path(setup->folder, work->campaign->name, setup->part);
	if (!path) return snprintf(work->error, CAMPAIGN_ERROR, "out of memory"), false;
	work->store = piece_store_open(path, work->campaign->name, work->error);
	free(path);
	for (size_t n = 0; work->store && n < piece_store_note_count(work->store); n++)
		say(work, "%s", piece_store_note(work->store, n));
	return work->store;
}

json_t *campaign_run(const struct campaign *campaign, const struct campaign_setup *setup, char error[CAMPAIGN_ERROR])
{
	struct campaign_work work = {.campaign = campaign,
								 .setup = setup,
								 .results = json_array(),
								 .missing = calloc(campaign->count + 1, sizeof *work.missing),
								 .error = error};
	snprintf(error, CAMPAIGN_ERROR, "out of memory");
	bool good = work.results && work.missing && open_store(&work) && look_up(&work);
	if (!good) work.lost = true; /* so that other ranks are sent home */
	if (work.missing_count > 0 || setup->ranks) labour_together(&work);
	good = good && !work.lost && work.refused == 0;
	good = piece_store_close(work.store, good ? error : NULL) && good;
	free(work.missing);
	if (good) return work.results;
	json_decref(work.results);
	return NULL;
}

char *campaign_store_path(const char *folder, const char *name, const char *part)
{
	char *path;
	return asprintf(&path, "%s/%s%s%s.pieces", folder, name, part ? "-" : "", part ? part : "") < 0 ? NULL : path;
}

void campaign_forget(const char *name, const char *folder)
{
	char *path = campaign_store_path(folder, name, NULL);
	if (path) unlink(path);
	free(path);
}

size_t campaign_finished(const json_t *results)
{
	size_t finished = 0;
	for (size_t r = 0; r < json_array_size(results); r++) finished += !json_is_null(json_array_get(results, r));
	return finished;
}

json_t *campaign_number(double value)
{
	char text[40];
	snprintf(text, sizeof text, "%a", value);
	return json_string(text);
}

double campaign_value(const json_t *object, const char *member)
{
	const char *text = json_string_value(json_object_get(object, member));
	return text ? strtod(text, NULL) : NAN;
}
