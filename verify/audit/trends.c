#include "audit/trends.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

#include "audit/trend_log.h"

static bool write_result(struct result *result, const char *folder, char error[REPORT_ERROR])
{
	if (!result) snprintf(error, REPORT_ERROR, "out of memory");
	bool written = result && result_write(result, folder, error);
	result_free(result);
	return written;
}

/* Pages for the last audit and the last of those that found something. */
static void choose_pages(struct trend_log *log)
{
	size_t chosen = 0;
	for (size_t a = log->audit_count; a-- > 0 && chosen < TREND_PAGES;)
		if (log->audits[a].findings || a + 1 == log->audit_count) log->audits[a].paged = true, chosen++;
}

/* All audits, the last first, and everything that was found. */
static struct result *overview(const struct trend_log *log)
{
	static const char *const audit_columns[] = {"audit",    "date",    "state",    "suite",    "seed",    "revision",
												"compiler", "machine", "measures", "findings", "seconds", NULL};
	static const char *const finding_columns[] = {"audit", "date", "revision", "check", "measure", "finding", NULL};
	struct result *result = result_new("audits", "Audits");
	if (!result) return NULL;
	size_t findings = 0;
	for (size_t a = 0; a < log->audit_count; a++) findings += log->audits[a].findings > 0;
	result_paragraph(result, "%zu audits, %zu of them with findings.", log->audit_count, findings);
	struct result_table found = result_table(result, "Findings", "The last first.", finding_columns);
	for (size_t p = log->point_count; p-- > 0;) {
		const struct trend_point *point = &log->points[p];
		const struct trend_audit *audit = &log->audits[point->audit];
		if (!point->finding) continue;
		table_row(found);
		table_text(found, "%" PRId64, audit->number);
		table_text(found, "%.10s", audit->date);
		table_text(found, "%s", audit->revision);
		table_text(found, "%s", point->check);
		table_text(found, "%s", point->measure);
		table_text(found, "%s", point->finding);
	}
	struct result_table table = result_table(result, "All audits", "The last first.", audit_columns);
	for (size_t a = log->audit_count; a-- > 0;) {
		const struct trend_audit *audit = &log->audits[a];
		table_row(table);
		table_text(table, "%" PRId64, audit->number);
		table_text(table, "%s", audit->date);
		table_text(table, "%s", audit->state);
		table_text(table, "%s", audit->suite);
		table_text(table, "%" PRIu64, audit->seed);
		table_text(table, "%s", audit->revision);
		table_text(table, "%s", audit->compiler);
		table_text(table, "%s", audit->machine);
		table_count(table, audit->measures);
		table_count(table, audit->findings);
		table_number(table, audit->seconds);
	}
	return result;
}

/* One audit with all it measured. */
static struct result *page_of(const struct trend_log *log, size_t a)
{
	static const char *const columns[] = {"check", "measure", "value", "low", "high", "count", "finding", NULL};
	const struct trend_audit *audit = &log->audits[a];
	char name[40], title[60], command[160];
	snprintf(name, sizeof name, "audit-%" PRId64, audit->number);
	snprintf(title, sizeof title, "Audit %" PRId64 " of %.10s", audit->number, audit->date);
	struct result *result = result_new(name, title);
	if (!result) return NULL;
	result_paragraph(result, "%s, by seed %" PRIu64 ": %zu measures, %zu findings. Revision %s, %s, on %s.",
					 audit->suite, audit->seed, audit->measures, audit->findings,
					 *audit->revision ? audit->revision : "unknown", audit->compiler, audit->machine);
	if (strcmp(audit->state, "complete") != 0)
		result_incomplete(result, "The audit is %s; no later one is held against it.", audit->state);
	struct result_table table =
		result_table(result, "What it found",
					 "Proportions and rates with 95 % intervals, other values with their quartiles.", columns);
	for (size_t p = 0; p < log->point_count; p++) {
		const struct trend_point *point = &log->points[p];
		if (point->audit != a) continue;
		table_row(table);
		table_text(table, "%s", point->check);
		table_text(table, "%s", point->measure);
		trend_cells(table, point);
		table_text(table, "%s", point->finding ? point->finding : "");
	}
	snprintf(command, sizeof command, "touchstone audit --suite %.80s --seed %" PRIu64, audit->suite, audit->seed);
	result_made_by(result, command, audit->seconds, *audit->revision ? audit->revision : NULL);
	return result;
}

static bool write_all(struct trend_log *log, const char *folder, char error[REPORT_ERROR])
{
	choose_pages(log);
	bool good = write_result(overview(log), folder, error);
	for (size_t a = 0; good && a < log->audit_count; a++)
		if (log->audits[a].paged) good = write_result(page_of(log, a), folder, error);
	for (size_t p = 0; good && p < log->point_count; p++) { /* each check where it comes up first */
		bool first = true;
		for (size_t q = 0; q < p && first; q++) first = strcmp(log->points[q].check, log->points[p].check) != 0;
		if (first) good = write_result(trend_of_check(log, log->points[p].check), folder, error);
	}
	return good;
}

bool trends_write(struct history *history, const char *folder, char error[REPORT_ERROR])
{
	struct trend_log log;
	bool good = trend_log_read(&log, history, error) && aside_folder(folder, error) && write_all(&log, folder, error);
	trend_log_free(&log);
	return good;
}
