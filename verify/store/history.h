/* The history of audits: one SQLite file that several programs may read and write at a time.
 *
 * An audit is begun, gets one check after another, and is ended. Each of these is one transaction, on disk when the
 * function returns (WAL, synchronous writes): what is there stays whatever happens to the program or the machine. Who
 * finds the file in use waits for up to HISTORY_PATIENCE seconds. Only audits that were ended as complete are ever held
 * against; one that was interrupted or killed stays in the history as what it is.
 *
 * Functions that return bool or a pointer fail with a one-line message that begins with the file's path. */
#ifndef VERIFY_STORE_HISTORY_H
#define VERIFY_STORE_HISTORY_H

#include "audit/verdict.h"
#include "store/text.h"

enum { HISTORY_PATIENCE = 30, HISTORY_VERSION = 1, HISTORY_APPLICATION = 0x54734831 /* "TsH1" */ };

struct history;

/* Opens a history; for writing, an absent or empty file becomes one. NULL when the file or its folder cannot be read or
 * written, is no database, is one of something else, of a newer version, or damaged; it is then left as it was. */
struct history *history_open(const char *path, bool writing, char error[STORE_ERROR]);
void history_close(struct history *history); /* NULL is fine */

/* ---- writing */

/* Where an audit comes from. Texts belong to the caller. */
struct history_audit {
	const char *date; /* UTC, "2024-05-01T12:00:00Z" */
	const char *suite, *revision, *compiler, *machine;
	uint64_t seed;
};
bool history_begin(struct history *history, const struct history_audit *audit, int64_t *id, char error[STORE_ERROR]);

struct history_measure {
	const char *name;
	enum measure_worse worse;
	struct measurement measured;
};
struct history_check {
	const char *name, *definition; /* what exactly is measured: nights with another definition are no reference */
	uint64_t seed;                 /* the first it ran with: the audit's, or one of its own */
	double seconds;
	bool accepted; /* what comes from here on is held against this one and later ones only */
	const struct history_measure *measures;
	size_t measure_count;
};
bool history_add(struct history *history, int64_t audit, const struct history_check *check, char error[STORE_ERROR]);

/* A measure that is no reference: worse than before, or beyond its threshold; `text` says how. */
struct history_finding {
	const char *check, *measure, *text;
};

/* Ends an audit as "complete" or "interrupted". */
bool history_end(struct history *history, int64_t audit, const char *state, double seconds,
				 const struct history_finding *findings, size_t finding_count, char error[STORE_ERROR]);

/* ---- reading */

/* What to look for; only what was measured on `machine` when it is a timing. */
struct history_key {
	const char *check, *definition, *measure, *machine;
};

/* The nights of a measure, in order, since the check was last accepted: complete audits only. `*nights` has room for
 * one more; the caller frees it. */
bool history_nights(struct history *history, const struct history_key *key, struct night **nights, size_t *count,
					char error[STORE_ERROR]);

/* When an audit was and what of: "audit 12 of 2026-11-01T03:00:00Z, revision 39dc0da". Returns `when`. */
const char *history_when(struct history *history, int64_t audit, char when[80]);

/* How long a check took on this machine: the median of the last audits, or NaN. The key's measure does not matter. */
double history_seconds(struct history *history, const struct history_key *key);

/* One row of what there is to be seen of all audits, whatever became of them: audits in order, and in each its checks
 * and their measures in the order in which they were added. Texts last until the function returns. An audit without
 * checks is told with no check. */
struct history_row {
	int64_t audit;
	const char *date, *suite, *revision, *compiler, *machine, *state, *check, *measure, *finding;
	uint64_t seed;
	double seconds; /* of the audit, 0 while it runs */
	bool accepted;
	enum measure_worse worse;
	struct measurement measured;
};
bool history_read(struct history *history, void (*see)(void *context, const struct history_row *row), void *context,
				  char error[STORE_ERROR]);

#endif
