#include "audit/audit.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "command/interrupt.h"
#include "command/progress.h"

static struct history_key key_of(const struct audit_plan *plan, const struct suite_check *check, const char *measure)
{
	return (struct history_key){check->name, check->definition, measure, plan->origin.machine};
}

/* ---- doing */

static void not_reached(const struct audit *audit, struct audit_check *one, double left)
{
	char took[32], were[32];
	one->state = AUDIT_NOT_REACHED;
	if (isnan(left))
		snprintf(one->reason, sizeof one->reason, "not reached: %s",
				 audit->interrupted ? "the audit was interrupted" : "the budget was over");
	else
		snprintf(one->reason, sizeof one->reason, "not reached: it takes about %s, and %s were left",
				 progress_duration(took, one->estimate), progress_duration(were, left));
}

/* Whether the check fits what is left of the budget, as far as that can be told. */
static bool fits(const struct audit *audit, struct audit_check *one, double began)
{
	const struct audit_plan *plan = audit->plan;
	if (!(plan->budget < INFINITY)) return true;
	struct history_key key = key_of(plan, one->check, "");
	one->estimate = plan->history ? history_seconds(plan->history, &key) : NAN;
	if (isnan(one->estimate)) one->estimate = check_estimate(one->check, one->seed, plan->threads);
	double left = plan->budget - (progress_clock() - began);
	if (!(one->estimate > left)) return true;
	not_reached(audit, one, left);
	return false;
}

/* The check's measures go into the history at once. */
static void store(struct audit *audit, const struct audit_check *one)
{
	const struct suite_check *check = one->check;
	struct history_measure *measures = calloc(check->measure_count, sizeof *measures);
	for (size_t m = 0; m < check->measure_count && measures; m++)
		measures[m] =
			(struct history_measure){check->measures[m].name, check->measures[m].worse, one->measures[m].measured};
	const struct history_check entry = {check->name,   check->definition, one->seed,           one->seconds,
										one->accepted, measures,          check->measure_count};
	if (!measures)
		snprintf(audit->trouble, sizeof audit->trouble, "out of memory");
	else
		history_add(audit->plan->history, audit->number, &entry, audit->trouble);
	free(measures);
}

static void run_check(struct audit *audit, struct audit_check *one, struct check_value *values, double began)
{
	const struct audit_plan *plan = audit->plan;
	char error[STORE_ERROR];
	if (!interrupted() && !fits(audit, one, began)) return;
	if (interrupted()) { /* perhaps only while it was tried how long it takes */
		audit->interrupted = !interrupted_by_time();
		not_reached(audit, one, NAN);
		return;
	}
	double clock = progress_clock();
	bool done = check_run(one->check, one->seed, 1, plan->threads, values, error);
	one->seconds = progress_clock() - clock;
	if (done) {
		one->state = AUDIT_DONE;
		for (size_t m = 0; m < one->check->measure_count; m++) one->measures[m].measured = values[m].measured;
		if (plan->history && !*audit->trouble) store(audit, one);
		return;
	}
	bool stopped = interrupted();
	audit->interrupted = stopped && !interrupted_by_time();
	one->state = stopped ? AUDIT_STOPPED : AUDIT_FAILED;
	snprintf(one->reason, sizeof one->reason, "%s",
			 !stopped             ? error
			 : audit->interrupted ? "stopped by a signal"
								  : "stopped: the budget was over");
}

static bool is_accepted(const struct audit_plan *plan, const char *name)
{
	bool accepted = false;
	for (size_t a = 0; a < plan->accepted_count; a++)
		accepted |= strcmp(plan->accepted[a], "all") == 0 || strcmp(plan->accepted[a], name) == 0;
	return accepted;
}

/* ---- judging */

/* Holds a measure against its thresholds and against the nights before. */
static void judge(struct audit *audit, const struct audit_check *one, struct audit_measure *measure,
				  const struct check_value *value)
{
	const struct audit_plan *plan = audit->plan;
	struct history_key key = key_of(plan, one->check, measure->asked->name);
	struct night *nights = NULL;
	size_t count = 0;
	if (plan->history && !one->accepted && !history_nights(plan->history, &key, &nights, &count, audit->trouble))
		count = 0;
	threshold_judge(measure->asked, value, nights, count, measure->fault);
	if (nights) {
		nights[count] = (struct night){audit->number, one->seed, true, measure->measured};
		measure->verdict = verdict_of(nights, count + 1, measure->asked->worse);
	}
	free(nights);
}

static void tell_regression(struct audit *audit, struct audit_measure *measure)
{
	char change[VERDICT_TEXT], when[80] = "tonight";
	const struct verdict *verdict = &measure->verdict;
	if (verdict->since != audit->number) history_when(audit->plan->history, verdict->since, when);
	verdict_change(verdict, change);
	if (verdict->now.nature == MEASURE_WORD)
		snprintf(measure->regression, AUDIT_TEXT, "%s, since %s", change, when);
	else
		snprintf(measure->regression, AUDIT_TEXT, "%s; since %s; of %zu and %zu nights; by chance %.2g", change, when,
				 verdict->nights, verdict->references, verdict->chance);
}

/* All measures together, so that the stated share of audits raises a false alarm, and no more. */
static void judge_together(struct audit *audit)
{
	const struct suite *suite = audit->plan->suite;
	size_t room = 0, count = 0;
	for (size_t c = 0; c < suite->check_count; c++) room += suite->checks[c].measure_count;
	struct verdict **verdicts = calloc(room + 1, sizeof *verdicts);
	for (size_t c = 0; c < suite->check_count && verdicts; c++)
		for (size_t m = 0; m < suite->checks[c].measure_count; m++)
			if (audit->checks[c].measures[m].verdict.compared)
				verdicts[count++] = &audit->checks[c].measures[m].verdict;
	if (verdicts) verdicts_judge(verdicts, count, suite->false_alarms);
	free(verdicts);
	for (size_t c = 0; c < suite->check_count; c++)
		for (size_t m = 0; m < suite->checks[c].measure_count; m++)
			if (audit->checks[c].measures[m].verdict.worse) tell_regression(audit, &audit->checks[c].measures[m]);
}

/* The last entry: how the audit ended, and which of its measures are no reference. */
static void finish(struct audit *audit)
{
	const struct suite *suite = audit->plan->suite;
	size_t room = 0, count = 0;
	for (size_t c = 0; c < suite->check_count; c++) room += suite->checks[c].measure_count;
	struct history_finding *findings = calloc(room + 1, sizeof *findings);
	for (size_t c = 0; c < suite->check_count && findings; c++)
		for (size_t m = 0; m < suite->checks[c].measure_count; m++) {
			const struct audit_measure *measure = &audit->checks[c].measures[m];
			const char *text = *measure->regression ? measure->regression : measure->fault;
			if (*text && audit->checks[c].state == AUDIT_DONE)
				findings[count++] = (struct history_finding){suite->checks[c].name, measure->asked->name, text};
		}
	if (findings)
		history_end(audit->plan->history, audit->number, audit->interrupted ? "interrupted" : "complete",
					audit->seconds, findings, count, audit->trouble);
	free(findings);
}

/* ---- together */

static bool prepare(struct audit *audit)
{
	const struct audit_plan *plan = audit->plan;
	audit->checks = calloc(plan->suite->check_count, sizeof *audit->checks);
	for (size_t c = 0; c < plan->suite->check_count && audit->checks; c++) {
		const struct suite_check *check = &plan->suite->checks[c];
		struct audit_check *one = &audit->checks[c];
		*one = (struct audit_check){.check = check,
									.seed = check_seed(check, plan->origin.seed),
									.estimate = NAN,
									.accepted = is_accepted(plan, check->name),
									.measures = calloc(check->measure_count, sizeof *one->measures)};
		if (!one->measures) return false;
		for (size_t m = 0; m < check->measure_count; m++) one->measures[m].asked = &check->measures[m];
	}
	return audit->checks;
}

bool audit_run(const struct audit_plan *plan, struct audit *audit, char error[STORE_ERROR])
{
	double began = progress_clock();
	*audit = (struct audit){.plan = plan};
	if (!prepare(audit)) {
		snprintf(error, STORE_ERROR, "out of memory");
		return false;
	}
	if (plan->history && !history_begin(plan->history, &plan->origin, &audit->number, error)) return false;
	interrupt_watch();
	if (plan->budget < INFINITY) interrupt_after(plan->budget);
	for (size_t c = 0; c < plan->suite->check_count; c++) {
		struct audit_check *one = &audit->checks[c];
		struct check_value *values = calloc(one->check->measure_count, sizeof *values);
		if (values) run_check(audit, one, values, began);
		for (size_t m = 0; values && one->state == AUDIT_DONE && m < one->check->measure_count; m++)
			judge(audit, one, &one->measures[m], &values[m]);
		if (!values) one->state = AUDIT_FAILED, snprintf(one->reason, sizeof one->reason, "out of memory");
		free(values);
	}
	judge_together(audit);
	audit->seconds = progress_clock() - began;
	if (plan->history && !*audit->trouble) finish(audit);
	return true;
}

void audit_free(struct audit *audit)
{
	for (size_t c = 0; audit->checks && c < audit->plan->suite->check_count; c++) free(audit->checks[c].measures);
	free(audit->checks);
}

size_t audit_count(const struct audit *audit, enum audit_state state)
{
	size_t count = 0;
	for (size_t c = 0; c < audit->plan->suite->check_count; c++) count += audit->checks[c].state == state;
	return count;
}

bool audit_finding(const struct audit *audit)
{
	bool found = audit_count(audit, AUDIT_FAILED) > 0;
	for (size_t c = 0; c < audit->plan->suite->check_count; c++)
		for (size_t m = 0; m < audit->checks[c].check->measure_count; m++)
			found |= *audit->checks[c].measures[m].fault || *audit->checks[c].measures[m].regression;
	return found;
}
