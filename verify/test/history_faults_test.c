/* Histories that cannot be written or read: each is told on one line, and nothing that was there is lost. */
#include <signal.h>
#include <sqlite3.h>
#include <sys/resource.h>
#include <sys/stat.h>

#include "history_samples.h"
#include "scene/random.h"

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

static void see(void *context, const struct history_row *row)
{
	*(size_t *)context +=
		strlen(row->date) + strlen(row->suite) + row->measured.sample.count + strlen(row->measured.word);
}

/* Bytes changed anywhere: the file is refused, or what is read of it is something that can be compared. */
static void changed_bytes_are_survived(void **state)
{
	(void)state;
	enum { SEED = 20261122, CHANGED = 200, CHANGES = 4 };
	print_message("seed %d\n", SEED);
	struct random_state random = random_seed(SEED);
	struct stat there;
	unsigned opened = 0;
	fill(30);
	assert_int_equal(stat(path, &there), 0);
	unsigned char *bytes = malloc((size_t)there.st_size);
	FILE *file = fopen(path, "r");
	assert_true(bytes && file && fread(bytes, 1, (size_t)there.st_size, file) == (size_t)there.st_size);
	fclose(file);
	for (int c = 0; c < CHANGED; c++) {
		size_t at[CHANGES];
		unsigned char old[CHANGES];
		for (int k = 0; k < CHANGES; k++) {
			at[k] = random_below(&random, (uint64_t)there.st_size);
			old[k] = bytes[at[k]];
			bytes[at[k]] = (unsigned char)random_below(&random, 256);
		}
		file = fopen(path, "w");
		assert_true(file && fwrite(bytes, 1, (size_t)there.st_size, file) == (size_t)there.st_size);
		fclose(file);
		for (int k = CHANGES; k-- > 0;) bytes[at[k]] = old[k];
		struct history *history = history_open(path, false, error);
		if (!history) continue;
		opened++;
		struct night *nights;
		size_t count, seen = 0;
		const struct history_key wanted = {key.check, key.definition, "below 7", key.machine};
		history_read(history, see, &seen, error);
		if (history_nights(history, &wanted, &nights, &count, error) && count > 0) {
			nights[count] = (struct night){1000, 7, true, measurement_proportion(1, 10)};
			struct verdict verdict = verdict_of(nights, count + 1, WORSE_MORE);
			assert_true(verdict.chance >= 0 && verdict.chance <= 1);
		}
		free(nights);
		history_close(history);
	}
	free(bytes);
	print_message("%u of %d changed histories could be opened\n", opened, CHANGED);
	assert_true(opened > 0 && opened < CHANGED);
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

int main(void)
{
	const struct CMUnitTest tests[] = {
		IN_FOLDER(strange_files_are_refused),  IN_FOLDER(damaged_files_are_refused),
		IN_FOLDER(changed_bytes_are_survived), IN_FOLDER(full_disks_are_told),
		IN_FOLDER(read_only_files_are_told),
	};
	return cmocka_run_group_tests(tests, NULL, NULL);
}
