/* The fuzzer: what it finds is there, is shrunk, comes again; and what is planted is found. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "fuzz/corpus.h"
#include "fuzz/mutate.h"
#include "fuzz/shrink.h"
#include "scene/random.h"
#include "test/folder.h"

enum { SEED = 20161122 };

static bool brief;

static int make_folder(void **state)
{
	*state = folder_new();
	return 0;
}

static int remove_folder(void **state)
{
	folder_remove(*state);
	return 0;
}

/* ---- properties */

static double any_number(struct random_state *random)
{
	return ldexp(random_uniform(random) - 0.5, (int)random_below(random, 1800) - 900);
}

static void changed_questions_stay_finite(void **state)
{
	(void)state;
	struct random_state random = random_seed(SEED);
	print_message("seed %d\n", SEED);
	uint64_t changed = 0;
	for (int trial = 0; trial < 100000; trial++) {
		enum touchstone_shape shape = (enum touchstone_shape)random_below(&random, TOUCHSTONE_SHAPES);
		double number[TOUCHSTONE_MOST_NUMBERS] = {0}, before[TOUCHSTONE_MOST_NUMBERS];
		for (size_t n = 0; n < shape_numbers(shape); n++) number[n] = any_number(&random);
		memcpy(before, number, sizeof before);
		fuzz_mutate(shape, &random, number);
		changed += memcmp(before, number, sizeof before) != 0;
		fuzz_nudge(shape, &random, number);
		for (int n = 0; n < TOUCHSTONE_MOST_NUMBERS; n++) {
			assert_true(isfinite(number[n]));
			if (n >= (int)shape_numbers(shape)) assert_true(number[n] == 0);
		}
		fuzz_fit(shape, 24, number);
		for (int n = 0; n < TOUCHSTONE_MOST_NUMBERS; n++) assert_true(number[n] == (double)(float)number[n]);
		fuzz_fit(shape, 7, number);
		for (int n = 0; n < TOUCHSTONE_MOST_NUMBERS; n++) assert_true(fuzz_bits(number[n]) <= 7);
	}
	assert_true(changed > 90000);
}

static void bits_are_counted(void **state)
{
	(void)state;
	assert_int_equal(fuzz_bits(0), 0);
	assert_int_equal(fuzz_bits(-0x1p-1074), 1);
	assert_int_equal(fuzz_bits(0x1p300), 1);
	assert_int_equal(fuzz_bits(0x3p-1074), 2);
	assert_int_equal(fuzz_bits(-0x1.8p-1022), 2);
	assert_int_equal(fuzz_bits(5), 3);
	assert_int_equal(fuzz_bits(0x1.fffffffffffffp0), 53);
	assert_int_equal(fuzz_bits(0.1), 52);
}

/* ---- hunts */

static void hunt_for(struct fuzz_hunt *hunt, const struct finder *finder, enum touchstone_shape shape,
					 uint64_t questions)
{
	*hunt = (struct fuzz_hunt){
		.subject = fuzz_subject(finder, shape, NAN),
		.seed = SEED,
		.threads = 1,
		.seconds = INFINITY,
		.questions = questions,
	};
}

static void run_hunt(struct fuzz_hunt *hunt)
{
	char error[160];
	if (!fuzz_hunt(hunt, error)) fail_msg("%s", error);
}

static bool has(const struct fuzz_hunt *hunt, enum fuzz_failure failure)
{
	bool there = false;
	for (size_t f = 0; f < hunt->findings; f++) there |= hunt->finding[f].shrunk.failure == failure;
	return there;
}

/* Whatever was found fails again when it is asked alone, in the same way, and is no longer than it was. */
static void findings_are_real(void **state)
{
	(void)state;
	static const char *const methods[] = {"naive", "guarded", "stable", "textbook-epsilon"};
	struct oracle *oracle = oracle_create();
	for (int m = 0; m < (brief ? 1 : 4); m++)
		for (int shape = 0; shape < TOUCHSTONE_SHAPES; shape++) {
			char why[160];
			struct finder finder = {.method = methods[m], .arithmetic = "binary64"};
			struct fuzz_hunt hunt;
			if (!finder_answers(&finder, (enum touchstone_shape)shape, why)) continue;
			hunt_for(&hunt, &finder, (enum touchstone_shape)shape, 65536);
			run_hunt(&hunt);
			for (size_t f = 0; f < hunt.findings; f++) {
				struct fuzz_case again = hunt.finding[f].shrunk, first = hunt.finding[f].first;
				assert_true(fuzz_try(&hunt.subject, oracle, &again));
				assert_true(fuzz_same(&again, &hunt.finding[f].shrunk));
				assert_true(fuzz_try(&hunt.subject, oracle, &first));
				assert_true(fuzz_same(&first, &again));
				assert_true(fuzz_case_bits(hunt.subject.shape, &again) <=
							fuzz_case_bits(hunt.subject.shape, &hunt.finding[f].first));
			}
			if (m == 0 && shape == TOUCHSTONE_BALL_BALL) {
				assert_true(has(&hunt, FUZZ_NEGATIVE));
				assert_true(has(&hunt, FUZZ_PHANTOM));
			}
			print_message("%s %s: %zu findings\n", methods[m], shape_name((enum touchstone_shape)shape), hunt.findings);
			fuzz_hunt_free(&hunt);
		}
	oracle_destroy(oracle);
}

static void claims_are_kept(void **state)
{
	(void)state;
	static const char *const methods[] = {"stable", "guarded", "compensated", "rounded"};
	static const char *const arithmetics[] = {"binary64", "short:9"};
	for (int m = brief ? 3 : 0; m < 4; m++)
		for (int a = 0; a < (brief ? 1 : 2); a++)
			for (int shape = 0; shape < TOUCHSTONE_SHAPES; shape++) {
				struct finder finder = {.method = methods[m], .arithmetic = arithmetics[a]};
				struct fuzz_hunt hunt;
				hunt_for(&hunt, &finder, (enum touchstone_shape)shape, 65536);
				run_hunt(&hunt);
				for (size_t f = 0; f < hunt.findings; f++) {
					char words[320];
					fuzz_words(&hunt.subject, &hunt.finding[f].shrunk, words);
					if (hunt.finding[f].shrunk.promised)
						fail_msg("%s %s %s: %s", methods[m], arithmetics[a], shape_name(hunt.subject.shape), words);
				}
				if (m == 3 && a == 0) assert_int_equal(hunt.findings, 0);
				fuzz_hunt_free(&hunt);
			}
}

/* The seed alone decides what is found. */
static void threads_do_not_matter(void **state)
{
	(void)state;
	const struct finder finder = {.method = "naive", .arithmetic = "binary64"};
	struct fuzz_hunt hunt[2];
	for (int h = 0; h < 2; h++) {
		hunt_for(&hunt[h], &finder, TOUCHSTONE_BALL_BALL, 100000);
		hunt[h].threads = h ? 3 : 1;
		run_hunt(&hunt[h]);
	}
	assert_true(hunt[0].findings > 3);
	assert_int_equal(hunt[0].findings, hunt[1].findings);
	for (size_t f = 0; f < hunt[0].findings; f++) {
		const struct fuzz_finding *one = &hunt[0].finding[f], *other = &hunt[1].finding[f];
		assert_memory_equal(one->shrunk.number, other->shrunk.number, sizeof one->shrunk.number);
		assert_int_equal(one->met, other->met);
		assert_int_equal(one->question, other->question);
	}
	for (int h = 0; h < 2; h++) fuzz_hunt_free(&hunt[h]);
}

/* ---- the corpus */

static struct fuzz_hunt *kept;
static const char *kept_folder;

static void keep(void *context, const struct fuzz_finding *finding)
{
	(void)context;
	char error[CORPUS_ERROR];
	if (!corpus_write(kept, finding, kept_folder, error)) fail_msg("%s", error);
}

/* What was found is known from the beginning the next time, and the hunt goes on where it was. */
static void a_hunt_goes_on(void **state)
{
	const char *folder = *state;
	const struct finder finder = {.method = "naive", .arithmetic = "binary64"};
	char error[CORPUS_ERROR];
	struct fuzz_hunt first, next;
	hunt_for(&first, &finder, TOUCHSTONE_BALL_PLANE, 100000);
	first.tell = keep;
	kept = &first;
	kept_folder = folder;
	run_hunt(&first);
	assert_true(first.findings > 2);
	assert_true(corpus_enter_rounds(&first, folder, error));

	hunt_for(&next, &finder, TOUCHSTONE_BALL_PLANE, 1);
	assert_true(corpus_read(&next, folder, error));
	assert_true(corpus_rounds(&next, folder, error));
	assert_int_equal(next.rounds, first.rounds);
	assert_true(next.corpus_count >= first.findings);
	run_hunt(&next);
	for (size_t f = 0; f < first.findings; f++) {
		bool again = false;
		for (size_t g = 0; g < next.findings; g++) again |= fuzz_same(&next.finding[g].first, &first.finding[f].first);
		assert_true(again);
	}
	fuzz_hunt_free(&first);
	fuzz_hunt_free(&next);
}

static void a_damaged_book_is_refused(void **state)
{
	const char *folder = *state;
	const struct finder finder = {.method = "stable", .arithmetic = "binary64"};
	char error[CORPUS_ERROR];
	struct fuzz_hunt hunt;
	hunt_for(&hunt, &finder, TOUCHSTONE_BALL_BALL, 1);
	folder_put(folder, "rounds.json", "{\n\"stable");
	assert_false(corpus_rounds(&hunt, folder, error));
	assert_non_null(strstr(error, "rounds.json:2: "));
	assert_false(corpus_enter_rounds(&hunt, folder, error));
	folder_put(folder, "mine.txt", "# mine\nball-ball 1 2 3\n");
	assert_false(corpus_read(&hunt, folder, error));
	assert_non_null(strstr(error, "mine.txt:2: "));
	fuzz_hunt_free(&hunt);
}

/* ---- planted faults */

/* What the fuzzer must find, and to how many bits it must shrink it. */
static const struct {
	const char *symbol;
	enum fuzz_failure failure;
	unsigned bits;
} planted[] = {
	{"sign", FUZZ_NEGATIVE, 12},
	{"missing_guard", FUZZ_PHANTOM, 12},
	{"wrong_root", FUZZ_IMPRECISE, 12},
	{"swapped_operands", FUZZ_MISSED, 12},
	{"absolute_epsilon", FUZZ_MISSED, 12},
	{"lost_compensation", FUZZ_IMPRECISE, 12},
	{"wrong_branch_at_zero", FUZZ_MISSED, 12},
	{"off_by_one_ulp", FUZZ_IMPRECISE, 12},
	{"crash", FUZZ_CRASH, 12},
	{"hang", FUZZ_HANG, 12},
};
enum { PLANTED = sizeof planted / sizeof *planted };

static struct plugin *load(const char *symbol)
{
	const struct plugin_patience patience = {strcmp(symbol, "hang") == 0 ? 0.1 : 10, 40, 2, true, NULL};
	char name[300], error[PLUGIN_ERROR];
	bool broken;
	snprintf(name, sizeof name, "%s/planted.so:planted_%s", TOUCHSTONE_PLUGINS, symbol);
	struct plugin *plugin = plugin_open(name, TOUCHSTONE_BALL_BALL, &patience, &broken, error);
	if (!plugin) fail_msg("%s", error);
	return plugin;
}

static void hunt_planted(struct fuzz_hunt *hunt, struct finder *finder, const char *symbol)
{
	*finder = (struct finder){.method = symbol, .arithmetic = "binary64", .plugin = load(symbol)};
	hunt_for(hunt, finder, TOUCHSTONE_BALL_BALL, 131072);
	hunt->subject.bound = 0.5;
	run_hunt(hunt);
}

static void planted_faults_are_found(void **state)
{
	(void)state;
	for (int p = 0; p < PLANTED; p++) {
		struct finder finder;
		struct fuzz_hunt hunt;
		unsigned least = UINT32_MAX;
		double seconds = 0;
		hunt_planted(&hunt, &finder, planted[p].symbol);
		for (size_t f = 0; f < hunt.findings; f++) {
			const struct fuzz_finding *finding = &hunt.finding[f];
			unsigned bits = fuzz_case_bits(TOUCHSTONE_BALL_BALL, &finding->shrunk);
			if (finding->shrunk.failure != planted[p].failure || bits >= least) continue;
			least = bits;
			seconds = finding->seconds;
		}
		if (least == UINT32_MAX) fail_msg("%s is not found", planted[p].symbol);
		print_message("%s: %s, met after %.2f s, %u significant bits\n", planted[p].symbol,
					  fuzz_failure_name(planted[p].failure), seconds, least);
		assert_true(least <= planted[p].bits);
		fuzz_hunt_free(&hunt);
		plugin_close(finder.plugin);
	}
}

/* Where nothing was planted, nothing is found. */
static void a_right_finder_stands(void **state)
{
	(void)state;
	struct finder finder;
	struct fuzz_hunt hunt;
	hunt_planted(&hunt, &finder, "nothing");
	assert_int_equal(hunt.findings, 0);
	assert_true(hunt.asked >= 65536);
	fuzz_hunt_free(&hunt);
	plugin_close(finder.plugin);
}

int main(void)
{
	brief = getenv("TOUCHSTONE_BRIEF");
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(changed_questions_stay_finite),
		cmocka_unit_test(bits_are_counted),
		cmocka_unit_test(findings_are_real),
		cmocka_unit_test(claims_are_kept),
		cmocka_unit_test(threads_do_not_matter),
		cmocka_unit_test_setup_teardown(a_hunt_goes_on, make_folder, remove_folder),
		cmocka_unit_test_setup_teardown(a_damaged_book_is_refused, make_folder, remove_folder),
		cmocka_unit_test(planted_faults_are_found),
		cmocka_unit_test(a_right_finder_stands),
	};
	return cmocka_run_group_tests(tests, NULL, NULL);
}
