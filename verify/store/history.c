#include "store/history.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "store/history_statement.h"

/* Samples are decimal numbers with 17 digits, parted by blanks. Ids ascend in order of time. */
static const char schema[] =
	"CREATE TABLE audit (id INTEGER PRIMARY KEY AUTOINCREMENT, date TEXT NOT NULL, suite TEXT NOT NULL, revision TEXT,"
	"  compiler TEXT, machine TEXT, seed INTEGER NOT NULL, seconds REAL,"
	"  state TEXT NOT NULL CHECK (state IN ('running', 'complete', 'interrupted'))) STRICT;"
	"CREATE TABLE checked (id INTEGER PRIMARY KEY AUTOINCREMENT, audit INTEGER NOT NULL REFERENCES audit,"
	"  name TEXT NOT NULL, definition TEXT NOT NULL, seed INTEGER NOT NULL, seconds REAL NOT NULL, accepted INTEGER "
	"NOT NULL,"
	"  UNIQUE (audit, name)) STRICT;"
	"CREATE TABLE measure (id INTEGER PRIMARY KEY, checked INTEGER NOT NULL REFERENCES checked, name TEXT NOT NULL,"
	"  nature TEXT NOT NULL, worse TEXT NOT NULL, value REAL, low REAL, high REAL, count INTEGER NOT NULL, hits REAL,"
	"  exposure REAL, samples TEXT, word TEXT, finding TEXT, UNIQUE (checked, name)) STRICT;"
	"CREATE INDEX checked_by_name ON checked (name);";

/* The one whole number a query gives, or -1 with a message. */
static int64_t number(const struct history *history, const char *sql, char error[STORE_ERROR])
{
	sqlite3_stmt *statement = history_statement(history, error, sql, "");
	if (!statement) return -1;
	bool there = sqlite3_step(statement) == SQLITE_ROW || history_trouble(history, error);
	int64_t number = there ? sqlite3_column_int64(statement, 0) : -1;
	sqlite3_finalize(statement);
	return number;
}

static bool refuse(const struct history *history, char error[STORE_ERROR], const char *what)
{
	snprintf(error, STORE_ERROR, "%.200s: %.100s; accepted: a history that `touchstone audit` wrote, or a new file",
			 history->path, what);
	return false;
}

/* Write-ahead logging is switched on by whoever is alone with the file for a moment; SQLite does not wait for that. */
static bool log_ahead(const struct history *history, char error[STORE_ERROR])
{
	for (int tried = 0;; tried++) {
		int code = sqlite3_exec(history->database, "PRAGMA journal_mode = WAL", NULL, NULL, NULL);
		if (code == SQLITE_OK) return true;
		if (code != SQLITE_BUSY || tried == 100 * HISTORY_PATIENCE) return history_trouble(history, error);
		usleep(10000);
	}
}

/* Whether nothing has been stored in the database yet; false also when it is none. */
static bool is_new(const struct history *history)
{
	char error[STORE_ERROR];
	return number(history, "SELECT count(*) FROM sqlite_schema", error) == 0 &&
		   number(history, "PRAGMA application_id", error) == 0;
}

/* Makes the tables unless another program just did. */
static bool create(const struct history *history, char error[STORE_ERROR])
{
	char *sql = sqlite3_mprintf("%s PRAGMA application_id = %d; PRAGMA user_version = %d;", schema, HISTORY_APPLICATION,
								HISTORY_VERSION);
	bool good = sql && log_ahead(history, error) && history_execute(history, error, "BEGIN IMMEDIATE", "");
	if (good && is_new(history))
		good = sqlite3_exec(history->database, sql, NULL, NULL, NULL) == SQLITE_OK || history_trouble(history, error);
	sqlite3_free(sql);
	return good && history_execute(history, error, "COMMIT", "");
}

/* Whether the file has all its pages. While there is a log beside it, those that are missing may be in there. */
static bool is_long_enough(const struct history *history, char error[STORE_ERROR])
{
	struct stat there, log;
	char *name = sqlite3_mprintf("%s-wal", history->path);
	bool logged = !name || (stat(name, &log) == 0 && log.st_size > 0);
	sqlite3_free(name);
	int64_t pages = number(history, "PRAGMA page_count", error), size = number(history, "PRAGMA page_size", error);
	if (pages < 0 || size < 0) return false;
	if (logged || stat(history->path, &there) != 0 || there.st_size >= pages * size) return true;
	snprintf(error, STORE_ERROR, "%.200s: is damaged: %lld of its %lld bytes are missing", history->path,
			 (long long)(pages * size - there.st_size), (long long)(pages * size));
	return false;
}

/* Whether the file is a history, and whole. */
static bool examine(const struct history *history, char error[STORE_ERROR])
{
	char what[100];
	int64_t application = number(history, "PRAGMA application_id", error);
	if (application < 0 && sqlite3_errcode(history->database) == SQLITE_NOTADB)
		return refuse(history, error, "is no database");
	if (application < 0) return false;
	int64_t version = number(history, "PRAGMA user_version", error);
	if (application != HISTORY_APPLICATION) return refuse(history, error, "is a database of something else");
	snprintf(what, sizeof what, "is of version %lld, and this program knows version %d", (long long)version,
			 HISTORY_VERSION);
	if (version != HISTORY_VERSION) return refuse(history, error, what);
	if (!is_long_enough(history, error)) return false;
	sqlite3_stmt *statement = history_statement(history, error, "PRAGMA quick_check(1)", "");
	if (!statement) return false;
	bool there = sqlite3_step(statement) == SQLITE_ROW || history_trouble(history, error);
	const char *said = there ? (const char *)sqlite3_column_text(statement, 0) : NULL;
	bool whole = said && strcmp(said, "ok") == 0;
	if (there && !whole) snprintf(error, STORE_ERROR, "%.200s: is damaged: %.200s", history->path, said ? said : "?");
	if (!whole) text_one_line(error);
	sqlite3_finalize(statement);
	return whole;
}

static bool connect(struct history *history, bool writing, char error[STORE_ERROR])
{
	struct stat there;
	bool absent = stat(history->path, &there) != 0;
	if (absent && (errno != ENOENT || !writing)) {
		snprintf(error, STORE_ERROR, "%.200s: cannot be read: %s", history->path, strerror(errno));
		return false;
	}
	if (!absent && !S_ISREG(there.st_mode)) return refuse(history, error, "is no file");
	int flags = writing ? SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE : SQLITE_OPEN_READONLY;
	if (sqlite3_open_v2(history->path, &history->database, flags, NULL) != SQLITE_OK)
		return history_trouble(history, error);
	sqlite3_busy_timeout(history->database, 1000 * HISTORY_PATIENCE);
	if (writing && sqlite3_db_readonly(history->database, "main") == 1) {
		snprintf(error, STORE_ERROR, "%.200s: cannot be written: it is read-only", history->path);
		return false;
	}
	if (!writing && there.st_size == 0) return refuse(history, error, "is empty");
	return !writing || !is_new(history) || create(history, error);
}

struct history *history_open(const char *path, bool writing, char error[STORE_ERROR])
{
	struct history *history = calloc(1, sizeof *history);
	if (history) history->path = strdup(path);
	if (!history || !history->path)
		snprintf(error, STORE_ERROR, "out of memory");
	else if (connect(history, writing, error) && examine(history, error) &&
			 (!writing || history_execute(history, error, "PRAGMA synchronous = FULL", "")))
		return history;
	history_close(history);
	return NULL;
}

void history_close(struct history *history)
{
	if (!history) return;
	sqlite3_close(history->database);
	free(history->path);
	free(history);
}
