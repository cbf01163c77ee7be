/* `touchstone run`, as a user meets it: what a run comes to, and how it is told. */
#include <math.h>
#include <pty.h>
#include <signal.h>

#include "command/interrupt.h"
#include "command/progress.h"
#include "own_folder.h"
#include "program.h"
#include "scene/random.h"
#include "store/scene_file.h"

static const uint64_t seed = 20140831;

#define GAS "run hard-spheres --set particles=64 --set equilibrate=2"

/* The digest of a run with these arguments. */
static void find_digest(char digest[17], const char *arguments)
{
	json_t *json = program_json(program_run("%s --json -", arguments), 0);
	assert_int_equal(strlen(json_text(json, "digest")), 16);
	strcpy(digest, json_text(json, "digest"));
	json_decref(json);
}

static void assert_same(bool same, const char *one, const char *other)
{
	char digests[2][17];
	find_digest(digests[0], one);
	find_digest(digests[1], other);
	if ((strcmp(digests[0], digests[1]) == 0) != same) fail_msg("%s: %s, %s: %s", one, digests[0], other, digests[1]);
}

/* However the command line cuts a run into slices, it is the run that the library makes in one go. */
static void runs_are_the_librarys(void **state)
{
	(void)state;
	print_message("seed %llu\n", (unsigned long long)seed);
	const char *const arithmetics[] = {"binary64", "binary32", "short:12", "mpfr:80", "twin"};
	struct random_state random = random_seed(seed);
	for (size_t trial = 0; trial < 5; trial++) {
		unsigned start = (unsigned)random_below(&random, 1000000), events = 300 + (unsigned)random_below(&random, 3000);
		char setting[40], error[STORE_ERROR], reason[160];
		snprintf(setting, sizeof setting, "density=%.3f", 0.2 + 0.7 * random_uniform(&random));
		const char *const settings[] = {"particles=64", setting};
		struct scene_file *file = scene_file_open("cases/inelastic-spheres.yaml", 2, settings, error);
		assert_non_null(file);
		file->seed = start;
		struct touchstone_scene scene;
		assert_true(scene_file_build(file, &scene, error));
		struct touchstone_engine *engine = touchstone_create(&scene, arithmetics[trial], "stable", reason);
		assert_non_null(engine);
		struct touchstone_status status;
		touchstone_run(engine, &(struct touchstone_limits){events, INFINITY, NULL}, NULL);
		touchstone_status(engine, &status);
		touchstone_destroy(engine);
		scene_free(&scene);
		scene_file_close(file);

		json_t *json = program_json(program_run("run inelastic-spheres --set particles=64 --set %s --set equilibrate=0 "
												"--seed %u --events %u --arithmetic %s --json -",
												setting, start, events, arithmetics[trial]),
									0);
		char digest[17];
		snprintf(digest, sizeof digest, "%016llx", (unsigned long long)status.digest);
		assert_string_equal(json_text(json, "digest"), digest);
		assert_true(json_number(json, "time") == status.time);
		assert_int_equal((int)json_number(json, "events"), events);
		json_decref(json);
	}
}

static void a_seed_is_a_run(void **state)
{
	(void)state;
	assert_same(true, GAS " --events 2000 --seed 7", GAS " --events 2e3 --set seed=7 --measure impact,conservation");
	assert_same(false, GAS " --events 2000 --seed 7", GAS " --events 2000 --seed 8");
	assert_same(false, GAS " --events 2000", GAS " --events 2000 --set density=0.4");
	assert_same(false, GAS " --events 2000", GAS " --events 2001");
	assert_same(true, GAS " --events 2000 --set search=all", GAS " --events 2000");
	assert_same(true, GAS " --events 2000 --arithmetic mpfr:53", GAS " --events 2000 --set arithmetic=binary64");
}

static void threads_change_nothing(void **state)
{
	(void)state;
	json_t *json[2];
	for (int t = 0; t < 2; t++)
		json[t] = program_json(program_run(GAS " --events 1000 --seed 5 --runs 3 --threads %d --json -", t + 1), 0);
	for (size_t run = 0; run < 3; run++) {
		const json_t *one = json_array_get(json_object_get(json[0], "runs"), run);
		const json_t *other = json_array_get(json_object_get(json[1], "runs"), run);
		char alone[17], arguments[100];
		snprintf(arguments, sizeof arguments, GAS " --events 1000 --seed %zu", 5 + run);
		find_digest(alone, arguments);
		assert_string_equal(json_text(one, "digest"), alone);
		assert_string_equal(json_text(other, "digest"), alone);
		assert_int_equal((int)json_number(other, "seed"), 5 + run);
	}
	assert_int_equal(json_array_size(json_object_get(json[0], "runs")), 3);
	assert_int_equal((int)json_number(json_object_get(json[0], "together"), "events"), 3000);
	for (int t = 0; t < 2; t++) json_decref(json[t]);
}

static void json_says_all(void **state)
{
	(void)state;
	json_t *json = program_json(
		program_run(GAS
					" --events 2000 --arithmetic binary32 --measure conservation,impact,three-body --explain --json -"),
		0);
	static const char *const texts[] = {"scene",   "arithmetic", "method", "digest",
										"verdict", "reason",     "title",  "file"};
	static const char *const numbers[] = {"seed",      "collisions", "events", "wall_seconds", "collisions_per_second",
										  "particles", "dimensions", "time",   "time_begun",   "peak_memory_bytes"};
	for (size_t t = 0; t < sizeof texts / sizeof *texts; t++) json_text(json, texts[t]);
	for (size_t n = 0; n < sizeof numbers / sizeof *numbers; n++) json_number(json, numbers[n]);
	assert_string_equal(json_text(json, "scene"), "hard-spheres");
	assert_string_equal(json_text(json, "arithmetic"), "binary32");
	assert_string_equal(json_text(json, "verdict"), "done");
	assert_int_equal((int)json_number(json, "bits"), 24);
	assert_int_equal((int)json_number(json, "collisions"), 2000);
	assert_true(json_number(json, "time_begun") > 0 && json_number(json, "time") > json_number(json, "time_begun"));
	assert_true(json_number(json, "peak_memory_bytes") > 64 * json_number(json, "bytes_per_particle"));
	assert_true(json_array_size(json_object_get(json, "explained")) > 3);

	const json_t *conservation = json_object_get(json, "conservation"), *impact = json_object_get(json, "impact");
	double energy = json_number_value(json_array_get(json_object_get(conservation, "energy"), 0));
	assert_true(fabs(energy - 96) < 1e-3); /* 3/2 N kT */
	double drift = json_number(conservation, "energy_drift");
	assert_true(fabs(drift) < 1e-4 && drift != 0);
	assert_true(fabs(json_number(conservation, "energy_drift_per_million") - 500 * drift) <= 1e-9 * fabs(drift));
	assert_int_equal((int)json_number(impact, "contacts"), 2000);
	const json_t *exact = json_object_get(impact, "exact"), *bar;
	double fraction = json_number(exact, "fraction_below");
	assert_true(fraction > 0.3 && fraction < 0.7); /* 2014 paper: about half */
	size_t index;
	json_int_t total = 0;
	json_array_foreach(json_object_get(exact, "bars"), index, bar) total += json_integer_value(bar);
	assert_int_equal(total, 2000);
	const json_t *three_body = json_object_get(json, "three_body");
	assert_int_equal((int)json_number(three_body, "contacts"), 2000);
	assert_int_equal((int)json_number(three_body, "overlapping"), (int)json_number(exact, "below"));
	double rate = json_number(three_body, "rate");
	const json_t *interval = json_object_get(three_body, "rate_interval");
	assert_true(rate == json_number(three_body, "events") / 2000);
	assert_true(json_number_value(json_array_get(interval, 0)) <= rate);
	assert_true(json_number_value(json_array_get(interval, 1)) > rate);
	json_decref(json);

	/* The file is what standard output is, and the table is printed beside it. */
	struct said said = program_run(GAS " --events 500 --json %s/run.json", folder);
	char *text = folder_text(folder, "run.json");
	json = json_loads(text, 0, NULL);
	assert_int_equal(said.status, 0);
	assert_non_null(json);
	assert_non_null(strstr(said.out, json_text(json, "digest")));
	assert_string_equal(said.err, "");
	free(text);
	json_decref(json);
	said_free(&said);
}

/* Which verdict a run ends with, and the exit status that goes with it. */
static void verdicts_have_statuses(void **state)
{
	(void)state;
	static const struct {
		const char *arguments, *verdict, *reason;
		int status;
	} runs[] = {
		{"run cases/bouncing-ball.yaml --json -", "collapsed", "particle 0", 0},
		{"run three-body --json -", "done", "no event is left", 0},
		{"run three-body --method naive --json -", "halted", "negative", 1},
		{"run inelastic-spheres --set particles=100 --method naive --arithmetic short:8 --measure failure --json -",
		 "halted", "during equilibration: ", 1},
		{"run cradle.yaml --events 10 --json -", "done", "", 0},
		{"run cradle --events 0 --json -", "done", "", 0},
	};
	for (size_t r = 0; r < sizeof runs / sizeof *runs; r++) {
		json_t *json = program_json(program_run("%s", runs[r].arguments), runs[r].status);
		assert_string_equal(json_text(json, "verdict"), runs[r].verdict);
		assert_non_null(strstr(json_text(json, "reason"), runs[r].reason));
		assert_true(!strstr(runs[r].reason, "equilibration") || json_number(json, "events") == 0);
		const json_t *failure = json_object_get(json, "failure");
		if (failure) assert_string_equal(json_text(failure, "what"), "halts");
		json_decref(json);
	}
}

static void limits_are_kept(void **state)
{
	(void)state;
	json_t *json = program_json(program_run(GAS " --set events=1e15 --time 0.5 --json -"), 0);
	assert_true(fabs(json_number(json, "time") - json_number(json, "time_begun") - 0.5) < 1e-12);
	assert_true(json_number(json, "events") > 50 && json_number(json, "events") < 1e4);
	json_decref(json);

	json = program_json(program_run(GAS " --events 0 --json -"), 0);
	assert_true(json_number(json, "events") == 0 && json_number(json, "time") == 0); /* nor equilibrated */
	json_decref(json);

	folder_put(folder, "limitless.yaml", "dimensions: 3\nparticles: 30\ndensity: 0.3\n");
	struct said said = program_run("run %s/limitless.yaml --json -", folder);
	assert_non_null(strstr(said.err, "1500 events")); /* 100 for each, two take part */
	json = json_loads(said.out, 0, NULL);
	assert_int_equal((int)json_number(json, "events"), 1500);
	json_decref(json);
	said_free(&said);
}

static void cases_are_found_by_name(void **state)
{
	(void)state;
	char arguments[100];
	folder_put(folder, "pair.yaml", "dimensions: 1\nparticles: 2\ndensity: 0.5\nevents: 10\n");
	snprintf(arguments, sizeof arguments, "run pair --cases %s", folder);
	char *direct;
	assert_true(asprintf(&direct, "run %s/pair.yaml", folder) > 0);
	assert_same(true, arguments, direct);
	assert_same(true, "run cradle --events 20", "run cases/cradle.yaml --events 20");
	program_refused(program_run("run cradle --cases %s", folder), "cradle: no such file, nor a case in ");
	free(direct);
}

static void explanations_need_no_run(void **state)
{
	(void)state;
	struct said ball = program_run("run bouncing-ball --explain --events 0");
	assert_int_equal(ball.status, 0);
	assert_non_null(strstr(ball.out, "Bouncing ball"));
	assert_non_null(strstr(ball.out, "no cells are built"));
	assert_null(strstr(ball.out, "digest"));
	said_free(&ball);
	struct said run = program_run("run bouncing-ball --explain");
	assert_non_null(strstr(run.out, "no cells are built"));
	assert_non_null(strstr(run.out, "digest"));
	said_free(&run);
}

static void particles_can_be_taken_up_again(void **state)
{
	(void)state;
	struct said said = program_run(GAS " --events 300 --xyz %s/end.xyz", folder);
	assert_int_equal(said.status, 0);
	said_free(&said);
	folder_put(folder, "again.yaml", "start: {positions: file, file: end.xyz}\nevents: 0\n");
	json_t *json = program_json(program_run("run %s/again.yaml --measure conservation --json -", folder), 0);
	const json_t *energy = json_object_get(json_object_get(json, "conservation"), "energy");
	assert_int_equal((int)json_number(json, "particles"), 64);
	assert_true(fabs(json_number_value(json_array_get(energy, 0)) - 96) < 1e-9);
	json_decref(json);
	program_refused(program_run(GAS " --events 3 --runs 2 --xyz %s/more.xyz", folder), "a single run");
	assert_int_equal(folder_count(folder, "more"), 0);
}

/* Runs at a terminal until progress shows, then sends a signal. Returns the status; what the terminal saw is in
 * `seen`, which the caller frees. */
static int interrupt_run(const char *path, int signal, char **seen)
{
	int terminal;
	char *words[PROGRAM_WORDS], text[200];
	snprintf(text, sizeof text, GAS " --set equilibrate=0 --events 1e15 --measure impact,conservation --json %s", path);
	program_words(text, words);
	pid_t process = forkpty(&terminal, NULL, NULL, &(struct winsize){.ws_row = 24, .ws_col = 132});
	if (process == 0) {
		execv(words[0], words);
		_exit(99);
	}
	assert_true(process > 0);
	size_t room = 1 << 20, length = 0;
	*seen = calloc(room, 1);
	bool sent = false;
	for (ssize_t more; length + 1 < room && (more = read(terminal, *seen + length, room - 1 - length)) > 0;) {
		length += (size_t)more;
		if (sent || !strstr(*seen, " left")) continue;
		assert_int_equal(kill(process, signal), 0);
		sent = true;
	}
	close(terminal);
	assert_true(sent);
	return program_status(process);
}

static void signals_keep_what_is_done(void **state)
{
	(void)state;
	static const int signals[] = {SIGINT, SIGTERM};
	for (int s = 0; s < 2; s++) {
		char path[64], *seen;
		snprintf(path, sizeof path, "%s/stopped.json", folder);
		int status = interrupt_run(path, signals[s], &seen);
		if (status != 130) fail_msg("status %d: %s", status, seen);
		const char *progress = strstr(seen, "hard-spheres: "), *table = strstr(seen, "verdict         interrupted");
		assert_true(progress && table && progress < table);
		assert_non_null(strstr(seen, " / 1e+15 events, "));
		assert_non_null(strstr(seen, "\r\033[K")); /* erased before the table */
		free(seen);
		json_t *json = json_load_file(path, 0, NULL);
		assert_non_null(json);
		assert_string_equal(json_text(json, "verdict"), "interrupted");
		assert_true(json_is_false(json_object_get(json, "complete")));
		assert_true(json_number(json, "events") > 0);
		assert_true(json_number(json_object_get(json, "impact"), "contacts") == json_number(json, "events"));
		assert_non_null(strstr(json_text(json, "reason"), "signal"));

		/* What is kept is a run that could have been asked for. */
		char arguments[128];
		snprintf(arguments, sizeof arguments, GAS " --set equilibrate=0 --events %.0f", json_number(json, "events"));
		char digest[17];
		find_digest(digest, arguments);
		assert_string_equal(json_text(json, "digest"), digest);
		json_decref(json);
		unlink(path);
	}
	assert_int_equal(folder_count(folder, ".part"), 0);
}

/* The first signal is taken note of, the second has its usual effect. */
static void a_second_signal_ends_at_once(void **state)
{
	(void)state;
	pid_t process = fork();
	if (process == 0) {
		interrupt_watch();
		if (interrupted() || *interrupt_flag()) _exit(1);
		raise(SIGINT);
		if (!interrupted() || !*interrupt_flag()) _exit(2);
		raise(SIGINT);
		_exit(3);
	}
	assert_true(process > 0);
	assert_int_equal(program_status(process), 128 + SIGINT);
}

static void durations_are_rounded(void **state)
{
	(void)state;
	static const struct {
		double seconds;
		const char *text;
	} durations[] = {{0, "0 s"},           {59.4, "59 s"},          {59.6, "1 min 00 s"},
					 {200, "3 min 20 s"},  {3569.4, "59 min 29 s"}, {3599, "1 h 00 min"},
					 {7500, "2 h 05 min"}, {INFINITY, "unknown"},   {NAN, "unknown"}};
	char text[32];
	for (size_t d = 0; d < sizeof durations / sizeof *durations; d++)
		assert_string_equal(progress_duration(text, durations[d].seconds), durations[d].text);
}

int main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(runs_are_the_librarys),           cmocka_unit_test(a_seed_is_a_run),
		cmocka_unit_test(threads_change_nothing),          cmocka_unit_test(json_says_all),
		cmocka_unit_test(verdicts_have_statuses),          cmocka_unit_test(limits_are_kept),
		cmocka_unit_test(cases_are_found_by_name),         cmocka_unit_test(explanations_need_no_run),
		cmocka_unit_test(particles_can_be_taken_up_again), cmocka_unit_test(signals_keep_what_is_done),
		cmocka_unit_test(a_second_signal_ends_at_once),    cmocka_unit_test(durations_are_rounded),
	};
	return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
