/* touchstone chart: speed against accuracy, measured here and now. */
#include "command/command.h"

#include <argp.h>
#include <omp.h>
#include <stdlib.h>
#include <string.h>

#include "command/charting.h"
#include "command/interrupt.h"
#include "command/output.h"
#include "result.h"

enum { ARITHMETIC = 256, METHOD, CASES, STARTS, SEED, SECONDS, THREADS, CSV, RESULTS, MOST_NAMES = 32 };

static const struct argp_option options[] = {
	{"quick", 'q', 0, 0, "Sizes that take about a minute (the default)", 1},
	{"full", 'f', 0, 0, "Twenty times as many questions, five times as many start states", 1},
	{"arithmetic", ARITHMETIC, "A", 0, "Only this arithmetic, such as binary64 or mpfr:200; may be repeated", 2},
	{"method", METHOD, "M", 0, "Only this method; may be repeated. Engines run by `stable`, or by those given", 2},
	{"cases", CASES, "N", 0, "Questions of each family (1000; with --full 20000)", 2},
	{"starts", STARTS, "N", 0, "Start states that horizons are taken from (8; with --full 40)", 2},
	{"seed", SEED, "S", 0, "Seed of questions and start states (1)", 2},
	{"seconds", SECONDS, "T", 0, "Take about so long: fewer questions and start states where these do not fit", 2},
	{"csv", CSV, "FILE", 0, "Write the chart as comma-separated values; - for standard output, instead of the table",
	 3},
	{"results", RESULTS, "DIR", 0,
	 "Store the chart, and the grades of each method, as results that `touchstone report` makes pages of "
	 "(build/results; with --csv only where it is said)",
	 3},
	{"threads", THREADS, "K", 0, "Threads for what is not timed (as many as there are cores)", 4},
	{0}};

struct names {
	const char *name[MOST_NAMES];
	size_t count;
};

struct wish {
	struct names arithmetics, methods;
	bool full;
	uint64_t cases, starts, seed; /* 0: as many as is usual */
	double seconds;
	int threads;
	const char *csv, *results;
};

static void add_name(struct names *names, const char *option, const char *name)
{
	for (size_t n = 0; n < names->count; n++)
		if (strcmp(names->name[n], name) == 0) return;
	if (names->count == MOST_NAMES) refuse_option(option, name, "at most 32 of them");
	names->name[names->count++] = name;
}

static error_t parse(int key, char *argument, struct argp_state *state)
{
	struct wish *wish = state->input;
	switch (key) {
	case 'q':
		wish->full = false;
		return 0;
	case 'f':
		wish->full = true;
		return 0;
	case ARITHMETIC:
		add_name(&wish->arithmetics, "arithmetic", argument);
		return 0;
	case METHOD:
		add_name(&wish->methods, "method", argument);
		return 0;
	case CASES:
		wish->cases = option_count("cases", argument, 1, 100000000);
		return 0;
	case STARTS:
		wish->starts = option_count("starts", argument, 1, 100000);
		return 0;
	case SEED:
		wish->seed = option_count("seed", argument, 0, INT64_MAX);
		return 0;
	case SECONDS:
		wish->seconds = option_number("seconds", argument, 0.1, 1e6, "seconds, 0.1 to 1e6");
		return 0;
	case THREADS:
		wish->threads = (int)option_count("threads", argument, 1, 1024);
		return 0;
	case CSV:
		wish->csv = argument;
		return 0;
	case RESULTS:
		wish->results = argument;
		return 0;
	case ARGP_KEY_ARG:
		refuse_usage("chart: '%.60s' is too much; accepted: options only", argument);
	default:
		return ARGP_ERR_UNKNOWN;
	}
}

/* ---- who is charted */

/* What is charted where nothing is said: of each way to compute one, and MPFR for comparison. */
static const struct names usual_arithmetics = {{"short:12", "short:18", "binary32", "binary64", "extended", "twin",
												"binary128", "mpfr:53", "mpfr:113", "mpfr:256"},
											   10};

struct cast {
	struct finder finders[MOST_NAMES * MOST_NAMES], engines[MOST_NAMES * MOST_NAMES];
	size_t finder_count, engine_count;
};

static bool runs_engines(const char *method)
{
	bool known = false;
	for (size_t n = 0; touchstone_method_name(n); n++) known |= strcmp(touchstone_method_name(n), method) == 0;
	return known;
}

/* The method in all arithmetics; those not asked for by name may be missing on this machine. */
static int add_method(struct cast *cast, const struct wish *wish, const char *method)
{
	char error[160];
	bool asked = wish->arithmetics.count > 0;
	const struct names *arithmetics = asked ? &wish->arithmetics : &usual_arithmetics;
	bool runs = runs_engines(method) && (wish->methods.count > 0 || strcmp(method, "stable") == 0);
	for (size_t a = 0; a < arithmetics->count; a++) {
		const struct finder finder = {.method = method, .arithmetic = arithmetics->name[a]};
		int bits = horizon_bits(finder.arithmetic, error);
		if (bits == 0 && !asked) continue;
		if (bits == 0) return refuse("chart: %s", error);
		if (!finder_answers(&finder, TOUCHSTONE_BALL_BALL, error)) return refuse("chart: %s", error);
		if (bits > CHART_MOST_BITS)
			return refuse("chart: arithmetic '%s'; accepted: of at most %d bits, so that a reference can carry twice "
						  "as many",
						  finder.arithmetic, CHART_MOST_BITS);
		cast->finders[cast->finder_count++] = finder;
		if (runs) cast->engines[cast->engine_count++] = finder;
	}
	return STATUS_WELL;
}

static int gather(struct cast *cast, const struct wish *wish)
{
	int status = STATUS_WELL;
	for (size_t m = 0; status == STATUS_WELL && m < wish->methods.count; m++)
		status = add_method(cast, wish, wish->methods.name[m]);
	for (size_t m = 0; status == STATUS_WELL && wish->methods.count == 0 && touchstone_finder_name(m); m++)
		status = add_method(cast, wish, touchstone_finder_name(m));
	return status;
}

/* ---- what comes of it */

/* Where results go, and whether they got there. */
struct shelf {
	const char *folder, *command;
	char error[REPORT_ERROR]; /* "": all is well */
};

static void store(struct shelf *shelf, struct result *result, double seconds)
{
	if (*shelf->error) {
		result_free(result);
		return;
	}
	snprintf(shelf->error, sizeof shelf->error, "out of memory");
	if (!result) return;
	result_made_by(result, shelf->command, seconds, *TOUCHSTONE_REVISION ? TOUCHSTONE_REVISION : NULL);
	if (result_write(result, shelf->folder, shelf->error)) *shelf->error = '\0';
	result_free(result);
}

/* The page that a click on one of a method's points leads to. */
static void store_grades(void *context, const struct grading_plan *plan, const struct grading *grading)
{
	char name[80], title[100];
	snprintf(name, sizeof name, "grade-%s", plan->finders->method);
	snprintf(title, sizeof title, "How %s does", plan->finders->method);
	store(context, grading_result(plan, grading, name, title), grading->seconds);
}

static bool write_csv(const char *path, const struct chart_plan *plan, const struct chart *chart,
					  char error[REPORT_ERROR])
{
	if (strcmp(path, "-") == 0) {
		chart_csv(stdout, plan, chart);
		return true;
	}
	struct aside file;
	if (!aside_open(&file, error, "%s", path)) return false;
	chart_csv(file.stream, plan, chart);
	return aside_keep(&file, error);
}

static int tell(const struct wish *wish, const struct chart_plan *plan, const struct chart *chart, struct shelf *shelf)
{
	char error[REPORT_ERROR];
	int status = chart->interrupted ? STATUS_INTERRUPTED : STATUS_WELL;
	if (shelf->folder) store(shelf, chart_result(plan, chart), chart->seconds);
	if (*shelf->error) status = refuse("%s", shelf->error);
	if (wish->csv && !write_csv(wish->csv, plan, chart, error)) status = refuse("%s", error);
	if (!wish->csv || strcmp(wish->csv, "-") != 0) chart_print(stdout, plan, chart);
	if (shelf->folder && !*shelf->error)
		fprintf(stderr, "chart: stored in %s; `touchstone report --results %s` draws it\n", shelf->folder,
				shelf->folder);
	return status;
}

static int run(const struct wish *wish, const struct cast *cast, struct shelf *shelf)
{
	const struct chart_plan plan = {
		.finders = cast->finders,
		.finder_count = cast->finder_count,
		.engines = cast->engines,
		.engine_count = cast->engine_count,
		.cases = wish->cases  ? wish->cases
				 : wish->full ? 20000
							  : 1000,
		.starts = (int)(wish->starts ? wish->starts
						: wish->full ? 40
									 : 8),
		.seconds = wish->seconds,
		.seed = wish->seed,
		.threads = wish->threads,
		.stop = interrupt_flag(),
		.graded = shelf->folder ? store_grades : NULL,
		.context = shelf,
	};
	char error[GRADING_ERROR];
	struct chart chart;
	interrupt_watch();
	int status = chart_run(&plan, &chart, error) ? tell(wish, &plan, &chart, shelf) : refuse("chart: %s", error);
	chart_free(&plan, &chart);
	return status;
}

int command_chart(int argc, char **argv)
{
	static const struct argp argp = {
		.options = options,
		.parser = parse,
		.doc = "Measures what finders and engines cost and what they are worth, and where none is both faster and "
			   "better. Finders: nanoseconds per call, against the bits that 99.9 % of the answers have right, "
			   "-log2(|got - exact| / the larger of the two), answers unrounded, and against the share of missed and "
			   "phantom events; questions harvested from runs and hand-made ones apart. Engines: nanoseconds per event "
			   "against the horizon, the events per particle after which the sequence of events differs from that of "
			   "the same start state in a much finer arithmetic.\v"
			   "In the CSV, ns is the throughput, cost_ratio is ns over that of `stable` in binary64, error_bits those "
			   "of 99.9 % on harvested questions.\n\n"
			   "Exit status: 0 all well; 2 bad input; 130 interrupted, and what was measured by then is told all the "
			   "same.\n\n"
			   "Example: touchstone chart && touchstone report",
	};
	struct wish wish = {.seed = 1, .threads = omp_get_num_procs()};
	struct shelf shelf = {.command = command_line(argc, argv)};
	struct cast *cast = calloc(1, sizeof *cast);
	argp_parse(&argp, argc, argv, 0, NULL, &wish);
	shelf.folder = wish.results ? wish.results : wish.csv ? NULL : "build/results";
	char error[REPORT_ERROR];
	int status;
	if (!cast || !shelf.command)
		status = refuse("out of memory");
	else if ((wish.csv && !output_possible(wish.csv, error)) || (shelf.folder && !aside_folder(shelf.folder, error)))
		status = refuse("%s", error);
	else if ((status = gather(cast, &wish)) == STATUS_WELL)
		status = run(&wish, cast, &shelf);
	free(cast);
	free((char *)shelf.command);
	return status;
}
