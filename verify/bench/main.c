/* make bench: what an event costs, here and now, beside what it cost when it was stored. */
#include <argp.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "bench/bench_result.h"
#include "bench/measure.h"
#include "bench/table.h"
#include "bench/timing.h"
#include "command/command.h"
#include "command/output.h"
#include "command/progress.h"
#include "provenance.h"
#include "store/text.h"

struct arguments {
	bool full, store;
	double scale;
	const char *baseline, *results, *count;
	uint64_t events;
};

enum { COUNT = 256, EVENTS };

static const struct argp_option options[] = {
	{"full", 'f', 0, 0, "More events, more repetitions, more counted: some 15 minutes instead of 4", 0},
	{"scale", 'x', "X", 0, "X times as many events, such as 0.01 to see whether it works", 0},
	{"baseline", 'b', "FILE", 0, "Run to compare with, written when there is none (build/bench-baseline.json)", 0},
	{"store", 's', 0, 0, "Replace that run by this one", 0},
	{"results", 'r', "DIR", 0, "Where the result is stored (build/results)", 0},
	{"count", COUNT, "POINT", OPTION_HIDDEN, 0, 0},
	{"events", EVENTS, "N", OPTION_HIDDEN, 0, 0},
	{0},
};

static error_t parse(int key, char *argument, struct argp_state *state)
{
	struct arguments *arguments = state->input;
	switch (key) {
	case 'f':
		arguments->full = true;
		return 0;
	case 'x':
		if (!text_number(argument, &arguments->scale) || !(arguments->scale > 0 && arguments->scale <= 1000))
			refuse_option("scale", argument, "a number above 0, to 1000");
		return 0;
	case 'b':
		arguments->baseline = argument;
		return 0;
	case 's':
		arguments->store = true;
		return 0;
	case 'r':
		arguments->results = argument;
		return 0;
	case COUNT:
		arguments->count = argument;
		return 0;
	case EVENTS:
		arguments->events = option_count("events", argument, 1, UINT64_MAX);
		return 0;
	default:
		return ARGP_ERR_UNKNOWN;
	}
}

/* What callgrind is to count (instructions.h). */
static int count(const struct arguments *arguments)
{
	struct effort effort = effort_of(arguments->full);
	char error[STORE_ERROR];
	int p = point_named(arguments->count);
	if (p < 0) return refuse("--count: '%.60s'; accepted: the name of a run, as the table has it", arguments->count);
	struct scene_file *file = point_open(&points[p], &effort, error);
	bool good = file && engine_count(file, arguments->events, error);
	scene_file_close(file);
	return good ? STATUS_WELL : refuse("%s", error);
}

/* Stores the result for the report, and the rows for later runs to be held against. */
static int store(const struct arguments *arguments, struct result *result, const struct findings *findings,
				 const struct row *rows, enum baseline_state state, double seconds)
{
	char command[80], error[REPORT_ERROR];
	bool usual = arguments->scale == 1, whole = !findings->stopped && usual;
	snprintf(command, sizeof command, "make bench%s", arguments->full ? " FULL=1" : "");
	if (!usual)
		snprintf(command, sizeof command, "bench%s --scale %g", arguments->full ? " --full" : "", arguments->scale);
	result_made_by(result, command, seconds, *TOUCHSTONE_REVISION ? TOUCHSTONE_REVISION : NULL);
	if (!result_write(result, arguments->results, error)) return refuse("%s", error);
	fprintf(stderr, "bench: stored as %s/bench.json\n", arguments->results);
	bool wanted = arguments->store || state == BASELINE_ABSENT;
	if (wanted && !whole) {
		fprintf(stderr, "bench: %s is not written: this run is no whole one\n", arguments->baseline);
	} else if (wanted) {
		if (!baseline_write(arguments->baseline, result_document(result), rows, ROWS, error))
			return refuse("%s", error);
		fprintf(stderr, "bench: later runs are held against this one, in %s\n", arguments->baseline);
	}
	return STATUS_WELL;
}

static int bench(const struct arguments *arguments)
{
	char error[STORE_ERROR];
	struct baseline *baseline;
	json_t *machine = provenance();
	enum baseline_state state = baseline_read(arguments->baseline, machine, &baseline, error);
	json_decref(machine);
	if (state == BASELINE_DAMAGED && !arguments->store) return refuse("%s", error);
	if (state == BASELINE_FOREIGN)
		fprintf(stderr, "bench: %s; so there are no quotients%s\n", error,
				arguments->store ? "" : " (STORE=1 replaces it)");

	struct findings *findings = malloc(sizeof *findings);
	struct row *rows = calloc(ROWS, sizeof *rows);
	struct demand demands[DEMANDS];
	struct effort effort = effort_of(arguments->full);
	effort.scale *= arguments->scale;
	int status = STATUS_REFUSED;
	double began = progress_clock();
	if (!findings || !rows) {
		refuse("out of memory");
	} else if (!aside_folder(arguments->results, error)) {
		refuse("%s", error);
	} else {
		findings_begin(findings, &effort);
		if (measure_all(findings, error)) {
			findings_rows(findings, rows);
			findings_demands(findings, demands);
			table_rows(stdout, rows, ROWS, baseline);
			table_demands(stdout, demands, DEMANDS);
			fflush(stdout);
			if (*findings->uncounted) fprintf(stderr, "bench: %s\n", findings->uncounted);
			struct result *result = bench_result(findings, rows, baseline);
			status = result ? store(arguments, result, findings, rows, state, progress_clock() - began)
							: refuse("out of memory");
			result_free(result);
			if (status == STATUS_WELL && findings->faults) status = STATUS_FINDING;
			if (status == STATUS_WELL && findings->stopped) status = STATUS_INTERRUPTED;
		} else {
			refuse("%s", error);
		}
	}
	baseline_free(baseline);
	free(rows);
	free(findings);
	return status;
}

int main(int argc, char **argv)
{
	const struct argp argp = {
		.options = options,
		.parser = parse,
		.doc = "Measures what an event costs: over the number of particles, over density, over precision; in time, in "
			   "instructions, in memory. Stores it as a result for `touchstone report`.\v"
			   "The scenes are cases of the folder cases, varied as by `touchstone run --set`. Ctrl-C keeps what is "
			   "done.\n\n"
			   "Exit status: 0 all well; 1 a run failed, or its events differed from those of another time; 2 bad "
			   "input; 130 interrupted.\n\n"
			   "Example: build/bench --scale 0.01",
	};
	struct arguments arguments = {
		.scale = 1, .baseline = "build/bench-baseline.json", .results = "build/results", .events = 1};
	argp_err_exit_status = STATUS_REFUSED;
	argp_parse(&argp, argc, argv, 0, NULL, &arguments);
	return arguments.count ? count(&arguments) : bench(&arguments);
}
