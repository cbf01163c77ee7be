/* The history as it lies in memory when pages are made of it. */
#ifndef VERIFY_AUDIT_TREND_LOG_H
#define VERIFY_AUDIT_TREND_LOG_H

#include <time.h>

#include "result.h"
#include "store/history.h"

/* One audit. */
struct trend_audit {
	int64_t number;
	time_t time;
	char date[24], *suite, *revision, *compiler, *machine, *state;
	uint64_t seed;
	double seconds;
	size_t measures, findings;
	bool paged; /* it has a page of its own */
};

/* What one of them found of one measure. */
struct trend_point {
	size_t audit; /* index into the audits */
	char *check, *measure, *finding, word[MEASURE_WORDS];
	enum measure_nature nature;
	double value, low, high;
	uint64_t count;
	bool accepted;
};

struct trend_log {
	struct trend_audit *audits;
	struct trend_point *points; /* in the order of the history */
	size_t audit_count, audit_room, point_count, point_room;
	bool failed; /* for want of memory */
};

/* Reads everything. False with a message; end with trend_log_free either way. */
bool trend_log_read(struct trend_log *log, struct history *history, char error[STORE_ERROR]);
void trend_log_free(struct trend_log *log);

/* The result of one check, NULL when there is no memory; `points` are its own. */
struct result *trend_of_check(const struct trend_log *log, const char *check);

/* "audit-12.html" where it has a page, "audits.html" where not. Returns `link`. */
const char *trend_link(const struct trend_audit *audit, char link[40]);

/* Adds "value, interval, count" to a table's row in hand, as numbers or, for a word, as text. */
void trend_cells(struct result_table table, const struct trend_point *point);

#endif
