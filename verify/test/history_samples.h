/* A folder with a history in it, for tests of the history. */
#ifndef VERIFY_TEST_HISTORY_SAMPLES_H
#define VERIFY_TEST_HISTORY_SAMPLES_H

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmocka.h>

#include "store/history.h"
#include "test/folder.h"

static char *folder, path[200], error[STORE_ERROR];

static const struct history_audit usual = {"2026-11-22T03:00:00Z", "standard", "39dc0da", "gcc 12", "a machine", 7};
static const struct history_key key = {"dense", "as it is", "below", "a machine"};

static inline struct history *open_well(bool writing)
{
	struct history *history = history_open(path, writing, error);
	if (!history) fail_msg("%s", error);
	return history;
}

static inline void must(bool done)
{
	if (!done) fail_msg("%s", error);
}

/* One audit of one check, whole. */
static inline int64_t add_audit(struct history *history, const struct history_audit *audit,
								const struct history_measure *measures, size_t count, bool accepted, const char *state,
								const char *finding)
{
	int64_t id;
	const struct history_check check = {key.check, key.definition, audit->seed, 1.5, accepted, measures, count};
	const struct history_finding found = {key.check, measures->name, finding};
	must(history_begin(history, audit, &id, error) && history_add(history, id, &check, error) &&
		 history_end(history, id, state, 2, &found, finding != NULL, error));
	return id;
}

static inline void count_row(void *context, const struct history_row *row)
{
	*(unsigned *)context += row->measure != NULL;
}

static inline unsigned rows_of(void)
{
	struct history *history = open_well(false);
	unsigned rows = 0;
	must(history_read(history, count_row, &rows, error));
	history_close(history);
	return rows;
}

static inline int set_up(void **state)
{
	(void)state;
	folder = folder_new();
	snprintf(path, sizeof path, "%s/history.db", folder);
	return 0;
}

static inline int tear_down(void **state)
{
	(void)state;
	folder_remove(folder);
	return 0;
}

/* A test that finds the folder new, with no history in it. */
#define IN_FOLDER(test) cmocka_unit_test_setup_teardown(test, set_up, tear_down)

#endif
