/* touchstone fuzz: looks for the smallest input that breaks a finder. */
#include "command/command.h"

#include <argp.h>
#include <inttypes.h>
#include <jansson.h>
#include <math.h>
#include <omp.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "command/cases.h"
#include "command/interrupt.h"
#include "command/output.h"
#include "command/party.h"
#include "command/progress.h"
#include "fuzz/corpus.h"
#include "fuzz/shrink.h"

enum { ARITHMETIC = 256, SHAPE, PLUGIN, PATIENCE, BOUND, SECONDS, QUESTIONS, SEED, CORPUS, THREADS, JSON };

static const struct argp_option options[] = {
	{"arithmetic", ARITHMETIC, "A", 0, "Arithmetic the finders work in (binary64); may be repeated", 1},
	{"shape", SHAPE, "S", 0, "Only ball-ball, ball-leave, ball-plane or half-space; may be repeated", 1},
	{"plugin", PLUGIN, "FILE.so[:SYMBOL]", 0, "A finder of your own, as for `touchstone grade`; may be repeated", 1},
	{"patience", PATIENCE, "SECONDS", 0, "Without an answer until a plug-in is taken to hang (0.2)", 1},
	{"bound", BOUND, "ULP", 0,
	 "How far off a time may be, in ulp of the arithmetic (what the finder's file claims, or anything)", 1},
	{"seconds", SECONDS, "N", 0, "Time in all, shared by finders and shapes (60)", 2},
	{"questions", QUESTIONS, "N", 0, "Questions to each finder and shape, in whole rounds of 65536, instead of time",
	 2},
	{"seed", SEED, "S", 0, "Seed of the questions (1)", 2},
	{"corpus", CORPUS, "DIR", 0, "Folder of what was found, to begin with and to add to (build/corpus)", 2},
	{"json", JSON, "FILE", 0, "Write the findings as JSON; - for standard output, instead of the table", 3},
	{"threads", THREADS, "K", 0, "Work on K threads (as many as there are cores); findings do not depend on it", 4},
	{0}};

struct wish {
	struct guests guests;
	const char *corpus, *json;
	double seconds, bound, patience;
	uint64_t questions, seed;
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
	case PLUGIN:
		words_add(&wish->guests.plugins, argument);
		return 0;
	case PATIENCE:
		wish->patience = option_number("patience", argument, 0.01, 1e6, "seconds, 0.01 to 1e6");
		return 0;
	case BOUND:
		wish->bound = option_number("bound", argument, 0, 1e300, "units in the last place, 0 or more");
		return 0;
	case SECONDS:
		wish->seconds = option_number("seconds", argument, 0.1, 1e7, "seconds, 0.1 to 1e7");
		return 0;
	case QUESTIONS:
		wish->questions = option_count("questions", argument, 1, UINT64_MAX / 2);
		return 0;
	case SEED:
		wish->seed = option_count("seed", argument, 0, UINT64_MAX);
		return 0;
	case CORPUS:
		wish->corpus = argument;
		return 0;
	case THREADS:
		wish->threads = (int)option_count("threads", argument, 1, 1024);
		return 0;
	case JSON:
		wish->json = argument;
		return 0;
	case ARGP_KEY_ARG:
		words_add(&wish->guests.methods, argument);
		return 0;
	default:
		return ARGP_ERR_UNKNOWN;
	}
}

/* One hunt, and how it is told of. */
struct chase {
	const struct wish *wish;
	struct fuzz_hunt hunt;
	struct progress progress;
	bool unwritten;
	char error[CORPUS_ERROR];
};

static void keep(void *context, const struct fuzz_finding *finding)
{
	struct chase *chase = context;
	if (!corpus_write(&chase->hunt, finding, chase->wish->corpus, chase->error)) chase->unwritten = true;
}

static void show(void *context, double part)
{
	struct chase *chase = context;
	progress_show(&chase->progress, 100 * part, 100);
}

/* ---- telling */

static bool is_finding(const struct fuzz_hunt *hunt)
{
	bool found = hunt->given_up;
	for (size_t f = 0; f < hunt->findings; f++) found |= hunt->finding[f].shrunk.promised;
	return found;
}

static void print_hunt(const struct fuzz_hunt *hunt)
{
	const struct fuzz_subject *subject = &hunt->subject;
	printf("%s %s %s: %" PRIu64 " questions in %.1f s (%.3g per second), %zu findings%s\n", subject->finder->method,
		   subject->finder->arithmetic, shape_name(subject->shape), hunt->asked, hunt->elapsed,
		   (double)hunt->asked / hunt->elapsed, hunt->findings,
		   hunt->given_up ? "; given up, for it crashed or hung too often" : "");
	for (size_t f = 0; f < hunt->findings; f++) {
		const struct fuzz_finding *finding = &hunt->finding[f];
		char words[320];
		fuzz_words(subject, &finding->shrunk, words);
		printf("  %s%s\n    met %" PRIu64 " times, first after %.2f s; %u significant bits, shrunk from %u:\n",
			   finding->shrunk.promised ? "" : "(beyond what it claims) ", words, finding->met, finding->seconds,
			   fuzz_case_bits(subject->shape, &finding->shrunk), fuzz_case_bits(subject->shape, &finding->first));
		for (int q = 0; q < finding->shrunk.questions; q++) {
			char *text = query_text(subject->shape, finding->shrunk.number[q]);
			printf("    %s\n", text ? text : "");
			free(text);
		}
	}
}

static json_t *finding_json(const struct fuzz_subject *subject, const struct fuzz_finding *finding)
{
	char words[320];
	fuzz_words(subject, &finding->shrunk, words);
	json_t *questions = json_array();
	for (int q = 0; q < finding->shrunk.questions; q++) {
		char *text = query_text(subject->shape, finding->shrunk.number[q]);
		json_array_append_new(questions, json_string(text ? text : ""));
		free(text);
	}
	return json_pack("{s:s, s:b, s:s, s:o, s:i, s:i, s:I, s:I, s:f}", "failure",
					 fuzz_failure_name(finding->shrunk.failure), "promised_not_to_happen", finding->shrunk.promised,
					 "words", words, "questions", questions, "significant_bits",
					 (int)fuzz_case_bits(subject->shape, &finding->shrunk), "significant_bits_when_met",
					 (int)fuzz_case_bits(subject->shape, &finding->first), "met", (json_int_t)finding->met, "question",
					 (json_int_t)finding->question, "seconds", finding->seconds);
}

static json_t *hunt_json(const struct fuzz_hunt *hunt)
{
	json_t *findings = json_array();
	for (size_t f = 0; f < hunt->findings; f++)
		json_array_append_new(findings, finding_json(&hunt->subject, &hunt->finding[f]));
	return json_pack("{s:s, s:s, s:s, s:I, s:I, s:f, s:b, s:o}", "method", hunt->subject.finder->method, "arithmetic",
					 hunt->subject.finder->arithmetic, "shape", shape_name(hunt->subject.shape), "seed",
					 (json_int_t)hunt->seed, "questions", (json_int_t)hunt->asked, "seconds", hunt->elapsed, "given_up",
					 hunt->given_up, "findings", findings);
}

/* ---- hunting */

/* What is known to be hard, and what was found before. */
static bool gather_corpus(struct chase *chase)
{
	char *path = cases_find(cases_folder(NULL), "hard-inputs.txt");
	bool good = !path || corpus_read_file(&chase->hunt, path, chase->error);
	free(path);
	return good && corpus_read(&chase->hunt, chase->wish->corpus, chase->error) &&
		   corpus_rounds(&chase->hunt, chase->wish->corpus, chase->error);
}

static int chase_one(const struct wish *wish, const struct finder *finder, enum touchstone_shape shape, double seconds,
					 json_t *told)
{
	char what[120];
	snprintf(what, sizeof what, "fuzz %.40s %.20s %s", finder->method, finder->arithmetic, shape_name(shape));
	struct chase chase = {.wish = wish, .progress = progress_begin(what, "%")};
	chase.hunt = (struct fuzz_hunt){
		.subject = fuzz_subject(finder, shape, wish->bound),
		.seed = wish->seed,
		.threads = wish->threads,
		.seconds = wish->questions ? INFINITY : seconds,
		.questions = wish->questions ? wish->questions : UINT64_MAX,
		.stop = interrupt_flag(),
		.tell = keep,
		.progress = show,
		.context = &chase,
	};
	bool good = gather_corpus(&chase) && fuzz_hunt(&chase.hunt, chase.error) && !chase.unwritten &&
				corpus_enter_rounds(&chase.hunt, wish->corpus, chase.error);
	progress_end(&chase.progress);
	int status = !good ? refuse("%s", chase.error) : is_finding(&chase.hunt) ? STATUS_FINDING : STATUS_WELL;
	if (good && told) json_array_append_new(told, hunt_json(&chase.hunt));
	if (good && (!wish->json || strcmp(wish->json, "-") != 0)) print_hunt(&chase.hunt);
	fuzz_hunt_free(&chase.hunt);
	return status;
}

static bool wanted(const struct wish *wish, const struct finder *finder, int shape)
{
	char why[160];
	return wish->guests.shapes & 1u << shape && finder_answers(finder, (enum touchstone_shape)shape, why);
}

static int chase_all(const struct wish *wish, const struct party *party, json_t *told)
{
	int chases = 0, status = STATUS_WELL;
	for (size_t f = 0; f < party->count; f++)
		for (int shape = 0; shape < TOUCHSTONE_SHAPES; shape++) chases += wanted(wish, &party->finders[f], shape);
	if (chases == 0) return refuse("fuzz: none of these finders answers any of these shapes");
	for (size_t f = 0; f < party->count; f++)
		for (int shape = 0; shape < TOUCHSTONE_SHAPES && status != STATUS_REFUSED && !interrupted(); shape++) {
			if (!wanted(wish, &party->finders[f], shape)) continue;
			int one = chase_one(wish, &party->finders[f], (enum touchstone_shape)shape, wish->seconds / chases, told);
			if (one != STATUS_WELL) status = one;
		}
	return status != STATUS_REFUSED && interrupted() ? STATUS_INTERRUPTED : status;
}

static int run(const struct wish *wish)
{
	char error[REPORT_ERROR];
	const struct plugin_patience patience = {wish->patience, 40, 3, true, interrupt_flag()};
	if (wish->json && !output_possible(wish->json, error)) return refuse("%s", error);
	if (!aside_folder(wish->corpus, error)) return refuse("%s", error);
	interrupt_watch();
	struct party party = {0};
	int status = party_gather(&party, "fuzz", &wish->guests, &patience);
	json_t *told = wish->json ? json_array() : NULL;
	if (status == STATUS_WELL) {
		status = chase_all(wish, &party, told);
		if (told && status != STATUS_REFUSED && !output_json(wish->json, told, error)) status = refuse("%s", error);
	}
	json_decref(told);
	party_dismiss(&party);
	return status;
}

int command_fuzz(int argc, char **argv)
{
	static const struct argp argp = {
		.options = options,
		.parser = parse,
		.args_doc = "METHOD... | all",
		.doc =
			"Looks for questions that finders of event times answer wrongly, from the families, from what was found "
			"before, and from changes to both. Looked for are: missed, phantom, negative, nan, imprecise (farther off "
			"than claimed, or than --bound), misordered (two times the wrong way round), crash and hang. What is found "
			"is made as simple as it can be while it stays the same failure at the same branch, and written to the "
			"corpus, one file each, for `touchstone replay`. Going on with the same corpus and seed goes on where the "
			"hunt left off.\v"
			"Exit status: 0 nothing was found that a method's file claims not to happen; 1 something was, or a finder "
			"that claims nothing failed; 2 bad input; 130 interrupted, and what was found by then is kept.\n\n"
			"Example: touchstone fuzz naive --shape ball-ball --seconds 5",
	};
	struct wish wish = {.corpus = "build/corpus",
						.seconds = 60,
						.bound = NAN,
						.patience = 0.2,
						.seed = 1,
						.threads = omp_get_num_procs()};
	if (!guests_room(&wish.guests, argc)) return refuse("out of memory");
	argp_parse(&argp, argc, argv, 0, NULL, &wish);
	guests_complete(&wish.guests, "fuzz");
	int status = run(&wish);
	guests_free(&wish.guests);
	return status;
}
