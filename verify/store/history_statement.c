#include "store/history_statement.h"

#include <stdarg.h>
#include <stdio.h>

bool history_trouble(const struct history *history, char error[STORE_ERROR])
{
	int code = sqlite3_errcode(history->database) & 0xff;
	const char *what = code == SQLITE_FULL || code == SQLITE_IOERR || code == SQLITE_READONLY ? "cannot be written"
					   : code == SQLITE_CORRUPT                                               ? "is damaged"
					   : code == SQLITE_BUSY || code == SQLITE_LOCKED                         ? "stays in use"
																							  : "cannot be used";
	snprintf(error, STORE_ERROR, "%.200s: %s: %.200s", history->path, what, sqlite3_errmsg(history->database));
	text_one_line(error);
	return false;
}

static sqlite3_stmt *prepare(const struct history *history, char error[STORE_ERROR], const char *sql, const char *kinds,
							 va_list values)
{
	sqlite3_stmt *statement;
	if (sqlite3_prepare_v2(history->database, sql, -1, &statement, NULL) != SQLITE_OK) {
		history_trouble(history, error);
		return NULL;
	}
	for (int place = 1; *kinds; kinds++, place++) {
		if (*kinds == 't')
			sqlite3_bind_text(statement, place, va_arg(values, const char *), -1, SQLITE_TRANSIENT);
		else if (*kinds == 'i')
			sqlite3_bind_int64(statement, place, va_arg(values, int64_t));
		else
			sqlite3_bind_double(statement, place, va_arg(values, double));
	}
	return statement;
}

sqlite3_stmt *history_statement(const struct history *history, char error[STORE_ERROR], const char *sql,
								const char *kinds, ...)
{
	va_list values;
	va_start(values, kinds);
	sqlite3_stmt *statement = prepare(history, error, sql, kinds, values);
	va_end(values);
	return statement;
}

bool history_execute(const struct history *history, char error[STORE_ERROR], const char *sql, const char *kinds, ...)
{
	va_list values;
	va_start(values, kinds);
	sqlite3_stmt *statement = prepare(history, error, sql, kinds, values);
	va_end(values);
	if (!statement) return false;
	bool done = sqlite3_step(statement) == SQLITE_DONE || history_trouble(history, error);
	sqlite3_finalize(statement);
	return done;
}
