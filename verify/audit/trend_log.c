#include "audit/trend_log.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Room for one more; NULL when there is none. */
static void *grow(void *list, size_t count, size_t *room, size_t size)
{
	if (count < *room) return list;
	void *more = reallocarray(list, 2 * *room + 64, size);
	if (more) *room = 2 * *room + 64;
	return more;
}

static time_t time_of(const char *date)
{
	struct tm parts = {0};
	return strptime(date, "%Y-%m-%dT%H:%M:%S", &parts) ? timegm(&parts) : 0;
}

static bool add_audit(struct trend_log *log, const struct history_row *row)
{
	struct trend_audit *audits = grow(log->audits, log->audit_count, &log->audit_room, sizeof *audits);
	if (!audits) return false;
	log->audits = audits;
	struct trend_audit *audit = &audits[log->audit_count++];
	*audit = (struct trend_audit){
		.number = row->audit,
		.time = time_of(row->date),
		.suite = strdup(row->suite),
		.revision = strdup(row->revision),
		.compiler = strdup(row->compiler),
		.machine = strdup(row->machine),
		.state = strdup(row->state),
		.seed = row->seed,
		.seconds = row->seconds,
	};
	snprintf(audit->date, sizeof audit->date, "%.20s", row->date);
	return audit->suite && audit->revision && audit->compiler && audit->machine && audit->state;
}

static bool add_point(struct trend_log *log, const struct history_row *row)
{
	struct trend_point *points = grow(log->points, log->point_count, &log->point_room, sizeof *points);
	if (!points) return false;
	log->points = points;
	struct trend_point *point = &points[log->point_count++];
	*point = (struct trend_point){
		.audit = log->audit_count - 1,
		.check = strdup(row->check),
		.measure = strdup(row->measure),
		.finding = row->finding ? strdup(row->finding) : NULL,
		.nature = row->measured.nature,
		.value = row->measured.value,
		.low = row->measured.low,
		.high = row->measured.high,
		.count = row->measured.count,
		.accepted = row->accepted,
	};
	memcpy(point->word, row->measured.word, sizeof point->word);
	struct trend_audit *audit = &log->audits[point->audit];
	audit->measures++;
	audit->findings += row->finding != NULL;
	return point->check && point->measure && (point->finding || !row->finding);
}

static void see(void *context, const struct history_row *row)
{
	struct trend_log *log = context;
	bool known = log->audit_count > 0 && log->audits[log->audit_count - 1].number == row->audit;
	if (!log->failed && !known) log->failed = !add_audit(log, row);
	if (!log->failed && row->measure) log->failed = !add_point(log, row);
}

bool trend_log_read(struct trend_log *log, struct history *history, char error[STORE_ERROR])
{
	*log = (struct trend_log){0};
	if (!history_read(history, see, log, error)) return false;
	if (log->failed) snprintf(error, STORE_ERROR, "no memory for the history");
	return !log->failed;
}

void trend_log_free(struct trend_log *log)
{
	for (size_t a = 0; a < log->audit_count; a++) {
		struct trend_audit *audit = &log->audits[a];
		char *const texts[] = {audit->suite, audit->revision, audit->compiler, audit->machine, audit->state};
		for (int t = 0; t < 5; t++) free(texts[t]);
	}
	for (size_t p = 0; p < log->point_count; p++) {
		free(log->points[p].check);
		free(log->points[p].measure);
		free(log->points[p].finding);
	}
	free(log->audits);
	free(log->points);
}

const char *trend_link(const struct trend_audit *audit, char link[40])
{
	if (audit->paged)
		snprintf(link, 40, "audit-%lld.html", (long long)audit->number);
	else
		snprintf(link, 40, "audits.html");
	return link;
}

void trend_cells(struct result_table table, const struct trend_point *point)
{
	if (point->nature == MEASURE_WORD) {
		table_text(table, "%s", point->word);
	} else {
		table_number(table, point->value);
	}
	table_number(table, point->low);
	table_number(table, point->high);
	table_count(table, point->count);
}
