#include <stdio.h>
#include <stdlib.h>

#include "store/history_statement.h"

static bool begin(const struct history *history, char error[STORE_ERROR])
{
	return history_execute(history, error, "BEGIN IMMEDIATE", "");
}

/* All or nothing. */
static bool finish(const struct history *history, bool good, char error[STORE_ERROR])
{
	if (good && history_execute(history, error, "COMMIT", "")) return true;
	sqlite3_exec(history->database, "ROLLBACK", NULL, NULL, NULL);
	return false;
}

bool history_begin(struct history *history, const struct history_audit *audit, int64_t *id, char error[STORE_ERROR])
{
	bool begun = history_execute(history, error,
								 "INSERT INTO audit (date, suite, revision, compiler, machine, seed, state)"
								 " VALUES (?, ?, ?, ?, ?, ?, 'running')",
								 "ttttti", audit->date, audit->suite, audit->revision, audit->compiler, audit->machine,
								 (int64_t)audit->seed);
	*id = sqlite3_last_insert_rowid(history->database);
	return begun;
}

/* To be freed; NULL when there is no memory. */
static char *sample_text(const struct sample *sample)
{
	char *text = NULL;
	size_t size;
	FILE *stream = open_memstream(&text, &size);
	for (size_t k = 0; stream && k < sample->count; k++) fprintf(stream, "%s%.17g", k ? " " : "", sample->value[k]);
	if (stream) fclose(stream);
	return text;
}

static bool add_measure(const struct history *history, int64_t checked, const struct history_measure *measure,
						char error[STORE_ERROR])
{
	const struct measurement *measured = &measure->measured;
	bool counted = measured->nature == MEASURE_PROPORTION || measured->nature == MEASURE_RATE;
	char *samples = measured->sample.count ? sample_text(&measured->sample) : NULL;
	bool added = history_execute(
		history, error,
		"INSERT INTO measure (checked, name, nature, worse, value, low, high, count, hits, exposure, samples, word)"
		" VALUES (?, ?, ?, ?, ?, ?, ?, ?, iif(?, ?, NULL), iif(?, ?, NULL), ?, ?)",
		"itttdddiididtt", checked, measure->name, nature_name(measured->nature), worse_name(measure->worse),
		measured->value, measured->low, measured->high, (int64_t)measured->count, (int64_t)counted, measured->hits,
		(int64_t)counted, measured->exposure, samples, measured->nature == MEASURE_WORD ? measured->word : NULL);
	free(samples);
	return added;
}

bool history_add(struct history *history, int64_t audit, const struct history_check *check, char error[STORE_ERROR])
{
	if (!begin(history, error)) return false;
	bool good = history_execute(
		history, error,
		"INSERT INTO checked (audit, name, definition, seed, seconds, accepted) VALUES (?, ?, ?, ?, ?, ?)", "ittidi",
		audit, check->name, check->definition, (int64_t)check->seed, check->seconds, (int64_t)check->accepted);
	int64_t checked = sqlite3_last_insert_rowid(history->database);
	for (size_t m = 0; good && m < check->measure_count; m++)
		good = add_measure(history, checked, &check->measures[m], error);
	return finish(history, good, error);
}

bool history_end(struct history *history, int64_t audit, const char *state, double seconds,
				 const struct history_finding *findings, size_t finding_count, char error[STORE_ERROR])
{
	if (!begin(history, error)) return false;
	bool good = history_execute(history, error, "UPDATE audit SET state = ?, seconds = ? WHERE id = ?", "tdi", state,
								seconds, audit);
	for (size_t f = 0; good && f < finding_count; f++)
		good = history_execute(history, error,
							   "UPDATE measure SET finding = ? WHERE name = ? AND checked ="
							   " (SELECT id FROM checked WHERE audit = ? AND name = ?)",
							   "ttit", findings[f].text, findings[f].measure, audit, findings[f].check);
	return finish(history, good, error);
}
