#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "store/history_statement.h"

/* The columns of a measurement, in the order in which read_measurement expects them. */
#define MEASURED "m.nature, m.value, m.low, m.high, m.count, m.hits, m.exposure, m.samples, m.word"

static double real(sqlite3_stmt *statement, int column)
{
	return sqlite3_column_type(statement, column) == SQLITE_NULL ? NAN : sqlite3_column_double(statement, column);
}

static const char *text(sqlite3_stmt *statement, int column)
{
	const char *text = (const char *)sqlite3_column_text(statement, column);
	return text ? text : "";
}

/* Whatever stands in the file: what is no measurement becomes a word of nothing. */
static struct measurement read_measurement(sqlite3_stmt *statement, int column)
{
	struct measurement measured = {0};
	if (!nature_named(text(statement, column), &measured.nature)) return measurement_word("");
	measured.value = real(statement, column + 1);
	measured.low = real(statement, column + 2);
	measured.high = real(statement, column + 3);
	measured.count = (uint64_t)sqlite3_column_int64(statement, column + 4);
	measured.hits = sqlite3_column_double(statement, column + 5);
	measured.exposure = sqlite3_column_double(statement, column + 6);
	const char *samples = text(statement, column + 7);
	for (char *end; *samples; samples = end) {
		double value = strtod(samples, &end);
		if (end == samples) break;
		sample_add(&measured.sample, value);
	}
	strncpy(measured.word, text(statement, column + 8), sizeof measured.word - 1);
	return measured;
}

/* Whether the counts are such as can be: those of a file that others wrote may not be. */
static bool sound(const struct measurement *measured)
{
	bool proportion = measured->nature == MEASURE_PROPORTION;
	bool counted = proportion || measured->nature == MEASURE_RATE;
	if (!counted) return true;
	return measured->hits >= 0 && measured->hits <= 0x1p53 && measured->hits == floor(measured->hits) &&
		   measured->exposure > 0 && measured->exposure <= 0x1p53 &&
		   (!proportion || (measured->hits <= measured->exposure && measured->exposure == floor(measured->exposure)));
}

/* Room for the night in hand and one more. */
static bool make_room(struct night **nights, size_t count, size_t *room)
{
	if (count + 2 <= *room) return true;
	struct night *more = reallocarray(*nights, *room = 2 * *room + 64, sizeof *more);
	if (more) *nights = more;
	return more;
}

bool history_nights(struct history *history, const struct history_key *key, struct night **nights, size_t *count,
					char error[STORE_ERROR])
{
	sqlite3_stmt *statement = history_statement(
		history, error,
		"SELECT a.id, c.seed, m.finding IS NULL, " MEASURED " FROM checked c JOIN audit a ON a.id = c.audit"
		" JOIN measure m ON m.checked = c.id WHERE c.name = ?1 AND c.definition = ?2 AND m.name = ?3"
		" AND a.state = 'complete' AND (m.nature <> 'timing' OR a.machine = ?4) AND c.id >= ifnull((SELECT max(b.id)"
		" FROM checked b JOIN audit o ON o.id = b.audit WHERE b.name = ?1 AND b.accepted AND o.state = 'complete'), 0)"
		" ORDER BY a.id",
		"tttt", key->check, key->definition, key->measure, key->machine);
	size_t room = 0;
	*nights = NULL, *count = 0;
	if (!statement) return false;
	int step = SQLITE_NOMEM;
	while (make_room(nights, *count, &room) && (step = sqlite3_step(statement)) == SQLITE_ROW) {
		struct night *night = &(*nights)[*count];
		*night = (struct night){.audit = sqlite3_column_int64(statement, 0),
								.seed = (uint64_t)sqlite3_column_int64(statement, 1),
								.good = sqlite3_column_int(statement, 2),
								.measured = read_measurement(statement, 3)};
		*count += sound(&night->measured);
	}
	if (step != SQLITE_DONE) history_trouble(history, error);
	sqlite3_finalize(statement);
	return step == SQLITE_DONE;
}

const char *history_when(struct history *history, int64_t audit, char when[80])
{
	char error[STORE_ERROR];
	sqlite3_stmt *statement =
		history_statement(history, error, "SELECT date, revision FROM audit WHERE id = ?", "i", audit);
	bool there = statement && sqlite3_step(statement) == SQLITE_ROW;
	const char *revision = there ? text(statement, 1) : "";
	snprintf(when, 80, "audit %lld of %.20s%s%.20s", (long long)audit, there ? text(statement, 0) : "?",
			 *revision ? ", revision " : "", revision);
	sqlite3_finalize(statement);
	return when;
}

double history_seconds(struct history *history, const struct history_key *key)
{
	char error[STORE_ERROR];
	struct sample sample = {0};
	sqlite3_stmt *statement =
		history_statement(history, error,
						  "SELECT c.seconds FROM checked c JOIN audit a ON a.id = c.audit WHERE c.name = ?"
						  " AND c.definition = ? AND a.machine = ? ORDER BY c.id DESC LIMIT 5",
						  "ttt", key->check, key->definition, key->machine);
	while (statement && sqlite3_step(statement) == SQLITE_ROW) sample_add(&sample, sqlite3_column_double(statement, 0));
	sqlite3_finalize(statement);
	return spread_of(&sample).median;
}

bool history_read(struct history *history, void (*see)(void *context, const struct history_row *row), void *context,
				  char error[STORE_ERROR])
{
	sqlite3_stmt *statement = history_statement(
		history, error,
		"SELECT a.id, a.date, a.suite, a.revision, a.compiler, a.machine, a.state, a.seed, a.seconds, c.name,"
		" c.accepted, m.name, m.worse, m.finding, " MEASURED " FROM audit a LEFT JOIN checked c ON c.audit = a.id"
		" LEFT JOIN measure m ON m.checked = c.id ORDER BY a.id, c.id, m.id",
		"");
	if (!statement) return false;
	int step;
	while ((step = sqlite3_step(statement)) == SQLITE_ROW) {
		struct history_row row = {
			.audit = sqlite3_column_int64(statement, 0),
			.date = text(statement, 1),
			.suite = text(statement, 2),
			.revision = text(statement, 3),
			.compiler = text(statement, 4),
			.machine = text(statement, 5),
			.state = text(statement, 6),
			.seed = (uint64_t)sqlite3_column_int64(statement, 7),
			.seconds = sqlite3_column_double(statement, 8),
			.check = (const char *)sqlite3_column_text(statement, 9),
			.accepted = sqlite3_column_int(statement, 10),
			.measure = (const char *)sqlite3_column_text(statement, 11),
			.finding = (const char *)sqlite3_column_text(statement, 13),
			.measured = read_measurement(statement, 14),
		};
		if (!worse_named(text(statement, 12), &row.worse)) row.worse = WORSE_EITHER;
		see(context, &row);
	}
	if (step != SQLITE_DONE) history_trouble(history, error);
	sqlite3_finalize(statement);
	return step == SQLITE_DONE;
}
