/* The history of audits: everything comes back; two at once lose nothing; what cannot be written or read is said on one
 * line, and nothing that was there is lost. */
#include <math.h>
#include <setjmp.h>
#include <signal.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmocka.h>
#include <sqlite3.h>

#include "scene/random.h"
#include "store/history.h"
#include "test/folder.h"

enum { SEED = 20261122 };

static char *folder, path[200], error[STORE_ERROR];

static const struct history_audit usual = {"2026-11-22T03:00:00Z", "standard", "39dc0da", "gcc 12", "a machine", 7};
static const struct history_key key = {"dense", "as it is", "below", "a machine"};

static struct history *open_well(bool writing)
{
	struct history *history = history_open(path, writing, error);
	if (!history) fail_msg("%s", error);
	return history;
}

static void must(bool done)
{
	if (!done) fail_msg("%s", error);
}

static struct measurement random_measurement(struct random_state *random, enum measure_nature nature)
{
	struct sample sample = {0};
	for (size_t k = 0; k < 1 + random_below(random, SAMPLE_MOST); k++)
		sample_add(&sample, exp(20 * random_normal(random)));
	if (nature == MEASURE_WORD) return measurement_word("f00dbeef00112233, or done, halted");
	if (nature == MEASURE_PROPORTION)
		return measurement_proportion(random_below(random, 50), 50 + random_below(random, 1000));
	if (nature == MEASURE_RATE) return measurement_rate(random_below(random, 50), exp(random_normal(random)));
	return measurement_sample(nature, &sample);
}

/* One audit of one check, whole. */
static int64_t add_audit(struct history *history, const struct history_audit *audit,
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

static void assert_same(const struct measurement *a, const struct measurement *b)
{
	assert_int_equal(a->nature, b->nature);
	assert_true(a->value == b->value || (isnan(a->value) && isnan(b->value)));
	assert_true(a->low == b->low || (isnan(a->low) && isnan(b->low)));
	assert_true(a->high == b->high || (isnan(a->high) && isnan(b->high)));
	assert_true(a->count == b->count && a->hits == b->hits && a->exposure == b->exposure);
	assert_int_equal(a->sample.count, b->sample.count);
	assert_memory_equal(a->sample.value, b->sample.value, a->sample.count * sizeof(double));
	assert_string_equal(a->word, b->word);
}

static void every_measurement_comes_back(void **state)
{
	(void)state;
	print_message("seed %d\n", SEED);
	struct random_state random = random_seed(SEED);
	enum { AUDITS = 8 };
	static const char *const names[] = {"word", "proportion", "rate", "sample", "timing"};
	struct history_measure measures[AUDITS][MEASURE_NATURES];
	struct history *history = open_well(true);
	for (int a = 0; a < AUDITS; a++) {
		struct history_audit audit = usual;
		audit.seed = UINT64_MAX - (uint64_t)a;
		for (int n = 0; n < MEASURE_NATURES; n++)
			measures[a][n] = (struct history_measure){names[n], (enum measure_worse)(a % 3),
													  random_measurement(&random, (enum measure_nature)n)};
		add_audit(history, &audit, measures[a], MEASURE_NATURES, false, "complete", NULL);
	}
	history_close(history);
	history = open_well(false);
	for (int n = 0; n < MEASURE_NATURES; n++) {
		struct night *nights;
		size_t count;
		must(history_nights(history, &(struct history_key){key.check, key.definition, names[n], key.machine}, &nights,
							&count, error));
		assert_int_equal(count, AUDITS);
		for (int a = 0; a < AUDITS; a++) {
			assert_true(nights[a].good && nights[a].seed == UINT64_MAX - (uint64_t)a);
			assert_same(&nights[a].measured, &measures[a][n].measured);
		}
		free(nights);
	}
	assert_true(history_seconds(history, &key) == 1.5);
	history_close(history);
}

static size_t nights_of(struct history *history, const struct history_key *wanted, size_t *good)
{
	struct night *nights;
	size_t count;
	must(history_nights(history, wanted, &nights, &count, error));
	*good = 0;
	for (size_t n = 0; n < count; n++) *good += nights[n].good;
	free(nights);
	return count;
}

/* What counts as a reference, and what does not. */
static void references_are_chosen(void **state)
{
	(void)state;
	struct history *history = open_well(true);
	struct sample one = {1, {1}};
	const struct history_measure measures[] = {{"below", WORSE_MORE, measurement_proportion(1, 10)},
											   {"time", WORSE_MORE, measurement_sample(MEASURE_TIMING, &one)}};
	struct history_audit elsewhere = usual;
	const struct history_key time = {key.check, key.definition, "time", key.machine};
	elsewhere.machine = "another";
	size_t good;
	add_audit(history, &usual, measures, 2, false, "complete", NULL);
	add_audit(history, &usual, measures, 2, false, "complete", "worse");
	add_audit(history, &usual, measures, 2, false, "interrupted", NULL);
	add_audit(history, &elsewhere, measures, 2, false, "complete", NULL);
	assert_true(nights_of(history, &key, &good) == 3 && good == 2);
	assert_true(nights_of(history, &time, &good) == 2); /* this machine's only */
	assert_true(nights_of(history, &(struct history_key){key.check, "another", "below", key.machine}, &good) == 0);
	add_audit(history, &usual, measures, 2, true, "interrupted", NULL);
	assert_true(nights_of(history, &key, &good) == 3); /* what did not come to its end accepts nothing */
	add_audit(history, &usual, measures, 2, true, "complete", NULL);
	add_audit(history, &usual, measures, 2, false, "complete", NULL);
	assert_true(nights_of(history, &key, &good) == 2 && good == 2);
	history_close(history);
}

static void count_row(void *context, const struct history_row *row)
{
	*(unsigned *)context += row->measure != NULL;
}

static unsigned rows_of(void)
{
	struct history *history = open_well(false);
	unsigned rows = 0;
	must(history_read(history, count_row, &rows, error));
	history_close(history);
	return rows;
}

/* Both make the file, and both write audit after audit. */
static void two_at_once_lose_nothing(void **state)
{
	(void)state;
	enum { WRITERS = 2, AUDITS = 25 };
	const struct history_measure measure = {"below", WORSE_MORE, measurement_proportion(1, 10)};
	pid_t writer[WRITERS];
	for (int w = 0; w < WRITERS; w++) {
		if ((writer[w] = fork()) != 0) continue;
		struct history *history = history_open(path, true, error);
		int64_t id;
		bool good = history;
		const struct history_check check = {key.check, key.definition, 1, 1, false, &measure, 1};
		for (int a = 0; a < AUDITS && good; a++)
			good = history_begin(history, &usual, &id, error) && history_add(history, id, &check, error) &&
				   history_end(history, id, "complete", 1, NULL, 0, error);
		if (!good) fprintf(stderr, "%s\n", error);
		history_close(history);
		_exit(good ? 0 : 1);
	}
	for (int w = 0; w < WRITERS; w++) {
		int status;
		assert_true(waitpid(writer[w], &status, 0) == writer[w] && status == 0);
	}
	assert_int_equal(rows_of(), WRITERS * AUDITS);
}

/* A writer that is killed at any moment leaves whole transactions only. */
static void killed_writers_leave_whole_audits(void **state)
{
	(void)state;
	const struct history_measure measures[] = {{"below", WORSE_MORE, measurement_proportion(1, 10)},
											   {"above", WORSE_MORE, measurement_proportion(9, 10)}};
	int told[2];
	assert_int_equal(pipe(told), 0);
	struct random_state random = random_seed(SEED);
	unsigned promised = 0;
	for (int kill_number = 0; kill_number < 10; kill_number++) {
		pid_t writer = fork();
		if (writer == 0) {
			struct history *history = history_open(path, true, error);
			while (history) {
				add_audit(history, &usual, measures, 2, false, "complete", NULL);
				if (write(told[1], "x", 1) != 1) break;
			}
			_exit(1);
		}
		char mark;
		assert_true(read(told[0], &mark, 1) == 1); /* it has begun */
		promised++;
		usleep((unsigned)random_below(&random, 10000));
		kill(writer, SIGKILL);
		int status;
		waitpid(writer, &status, 0);
		assert_true(WIFSIGNALED(status));
	}
	close(told[1]);
	for (char mark; read(told[0], &mark, 1) == 1;) promised++;
	close(told[0]);
	unsigned rows = rows_of();
	print_message("%u audits were promised to be stored, %u measures are\n", promised, rows);
	assert_true(promised > 0 && rows % 2 == 0 && rows >= 2 * promised);
}

static void assert_refused(bool writing, const char *words)
{
	struct history *history = history_open(path, writing, error);
	assert_null(history);
	if (!strstr(error, words) || strncmp(error, path, strlen(path)) != 0 || strchr(error, '\n'))
		fail_msg("not one line '%s: ... %s ...': %s", path, words, error);
}

static void execute(const char *sql)
{
	sqlite3 *database;
	assert_int_equal(sqlite3_open(path, &database), SQLITE_OK);
	assert_int_equal(sqlite3_exec(database, sql, NULL, NULL, NULL), SQLITE_OK);
	sqlite3_close(database);
}

/* A history of one audit with so many measures. */
static void fill(unsigned count)
{
	struct history_measure *measures = calloc(count, sizeof *measures);
	char(*names)[20] = calloc(count, sizeof *names);
	assert_true(measures && names);
	for (unsigned m = 0; m < count; m++) {
		snprintf(names[m], sizeof names[m], "below %u", m);
		measures[m] = (struct history_measure){names[m], WORSE_MORE, measurement_proportion(1, 10)};
	}
	struct history *history = open_well(true);
	add_audit(history, &usual, measures, count, false, "complete", NULL);
	history_close(history);
	free(measures);
	free(names);
}

/* What is refused stays as it was, byte by byte. */
static void assert_left_alone(bool writing, const char *words)
{
	struct stat before, after;
	char *name = strrchr(path, '/') + 1, *text = folder_text(folder, name);
	assert_int_equal(stat(path, &before), 0);
	assert_refused(writing, words);
	assert_int_equal(stat(path, &after), 0);
	assert_true(before.st_size == after.st_size && before.st_mtim.tv_nsec == after.st_mtim.tv_nsec);
	char *now = folder_text(folder, name);
	assert_string_equal(text, now);
	free(text);
	free(now);
}

static void strange_files_are_refused(void **state)
{
	(void)state;
	assert_refused(false, "cannot be read: No such file");
	folder_put(folder, "history.db", "checks:\n  - name: a suite, not its history\n");
	for (int writing = 0; writing < 2; writing++) assert_left_alone(writing, "is no database; accepted: ");
	unlink(path);
	execute("CREATE TABLE recipes (name TEXT)");
	for (int writing = 0; writing < 2; writing++) assert_left_alone(writing, "is a database of something else");
	unlink(path);
	fill(3);
	execute("PRAGMA user_version = 2");
	for (int writing = 0; writing < 2; writing++) assert_left_alone(writing, "is of version 2");
	execute("PRAGMA user_version = 1");
	assert_int_equal(rows_of(), 3);

	snprintf(path, sizeof path, "%s/absent/history.db", folder);
	for (int writing = 0; writing < 2; writing++) assert_refused(writing, writing ? "" : "No such file");
	snprintf(path, sizeof path, "%s", folder);
	assert_refused(true, "is no file");
}

/* Cut off anywhere, or with a page overwritten, it is found damaged; never is part of it taken for the whole. */
static void damaged_files_are_refused(void **state)
{
	(void)state;
	fill(300);
	struct stat there;
	assert_int_equal(stat(path, &there), 0);
	assert_true(there.st_size > 5 * 4096);
	for (off_t size = there.st_size - 1; size > 0; size -= size > 4096 ? 4096 : 700) {
		assert_int_equal(truncate(path, size), 0);
		assert_refused(size & 1, "");
		assert_true(strstr(error, "damaged") || strstr(error, "no database"));
	}
	unlink(path);
	fill(300);
	FILE *file = fopen(path, "r+");
	assert_true(file && fseek(file, 4096 * 3, SEEK_SET) == 0);
	for (int i = 0; i < 4096; i++) fputc(i * 7 & 0xff, file);
	fclose(file);
	assert_refused(true, "damaged");
}

/* The disk is full: the size a file may have is limited, so that writing fails as it then does. */
static void full_disks_are_told(void **state)
{
	(void)state;
	fill(2);
	pid_t writer = fork();
	if (writer == 0) {
		const struct history_measure measure = {"below", WORSE_MORE, measurement_proportion(1, 10)};
		const struct history_check check = {key.check, key.definition, 1, 1, false, &measure, 1};
		struct history *history = history_open(path, true, error);
		struct rlimit limit = {64 << 10, 64 << 10};
		signal(SIGXFSZ, SIG_IGN);
		setrlimit(RLIMIT_FSIZE, &limit);
		bool good = history;
		int64_t id;
		for (int a = 0; a < 10000 && good; a++)
			good = history_begin(history, &usual, &id, error) && history_add(history, id, &check, error) &&
				   history_end(history, id, "complete", 1, NULL, 0, error);
		bool told = !good && strstr(error, "cannot be written: ") && strncmp(error, path, strlen(path)) == 0;
		if (!told) fprintf(stderr, "%s\n", error);
		history_close(history);
		_exit(told ? 0 : 1);
	}
	int status;
	waitpid(writer, &status, 0);
	assert_int_equal(status, 0);
	unsigned rows = rows_of();
	print_message("%u audits were stored before the disk was full\n", rows);
	assert_true(rows > 2); /* what was there is there, and what went before the fault */
	fill(1);
	assert_int_equal(rows_of(), rows + 1);
}

/* As somebody who may read but not write. */
static void read_only_files_are_told(void **state)
{
	(void)state;
	fill(2);
	assert_true(chmod(folder, 0755) == 0 && chmod(path, 0444) == 0);
	pid_t reader = fork();
	if (reader == 0) {
		if (geteuid() == 0 && setresuid(65534, 65534, 65534) != 0) _exit(2);
		struct history *history = history_open(path, true, error);
		bool told = !history && strstr(error, "cannot be written: ");
		if (!told) fprintf(stderr, "%s\n", history ? "opened" : error);
		_exit(told ? 0 : 1);
	}
	int status;
	waitpid(reader, &status, 0);
	assert_int_equal(status, 0);
	chmod(path, 0644);
	assert_int_equal(rows_of(), 2);
}

static int set_up(void **state)
{
	(void)state;
	folder = folder_new();
	snprintf(path, sizeof path, "%s/history.db", folder);
	return 0;
}

static int tear_down(void **state)
{
	(void)state;
	folder_remove(folder);
	return 0;
}

int main(void)
{
#define IN_FOLDER(test) cmocka_unit_test_setup_teardown(test, set_up, tear_down)
	const struct CMUnitTest tests[] = {
		IN_FOLDER(every_measurement_comes_back), IN_FOLDER(references_are_chosen),
		IN_FOLDER(two_at_once_lose_nothing),     IN_FOLDER(killed_writers_leave_whole_audits),
		IN_FOLDER(strange_files_are_refused),    IN_FOLDER(damaged_files_are_refused),
		IN_FOLDER(full_disks_are_told),          IN_FOLDER(read_only_files_are_told),
	};
	return cmocka_run_group_tests(tests, NULL, NULL);
}
