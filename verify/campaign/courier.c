#include "campaign/courier.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

/* MPI would wait by spinning; a core that waits is better lent to one that works. */
static void nap(void)
{
	nanosleep(&(struct timespec){0, 1000000}, NULL);
}

static void send(const struct ranks *ranks, int to, json_t *message)
{
	char *text = message ? json_dumps(message, JSON_COMPACT) : NULL;
	ranks->send(to, text ? text : "{}");
	free(text);
	json_decref(message);
}

/* The next message, or NULL when there is none. */
static json_t *receive(const struct ranks *ranks, int *from)
{
	size_t length;
	if (!ranks->waiting(from, &length)) return NULL;
	char *text = malloc(length);
	if (!text) abort(); /* the message could be neither read nor left */
	ranks->receive(*from, text, length);
	json_t *message = json_loads(text, 0, NULL);
	free(text);
	return message ? message : json_object();
}

/* ------------------------------------------------------------------ rank 0 */

enum { ASLEEP = -2, HOME = -3 }; /* waits for a piece; has gone; otherwise the place of the piece a rank is at */

static void keep(struct campaign_work *work, long at, json_t *message)
{
	const char *error = json_string_value(json_object_get(message, "error"));
	if (at >= 0) work_keep(work, at, json_incref(json_object_get(message, "result")), error ? error : "");
}

static void hand_out(struct campaign_work *work, const struct ranks *ranks, int to, long *at)
{
	*at = work_take(work);
	if (*at == WORK_NONE) {
		*at = ASLEEP;
		return;
	}
	char key[CAMPAIGN_KEY];
	work_key(work, *at, key);
	send(ranks, to, json_pack("{s:I, s:s}", "piece", (json_int_t)work_piece(work, *at), "key", key));
}

/* Those that have nothing to do go home together, so that none has to wait for the others in MPI. */
static int send_home(const struct ranks *ranks, int size, long *at)
{
	int sent = 0;
	for (int rank = 1; rank < size; rank++) {
		if (at[rank] != ASLEEP) continue;
		send(ranks, rank, NULL);
		at[rank] = HOME;
		sent++;
	}
	return sent;
}

static void tell_unfinished(const struct campaign_work *work, int size, const long *at,
							void (*say)(void *context, const char *line), void *context)
{
	for (int rank = 1; rank < size; rank++) {
		char key[CAMPAIGN_KEY], line[CAMPAIGN_KEY + 100];
		if (at[rank] < 0) continue;
		work_key(work, at[rank], key);
		snprintf(line, sizeof line, "rank %d did not finish what it was at, which is to be made again: %s", rank, key);
		if (say)
			say(context, line);
		else
			fprintf(stderr, "touchstone: %s\n", line);
	}
}

void courier_serve(struct campaign_work *work, const struct ranks *ranks, int size,
				   void (*say)(void *context, const char *line), void *context)
{
	long *at = calloc((size_t)size, sizeof *at);
	if (!at) abort();
	for (int rank = 1; rank < size; rank++) at[rank] = WORK_NONE; /* has not asked yet */
	int here = size - 1, patience = 500; /* naps after an end is asked for: mpirun soon kills what lingers */
	while (here > 0 && patience > 0) {
		int from;
		json_t *message = receive(ranks, &from);
		if (message) {
			keep(work, at[from], message);
			hand_out(work, ranks, from, &at[from]);
			json_decref(message);
			continue;
		}
		bool stopped = work_stopped(work);
		if (stopped || work_over(work)) here -= send_home(ranks, size, at);
		if (here > 0) nap();
		patience -= stopped;
	}
	if (here > 0) tell_unfinished(work, size, at, say, context);
	free(at);
}

/* ------------------------------------------------------------------ the others */

static void tell_nobody(const struct campaign_watch *watch, double part)
{
	(void)watch, (void)part;
}

/* Makes what a message asks for; the answer. */
static json_t *make(const struct campaign *campaign, const json_t *asked, const volatile int *stop)
{
	size_t piece = (size_t)json_integer_value(json_object_get(asked, "piece"));
	const char *wanted = json_string_value(json_object_get(asked, "key"));
	char key[CAMPAIGN_KEY] = "", error[CAMPAIGN_ERROR] = "";
	json_t *result = NULL;
	if (piece < campaign->count) campaign->key(campaign->context, piece, key);
	if (wanted && strcmp(key, wanted) == 0)
		result =
			campaign->make(campaign->context, piece, &(struct campaign_watch){stop, tell_nobody, NULL, piece}, error);
	else
		snprintf(error, sizeof error, "%.40s: a rank reads the campaign differently: '%.150s' instead of '%.150s'",
				 campaign->name, key, wanted ? wanted : "");
	json_t *answer = json_pack("{s:I}", "piece", (json_int_t)piece);
	if (result)
		json_object_set_new(answer, "result", result);
	else if (*error)
		json_object_set_new(answer, "error", json_string(error));
	return answer;
}

void courier_make(const struct campaign *campaign, const struct ranks *ranks, const volatile int *stop)
{
	send(ranks, 0, NULL);
	while (!(stop && *stop)) {
		int from;
		json_t *message = receive(ranks, &from);
		if (!message) {
			nap();
			continue;
		}
		bool home = !json_object_get(message, "piece");
		if (!home) send(ranks, 0, make(campaign, message, stop));
		json_decref(message);
		if (home) break;
	}
}
