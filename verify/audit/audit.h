/* An audit: the checks of a suite, the most telling first, until the budget is over; then every measure is held against
 * its thresholds and against the history. */
#ifndef VERIFY_AUDIT_AUDIT_H
#define VERIFY_AUDIT_AUDIT_H

#include <jansson.h>
#include <stdio.h>

#include "audit/check.h"
#include "store/history.h"

/* What is to be done. All belongs to the caller. */
struct audit_plan {
	const struct suite *suite;
	struct history *history;     /* to be held against and added to, or NULL */
	struct history_audit origin; /* its seed is the audit's */
	double budget;               /* seconds; INFINITY for as long as it takes */
	int threads;                 /* no number but a timing depends on it */
	const char *const *accepted; /* checks whose measures now are what they should be; "all" is all */
	size_t accepted_count;
};

enum audit_state {
	AUDIT_DONE,
	AUDIT_STOPPED,     /* on the way, by the budget or a signal: nothing of it is kept */
	AUDIT_NOT_REACHED, /* not begun */
	AUDIT_FAILED,      /* it cannot be done */
};

enum { AUDIT_TEXT = 400 };

struct audit_measure {
	const struct suite_measure *asked;
	struct measurement measured;
	struct verdict verdict;
	char fault[AUDIT_TEXT];      /* which threshold is not kept; "" when all are */
	char regression[AUDIT_TEXT]; /* what got worse, by how much and since when; "" when nothing did */
};

struct audit_check {
	const struct suite_check *check;
	enum audit_state state;
	uint64_t seed;
	double seconds, estimate; /* it took; it was expected to take, or NaN */
	bool accepted;
	char reason[STORE_ERROR]; /* why it is not done */
	struct audit_measure *measures;
};

struct audit {
	const struct audit_plan *plan;
	int64_t number; /* in the history; 0 without one */
	double seconds;
	bool interrupted;           /* by a signal */
	struct audit_check *checks; /* as many as the suite has, and in its order */
	char trouble[STORE_ERROR];  /* why the history does not have it all; "" when it has */
};

/* Does it. Each check is in the history as soon as it is done. False with a message when it could not begin; end with
 * audit_free either way. */
bool audit_run(const struct audit_plan *plan, struct audit *audit, char error[STORE_ERROR]);
void audit_free(struct audit *audit);

/* Whether there is something to be woken for: a regression, a threshold that is not kept, a check that failed. */
bool audit_finding(const struct audit *audit);

/* How many checks are in a state. */
size_t audit_count(const struct audit *audit, enum audit_state state);

/* Whether a measure has a threshold of its own, whatever nights there were before. */
bool threshold_asks(const struct suite_measure *asked);

/* What is wrong with a value by its thresholds, given the nights before; `fault` is "" when nothing is. */
void threshold_judge(const struct suite_measure *asked, const struct check_value *value, const struct night *nights,
					 size_t night_count, char fault[AUDIT_TEXT]);

/* ---- telling */

/* For people: all measures, then what is wrong and what was not reached. */
void audit_print(FILE *stream, const struct audit *audit);

/* As JSON (touchstone-audit-1), owned by the caller: one object,
 *
 *	schema, suite, title, date, seed, revision, compiler, machine (text), false_alarms (stated), budget_seconds (may be
 *	missing), seconds, state (complete, interrupted), audit (number in the history; may be missing)
 *	tests, failures, errors, skipped    measures: all, those with a finding, of failed checks, of checks not done
 *	checks          [{check, definition, seed, state (done, stopped, not reached, failed), reason, seconds, measures}]
 *	and of these    [{measure, unit, nature, seconds (its share), value or word, interval, count, worse (which way),
 *	                fault, regression, finding (both of them), unreached, error (texts; may be missing), shown (for
 *people), chance, nights, references, before, since (audit): how it was compared; may be missing}] */
json_t *audit_json(const struct audit *audit);

#endif
