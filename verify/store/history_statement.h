/* SQL statements of the history, prepared and bound. For the parts of the history only. */
#ifndef VERIFY_STORE_HISTORY_STATEMENT_H
#define VERIFY_STORE_HISTORY_STATEMENT_H

#include <sqlite3.h>

#include "store/history.h"

struct history {
	sqlite3 *database;
	char *path;
};

/* Says what went wrong in the database, and returns false. */
bool history_trouble(const struct history *history, char error[STORE_ERROR]);

/* A statement with its values in order: in `kinds` each is t (const char *, NULL allowed), i (int64_t) or d (double,
 * NaN becomes NULL). NULL with a message. End with sqlite3_finalize. */
sqlite3_stmt *history_statement(const struct history *history, char error[STORE_ERROR], const char *sql,
								const char *kinds, ...);

/* The same, carried out for what it changes. */
bool history_execute(const struct history *history, char error[STORE_ERROR], const char *sql, const char *kinds, ...);

#endif
