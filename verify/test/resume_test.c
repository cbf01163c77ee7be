/* `touchstone run --checkpoint` and `--resume`, as a user meets them: a run in parts is the run in one, whoever ends
 * the parts; and what does not fit is refused. */
#include <math.h>
#include <signal.h>
#include <sys/stat.h>

#include "own_folder.h"
#include "program.h"
#include "soak/kills.h"

enum { SEED = 20161130 };

static bool brief; /* under sanitizers, where everything takes ten times longer */

static json_t *run(const char *arguments)
{
	return program_json(program_run("run %s --json -", arguments), 0);
}

static uint64_t whole_number(const json_t *json, const char *key)
{
	return (uint64_t)json_integer_value(json_object_get(json, key));
}

/* The same but for what parts must differ in. */
static void assert_same_run(const json_t *one, const json_t *other, const char *scene)
{
	static const char *const same[] = {"seed",    "events",    "collisions",     "captures",   "releases",
									   "bounces", "crossings", "captured_pairs", "time_begun", "time",
									   "verdict", "reason",    "complete",       "digest",     "potential_energy",
									   "fluxes",  "impact",    "conservation",   "three_body"};
	for (size_t k = 0; k < sizeof same / sizeof *same; k++) {
		const json_t *first = json_object_get(one, same[k]), *second = json_object_get(other, same[k]);
		if (first != second && !json_equal(first, second)) fail_msg("%s: '%s' differs", scene, same[k]);
	}
}

/* Cut at random events, by another search after each cut, also while it is equilibrated. */
static void parts_make_the_whole(void **state)
{
	(void)state;
	static const char *const scenes[] = {
		"hard-spheres --set particles=108 --set equilibrate=3 --measure impact,conservation,three-body",
		"square-well --set particles=108 --set density=0.2 --set equilibrate=2 --measure conservation",
		("stepped-lennard-jones --set particles=108 --arithmetic twin "
		 "--set virtual_walls=[{point:\t[0,0,0],normal:\t[1,0,0]}]"),
		"mixture --set particles=64 --arithmetic binary32 --set form=absolute --measure impact",
		"inelastic-spheres --set particles=64 --arithmetic mpfr:113 --set equilibrate=0",
		"cradle --arithmetic short:24",
		"column --arithmetic extended --measure conservation",
		"bouncing-ball --arithmetic binary128",
	};
	struct random_state random = random_seed(SEED);
	for (size_t s = 0; s < sizeof scenes / sizeof *scenes; s++) {
		char arguments[600];
		uint64_t events = brief ? 200 : 1000;
		snprintf(arguments, sizeof arguments, "%s --events %llu", scenes[s], (unsigned long long)events);
		json_t *whole = run(arguments), *part = NULL;
		uint64_t done = 0, all = whole_number(whole, "events");
		for (int cut = 0; cut < 3; cut++) {
			uint64_t until = cut == 2 ? events : done + random_below(&random, all - done + 1);
			snprintf(arguments, sizeof arguments,
					 "%s --events %llu --checkpoint %s/cut.h5 --every %llu%s%s/cut.h5 --set search=%s", scenes[s],
					 (unsigned long long)(until ? until : 1), folder,
					 (unsigned long long)(100 + random_below(&random, 900)), cut ? " --resume " : " --checkpoint ",
					 folder, cut == 1 ? "all" : "cells");
			json_decref(part);
			part = run(arguments);
			assert_true(cut ? whole_number(part, "resumed_from") == done
							: json_is_null(json_object_get(part, "resumed_from")));
			assert_true(whole_number(part, "checkpoints") >= 1);
			done = whole_number(part, "events");
		}
		assert_same_run(whole, part, scenes[s]);
		json_decref(part);
		json_decref(whole);
	}
}

/* Ctrl-C keeps what is done, and says what to type to go on; that line, typed, comes to the end. */
static void an_interrupted_run_goes_on(void **state)
{
	(void)state;
	const char *events = brief ? "2e4" : "1e5";
	char arguments[600], command[800];
	snprintf(arguments, sizeof arguments, "hard-spheres --set particles=500 --set equilibrate=80 --events %s", events);
	json_t *whole = run(arguments);
	useconds_t wait = 20000;
	int caught = 0;
	for (int trial = 0; trial < 100 && caught < 3; trial++) {
		snprintf(command, sizeof command, "exec %s run %s --checkpoint %s/stop.h5 2>%s/err", TOUCHSTONE_PROGRAM,
				 arguments, folder, folder);
		pid_t process = kills_start(command);
		usleep(wait);
		kill(process, SIGINT);
		int status = program_status(process);
		char *err = folder_text(folder, "err"), *line = strstr(err, "to go on: touchstone ");
		if (line) {
			assert_int_equal(status, 130);
			line += strlen("to go on: touchstone run ");
			line[strcspn(line, "\n")] = '\0';
			json_t *rest = run(line);
			assert_same_run(whole, rest, line);
			assert_int_equal(folder_count(folder, "part"), 0);
			json_decref(rest);
			caught++;
		}
		wait = status == 0 ? wait / 2 : wait + wait / 4; /* it was through, or had not begun, or once more later */
		free(err);
	}
	assert_int_equal(caught, 3);
	json_decref(whole);
}

/* make soak does the same for longer. */
static void a_killed_run_goes_on(void **state)
{
	(void)state;
	const struct kills kills = {TOUCHSTONE_PROGRAM, folder,
								brief ? "square-well --set particles=200 --set density=0.2 --events 4e3"
									  : "square-well --set particles=500 --set density=0.2 --events 3e4",
								200};
	struct random_state random = random_seed(SEED + 1);
	struct kills_tally tally = {0};
	char expected[17], digest[17];
	double clock = progress_clock();
	assert_true(kills_run(&kills, 0, 0, &random, &tally, expected));
	double seconds = progress_clock() - clock;
	for (int trial = 0; tally.killed < 5 && trial < 5; trial++) {
		assert_true(kills_run(&kills, 5, seconds / 2, &random, &tally, digest));
		assert_string_equal(digest, expected);
	}
	print_message("%u killed, %u of them writing, %u resumed\n", tally.killed, tally.writing, tally.resumed);
	if (tally.unwhole) fail_msg("%s", tally.error);
	assert_true(tally.killed >= 5 && tally.resumed >= 1);
}

/* ------------------------------------------------------------------ what does not fit */

#define GAS "run hard-spheres --set particles=32 --set equilibrate=1"

static void refused(const char *words, const char *rest)
{
	program_refused(program_run(GAS " %s --resume %s/kept.h5", rest, folder), words);
}

static void what_does_not_fit_is_refused(void **state)
{
	(void)state;
	struct said said = program_run(GAS " --events 300 --checkpoint %s/kept.h5 --measure impact", folder);
	assert_int_equal(said.status, 0);
	said_free(&said);
	refused("another scene: hard-spheres, with seed 1; accepted", "--events 400 --set density=0.4");
	refused("another scene", "--events 400 --set particles=64");
	refused("another scene", "--events 400 --seed 2");
	refused("another scene", "--events 400 --set equilibrate=2");
	refused("another scene", "--events 400 --set form=absolute");
	refused("by stable, not naive; accepted: the same method", "--events 400 --method naive");
	refused("in binary64, not mpfr:53; accepted: the same arithmetic", "--events 400 --arithmetic mpfr:53");
	refused("come to 300 events; accepted", "--events 299");
	refused("come to a time of", "--time 0.001");
	refused("conservation was not measured", "--events 400 --measure conservation");
	refused("--runs: 2, with a checkpoint", "--events 400 --runs 2");
	refused("--against: accepted: without", "--events 400 --against mpfr:80");
	refused("--every: accepted: with --checkpoint", "--events 400 --every 5");
	program_refused(program_run(GAS " --events 10 --checkpoint %s/k.h5 --every 0", folder), "--every: '0'; accepted");
	program_refused(program_run(GAS " --events 10 --checkpoint %s", folder), "not a file");
	program_refused(program_run(GAS " --events 10 --resume %s/none.h5", folder), "none.h5: cannot be read");
	program_refused(program_run("run column --events 10 --resume %s/kept.h5", folder), "another scene");
	assert_int_equal(folder_count(folder, "k.h5"), 0);

	char path[400];
	snprintf(path, sizeof path, "%s/kept.h5", folder);
	json_t *json = program_json(program_run(GAS " --events 400 --json - --resume %s", path), 0);
	assert_int_equal((int)json_number(json_object_get(json, "impact"), "contacts"), 400); /* goes on unasked */
	json_decref(json);
	assert_int_equal(truncate(path, 5000), 0);
	refused("cut short", "--events 400");
}

int main(void)
{
	brief = getenv("TOUCHSTONE_BRIEF");
	print_message("seed %d\n", SEED);
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(parts_make_the_whole),
		cmocka_unit_test(an_interrupted_run_goes_on),
		cmocka_unit_test(a_killed_run_goes_on),
		cmocka_unit_test(what_does_not_fit_is_refused),
	};
	return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
