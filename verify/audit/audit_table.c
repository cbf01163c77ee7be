/* An audit as people read it. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "audit/audit.h"
#include "command/progress.h"

/* How a measure stands to the nights before. */
static void print_standing(FILE *stream, const struct audit_check *one, const struct audit_measure *measure)
{
	const struct verdict *verdict = &measure->verdict;
	if (one->accepted)
		fputs("accepted", stream);
	else if (!verdict->compared)
		fputs("no earlier audit to hold it against", stream);
	else if (measure->measured.nature == MEASURE_WORD)
		fputs(verdict->worse ? "not what it was" : "as it was", stream);
	else
		fprintf(stream, "%s, by chance %.2g, over %zu night%s", verdict->worse ? "worse" : "as it was", verdict->chance,
				verdict->references, verdict->references == 1 ? "" : "s");
}

static void print_check(FILE *stream, const struct audit *audit, const struct audit_check *one)
{
	char took[32], text[MEASUREMENT_TEXT];
	if (one->state != AUDIT_DONE) {
		fprintf(stream, "%s: %s\n", one->check->name, one->reason);
		return;
	}
	fprintf(stream, "%s, %s\n", one->check->name, progress_duration(took, one->seconds));
	for (size_t m = 0; m < one->check->measure_count; m++) {
		const struct audit_measure *measure = &one->measures[m];
		bool wrong = *measure->fault || *measure->regression;
		fprintf(stream, "  %c %-22s  %s", wrong ? '!' : ' ', measure->asked->name,
				measurement_text(&measure->measured, text));
		if (threshold_asks(measure->asked) && !*measure->fault) fputs("; as asked for", stream);
		if (audit->plan->history) fputs("; ", stream), print_standing(stream, one, measure);
		fputc('\n', stream);
	}
}

static void print_findings(FILE *stream, const struct audit *audit)
{
	fputc('\n', stream);
	for (size_t c = 0; c < audit->plan->suite->check_count; c++) {
		const struct audit_check *one = &audit->checks[c];
		if (one->state == AUDIT_FAILED) fprintf(stream, "failed: %s: %s\n", one->check->name, one->reason);
		for (size_t m = 0; m < one->check->measure_count; m++) {
			const struct audit_measure *measure = &one->measures[m];
			const char *name = measure->asked->name;
			if (*measure->fault) fprintf(stream, "threshold: %s: %s: %s\n", one->check->name, name, measure->fault);
			if (*measure->regression)
				fprintf(stream, "regression: %s: %s: %s\n", one->check->name, name, measure->regression);
		}
	}
}

void audit_print(FILE *stream, const struct audit *audit)
{
	const struct suite *suite = audit->plan->suite;
	char took[32];
	for (size_t c = 0; c < suite->check_count; c++) print_check(stream, audit, &audit->checks[c]);
	if (audit_finding(audit)) print_findings(stream, audit);
	size_t done = audit_count(audit, AUDIT_DONE);
	fprintf(stream, "\n%s, seed %llu: %zu of %zu checks in %s, %s", suite->name,
			(unsigned long long)audit->plan->origin.seed, done, suite->check_count,
			progress_duration(took, audit->seconds),
			audit_finding(audit) ? "with findings"
			: done               ? "all well"
								 : "nothing was done");
	if (audit->plan->history)
		fprintf(stream, "; audit %lld%s; false alarms stated at %g an audit", (long long)audit->number,
				audit->interrupted ? ", interrupted, is no reference" : "", suite->false_alarms);
	fputc('\n', stream);
}
