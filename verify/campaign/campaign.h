/* Campaigns: many independent pieces of work, each made once, kept, and never made again.
 *
 * A piece is told apart by its key, which says everything that determines its numbers, such as "density=0.5
 * restitution=0.9 seed=3 events=1e6". Finished pieces are kept in FOLDER/NAME.pieces (see piece_store.h), so that a
 * campaign that was stopped or killed goes on where it was: running it again makes what is missing.
 *
 *	static json_t *make(void *context, size_t piece, const struct campaign_watch *watch, char error[CAMPAIGN_ERROR]) ...
 *	struct campaign campaign = {"fig5", rungs * seeds, write_key, NULL, make, &setup};
 *	json_t *results = campaign_run(&campaign, &(struct campaign_setup){.folder = "build/results", .threads = 2}, error);
 */
#ifndef VERIFY_CAMPAIGN_H
#define VERIFY_CAMPAIGN_H

#include <jansson.h>
#include <stdbool.h>
#include <stddef.h>

#include "campaign/ranks.h"

enum {
	CAMPAIGN_KEY = 2048,  /* room for a key, its end included */
	CAMPAIGN_ERROR = 512, /* room for a one-line message, its end included */
};

/* Who looks on while one piece is made. */
struct campaign_watch {
	const volatile int
		*stop; /* non-zero: return NULL soon, without a message; the piece is made another time. Or NULL */
	/* May be told how much of the piece is done, 0 to 1, as often as one likes. Never NULL. */
	void (*progress)(const struct campaign_watch *watch, double part);
	struct campaign_work *work; /* for `progress` */
	size_t piece;
};

struct campaign {
	const char *name; /* of the store; letters, digits, '-' and '_' */
	size_t count;     /* pieces */
	/* Writes the key of a piece, on one line. Two pieces of a campaign never share one. */
	void (*key)(void *context, size_t piece, char key[CAMPAIGN_KEY]);
	/* How long the piece will take, in any unit: the longest is begun first. NULL: all the same. */
	double (*cost)(void *context, size_t piece);
	/* Makes one piece, on any thread: a new object whose numbers the key alone determines, except for those in its
	 * member "made" (seconds, machine), which may differ between two makings. NULL when stopped, or with a message. */
	json_t *(*make)(void *context, size_t piece, const struct campaign_watch *watch, char error[CAMPAIGN_ERROR]);
	void *context;
};

struct campaign_setup {
	const char *folder;       /* where the pieces are kept, made if need be; NULL: nowhere */
	const char *part;         /* of the campaign that is made here, for the store's name, such as "2-of-4"; NULL: all */
	bool this_revision;       /* leave out, and make again, what another revision of the program has made */
	int threads;              /* pieces made side by side; no number depends on it */
	const volatile int *stop; /* non-zero: come to an end with what is done; or NULL */
	const struct ranks *ranks; /* others that make pieces as well, `rank_count` with this one; NULL: none */
	int rank_count;
	/* Told how much of what was missing is done, 0 to 1, by one thread at a time; or NULL. */
	void (*progress)(void *context, double part);
	/* Told one line of what there is to know about the store (a line that was cut off, say); NULL: standard error. */
	void (*say)(void *context, const char *line);
	void *context;
};

/* Makes what is missing. Returns the results of all pieces in their order, null for those that a stop left unmade, and
 * the caller owns them; or NULL with one line in `error` when a piece refuses (the others are made and kept all the
 * same) or the store does. */
json_t *campaign_run(const struct campaign *campaign, const struct campaign_setup *setup, char error[CAMPAIGN_ERROR]);

/* FOLDER/NAME.pieces, or FOLDER/NAME-PART.pieces; the caller frees it, NULL when out of memory. */
char *campaign_store_path(const char *folder, const char *name, const char *part);

/* Removes what is kept of a campaign, when its numbers have gone where they belong. */
void campaign_forget(const char *name, const char *folder);

/* How many of the results are there. */
size_t campaign_finished(const json_t *results);

/* A double that comes back bit for bit, as a hex float (and inf, -inf, nan); and back: NaN where there is none. */
json_t *campaign_number(double value);
double campaign_value(const json_t *object, const char *member);

#endif
