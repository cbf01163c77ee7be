/* touchstone grade: how often finders are wrong, how wrong, on which input, and at what price. */
#include "command/command.h"

#include <argp.h>
#include <math.h>
#include <omp.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "command/grading.h"
#include "command/interrupt.h"
#include "command/live_links.h"
#include "command/output.h"
#include "command/party.h"
#include "result.h"
#include "store/text.h"

enum { ARITHMETIC = 256, SHAPE, FAMILY, INPUTS, PLUGIN, PATIENCE, CASES, SEED, THREADS, CSV, ANSWERS, RESULTS };

static const struct argp_option options[] = {
	{"arithmetic", ARITHMETIC, "A", 0, "Arithmetic the finders work in (binary64); may be repeated", 1},
	{"shape", SHAPE, "S", 0, "Only ball-ball, ball-leave, ball-plane or half-space; may be repeated", 1},
	{"family", FAMILY, "F", 0, "Only questions of this family (all); may be repeated. `touchstone list` has them", 1},
	{"inputs", INPUTS, "FILE", 0,
	 "The questions of a file, one a line, such as `ball-ball 3 0 0 -0x1p0 0 0 1`; families then only by --family", 1},
	{"cases", CASES, "N", 0, "Questions of each family and shape (1e5)", 1},
	{"seed", SEED, "S", 0, "Seed of the families (1)", 1},
	{"plugin", PLUGIN, "FILE.so[:SYMBOL]", 0,
	 "A finder of your own against lib/touchstone.h, asked in a process of its own; may be repeated. With a symbol, a "
	 "function of that name for the shape of --shape (ball-ball)",
	 2},
	{"patience", PATIENCE, "SECONDS", 0, "Without an answer until a plug-in is taken to be in an endless loop (1)", 2},
	{"csv", CSV, "FILE", 0, "Write the grades as comma-separated values; - for standard output, instead of the table",
	 3},
	{"answers", ANSWERS, "FILE", 0, "Write each answer beside the exact one; - likewise", 3},
	{"results", RESULTS, "DIR", 0, "Store the grades as a result that `touchstone report` makes a page of", 3},
	{"threads", THREADS, "K", 0, "Work on K threads (as many as there are cores); grades do not depend on it", 4},
	{0}};

struct wish {
	struct guests guests;
	struct words families;
	const char *inputs, *csv, *answers, *results;
	uint64_t cases, seed;
	double patience;
	int threads;
};

static error_t parse(int key, char *argument, struct argp_state *state)
{
	struct wish *wish = state->input;
	switch (key) {
	case ARITHMETIC:
		words_add(&wish->guests.arithmetics, argument);
		return 0;
	case SHAPE:
		guests_add_shape(&wish->guests, argument);
		return 0;
	case FAMILY:
		if (strcmp(argument, "all") != 0 && !family_named(argument))
			refuse_option("family", argument, "all, or one that `touchstone list families` has");
		words_add(&wish->families, argument);
		return 0;
	case INPUTS:
		wish->inputs = argument;
		return 0;
	case PLUGIN:
		words_add(&wish->guests.plugins, argument);
		return 0;
	case PATIENCE:
		wish->patience = option_number("patience", argument, 0.01, 1e6, "seconds, 0.01 to 1e6");
		return 0;
	case CASES:
		wish->cases = option_count("cases", argument, 1, 100000000);
		return 0;
	case SEED:
		wish->seed = option_count("seed", argument, 0, UINT64_MAX);
		return 0;
	case THREADS:
		wish->threads = (int)option_count("threads", argument, 1, 1024);
		return 0;
	case CSV:
		wish->csv = argument;
		return 0;
	case ANSWERS:
		wish->answers = argument;
		return 0;
	case RESULTS:
		wish->results = argument;
		return 0;
	case ARGP_KEY_ARG:
		words_add(&wish->guests.methods, argument);
		return 0;
	default:
		return ARGP_ERR_UNKNOWN;
	}
}

/* ---- what is asked */

static bool wants(const struct wish *wish, const struct family *family)
{
	bool wanted = wish->families.count == 0 && !wish->inputs;
	for (size_t f = 0; f < wish->families.count; f++)
		wanted |= strcmp(wish->families.word[f], "all") == 0 || strcmp(wish->families.word[f], family->name) == 0;
	return wanted;
}

/* Families first, then the file. */
static size_t collect(struct question_source *sources, const struct wish *wish, const struct query_file *file,
					  const char *title)
{
	size_t count = 0;
	for (size_t f = 0; family_at(f); f++)
		if (wants(wish, family_at(f)))
			sources[count++] = (struct question_source){
				.name = family_at(f)->name, .origin = family_at(f)->origin, .family = family_at(f)};
	if (wish->inputs)
		sources[count++] = (struct question_source){.name = title, .origin = FAMILY_HAND_MADE, .file = file};
	return count;
}

/* ---- what comes of it */

static bool is_output(const char *path)
{
	return path && strcmp(path, "-") == 0;
}

static bool write_csv(const char *path, const struct grading *grading, char error[REPORT_ERROR])
{
	if (is_output(path)) {
		grading_csv(stdout, grading);
		return true;
	}
	struct aside file;
	if (!aside_open(&file, error, "%s", path)) return false;
	grading_csv(file.stream, grading);
	return aside_keep(&file, error);
}

static bool store(const struct wish *wish, const struct grading_plan *plan, const struct grading *grading,
				  const char *command, char error[REPORT_ERROR])
{
	struct result *result = grading_result(plan, grading, "grade", "How the finders do");
	snprintf(error, REPORT_ERROR, "out of memory");
	if (!result) return false;
	live_links(result, "grade");
	result_made_by(result, command, grading->seconds, *TOUCHSTONE_REVISION ? TOUCHSTONE_REVISION : NULL);
	bool stored = result_write(result, wish->results, error);
	result_free(result);
	return stored;
}

static int tell(const struct wish *wish, const struct grading_plan *plan, const struct grading *grading,
				const char *command)
{
	char error[REPORT_ERROR];
	int status = grading->interrupted ? STATUS_INTERRUPTED : grading_finding(grading) ? STATUS_FINDING : STATUS_WELL;
	if (wish->csv && !write_csv(wish->csv, grading, error)) status = refuse("%s", error);
	if (wish->results && !store(wish, plan, grading, command, error)) status = refuse("%s", error);
	if (is_output(wish->csv) || is_output(wish->answers))
		grading_print_findings(stderr, grading);
	else
		grading_print(stdout, grading);
	return status;
}

/* Grades, the answers going to a file that appears when all is done. */
static int grade(const struct wish *wish, struct grading_plan *plan, const char *command)
{
	char error[REPORT_ERROR];
	struct aside file;
	bool aside = wish->answers && !is_output(wish->answers);
	if (aside && !aside_open(&file, error, "%s", wish->answers)) return refuse("%s", error);
	if (wish->answers) plan->answers = aside ? file.stream : stdout;
	struct grading grading;
	bool good = grading_run(plan, &grading, error);
	if (aside && !good) aside_drop(&file);
	if (aside && good) good = aside_keep(&file, error);
	int status = good ? tell(wish, plan, &grading, command) : refuse("%s", error);
	grading_free(&grading);
	return status;
}

static int ask(const struct wish *wish, const struct party *party, const struct query_file *file, const char *command)
{
	size_t families = 0;
	while (family_at(families)) families++;
	char *title = wish->inputs ? text_stem(wish->inputs) : NULL;
	struct question_source *sources = calloc(families + 1, sizeof *sources);
	struct grading_plan plan = {
		.finders = party->finders,
		.finder_count = party->count,
		.sources = sources,
		.shapes = wish->guests.shapes,
		.cases = wish->cases,
		.seed = wish->seed,
		.threads = wish->threads,
		.stop = interrupt_flag(),
	};
	int status = STATUS_REFUSED;
	if (!sources || (wish->inputs && !title)) {
		refuse("out of memory");
	} else {
		plan.source_count = collect(sources, wish, file, title);
		status =
			grading_questions(&plan) > 0
				? grade(wish, &plan, command)
				: refuse("grade: no question of these families or this file has a shape that these finders answer");
	}
	free(sources);
	free(title);
	return status;
}

static int run(struct wish *wish, const char *command)
{
	char error[REPORT_ERROR];
	const struct plugin_patience patience = {
		.seconds = wish->patience, .crashes = 100, .loops = 3, .stop = interrupt_flag()};
	const char *const outputs[] = {wish->csv, wish->answers};
	for (int o = 0; o < 2; o++)
		if (outputs[o] && !output_possible(outputs[o], error)) return refuse("%s", error);
	if (is_output(wish->csv) && is_output(wish->answers))
		return refuse("--csv and --answers: only one of them can go to standard output");
	if (wish->results && !aside_folder(wish->results, error)) return refuse("%s", error);
	struct query_file file = {0};
	if (wish->inputs && !query_file_read(wish->inputs, &file, error)) return refuse("%s", error);
	interrupt_watch();
	struct party party = {0};
	int status = party_gather(&party, "grade", &wish->guests, &patience);
	if (status == STATUS_WELL) status = ask(wish, &party, &file, command);
	party_dismiss(&party);
	query_file_free(&file);
	return status;
}

int command_grade(int argc, char **argv)
{
	static const struct argp argp = {
		.options = options,
		.parser = parse,
		.args_doc = "METHOD... | all",
		.doc =
			"Asks finders of event times questions whose exact answers are known, and tells how often each is wrong, "
			"how wrong, on which input, and what it takes. Counted apart are: missed, an event that was not found; "
			"phantom, one found where there is none; negative, a time before now; nan; and pairs of questions whose "
			"order in time came out wrong. The others have an error in ulp and leave a gap at contact.\v"
			"Exit status: 0 all is well; 1 a method does not keep the bound that its file claims, or a plug-in "
			"crashes, does not come to an end, or answers with a number that is no time; 2 bad input; 130 "
			"interrupted, and what was done by then is told all the same.\n\n"
			"Example: touchstone grade stable naive --family grazing --cases 1e6",
	};
	struct wish wish = {.cases = 100000, .seed = 1, .patience = 1, .threads = omp_get_num_procs()};
	char *command = command_line(argc, argv);
	if (!command || !guests_room(&wish.guests, argc) || !words_room(&wish.families, argc))
		return refuse("out of memory");
	argp_parse(&argp, argc, argv, 0, NULL, &wish);
	guests_complete(&wish.guests, "grade");
	int status = run(&wish, command);
	guests_free(&wish.guests);
	free(wish.families.word);
	free(command);
	return status;
}
