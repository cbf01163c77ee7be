/* touchstone run: one scene, once or several times. */
#include "command/command.h"

#include <argp.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "command/cases.h"
#include "command/checkpointing.h"
#include "command/interrupt.h"
#include "command/outcome.h"
#include "command/output.h"
#include "measure/course.h"

static const double default_meetings = 100; /* collisions per particle, where nothing limits a run */

static const uint64_t most_traced = 100000; /* events */

/* Options without a letter; the first ones are scene keys of the same name. */
enum {
	ARITHMETIC = 256,
	METHOD,
	EVENTS,
	TIME,
	SEED,
	SET,
	EXPLAIN,
	JSON,
	XYZ,
	MEASURE,
	AGAINST,
	TRACE,
	RUNS,
	THREADS,
	CHECKPOINT,
	EVERY,
	RESUME,
	CASES
};

static const struct argp_option options[] = {
	{"arithmetic", ARITHMETIC, "A", 0,
	 "Arithmetic of the engine, such as binary64 or mpfr:200; `touchstone list` has all", 1},
	{"method", METHOD, "M", 0, "Method that finds events, such as stable or naive; `touchstone list` has all", 1},
	{"events", EVENTS, "N", 0,
	 "Events to execute, such as 1e6 (those of the scene, or else 100 per particle). With 0 nothing is run, not even "
	 "equilibration",
	 1},
	{"time", TIME, "T", 0, "Simulated time to run for, after equilibration", 1},
	{"seed", SEED, "S", 0, "Seed of the start state", 1},
	{"set", SET, "KEY=VALUE", 0,
	 "Override any key of the scene, such as density=0.9; may be repeated, the last one counts", 1},
	{"explain", EXPLAIN, 0, 0, "First say what is modelled and what is left out. With --events 0, say only that", 2},
	{"measure", MEASURE, "LIST", 0, "Measure on the way", 2},
	{"against", AGAINST, "A", 0,
	 "Run the same start in the finer arithmetic A as well, such as mpfr:256, and say for how many events this run can "
	 "be trusted: until the two sequences of events first differ",
	 2},
	{"trace", TRACE, 0, 0,
	 "Tell every event: particles, time, separation, velocities after, and whether it is stabilising (at once, on an "
	 "overlap) or goes back in time. One run, of 100000 events at most",
	 2},
	{"json", JSON, "FILE", 0, "Write what came of it as JSON; - for standard output, instead of the table", 2},
	{"xyz", XYZ, "FILE", 0,
	 "Write the particles at the end as extended XYZ, with how many partners each has captured where there are steps; "
	 "with --every, first those at the beginning and on the way, as frames of the one file",
	 2},
	{"runs", RUNS, "R", 0, "Run R times, with the seeds S, S+1, ... (1)", 3},
	{"threads", THREADS, "K", 0, "Run K of them at a time (1); the results do not depend on it", 3},
	{"checkpoint", CHECKPOINT, "FILE", 0,
	 "Write the whole state to FILE at the end and on Ctrl-C, so that --resume can go on from it", 4},
	{"every", EVERY, "N", 0, "Write what --checkpoint and --xyz write whenever so many more events have been executed",
	 4},
	{"resume", RESUME, "FILE", 0,
	 "Go on from a checkpoint of the same scene as if the run had never stopped: --events, --time and what is measured "
	 "mean the whole of it",
	 4},
	{"cases", CASES, "DIR", 0, "Folder in which scenes are found by name", 5},
	{0}};

struct wish {
	const char *scene, *json, *xyz, *folder, *against, *checkpoint, *resume;
	bool explain, trace;
	unsigned measures; /* of enum run_measure */
	uint64_t runs, threads, every;
	char **words;    /* of the command line, the first being the command */
	char **settings; /* KEY=VALUE, each from malloc */
	size_t setting_count;
};

/* An option that is a key of the scene goes the way of --set. */
static void add_setting(struct wish *wish, const char *key, const char *value)
{
	char *setting;
	if (asprintf(&setting, "%s%s%s", key ? key : "", key ? "=" : "", value) < 0) refuse_usage("out of memory");
	wish->settings[wish->setting_count++] = setting;
}

static void choose_measures(struct wish *wish, char *list)
{
	char accepted[RUN_MEASURE_NAMES + 40], names[RUN_MEASURE_NAMES];
	for (char *word; (word = strsep(&list, ","));) {
		unsigned measure = run_measure_named(word);
		snprintf(accepted, sizeof accepted, "%s, or several with commas", run_measure_names(names));
		if (!measure) refuse_option("measure", word, accepted);
		wish->measures |= measure;
	}
}

/* The help of --measure goes on with what there is to measure. */
static char *help(int key, const char *text, void *input)
{
	(void)input;
	if (key != MEASURE) return (char *)text;
	char *whole = NULL;
	size_t size;
	FILE *stream = open_memstream(&whole, &size);
	if (!stream) return (char *)text;
	fputs(text, stream);
	for (const struct run_measure_entry *entry = run_measures; entry->name; entry++)
		fprintf(stream, "%s%s (%s)", entry == run_measures ? ": " : ", ", entry->name, entry->about);
	fclose(stream);
	return whole;
}

static error_t parse(int key, char *argument, struct argp_state *state)
{
	struct wish *wish = state->input;
	switch (key) {
	case ARITHMETIC:
	case METHOD:
	case EVENTS:
	case TIME:
	case SEED:
		add_setting(wish, options[key - ARITHMETIC].name, argument);
		return 0;
	case SET:
		add_setting(wish, NULL, argument);
		return 0;
	case EXPLAIN:
		wish->explain = true;
		return 0;
	case AGAINST:
		wish->against = argument;
		return 0;
	case TRACE:
		wish->trace = true;
		return 0;
	case JSON:
		wish->json = argument;
		return 0;
	case XYZ:
		wish->xyz = argument;
		return 0;
	case MEASURE:
		choose_measures(wish, argument);
		return 0;
	case RUNS:
		wish->runs = option_count("runs", argument, 1, 100000);
		return 0;
	case THREADS:
		wish->threads = option_count("threads", argument, 1, 1024);
		return 0;
	case CHECKPOINT:
		wish->checkpoint = argument;
		return 0;
	case EVERY:
		wish->every = option_count("every", argument, 1, UINT64_MAX);
		return 0;
	case RESUME:
		wish->resume = argument;
		return 0;
	case CASES:
		wish->folder = argument;
		return 0;
	case ARGP_KEY_ARG:
		if (wish->scene) refuse_usage("run: '%.60s' is a second scene; accepted: one", argument);
		wish->scene = argument;
		return 0;
	case ARGP_KEY_NO_ARGS:
		refuse_usage("run: no scene; accepted: a scene file, or a case by its name, see touchstone list cases");
	default:
		return ARGP_ERR_UNKNOWN;
	}
}

static void keep_line(void *lines, const char *text)
{
	json_array_append_new(lines, json_string(text));
}

/* How the engine goes about the scene: a list of lines, printed as well. NULL with a message. */
static json_t *explain(const struct scene_file *file, FILE *stream, char error[STORE_ERROR])
{
	struct simulation simulation;
	if (!simulation_open(&simulation, file, file->seed, error)) return NULL;
	json_t *lines = json_array(), *line;
	keep_line(lines, file->title);
	if (*file->about) keep_line(lines, file->about);
	touchstone_explain(simulation.engine, keep_line, lines);
	simulation_close(&simulation);
	size_t index;
	json_array_foreach(lines, index, line) fprintf(stream, "%s\n", json_string_value(line));
	fputs("\n", stream);
	return lines;
}

/* Makes all runs; several at a time, each in its own engine. */
static void make_runs(const struct run_plan *plan, const struct wish *wish, struct outcome *outcomes)
{
	struct simulation_progress progress = {.line = progress_begin(plan->file->name, "events"),
										   .runs = (unsigned)wish->runs};
	interrupt_watch();
#pragma omp parallel for schedule(dynamic, 1) num_threads((int)wish->threads)
	for (uint64_t run = 0; run < wish->runs; run++)
		outcome_find(&outcomes[run], plan, plan->file->seed + run, &progress);
	progress_end(&progress.line);
}

static bool limited(const struct scene_file *file)
{
	return file->limits.events < UINT64_MAX || file->limits.time < INFINITY;
}

/* Tells what came of the runs, and returns the exit status. */
static int tell(const struct run_plan *plan, const struct wish *wish, const struct outcome *outcomes, json_t *explained)
{
	bool interrupted = false, broken = false;
	for (size_t run = 0; run < wish->runs; run++) {
		if (outcomes[run].failed) return refuse("%s", outcomes[run].error);
		enum touchstone_verdict verdict = outcomes[run].status.verdict;
		interrupted |= outcomes[run].interrupted;
		broken |= verdict == TOUCHSTONE_HALTED || verdict == TOUCHSTONE_DIVERGED ||
				  (plan->measures & RUN_FAILURE && !failure_survived(&outcomes[run].failure));
	}
	if (!limited(plan->file))
		fprintf(stderr, "touchstone: neither events nor time given; ran %llu events, so that each particle meets %g\n",
				(unsigned long long)plan->limits.events, default_meetings);
	int status = interrupted ? STATUS_INTERRUPTED : broken ? STATUS_FINDING : STATUS_WELL;
	if (*outcomes->error) status = refuse("%s", outcomes->error);
	if (wish->json) {
		char error[REPORT_ERROR];
		json_t *json = outcome_json(plan, outcomes, wish->runs, explained);
		if (!output_json(wish->json, json, error)) status = refuse("%s", error);
		json_decref(json);
	}
	bool only_explained = explained && plan->limits.events == 0, taken = wish->json && strcmp(wish->json, "-") == 0;
	if (!only_explained && !taken) outcome_print(plan, outcomes, wish->runs);
	return status;
}

/* What to type for an interrupted run to go on. */
static void tell_how_to_resume(const struct wish *wish)
{
	fprintf(stderr, "touchstone: to go on: touchstone run");
	for (char **word = wish->words + 1; *word; word++) {
		if (strncmp(*word, "--resume", strlen("--resume")) == 0)
			word += !strchr(*word, '=') && word[1];
		else
			fprintf(stderr, strpbrk(*word, " '\"[]{}*?$\\&|;<>()#") ? " '%s'" : " %s", *word);
	}
	fprintf(stderr, " --resume %s\n", wish->checkpoint);
}

static int run_file(const struct wish *wish, const char *path, const struct scene_file *file,
					const struct checkpoint *resumed)
{
	char error[STORE_ERROR];
	if (!simulation_names(file, error)) return refuse("%s", error);
	if (file->seed > INT64_MAX - wish->runs) {
		scene_file_refuse(file, error, "seed", "%llu; accepted: with %llu runs, up to %llu",
						  (unsigned long long)file->seed, (unsigned long long)wish->runs,
						  (unsigned long long)(INT64_MAX - wish->runs));
		return refuse("%s", error);
	}
	char reason[160];
	if (wish->against && !horizon_possible(file->arithmetic, wish->against, reason))
		return refuse("--against: %s", reason);
	struct touchstone_limits limits = file->limits;
	if (!limited(file)) limits.events = course_events(default_meetings, file->recipe.particle_count);
	if (wish->trace && limits.events > most_traced) limits.events = most_traced;
	const struct run_plan plan = {
		.path = path,
		.file = file,
		.limits = limits,
		.settings = (const char *const *)wish->settings,
		.setting_count = wish->setting_count,
		.measures = wish->measures | (resumed ? checkpointing_measures(resumed) : 0),
		.trace = wish->trace,
		.xyz = wish->xyz,
		.against = wish->against,
		.checkpoint = wish->checkpoint,
		.every = wish->every,
		.resume = wish->resume,
		.resumed = resumed,
	};
	json_t *explained = NULL;
	FILE *stream = wish->json && strcmp(wish->json, "-") == 0 ? stderr : stdout;
	if (wish->explain && !(explained = explain(file, stream, error))) return refuse("%s", error);

	struct outcome *outcomes = calloc(wish->runs, sizeof *outcomes);
	int status = STATUS_REFUSED;
	if (outcomes) {
		make_runs(&plan, wish, outcomes);
		status = tell(&plan, wish, outcomes, explained);
		if (status == STATUS_INTERRUPTED && outcomes->checkpoints) tell_how_to_resume(wish);
		for (size_t run = 0; run < wish->runs; run++) outcome_free(&outcomes[run]);
	} else {
		refuse("no memory for %llu runs", (unsigned long long)wish->runs);
	}
	free(outcomes);
	json_decref(explained);
	return status;
}

static int run(const struct wish *wish)
{
	char error[STORE_ERROR];
	if ((wish->checkpoint || wish->resume) && wish->runs > 1)
		return refuse("--runs: %llu, with a checkpoint; accepted: a checkpoint of a single run",
					  (unsigned long long)wish->runs);
	if ((wish->checkpoint || wish->resume) && wish->against)
		return refuse("--against: accepted: without --checkpoint and --resume, since both runs begin together");
	if (wish->every && ((!wish->checkpoint && !wish->xyz) || wish->trace))
		return refuse("--every: accepted: with --checkpoint or --xyz, and without --trace");
	if (wish->xyz && (wish->runs > 1 || strcmp(wish->xyz, "-") == 0))
		return refuse("--xyz: accepted: a file, and a single run");
	const char *unkept = wish->trace                    ? "trace"
						 : wish->measures & RUN_FAILURE ? "measure failure"
						 : wish->measures & RUN_STATES  ? "measure states"
														: NULL;
	if ((wish->checkpoint || wish->resume) && unkept)
		return refuse("--%s: accepted: without --checkpoint and --resume", unkept);
	if (wish->trace && wish->runs > 1) return refuse("--trace: accepted: a single run");
	if ((wish->json && !output_possible(wish->json, error)) || (wish->xyz && !output_possible(wish->xyz, error)) ||
		(wish->checkpoint && !output_possible(wish->checkpoint, error)))
		return refuse("%s", error);
	const char *folder = cases_folder(wish->folder);
	char *path = cases_find(folder, wish->scene);
	if (!path)
		return refuse("%s: no such file, nor a case in %s; accepted: a scene file, or a name that `touchstone list "
					  "cases` has",
					  wish->scene, folder);
	int status = STATUS_REFUSED;
	struct checkpoint resumed = {0};
	struct scene_file *file = scene_file_open(path, wish->setting_count, (const char *const *)wish->settings, error);
	if (file && (!wish->resume || checkpoint_read(wish->resume, &resumed, error)))
		status = run_file(wish, path, file, wish->resume ? &resumed : NULL);
	else
		refuse("%s", error);
	checkpoint_free(&resumed);
	scene_file_close(file);
	free(path);
	return status;
}

int command_run(int argc, char **argv)
{
	static const struct argp argp = {
		.options = options,
		.parser = parse,
		.args_doc = "SCENE",
		.help_filter = help,
		.doc = "Runs a scene and tells what became of it: how many events, its verdict, how fast it was, and a digest "
			   "that is the same for every compiler, optimisation and number of threads. SCENE is a file, or a case by "
			   "its name.\v"
			   "Verdicts: done, a limit was reached or no event is left; collapsed, events go on but time does not; "
			   "halted, the method has no answer; diverged, a number is no longer finite; interrupted, by Ctrl-C.\n\n"
			   "With --against both arithmetics are given the same start: after equilibration the run begins anew, a "
			   "moment "
			   "later, from its state rounded to doubles. Without equilibration it is the run that it is without.\n\n"
			   "Exit status: 0 done or collapsed; 1 halted or diverged, or a failure measured; 2 bad input; 130 "
			   "interrupted, and what was done "
			   "by then is told all the same.\n\n"
			   "A run that is stopped and resumed, at any event, ends with the digest of the run that never was.\n\n"
			   "Example: touchstone run hard-spheres --set density=0.9 --events 1e6 --measure impact --json -\n"
			   "         touchstone run mixture --against mpfr:256",
	};
	struct wish wish = {.runs = 1, .threads = 1, .words = argv, .settings = calloc((size_t)argc, sizeof(char *))};
	if (!wish.settings) return refuse("out of memory");
	argp_parse(&argp, argc, argv, 0, NULL, &wish);
	int status = run(&wish);
	for (size_t s = 0; s < wish.setting_count; s++) free(wish.settings[s]);
	free(wish.settings);
	return status;
}
