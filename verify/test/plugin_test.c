/* Plug-ins: their answers come through, and whatever they do wrong is told with the question it was done at. */
#include <elf.h>
#include <errno.h>
#include <math.h>
#include <setjmp.h>
#include <signal.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmocka.h>

#include "plugin/plugin.h"
#include "test/folder.h"

#define FAULTY TOUCHSTONE_PLUGINS "/faulty.so"
enum { QUESTIONS = 5000, MOST_FAULTS = 64 };

static const struct plugin_patience patience = {.seconds = 0.3, .crashes = 20, .loops = 3};
static double number[QUESTIONS][TOUCHSTONE_MOST_NUMBERS], answer[QUESTIONS];

static struct {
	size_t count;
	struct plugin_fault fault[MOST_FAULTS];
} told;

static void keep(void *context, const struct plugin_fault *fault)
{
	(void)context;
	assert_true(told.count < MOST_FAULTS);
	told.fault[told.count++] = *fault;
}

/* Balls that fly head-on at speed 1 from r to s: the wait is r - s, whoever computes it. */
static void ask_ordinary(void)
{
	for (int k = 0; k < QUESTIONS; k++) {
		const double head_on[TOUCHSTONE_MOST_NUMBERS] = {3 + k, 0, 0, -1, 0, 0, 1};
		memcpy(number[k], head_on, sizeof number[k]);
		answer[k] = -7;
	}
	told.count = 0;
}

static struct plugin *open_well(const char *name)
{
	char error[PLUGIN_ERROR] = "";
	bool broken;
	struct plugin *plugin = plugin_open(name, TOUCHSTONE_BALL_BALL, &patience, &broken, error);
	if (!plugin || broken) fail_msg("%s: %s", name, error);
	return plugin;
}

static size_t find(struct plugin *plugin, size_t count)
{
	return plugin_find(plugin, TOUCHSTONE_BALL_BALL, (void *)number, count, answer, keep, NULL);
}

static void check_ordinary(size_t from, size_t to)
{
	for (size_t k = from; k < to; k++)
		if (answer[k] != 2 + (double)k) fail_msg("question %zu: %g, not %g", k, answer[k], 2 + (double)k);
}

static void answers_come_through(void **state)
{
	(void)state;
	static const char *const names[] = {TOUCHSTONE_PLUGINS "/example.so", TOUCHSTONE_PLUGINS "/example_cxx.so", FAULTY,
										FAULTY ":another_name"};
	for (size_t n = 0; n < sizeof names / sizeof *names; n++) {
		struct plugin *plugin = open_well(names[n]);
		assert_string_equal(plugin_name(plugin), strrchr(names[n], '/') + 1);
		assert_true(plugin_answers(plugin, TOUCHSTONE_BALL_BALL));
		assert_false(plugin_answers(plugin, TOUCHSTONE_BALL_PLANE));
		ask_ordinary();
		assert_int_equal(find(plugin, QUESTIONS), QUESTIONS);
		check_ordinary(0, QUESTIONS);
		assert_int_equal(told.count, 0);
		double nanoseconds = plugin_nanoseconds(plugin, TOUCHSTONE_BALL_BALL, (void *)number, QUESTIONS);
		assert_true(nanoseconds >= 0 && nanoseconds < 1e6);
		plugin_close(plugin);
	}
}

static void each_shape_has_its_function(void **state)
{
	(void)state;
	static const double question[1][TOUCHSTONE_MOST_NUMBERS] = {{1, 2, 3, 4, 5, 6, 7}};
	static const double expected[] = {
		[TOUCHSTONE_BALL_BALL] = 7654321, [TOUCHSTONE_BALL_LEAVE] = 17654321, [TOUCHSTONE_BALL_PLANE] = 20004321};
	struct plugin *plugin = open_well(TOUCHSTONE_PLUGINS "/shapes.so");
	for (int shape = 0; shape <= TOUCHSTONE_BALL_PLANE; shape++) {
		assert_true(plugin_answers(plugin, (enum touchstone_shape)shape));
		assert_int_equal(plugin_find(plugin, (enum touchstone_shape)shape, question, 1, answer, keep, NULL), 1);
		if (answer[0] != expected[shape]) fail_msg("shape %d: %.17g", shape, answer[0]);
	}
	assert_false(plugin_answers(plugin, TOUCHSTONE_HALF_SPACE));
	plugin_close(plugin);

	bool broken;
	char error[PLUGIN_ERROR];
	plugin = plugin_open(TOUCHSTONE_PLUGINS "/shapes.so:touchstone_ball_plane", TOUCHSTONE_BALL_PLANE, &patience,
						 &broken, error);
	assert_non_null(plugin);
	assert_true(plugin_answers(plugin, TOUCHSTONE_BALL_PLANE) && !plugin_answers(plugin, TOUCHSTONE_BALL_BALL));
	plugin_close(plugin);
}

/* What is not finite is not asked. */
static void only_finite_questions_are_asked(void **state)
{
	(void)state;
	struct plugin *plugin = open_well(FAULTY);
	ask_ordinary();
	number[1][0] = INFINITY;
	number[3][6] = NAN;
	assert_int_equal(find(plugin, 6), 6);
	assert_true(isnan(answer[1]) && isnan(answer[3]));
	check_ordinary(4, 6);
	plugin_close(plugin);
}

/* Each fault at a question of its own, among others that are answered all the same. */
static void faults_are_told_with_their_question(void **state)
{
	(void)state;
	static const struct {
		double contact;
		struct plugin_fault fault;
		const char *words;
	} faults[] = {
		{101, {.signal = SIGSEGV}, "is ended by SIGSEGV (Segmentation fault)"},
		{102, {.endless = true}, "does not come to an end"},
		{106, {.status = 0}, "ends the process with status 0"},
		{107, {.signal = SIGUSR1}, "is ended by SIGUSR1"},
		{108, {.signal = SIGABRT}, "is ended by SIGABRT (Aborted)"},
	};
	enum { FAULTS = sizeof faults / sizeof *faults };
	static const size_t places[] = {0, 1023, 1024, 2047, QUESTIONS - 1}; /* at the ends of batches */
	struct plugin *plugin = open_well(FAULTY);
	for (size_t shift = 0; shift < FAULTS; shift++) {
		ask_ordinary();
		for (size_t f = 0; f < FAULTS; f++) number[places[(f + shift) % FAULTS]][6] = faults[f].contact;
		assert_int_equal(find(plugin, QUESTIONS), QUESTIONS);
		assert_int_equal(told.count, FAULTS);
		for (size_t place = 0; place < FAULTS; place++) {
			const struct plugin_fault *fault = &told.fault[place];
			size_t f = (place + FAULTS - shift) % FAULTS;
			char words[120];
			plugin_fault_words(fault, words);
			if (fault->question != places[place] || fault->signal != faults[f].fault.signal ||
				fault->status != faults[f].fault.status || fault->endless != faults[f].fault.endless || !fault->alone)
				fail_msg("question %zu, not %zu: %s, not %s", fault->question, places[place], words, faults[f].words);
			assert_non_null(strstr(words, faults[f].words));
			assert_true(isnan(answer[places[place]]));
		}
		check_ordinary(1, 1023);
		check_ordinary(1025, 2047);
		check_ordinary(2048, QUESTIONS - 1);
	}
	plugin_close(plugin);
}

/* Answers that are no answers are handed on as they are; noise and meddling change nothing. */
static void strange_answers_are_handed_on(void **state)
{
	(void)state;
	struct plugin *plugin = open_well(FAULTY);
	ask_ordinary();
	const double contact[] = {103, 104, 105, 109, 110};
	for (int k = 0; k < 5; k++) number[k][6] = contact[k];
	assert_int_equal(find(plugin, QUESTIONS), QUESTIONS);
	assert_true(isnan(answer[0]) && answer[1] == -1 && answer[2] == -1e300);
	assert_true(answer[3] == 6 - 109);
	assert_true(number[4][0] == 7);
	check_ordinary(5, QUESTIONS);
	assert_int_equal(told.count, 0);
	plugin_close(plugin);
}

/* A fault that does not come back when its question is asked alone is told to be such. */
static void faults_of_memory_are_told_apart(void **state)
{
	(void)state;
	struct plugin *plugin = open_well(FAULTY);
	ask_ordinary();
	number[10][6] = 111;
	assert_int_equal(find(plugin, 100), 100);
	assert_int_equal(told.count, 1);
	assert_int_equal(told.fault[0].question, 10);
	assert_false(told.fault[0].alone);
	check_ordinary(11, 100);
	plugin_close(plugin);
}

/* One that does nothing but crash, or loop, is not asked for ever. */
static void patience_has_an_end(void **state)
{
	(void)state;
	struct plugin *plugin = open_well(FAULTY);
	ask_ordinary();
	for (int k = 5; k < QUESTIONS; k++) number[k][6] = 101;
	assert_int_equal(find(plugin, QUESTIONS), 5 + patience.crashes);
	assert_int_equal(told.count, patience.crashes);
	check_ordinary(0, 5);
	ask_ordinary();
	for (int k = 5; k < QUESTIONS; k++) number[k][6] = 102;
	assert_int_equal(find(plugin, QUESTIONS), 5 + patience.loops);
	assert_true(isnan(plugin_nanoseconds(plugin, TOUCHSTONE_BALL_BALL, (void *)number, 10)));
	ask_ordinary();
	assert_int_equal(find(plugin, QUESTIONS), QUESTIONS); /* and it can be asked again */
	check_ordinary(0, QUESTIONS);
	plugin_close(plugin);
}

static void an_interrupt_is_heeded(void **state)
{
	(void)state;
	volatile int stop = 0;
	struct plugin_patience endless = {.seconds = 1e9, .crashes = 1, .loops = 1, .stop = &stop};
	char error[PLUGIN_ERROR];
	bool broken;
	struct plugin *plugin = plugin_open(FAULTY, TOUCHSTONE_BALL_BALL, &endless, &broken, error);
	assert_non_null(plugin);
	ask_ordinary();
	number[3][6] = 102;
	stop = 1;
	assert_int_equal(find(plugin, QUESTIONS), 0);
	assert_int_equal(told.count, 0);
	plugin_close(plugin);
}

static void refused(const char *name, bool broken, const char *words)
{
	char error[PLUGIN_ERROR] = "";
	bool is_broken;
	assert_null(plugin_open(name, TOUCHSTONE_BALL_BALL, &patience, &is_broken, error));
	if (is_broken != broken || !strstr(error, words) || strchr(error, '\n'))
		fail_msg("%s: not '... %s ...': %s", name, words, error);
}

/* A copy of a plug-in whose header says something else: one field of it, changed. */
static char *forge(const char *folder, const char *name, size_t field, unsigned char value)
{
	static char bytes[1 << 20];
	char *path = NULL;
	FILE *from = fopen(FAULTY, "rb");
	size_t size = fread(bytes, 1, sizeof bytes, from);
	fclose(from);
	bytes[field] = (char)value;
	assert_true(size > field && asprintf(&path, "%s/%s", folder, name) > 0);
	FILE *to = fopen(path, "wb");
	fwrite(bytes, 1, size, to);
	fclose(to);
	return path;
}

static void what_is_no_plugin_is_refused(void **state)
{
	(void)state;
	char *folder = folder_new();
	refused("nowhere.so", false, "nowhere.so: cannot be read: No such file");
	refused("lib", false, "lib: no ELF file");
	refused("Makefile", false, "Makefile: no ELF file");
	refused("", false, "cannot be read");
	refused(TOUCHSTONE_PLUGINS "/strange.so", false, "strange.so: has no function touchstone_ball_ball");
	refused(FAULTY ":no_such_name", false, "faulty.so: has no function no_such_name");
	refused(FAULTY ":", false, "cannot be read");
	refused(TOUCHSTONE_PLUGINS "/unloadable.so", true,
			"unloadable.so: is ended by SIGABRT (Aborted) while it is loaded");
	refused(TOUCHSTONE_PROGRAM, false, "touchstone: ");
	struct {
		size_t field;
		unsigned char value;
		const char *words;
	} forged[] = {
		{offsetof(Elf64_Ehdr, e_machine), EM_S390, "for another machine (64 bits, ELF machine 22)"},
		{EI_CLASS, ELFCLASS32, "for another machine (32 bits"},
		{offsetof(Elf64_Ehdr, e_type), ET_REL, "an ELF file, but no shared object"},
		{offsetof(Elf64_Ehdr, e_phoff), 1, "forged-3.so"},
	};
	for (size_t f = 0; f < 4; f++) {
		char name[32];
		snprintf(name, sizeof name, "forged-%zu.so", f);
		char *path = forge(folder, name, forged[f].field, forged[f].value);
		refused(path, false, forged[f].words);
		free(path);
	}
	folder_remove(folder);
}

/* No child is left when a plug-in is closed. */
static void nothing_stays_behind(void **state)
{
	(void)state;
	plugin_close(NULL);
	plugin_close(open_well(FAULTY));
	assert_int_equal(waitpid(-1, NULL, WNOHANG), -1);
	assert_int_equal(errno, ECHILD);
}

int main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(answers_come_through),
		cmocka_unit_test(each_shape_has_its_function),
		cmocka_unit_test(only_finite_questions_are_asked),
		cmocka_unit_test(faults_are_told_with_their_question),
		cmocka_unit_test(strange_answers_are_handed_on),
		cmocka_unit_test(faults_of_memory_are_told_apart),
		cmocka_unit_test(patience_has_an_end),
		cmocka_unit_test(an_interrupt_is_heeded),
		cmocka_unit_test(what_is_no_plugin_is_refused),
		cmocka_unit_test(nothing_stays_behind),
	};
	return cmocka_run_group_tests(tests, NULL, NULL);
}
