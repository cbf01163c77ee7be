/* touchstone replay: one input, step by step, through every method and arithmetic, beside the exact answer. */
#include "command/command.h"

#include <argp.h>
#include <math.h>
#include <mpfr.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "measure/exact_steps.h"
#include "measure/finder_grade.h"
#include "store/query_file.h"

enum { METHOD = 256, ARITHMETIC, NAMES = 64, MESSAGE = 400, TEXT = 2000, CELL = 24 };

static const struct argp_option options[] = {
	{"method", METHOD, "M", 0, "Only this method (all that have a finder for the shape); may be repeated", 0},
	{"arithmetic", ARITHMETIC, "A", 0, "Only this arithmetic (all, as short:12 and mpfr:200); may be repeated", 0},
	{0}};

/* What stands for arithmetics of any precision. */
static const struct {
	const char *name, *chosen;
} precisions[] = {{"short:P", "short:12"}, {"mpfr:P", "mpfr:200"}};

struct names {
	const char *name[NAMES];
	size_t count;
	bool chosen; /* by the user: then it is an error if there is none such */
};

struct wish {
	struct names methods, arithmetics;
	const char *file;
	char text[TEXT]; /* a question on the command line */
};

static void add_name(struct names *names, const char *name)
{
	if (names->count == NAMES) refuse_usage("replay: too many names; accepted: up to %d", NAMES);
	names->name[names->count++] = name;
}

/* A question given in words of its own takes all words up to the next option. */
static void take_words(struct wish *wish, const char *first, struct argp_state *state)
{
	size_t length = (size_t)snprintf(wish->text, TEXT, "%s", first);
	while (state->next < state->argc && strncmp(state->argv[state->next], "--", 2) != 0 && length < TEXT)
		length += (size_t)snprintf(wish->text + length, TEXT - length, " %s", state->argv[state->next++]);
	if (length >= TEXT) refuse_usage("replay: a question without end; accepted: a shape and its numbers");
}

static error_t parse(int key, char *argument, struct argp_state *state)
{
	struct wish *wish = state->input;
	enum touchstone_shape shape;
	switch (key) {
	case METHOD:
		wish->methods.chosen = true;
		add_name(&wish->methods, argument);
		return 0;
	case ARITHMETIC:
		wish->arithmetics.chosen = true;
		add_name(&wish->arithmetics, argument);
		return 0;
	case ARGP_KEY_ARG:
		if (wish->file || *wish->text)
			refuse_usage("replay: '%.60s' is too much; accepted: one file or question", argument);
		if (shape_named(argument, &shape) || strchr(argument, ' '))
			take_words(wish, argument, state);
		else
			wish->file = argument;
		return 0;
	case ARGP_KEY_NO_ARGS:
		refuse_usage("replay: nothing to replay; accepted: a file of questions, or a question such as "
					 "ball-ball 3 0 0 -1 0 0 1");
	default:
		return ARGP_ERR_UNKNOWN;
	}
}

/* ---- the exact answer */

/* A question with its exact answer. */
struct replay {
	const struct query *query;
	bool defined; /* all numbers are finite */
	struct oracle *oracle;
	struct oracle_time time;
	struct exact_steps exact;
};

static void print_exact_steps(const struct replay *replay)
{
	static const char *const letters[] = {"a", "b", "c", "D"};
	mpfr_t digits;
	mpfr_init2(digits, 120);
	for (int s = 0; s < EXACT_STEPS; s++) {
		const char *formula = exact_step_formula(replay->query->shape, (enum exact_step)s);
		if (!formula) continue;
		mpfr_set_q(digits, replay->exact.value[s], MPFR_RNDN);
		mpfr_printf("  %s = %-18s  %.24Rg\n", letters[s], formula, digits);
	}
	mpfr_clear(digits);
}

static void print_exact(const struct replay *replay)
{
	if (!replay->defined) {
		printf("  exactly: undefined, since a number is not finite\n");
		return;
	}
	print_exact_steps(replay);
	if (replay->time.event == ORACLE_NEVER) {
		printf("  exactly: no event\n");
		return;
	}
	double nearest = oracle_round(replay->oracle, &replay->time, MPFR_RNDN);
	bool is_double = oracle_compare_double(replay->oracle, &replay->time, nearest) == 0;
	mpfr_t digits;
	mpfr_init2(digits, 120);
	oracle_round_mpfr(replay->oracle, digits, &replay->time, MPFR_RNDN);
	mpfr_printf("  exactly: %s t = %.30Rg, %s %a\n", replay->time.event == ORACLE_NOW ? "now," : "later, at", digits,
				is_double ? "the double" : "nearest double", nearest);
	mpfr_clear(digits);
}

/* ---- the methods */

static void cell(double value, double error, bool exactly_zero)
{
	char text[CELL] = "", off[CELL] = "";
	if (!isnan(value)) snprintf(text, sizeof text, "%.6g", value);
	if (!isnan(value) && !isnan(error)) {
		if (error > 0 && exactly_zero)
			snprintf(off, sizeof off, "not 0");
		else
			snprintf(off, sizeof off, "%.3g", error);
	}
	printf("  %13s %8s", text, off);
}

/* What became of the answer, in a word where it is a fault. */
static const char *verdict(const struct replay *replay, double got)
{
	if (!replay->defined) return "";
	bool never = replay->time.event == ORACLE_NEVER;
	if (isnan(got)) return "nan";
	if (got < 0) return "negative";
	if (never) return got < INFINITY ? "phantom" : "";
	return got == INFINITY && oracle_error(replay->oracle, &replay->time, got) > 0 ? "missed" : "";
}

static void print_steps(const struct replay *replay, const char *method, const char *arithmetic,
						const struct touchstone_steps *steps)
{
	const double value[EXACT_STEPS] = {steps->a, steps->b, steps->c, steps->discriminant};
	printf("  %-18s %-10s", method, arithmetic);
	for (int s = 0; s < EXACT_STEPS; s++) {
		if (!exact_step_formula(replay->query->shape, (enum exact_step)s)) continue;
		double error = replay->defined ? exact_step_error(replay->exact.value[s], value[s]) : NAN;
		cell(value[s], error, replay->defined && mpq_sgn(replay->exact.value[s]) == 0);
	}
	double error = replay->defined ? oracle_error(replay->oracle, &replay->time, steps->time) : NAN;
	const char *word = verdict(replay, steps->time);
	printf("  %22a ", steps->time);
	if (*word)
		printf("%8s", word);
	else if (!isnan(error))
		printf("%8.3g", error);
	printf("\n");
}

static void print_heading(const struct replay *replay)
{
	static const char *const letters[] = {"a", "b", "c", "D"};
	printf("  %-18s %-10s", "method", "arithmetic");
	for (int s = 0; s < EXACT_STEPS; s++)
		if (exact_step_formula(replay->query->shape, (enum exact_step)s)) printf("  %13s %8s", letters[s], "ulp off");
	printf("  %22s %8s\n", "t", "ulp off");
}

/* One line for each method and arithmetic. False with the last reason when there is none. */
static bool print_methods(const struct replay *replay, const struct wish *wish, char error[160])
{
	bool any = false;
	for (size_t m = 0; m < wish->methods.count; m++)
		for (size_t a = 0; a < wish->arithmetics.count; a++) {
			const char *method = wish->methods.name[m], *arithmetic = wish->arithmetics.name[a];
			struct touchstone_steps steps;
			if (!touchstone_find_steps(arithmetic, method, replay->query->shape, replay->query->number, &steps, error))
				continue;
			if (!any) print_heading(replay);
			any = true;
			print_steps(replay, method, arithmetic, &steps);
		}
	return any;
}

static void print_question(const struct query *query)
{
	query_write(stdout, query);
	printf("\n ");
	for (size_t i = 0; i < shape_numbers(query->shape); i++) printf(" %.17g", query->number[i]);
	printf("\n");
}

static int replay_one(const struct wish *wish, const struct query *query, struct oracle *oracle)
{
	char error[160] = "no method";
	struct oracle_query question = finder_question(query->shape, query->number);
	struct replay replay = {.query = query, .oracle = oracle, .defined = oracle_accepts(&question)};
	if (replay.defined) {
		replay.time = oracle_solve(oracle, &question);
		exact_steps_init(&replay.exact, query->shape, query->number);
	}
	print_question(query);
	print_exact(&replay);
	int status = print_methods(&replay, wish, error) ? STATUS_WELL : refuse("replay: %s", error);
	if (replay.defined) exact_steps_clear(&replay.exact);
	return status;
}

/* ---- the command */

static void choose_names(struct wish *wish)
{
	const char *name;
	for (size_t n = 0; !wish->methods.chosen && (name = touchstone_finder_name(n)); n++) add_name(&wish->methods, name);
	for (size_t n = 0; !wish->arithmetics.chosen && (name = touchstone_arithmetic_name(n)); n++) {
		for (int p = 0; p < 2; p++)
			if (strcmp(precisions[p].name, name) == 0) name = precisions[p].chosen;
		add_name(&wish->arithmetics, name);
	}
}

/* A name that no shape knows is refused before anything is printed. */
static int check_names(const struct wish *wish)
{
	for (size_t m = 0; m < wish->methods.count; m++)
		for (size_t a = 0; a < wish->arithmetics.count; a++) {
			char error[160];
			bool known = !wish->methods.chosen && !wish->arithmetics.chosen;
			for (int shape = 0; shape < TOUCHSTONE_SHAPES; shape++)
				known |= touchstone_find(wish->arithmetics.name[a], wish->methods.name[m], (enum touchstone_shape)shape,
										 NULL, 0, false, NULL, error);
			if (!known) return refuse("replay: %s", error);
		}
	return STATUS_WELL;
}

static int replay_file(const struct wish *wish, struct oracle *oracle)
{
	char error[MESSAGE];
	struct query_file file;
	int status = STATUS_WELL;
	if (!query_file_read(wish->file, &file, error)) return refuse("%s", error);
	for (size_t q = 0; q < file.count; q++) {
		int one = replay_one(wish, &file.query[q], oracle);
		if (one != STATUS_WELL) status = one;
		if (q + 1 < file.count) printf("\n");
	}
	query_file_free(&file);
	return status;
}

int command_replay(int argc, char **argv)
{
	static const struct argp argp = {
		.options = options,
		.parser = parse,
		.args_doc = "FILE | SHAPE NUMBER...",
		.doc = "Takes questions apart: the coefficients, the discriminant and the time that each method forms in each "
			   "arithmetic, beside the exact ones. Errors are in ulp of binary64. Questions are the lines of a file (- "
			   "for standard input), or one is given on the command line, its numbers decimal or hexadecimal.\v"
			   "Shapes: ball-ball and ball-leave rx ry rz vx vy vz contact; ball-plane distance speed acceleration "
			   "contact; half-space distance speed.\n\n"
			   "Example: touchstone replay ball-ball 3 0 0 -0x1.8p0 0 0 1",
	};
	struct wish wish = {0};
	char error[MESSAGE];
	argp_parse(&argp, argc, argv, ARGP_IN_ORDER, NULL, &wish);
	choose_names(&wish);
	struct query query;
	if (!wish.file && !query_parse(wish.text, &query, error)) return refuse("replay: %s", error);
	int status = check_names(&wish);
	if (status != STATUS_WELL) return status;
	struct oracle *oracle = oracle_create();
	if (!oracle) return refuse("out of memory");
	status = wish.file ? replay_file(&wish, oracle) : replay_one(&wish, &query, oracle);
	oracle_destroy(oracle);
	mpfr_free_cache();
	return status;
}
