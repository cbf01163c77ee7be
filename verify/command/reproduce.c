/* touchstone reproduce: measures the papers' figures and stores them as results. */
#include "command/command.h"

#include <argp.h>
#include <inttypes.h>
#include <limits.h>
#include <omp.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include "campaign/campaign.h"
#include "command/interrupt.h"
#include "command/live_links.h"
#include "command/progress.h"
#include "command/table_print.h"
#include "figure/figure.h"

const struct figure_entry figures[] = {
	{"fig3", "2014, fig. 3: how far from contact spheres are when they collide", figure_impact},
	{"fig4", "2014, figs. 4 and 6: three bodies in contact, event by event, by each method", figure_stepping},
	{"fig5", "2014, fig. 5: how often three bodies meet, over restitution and density", figure_three_body},
	{"fig7", "2014, section 5 and fig. 7: a ball comes to rest on a plate, or halts", figure_collapse},
	{"ladder", "2014, fig. 5 at 53 bits: how rates of what goes wrong fall with the bits carried", figure_ladder},
	{"horizon", "for how many events per particle a run can be trusted, over the bits it carries", figure_horizon},
	{"time-and-place", "what late times and far places do to impacts, three-body events and the horizon",
	 figure_time_place},
	{"states", "2016, section 5: wells and shoulders, what positions say of them, and methods that believe it",
	 figure_states},
	{"atlas", "what each method does in each stress scene, and from which precision on it survives", figure_atlas},
	{0},
};
enum { FIGURES = sizeof figures / sizeof *figures - 1 };

struct arguments {
	bool wanted[FIGURES];
	bool full, any_revision;
	uint64_t seed;
	int threads;
	const char *results;
};

static const struct argp_option options[] = {
	{"quick", 'q', 0, 0, "sizes that take minutes (the default)", 0},
	{"full", 'f', 0, 0, "the papers' own sizes: 10^9 collisions per histogram, 10^6 plates", 0},
	{"seed", 'S', "S", 0, "of the start states and plates (1)", 0},
	{"threads", 't', "K", 0, "runs side by side (as many as there are cores); the numbers do not depend on it", 0},
	{"any-revision", 'a', 0, 0,
	 "go on from what another revision of the program has finished as well, which is otherwise made again", 0},
	{"results", 'r', "DIR", 0, "where results are stored (build/results)", 0},
	{0},
};

static void want(struct arguments *arguments, const char *name)
{
	bool found = false;
	for (int f = 0; f < FIGURES; f++)
		if (strcmp(name, "all") == 0 || strcmp(name, figures[f].name) == 0) arguments->wanted[f] = found = true;
	if (!found) refuse_usage("no figure '%.40s'; accepted: all, or one that `touchstone list figures` has", name);
}

static error_t parse(int key, char *argument, struct argp_state *state)
{
	struct arguments *arguments = state->input;
	switch (key) {
	case 'q':
		arguments->full = false;
		return 0;
	case 'f':
		arguments->full = true;
		return 0;
	case 'S':
		arguments->seed = option_count("seed", argument, 0, UINT64_MAX);
		return 0;
	case 't':
		arguments->threads = (int)option_count("threads", argument, 1, 1024);
		return 0;
	case 'a':
		arguments->any_revision = true;
		return 0;
	case 'r':
		arguments->results = argument;
		return 0;
	case ARGP_KEY_ARG:
		want(arguments, argument);
		return 0;
	case ARGP_KEY_NO_ARGS:
		argp_usage(state);
		return 0;
	default:
		return ARGP_ERR_UNKNOWN;
	}
}

static void show(void *context, double part)
{
	progress_show(context, 100 * part, 100);
}

/* What is finished of a figure waits apart from that of other sizes and seeds, until the figure is whole. */
static bool unfinished(const struct arguments *arguments, char path[PATH_MAX])
{
	return snprintf(path, PATH_MAX, "%s/unfinished/%s-%" PRIu64, arguments->results, arguments->full ? "full" : "quick",
					arguments->seed) < PATH_MAX;
}

/* Clears it away; folders that hold something else stay. */
static void forget(int f, char *path)
{
	campaign_forget(figures[f].name, path);
	if (rmdir(path) != 0) return;
	*strrchr(path, '/') = '\0';
	rmdir(path);
}

/* Measures one figure and stores it. */
static int make(int f, const struct arguments *arguments)
{
	char error[REPORT_ERROR], command[120], pieces[PATH_MAX];
	if (!unfinished(arguments, pieces)) return refuse("--results: a path too long");
	struct progress progress = progress_begin(figures[f].name, "%");
	struct figure_setup setup = {
		.full = arguments->full,
		.seed = arguments->seed,
		.threads = arguments->threads,
		.folder = pieces,
		.any_revision = arguments->any_revision,
		.stop = interrupt_flag(),
		.progress = show,
		.context = &progress,
	};
	double began = progress_clock();
	struct result *result = figures[f].make(&setup, error);
	progress_end(&progress);
	if (!result) return refuse("%s: %s", figures[f].name, error);
	snprintf(command, sizeof command, "touchstone reproduce %s %s --seed %" PRIu64, figures[f].name,
			 arguments->full ? "--full" : "--quick", arguments->seed);
	double seconds = progress_clock() - began;
	live_links(result, figures[f].name);
	if (arguments->any_revision)
		result_note(result, "What other revisions of the program had finished was taken as it was (--any-revision).");
	result_made_by(result, command, seconds, *TOUCHSTONE_REVISION ? TOUCHSTONE_REVISION : NULL);
	bool written = result_write(result, arguments->results, error);
	if (written && figures[f].make == figure_atlas) table_print(result, 0); /* it is one table */
	result_free(result);
	if (!written) return refuse("%s", error);
	if (!interrupted()) forget(f, pieces);
	fprintf(stderr, "%s: %s in %.1f s, stored as %s/%s.json\n", figures[f].name,
			interrupted() ? "interrupted" : "measured", seconds, arguments->results, figures[f].name);
	return STATUS_WELL;
}

int command_reproduce(int argc, char **argv)
{
	struct arguments arguments = {.seed = 1, .threads = omp_get_num_procs(), .results = "build/results"};
	const struct argp argp = {
		.options = options,
		.parser = parse,
		.args_doc = "FIGURE... | all",
		.doc =
			"Measures figures of the papers and stores each as a result, beside what the papers say.\v"
			"Figures: all, or those that `touchstone list figures` has.\n"
			"`touchstone report` draws pages from what is stored. Ctrl-C keeps what is done and marks it "
			"incomplete; the same call then goes on from there.\n\n"
			"With --full, horizon takes 14 minutes of one core, time-and-place 15, states 31 and atlas 78 (measured). "
			"Of ladder 471 of 493 parts took 197 minutes, 108 of them for 10^9 collisions in binary64 of three "
			"inelastic gases each; the others, in 8 and 10 bits and in mpfr, were not waited for. Reckoned from the "
			"speed of its parts, and not yet run through, is fig5: two hours.\n\n"
			"Example: touchstone reproduce fig7 --quick && touchstone report",
	};
	argp_parse(&argp, argc, argv, 0, NULL, &arguments);
	char error[REPORT_ERROR];
	if (!aside_folder(arguments.results, error)) return refuse("%s", error);
	interrupt_watch();
	for (int f = 0; f < FIGURES && !interrupted(); f++) {
		int status = arguments.wanted[f] ? make(f, &arguments) : STATUS_WELL;
		if (status != STATUS_WELL) return status;
	}
	return interrupted() ? STATUS_INTERRUPTED : STATUS_WELL;
}
