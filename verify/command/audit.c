/* touchstone audit: a suite against its thresholds and its history. */
#include "command/command.h"

#include <argp.h>
#include <inttypes.h>
#include <math.h>
#include <omp.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "audit/audit.h"
#include "command/cases.h"
#include "command/output.h"
#include "junit.h"
#include "provenance.h"
#include "result.h"
#include "store/text.h"

enum { SUITE = 256, BUDGET, HISTORY, ACCEPT, SEED, JSON, JUNIT, THREADS, REVISION, CASES };

static const struct argp_option options[] = {
	{"suite", SUITE, "FILE", 0, "The suite: a file, or the name of one in cases/suites (standard)", 1},
	{"budget", BUDGET, "TIME", 0,
	 "Time it may take, such as 90s, 10m, 2h: the most telling checks come first, and what is not reached is said", 1},
	{"seed", SEED, "S", 0, "Seed of all checks that have none of their own (1); a new one every night tests more", 1},
	{"history", HISTORY, "FILE.db", 0, "Compare with the audits in this file, and add this one; made when absent", 2},
	{"accept", ACCEPT, "CHECK", 0,
	 "What this check finds now is what it should: hold later audits against it. May be repeated; all is all checks",
	 2},
	{"revision", REVISION, "TEXT", 0, "What is audited, for the history (the revision touchstone was built from)", 2},
	{"json", JSON, "FILE", 0, "Write what came of it as JSON; - for standard output, instead of the table", 3},
	{"junit", JUNIT, "FILE", 0, "Write it as JUnit XML, for continuous integration; - likewise", 3},
	{"threads", THREADS, "K", 0, "Work on K threads (as many as there are cores); only timings depend on it", 4},
	{"cases", CASES, "DIR", 0, "Folder in which scenes and suites are found by name", 4},
	{0}};

struct wish {
	const char *suite, *history, *json, *junit, *folder, *revision;
	const char **accepted;
	size_t accepted_count;
	double budget;
	uint64_t seed;
	int threads;
};

/* "90s", "10m", "2h", "1.5h"; a number alone is seconds. */
static double option_time(const char *argument)
{
	static const char accepted[] = "a time above 0, such as 90s, 10m, 2h";
	size_t length = strlen(argument);
	char unit = length ? argument[length - 1] : '\0', *number = strdup(argument);
	double seconds = 0, scale = unit == 'h' ? 3600 : unit == 'm' ? 60 : 1;
	if (number && strchr("smh", unit) && length) number[length - 1] = '\0';
	bool good = number && text_number(number, &seconds) && seconds * scale > 0 && seconds * scale < 1e8;
	free(number);
	if (!good) refuse_option("budget", argument, accepted);
	return seconds * scale;
}

static error_t parse(int key, char *argument, struct argp_state *state)
{
	struct wish *wish = state->input;
	switch (key) {
	case SUITE:
		wish->suite = argument;
		return 0;
	case BUDGET:
		wish->budget = option_time(argument);
		return 0;
	case SEED:
		wish->seed = option_count("seed", argument, 0, 1000000000000);
		return 0;
	case HISTORY:
		wish->history = argument;
		return 0;
	case ACCEPT:
		wish->accepted[wish->accepted_count++] = argument;
		return 0;
	case REVISION:
		wish->revision = argument;
		return 0;
	case JSON:
		wish->json = argument;
		return 0;
	case JUNIT:
		wish->junit = argument;
		return 0;
	case THREADS:
		wish->threads = (int)option_count("threads", argument, 1, 1024);
		return 0;
	case CASES:
		wish->folder = argument;
		return 0;
	case ARGP_KEY_ARG:
		refuse_usage("audit: '%.60s' is too much; accepted: options only, see touchstone audit --help", argument);
	default:
		return ARGP_ERR_UNKNOWN;
	}
}

static bool is_output(const char *path)
{
	return path && strcmp(path, "-") == 0;
}

/* Whether all that is to be accepted is there. */
static bool check_accepted(const struct wish *wish, const struct suite *suite)
{
	for (size_t a = 0; a < wish->accepted_count; a++) {
		bool found = strcmp(wish->accepted[a], "all") == 0;
		for (size_t c = 0; c < suite->check_count; c++) found |= strcmp(wish->accepted[a], suite->checks[c].name) == 0;
		if (!found)
			return refuse("--accept: '%.60s'; accepted: all, or the name of a check of %s", wish->accepted[a],
						  suite->name) == STATUS_WELL;
	}
	return true;
}

static int tell(const struct wish *wish, const struct audit *audit)
{
	char error[REPORT_ERROR];
	json_t *json = audit_json(audit);
	int status = audit->interrupted                    ? STATUS_INTERRUPTED
				 : audit_finding(audit)                ? STATUS_FINDING
				 : audit_count(audit, AUDIT_DONE) == 0 ? STATUS_FINDING
													   : STATUS_WELL;
	if (!is_output(wish->json) && !is_output(wish->junit)) audit_print(stdout, audit);
	if (wish->json && !output_json(wish->json, json, error)) status = refuse("%s", error);
	if (wish->junit && !junit_write(wish->junit, json, error)) status = refuse("%s", error);
	if (*audit->trouble) status = refuse("%s", audit->trouble);
	json_decref(json);
	return status;
}

/* The date, the compiler and the machine, from where results have them. */
static int run(const struct wish *wish, const struct suite *suite, struct history *history)
{
	char error[STORE_ERROR], machine[200];
	struct result *result = result_new("audit", suite->title);
	if (!result) return refuse("out of memory");
	const json_t *document = result_document(result), *made = json_object_get(document, "machine");
	snprintf(machine, sizeof machine, "%.150s, %d cores", json_string_value(json_object_get(made, "processor")),
			 (int)json_integer_value(json_object_get(made, "cores")));
	const struct audit_plan plan = {
		.suite = suite,
		.history = history,
		.origin = {.date = json_string_value(json_object_get(document, "date")),
				   .suite = suite->name,
				   .revision = wish->revision ? wish->revision : TOUCHSTONE_REVISION,
				   .compiler = json_string_value(json_object_get(made, "compiler")),
				   .machine = machine,
				   .seed = wish->seed},
		.budget = wish->budget,
		.threads = wish->threads,
		.accepted = wish->accepted,
		.accepted_count = wish->accepted_count,
	};
	struct audit audit;
	int status = audit_run(&plan, &audit, error) ? tell(wish, &audit) : refuse("%s", error);
	audit_free(&audit);
	result_free(result);
	return status;
}

static int audit(const struct wish *wish)
{
	char error[STORE_ERROR], *folder;
	const char *cases = cases_folder(wish->folder), *const outputs[] = {wish->json, wish->junit};
	if (is_output(wish->json) && is_output(wish->junit))
		return refuse("--json and --junit: only one of them can go to standard output");
	for (int o = 0; o < 2; o++)
		if (outputs[o] && !output_possible(outputs[o], error)) return refuse("%s", error);
	if (asprintf(&folder, "%s/suites", cases) < 0) return refuse("out of memory");
	char *path = cases_find(folder, wish->suite);
	free(folder);
	if (!path)
		return refuse("--suite: '%.60s' is no file, nor a suite in %.80s/suites; accepted: a suite, such as standard",
					  wish->suite, cases);
	int status = STATUS_REFUSED;
	struct suite *suite = suite_open(path, cases, error);
	free(path);
	if (!suite) return refuse("%s", error);
	struct history *history = NULL;
	if (!check_accepted(wish, suite))
		status = STATUS_REFUSED;
	else if (wish->history && !(history = history_open(wish->history, true, error)))
		refuse("%s", error);
	else
		status = run(wish, suite, history);
	history_close(history);
	suite_close(suite);
	return status;
}

int command_audit(int argc, char **argv)
{
	static const struct argp argp = {
		.options = options,
		.parser = parse,
		.doc =
			"Runs the checks of a suite, scenes, finders and figures, and holds every measure against its thresholds "
			"and, with --history, against the audits before: digests must be equal; counts, rates, values and timings "
			"must not be worse than chance allows. So wrong an alarm is raised by no more than a stated share of "
			"audits (false_alarms of the suite), however many measures there are.\v"
			"A regression is told with its size and since when it has been there; it stays an alarm until it is gone "
			"or "
			"accepted. Ctrl-C keeps what is done, marked as interrupted, and no later audit is held against it.\n\n"
			"Exit status: 0 all well; 1 a regression, a threshold that is not kept, a check that failed, or nothing "
			"reached; 2 bad input, or a history that cannot be read or written; 130 interrupted.\n\n"
			"Example: touchstone audit --suite standard --budget 10m --history build/history.db --junit audit.xml",
	};
	struct wish wish = {.suite = "standard",
						.budget = INFINITY,
						.seed = 1,
						.threads = omp_get_num_procs(),
						.accepted = calloc((size_t)argc + 1, sizeof(char *))};
	if (!wish.accepted) return refuse("out of memory");
	argp_parse(&argp, argc, argv, 0, NULL, &wish);
	int status = audit(&wish);
	free(wish.accepted);
	return status;
}
