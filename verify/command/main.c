/* touchstone COMMAND ...: finds the command and lets it run. */
#include "command/command.h"

#include <argp.h>
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "store/text.h"

static const struct command {
	const char *name, *about;
	int (*run)(int argc, char **argv);
} commands[] = {
	{"list", "cases, methods, arithmetics and figures, with one line each", command_list},
	{"run", "one scene: what became of it, how fast, and its digest", command_run},
	{"reproduce", "the papers' figures, stored as results", command_reproduce},
	{"grade", "finders of event times, held against the exact answers", command_grade},
	{"chart", "speed against accuracy, measured here and now", command_chart},
	{"fuzz", "random search for the smallest input that breaks a finder", command_fuzz},
	{"replay", "one input through every method and arithmetic, beside the exact answer", command_replay},
	{"audit", "a suite against its thresholds and its history, to be woken by", command_audit},
	{"campaign", "runs over a grid of parameters and seeds, each made once", command_campaign},
	{"merge", "the stores of a campaign's shards put together", command_merge},
	{"report", "pages from stored results", command_report},
};
enum { COMMANDS = sizeof commands / sizeof *commands };

static const struct command *chosen;
static int chosen_at;

static void choose(const char *name)
{
	for (int c = 0; c < COMMANDS; c++)
		if (strcmp(commands[c].name, name) == 0) chosen = &commands[c];
	if (chosen) return;
	char accepted[200] = "", shown[TEXT_SHOWN];
	for (int c = 0; c < COMMANDS; c++) {
		size_t length = strlen(accepted);
		snprintf(accepted + length, sizeof accepted - length, "%s%s", c == 0 ? "" : ", ", commands[c].name);
	}
	exit(refuse("no command '%s'; accepted: %s", text_shown(shown, name), accepted));
}

static error_t parse(int key, char *argument, struct argp_state *state)
{
	if (key == ARGP_KEY_NO_ARGS) argp_usage(state);
	if (key != ARGP_KEY_ARG) return ARGP_ERR_UNKNOWN;
	choose(argument);
	chosen_at = state->next - 1;
	state->next = state->argc; /* the rest is the command's own */
	return 0;
}

/* Data that never arrived is no success. */
static void check_output(void)
{
	errno = 0;
	if (fflush(stdout) == 0 && !ferror(stdout)) return;
	if (errno != EPIPE) refuse("standard output: cannot be written: %s", strerror(errno ? errno : EIO));
	_exit(STATUS_REFUSED);
}

int main(int argc, char **argv)
{
	atexit(check_output);
	argp_err_exit_status = STATUS_REFUSED;
	argp_program_version = "touchstone " TOUCHSTONE_VERSION;

	struct argp_option options[COMMANDS + 2] = {{.doc = "Commands:"}};
	for (int c = 0; c < COMMANDS; c++)
		options[c + 1] = (struct argp_option){.name = commands[c].name, .flags = OPTION_DOC, .doc = commands[c].about};
	struct argp argp = {
		.options = options,
		.parser = parse,
		.args_doc = "COMMAND ...",
		.doc =
			"Measures where and how often floating point breaks event-driven particle dynamics.\v"
			"`touchstone COMMAND --help` tells what a command does, with an example.\n\n"
			"Exit status: 0 all well; 1 a finding, such as a run that halted or diverged; 2 wrong usage, bad input, or "
			"an output that cannot be written; 77 skipped, because an optional part is missing; 130 stopped by a "
			"signal, with what was done by then kept.\n\n"
			"Example: touchstone run bouncing-ball --events 100",
	};
	argp_parse(&argp, argc, argv, ARGP_IN_ORDER, NULL, NULL);

	char name[40];
	snprintf(name, sizeof name, "touchstone %s", chosen->name);
	argv[chosen_at] = name;
	return chosen->run(argc - chosen_at, argv + chosen_at);
}
