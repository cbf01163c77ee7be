/* Two small campaigns in this program's folder, for tests of `touchstone campaign`. */
#ifndef VERIFY_TEST_CAMPAIGN_SAMPLES_H
#define VERIFY_TEST_CAMPAIGN_SAMPLES_H

#include "program.h"

static char *folder;
static json_t *expected; /* the runs of the small campaign, made by one thread */

enum { RUNS = 12 };

/* Everything that can be measured of a run. */
static const char small_campaign[] = "title: small\n"
									 "scene: square-well\n"
									 "set: {particles: 32, start.temperature: 2, equilibrate: 5}\n"
									 "grid:\n"
									 "  density: [0.2, 0.4]\n"
									 "  arithmetic: [binary64, 'short:12']\n"
									 "seeds: [1..2, 7]\n"
									 "events: 1e3\n"
									 "measures: [impact, conservation, three-body, failure, states]\n"
									 "against: mpfr:100\n";

/* Slow enough to be killed on the way, for each run some 50 ms. */
static const char slow_campaign[] = "scene: hard-spheres\n"
									"set: {particles: 32, equilibrate: 0, arithmetic: mpfr:100}\n"
									"grid: {density: [0.2, 0.4]}\n"
									"seeds: 1..6\n"
									"events: 5000\n";

/* What the keys determine of the runs, which `from` holds. */
static inline json_t *runs_of(json_t *from)
{
	json_t *runs = json_incref(json_object_get(from, "runs")), *run;
	size_t r;
	json_array_foreach(runs, r, run) json_object_del(run, "made");
	json_decref(from);
	return runs;
}

static inline json_t *finish(const char *where, const char *name)
{
	struct said said =
		program_run("campaign %s/%s.yaml --results %s/%s --threads 2 --json -", folder, name, folder, where);
	return runs_of(program_json(said, 0));
}

/* Starts a program, its messages going to the file `log`. */
static inline pid_t launch(char *words[])
{
	pid_t process = fork();
	if (process > 0) return process;
	if (!freopen("/dev/null", "r", stdin) || !freopen("/dev/null", "w", stdout)) _exit(99);
	char log[200];
	snprintf(log, sizeof log, "%s/log", folder);
	if (!freopen(log, "w", stderr)) _exit(99);
	execvp(words[0], words);
	_exit(99);
}

static inline int set_up(void **state)
{
	(void)state;
	folder = folder_new();
	folder_put(folder, "small.yaml", small_campaign);
	folder_put(folder, "slow.yaml", slow_campaign);
	expected = finish("threads", "small");
	return 0;
}

static inline int tear_down(void **state)
{
	(void)state;
	json_decref(expected);
	folder_remove(folder);
	return 0;
}

#endif
