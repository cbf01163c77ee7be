/* The history of audits: everything comes back; two at once lose nothing; what is killed leaves whole transactions. */
#include <math.h>
#include <signal.h>

#include "history_samples.h"
#include "scene/random.h"

enum { SEED = 20261122 };

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

int main(void)
{
	const struct CMUnitTest tests[] = {
		IN_FOLDER(every_measurement_comes_back),
		IN_FOLDER(references_are_chosen),
		IN_FOLDER(two_at_once_lose_nothing),
		IN_FOLDER(killed_writers_leave_whole_audits),
	};
	return cmocka_run_group_tests(tests, NULL, NULL);
}
