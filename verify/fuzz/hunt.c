#include "fuzz/hunt.h"

#include <math.h>
#include <omp.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "family/family.h"
#include "fuzz/mutate.h"
#include "fuzz/shrink.h"

enum {
	SLICE = 4096,  /* questions made, asked and judged by one thread; even */
	SLICES = 16,   /* of a round */
	TRIES = 10000, /* to shrink a finding; */
	FRESH = 4,     /* one slice in so many is a family's own questions */
};

typedef double question[TOUCHSTONE_MOST_NUMBERS];

/* What one thread works on. */
struct slice {
	question number[SLICE];
	double answer[SLICE];
	struct plugin_fault fault[SLICE];
	bool faulty[SLICE];
	size_t count;   /* questions that have been dealt with */
	size_t ordered; /* 2: of questions 2k and 2k + 1 the order of times counts; 1: of all that follow each other */
	struct fuzz_finding *finding;
	size_t findings, room;
	bool failed;
};

static double now(void)
{
	struct timespec time;
	clock_gettime(CLOCK_MONOTONIC, &time);
	return (double)time.tv_sec + 1e-9 * (double)time.tv_nsec;
}

bool fuzz_feed(struct fuzz_hunt *hunt, const double number[TOUCHSTONE_MOST_NUMBERS])
{
	if (hunt->corpus_count == hunt->corpus_room) {
		size_t room = hunt->corpus_room ? 2 * hunt->corpus_room : 64;
		void *larger = reallocarray(hunt->corpus, room, sizeof *hunt->corpus);
		if (!larger) return false;
		hunt->corpus = larger;
		hunt->corpus_room = room;
	}
	memcpy(hunt->corpus[hunt->corpus_count++], number, sizeof *hunt->corpus);
	return true;
}

/* ---- questions */

/* Families that have questions of the shape. */
static size_t families_of(enum touchstone_shape shape, const struct family *list[64])
{
	size_t count = 0;
	for (size_t f = 0; family_at(f) && count < 64; f++)
		if (family_at(f)->shapes & 1u << shape) list[count++] = family_at(f);
	return count;
}

/* Slice number `index` of all that the seed stands for. */
static bool make_slice(const struct fuzz_hunt *hunt, struct slice *slice, uint64_t index, char error[160])
{
	enum touchstone_shape shape = hunt->subject.shape;
	const struct family *list[64];
	size_t families = families_of(shape, list);
	uint64_t turn = index / FRESH;
	const struct family *family = list[turn % families];
	uint64_t first = turn / families * SLICE;
	slice->ordered = index % FRESH == 1 ? 2 : 0;
	if (!family_fill(family, shape, hunt->seed, first, SLICE, slice->number, error)) return false;
	struct random_state random = random_seed(hunt->seed ^ (index + 1) * UINT64_C(0x9e3779b97f4a7c15));
	for (size_t k = 0; index % FRESH != 0 && k < SLICE; k++) {
		bool neighbour = slice->ordered && k % 2 == 1;
		if (neighbour)
			memcpy(slice->number[k], slice->number[k - 1], sizeof *slice->number);
		else if (hunt->corpus_count && random_bits(&random) >> 62)
			memcpy(slice->number[k], hunt->corpus[random_below(&random, hunt->corpus_count)], sizeof *slice->number);
		if (neighbour)
			fuzz_nudge(shape, &random, slice->number[k]);
		else
			fuzz_mutate(shape, &random, slice->number[k]);
	}
	for (size_t k = 0; k < SLICE; k++) fuzz_fit(shape, hunt->subject.claim.bits, slice->number[k]);
	return true;
}

/* ---- answers */

static void note_fault(void *context, const struct plugin_fault *fault)
{
	struct slice *slice = context;
	slice->fault[fault->question] = *fault;
	slice->faulty[fault->question] = true;
}

static bool answer_slice(const struct fuzz_hunt *hunt, struct slice *slice, char error[160])
{
	const struct finder *finder = hunt->subject.finder;
	const double(*numbers)[TOUCHSTONE_MOST_NUMBERS] = (void *)slice->number;
	memset(slice->faulty, 0, sizeof slice->faulty);
	if (!finder->plugin)
		return touchstone_find(finder->arithmetic, finder->method, hunt->subject.shape, numbers, slice->count, false,
							   slice->answer, error);
	slice->count =
		plugin_find(finder->plugin, hunt->subject.shape, numbers, slice->count, slice->answer, note_fault, slice);
	return true;
}

/* ---- findings */

static struct fuzz_finding *like(struct fuzz_finding *findings, size_t count, const struct fuzz_case *failed)
{
	for (size_t f = 0; f < count; f++)
		if (fuzz_same(&findings[f].first, failed)) return &findings[f];
	return NULL;
}

/* A failure of this slice: counted, and kept if it is the first of its kind, or the simplest. */
static void keep(enum touchstone_shape shape, struct slice *slice, const struct fuzz_case *failed, uint64_t question)
{
	struct fuzz_finding *known = like(slice->finding, slice->findings, failed);
	if (known) {
		known->met++;
		if (fuzz_case_bits(shape, failed) < fuzz_case_bits(shape, &known->shrunk)) known->shrunk = *failed;
		return;
	}
	if (slice->findings == slice->room) {
		size_t room = slice->room ? 2 * slice->room : 16;
		void *larger = reallocarray(slice->finding, room, sizeof *slice->finding);
		if (!larger) {
			slice->failed = true;
			return;
		}
		slice->finding = larger;
		slice->room = room;
	}
	slice->finding[slice->findings++] =
		(struct fuzz_finding){.first = *failed, .shrunk = *failed, .met = 1, .question = question};
}

static void judge_slice(const struct fuzz_hunt *hunt, struct oracle *oracle, struct slice *slice)
{
	bool wrong = false;
	struct fuzz_case failed;
	slice->findings = 0;
	for (size_t k = 0; k < slice->count; k++) {
		bool earlier = k > 0 && wrong;
		wrong = fuzz_judge(&hunt->subject, oracle, slice->number[k], slice->answer[k],
						   slice->faulty[k] ? &slice->fault[k] : NULL, &failed);
		if (wrong)
			keep(hunt->subject.shape, slice, &failed, k);
		else if (slice->ordered && k > 0 && (k + 1) % slice->ordered == 0 && !earlier &&
				 fuzz_judge_order(&hunt->subject, oracle, (void *)(slice->number + k - 1), slice->answer + k - 1,
								  &failed))
			keep(hunt->subject.shape, slice, &failed, k);
	}
}

/* Makes a case as simple as it gets, and one more to begin with. */
static bool shrink(struct fuzz_hunt *hunt, struct oracle *oracle, struct fuzz_case *failed)
{
	fuzz_shrink(&hunt->subject, oracle, failed, TRIES, hunt->stop);
	bool good = true;
	for (int q = 0; q < failed->questions; q++) good = good && fuzz_feed(hunt, failed->number[q]);
	return good;
}

static struct fuzz_finding *add_finding(struct fuzz_hunt *hunt)
{
	struct fuzz_finding *larger = reallocarray(hunt->finding, hunt->findings + 1, sizeof *larger);
	if (!larger) return NULL;
	hunt->finding = larger;
	return &larger[hunt->findings++];
}

/* Joins what a slice has found to the whole, and shrinks what is new, or simpler than what was known. */
static bool take_in(struct fuzz_hunt *hunt, struct oracle *oracle, const struct slice *slice, double began)
{
	enum touchstone_shape shape = hunt->subject.shape;
	for (size_t f = 0; f < slice->findings; f++) {
		const struct fuzz_finding *found = &slice->finding[f];
		struct fuzz_finding *known = like(hunt->finding, hunt->findings, &found->first);
		struct fuzz_case simple = found->shrunk;
		if (known && fuzz_case_bits(shape, &simple) >= fuzz_case_bits(shape, &known->shrunk)) {
			known->met += found->met;
			continue;
		}
		double met = now() - began;
		if (!shrink(hunt, oracle, &simple)) return false;
		if (known) {
			known->met += found->met;
		} else {
			if (!(known = add_finding(hunt))) return false;
			*known = *found;
			known->question += hunt->asked;
			known->seconds = met;
		}
		known->shrunk = simple;
		if (hunt->tell) hunt->tell(hunt->context, known);
	}
	hunt->asked += slice->count;
	return !slice->failed;
}

/* ---- rounds */

struct crew {
	int threads;
	struct slice *slice;    /* SLICES of them */
	struct oracle **oracle; /* one a thread */
};

static bool stopped(const struct fuzz_hunt *hunt)
{
	return hunt->stop && *hunt->stop;
}

/* Works on so many slices, each with its questions made by `index`, or already there if that is NULL. */
static bool work(struct fuzz_hunt *hunt, struct crew *crew, const uint64_t *index, size_t slices, double began,
				 char error[160])
{
	bool good = true;
#pragma omp parallel for schedule(dynamic, 1) num_threads(crew->threads) reduction(&& : good)
	for (size_t s = 0; s < slices; s++) {
		struct slice *slice = &crew->slice[s];
		char why[160];
		if (index) slice->count = SLICE;
		bool enough = hunt->subject.finder->plugin && s > 0 && crew->slice[s - 1].count < SLICE; /* one at a time */
		if (stopped(hunt) || enough) slice->count = 0;
		bool done = (!index || make_slice(hunt, slice, *index + s, why)) && answer_slice(hunt, slice, why);
		if (done) judge_slice(hunt, crew->oracle[omp_get_thread_num()], slice);
#pragma omp critical(fuzz_error)
		if (!done) snprintf(error, 160, "%s", why);
		good = good && done;
	}
	for (size_t s = 0; good && s < slices; s++) {
		bool whole = crew->slice[s].count == SLICE || !index;
		good = take_in(hunt, crew->oracle[0], &crew->slice[s], began);
		if (!good) snprintf(error, 160, "out of memory");
		hunt->given_up |= !whole && !stopped(hunt);
	}
	return good;
}

/* What is in the corpus has gone wrong somewhere before. */
static bool ask_corpus(struct fuzz_hunt *hunt, struct crew *crew, double began, char error[160])
{
	size_t count = hunt->corpus_count;
	bool good = true;
	for (size_t from = 0; good && from < count && !stopped(hunt); from += SLICE) {
		struct slice *slice = crew->slice;
		slice->count = count - from < SLICE ? count - from : SLICE;
		slice->ordered = 1;
		memcpy(slice->number, hunt->corpus + from, slice->count * sizeof *slice->number);
		good = work(hunt, crew, NULL, 1, began, error);
	}
	return good;
}

static bool go_on(struct fuzz_hunt *hunt, double began)
{
	double spent = now() - began, asked = (double)hunt->asked / (double)hunt->questions;
	if (hunt->progress) hunt->progress(hunt->context, fmin(1, fmax(asked, spent / hunt->seconds)));
	return !stopped(hunt) && !hunt->given_up && spent < hunt->seconds && hunt->asked < hunt->questions;
}

bool fuzz_hunt(struct fuzz_hunt *hunt, char error[160])
{
	/* a plug-in is asked by one thread at a time */
	struct crew crew = {.threads = hunt->subject.finder->plugin ? 1 : hunt->threads};
	double began = now();
	crew.slice = calloc(SLICES, sizeof *crew.slice);
	crew.oracle = calloc((size_t)crew.threads, sizeof(struct oracle *));
	bool good = crew.slice && crew.oracle;
	for (int t = 0; good && t < crew.threads; t++) good = (crew.oracle[t] = oracle_create());
	if (!good) snprintf(error, 160, "out of memory");
	good = good && ask_corpus(hunt, &crew, began, error);
	while (good && go_on(hunt, began)) {
		uint64_t index = hunt->rounds * SLICES;
		good = work(hunt, &crew, &index, SLICES, began, error);
		hunt->rounds += !stopped(hunt);
	}
	hunt->elapsed = now() - began;
	for (int t = 0; crew.oracle && t < crew.threads; t++) oracle_destroy(crew.oracle[t]);
	for (size_t s = 0; crew.slice && s < SLICES; s++) free(crew.slice[s].finding);
	free(crew.oracle);
	free(crew.slice);
	return good;
}

void fuzz_hunt_free(struct fuzz_hunt *hunt)
{
	free(hunt->corpus);
	free(hunt->finding);
	hunt->corpus = NULL;
	hunt->finding = NULL;
	hunt->corpus_count = hunt->corpus_room = hunt->findings = 0;
}
