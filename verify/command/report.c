/* touchstone report: pages from stored results. */
#include "command/command.h"

#include <argp.h>
#include <stdio.h>
#include <stdlib.h>

#include "audit/trends.h"
#include "page.h"

struct folders {
	const char *results, *output, *history;
};

static error_t parse(int key, char *argument, struct argp_state *state)
{
	struct folders *folders = state->input;
	switch (key) {
	case 'r':
		folders->results = argument;
		return 0;
	case 'o':
		folders->output = argument;
		return 0;
	case 'h':
		folders->history = argument;
		return 0;
	case ARGP_KEY_ARG:
		refuse_usage("report: '%.60s' is too much; accepted: options only, see touchstone report --help", argument);
	default:
		return ARGP_ERR_UNKNOWN;
	}
}

/* Makes results of the history, beside the others. */
static bool read_history(const struct folders *folders, char error[REPORT_ERROR])
{
	struct history *history = history_open(folders->history, false, error);
	bool good = history && trends_write(history, folders->results, error);
	history_close(history);
	return good;
}

int command_report(int argc, char **argv)
{
	static const struct argp_option options[] = {
		{"results", 'r', "DIR", 0, "Folder of the results, as `reproduce` leaves them (build/results)", 0},
		{"output", 'o', "DIR", 0, "Folder to write the pages into (build/report)", 0},
		{"history", 'h', "FILE.db", 0, "Also show the audits in this history: each measure over time", 0},
		{0}};
	static const struct argp argp = {
		.options = options,
		.parser = parse,
		.doc =
			"Writes the report on all stored results: index.html, to be opened from disk, a page for each result, its "
			"figures as SVG and PDF, its numbers as CSV. Where figures cannot be drawn, because gnuplot is missing, "
			"the pages say "
			"so and the exit status is 77.\v"
			"Example: touchstone report --results build/results --output build/report",
	};
	struct folders folders = {"build/results", "build/report", NULL};
	argp_parse(&argp, argc, argv, 0, NULL, &folders);
	char error[REPORT_ERROR] = "";
	if (folders.history && !read_history(&folders, error)) return refuse("%s", error);
	*error = '\0';
	if (!report_write(folders.results, folders.output, error)) return refuse("%s", error);
	char *folder = realpath(folders.output, NULL);
	printf("%s/index.html\n", folder ? folder : folders.output);
	free(folder);
	if (!*error) return STATUS_WELL;
	refuse("%s", error);
	return STATUS_SKIPPED;
}
