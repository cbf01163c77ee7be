#include "command/grading.h"

#include <math.h>
#include <omp.h>
#include <stdlib.h>
#include <string.h>

#include "command/command.h"
#include "measure/call_time.h"

enum {
	BLOCK = 32768, /* questions held at a time */
	SLICE = 1024,  /* of them, answered and graded at a time by one thread; even, so that pairs stay together */
	TIMED = 1024,  /* of them, calls that are timed together */
};

typedef double question[TOUCHSTONE_MOST_NUMBERS];

/* The questions in hand: some of those of one shape from one source. */
struct block {
	const struct question_source *source;
	enum touchstone_shape shape;
	uint64_t first, total; /* number of the first one in hand; how many there are in all */
	size_t count;
	question *number; /* BLOCK of them */
	long *line;       /* where each stands in its file, or its number from 1 */
	size_t next;      /* query of the file to look at next */
};

/* Where a finder sits while one block after another is asked. */
struct seat {
	struct work *work;
	struct grade_row *row;
	double answer[BLOCK]; /* to the questions in hand */
};

struct work {
	const struct grading_plan *plan;
	struct grading *grading;
	struct progress progress;
	double total; /* answers to be graded */
	struct block block;
	struct seat *seat; /* room for all finders */
	size_t seats;      /* those that answer the shape in hand */
	struct call_time *callee;
	struct oracle **oracle; /* of each thread */
	char *error;
};

static bool fail(struct work *work, const char *why)
{
	snprintf(work->error, GRADING_ERROR, "%s", why);
	return false;
}

static bool stopped(const struct work *work)
{
	return work->plan->stop && *work->plan->stop;
}

/* ---- questions */

static uint64_t questions_in(const struct grading_plan *plan, const struct question_source *source,
							 enum touchstone_shape shape)
{
	if (!(plan->shapes & 1u << shape)) return 0;
	if (source->family) return source->family->shapes & 1u << shape ? plan->cases : 0;
	uint64_t count = 0;
	for (size_t q = 0; q < source->file->count; q++) count += source->file->query[q].shape == shape;
	return count;
}

/* The next of the file's questions of the block's shape. */
static void read_file(struct block *block)
{
	const struct query_file *file = block->source->file;
	for (size_t k = 0; k < block->count; block->next++) {
		const struct query *query = &file->query[block->next];
		if (query->shape != block->shape) continue;
		memcpy(block->number[k], query->number, sizeof block->number[k]);
		block->line[k++] = query->line;
	}
}

/* Takes the questions from number `first` on in hand. */
static bool fill_block(struct work *work, uint64_t first)
{
	struct block *block = &work->block;
	char why[160];
	block->first = first;
	block->count = block->total - first < BLOCK ? (size_t)(block->total - first) : BLOCK;
	if (block->source->file) {
		read_file(block);
		return true;
	}
	for (size_t k = 0; k < block->count; k++) block->line[k] = (long)(first + k + 1);
	return family_fill(block->source->family, block->shape, work->plan->seed, first, block->count, block->number,
					   why) ||
		   fail(work, why);
}

/* ---- answers */

static void add_fault(void *context, const struct plugin_fault *fault)
{
	struct seat *seat = context;
	struct grading *grading = seat->work->grading;
	const struct block *block = &seat->work->block;
	seat->row->faults++;
	struct grade_fault *faults = reallocarray(grading->faults, grading->fault_count + 1, sizeof *faults);
	if (!faults) return; /* it has been counted */
	grading->faults = faults;
	struct grade_fault *one = &faults[grading->fault_count++];
	*one = (struct grade_fault){
		.row = (size_t)(seat->row - grading->rows), .fault = *fault, .line = block->line[fault->question]};
	memcpy(one->number, block->number[fault->question], sizeof one->number);
}

/* Returns how many of the questions in hand the plug-in has dealt with. */
static size_t ask_plugin(struct seat *seat)
{
	const struct block *block = &seat->work->block;
	struct grade_row *row = seat->row;
	if (row->given_up) return 0;
	size_t dealt = plugin_find(row->finder->plugin, block->shape, (void *)block->number, block->count, seat->answer,
							   add_fault, seat);
	row->given_up = dealt < block->count && !stopped(seat->work);
	return dealt;
}

/* Answers (plug-ins have been asked before) and grades a slice of the questions in hand. */
static bool grade_slice(struct seat *seat, size_t from, size_t count)
{
	const struct block *block = &seat->work->block;
	const struct finder *finder = seat->row->finder;
	const double(*number)[TOUCHSTONE_MOST_NUMBERS] = (void *)(block->number + from);
	double *answer = seat->answer + from;
	bool paired = block->source->family && block->source->family->paired;
	struct finder_grade part = finder_grade_new(block->shape);
	part.claim = seat->row->grade.claim;
	char why[160];
	bool good = (finder->plugin || touchstone_find(finder->arithmetic, finder->method, block->shape, number, count,
												   false, answer, why)) &&
				finder_grade_add(&part, seat->work->oracle[omp_get_thread_num()], block->first + from, number, answer,
								 count, paired);
#pragma omp critical(grading_row)
	good = good && finder_grade_merge(&seat->row->grade, &part);
	finder_grade_free(&part);
	return good;
}

/* One finder, all questions in hand. */
static bool grade_block(struct seat *seat)
{
	struct work *work = seat->work;
	size_t count = seat->row->finder->plugin ? ask_plugin(seat) : work->block.count;
	bool good = true;
#pragma omp parallel for schedule(dynamic, 1) num_threads(work->plan->threads) reduction(&& : good)
	for (size_t from = 0; from < count; from += SLICE)
		good = grade_slice(seat, from, count - from < SLICE ? count - from : SLICE) && good;
	for (size_t k = count; k < work->block.count; k++) seat->answer[k] = NAN;
	work->grading->answered += count;
	progress_show(&work->progress, (double)work->grading->answered, work->total);
	return good || fail(work, "out of memory");
}

/* One line for each question in hand and each finder: line,method,answer,exact. */
static void write_answers(const struct work *work)
{
	const struct block *block = &work->block;
	const struct finder *finders = work->plan->finders;
	bool one_arithmetic = true;
	for (size_t f = 1; f < work->plan->finder_count; f++)
		one_arithmetic &= strcmp(finders[f].arithmetic, finders[0].arithmetic) == 0;
	for (size_t k = 0; k < block->count; k++) {
		struct oracle_query query = finder_question(block->shape, block->number[k]);
		double exact = NAN;
		if (oracle_accepts(&query)) {
			struct oracle_time time = oracle_solve(work->oracle[0], &query);
			exact = oracle_round(work->oracle[0], &time, MPFR_RNDN);
		}
		for (const struct seat *seat = work->seat; seat < work->seat + work->seats; seat++)
			fprintf(work->plan->answers, "%ld,%s%s%s,%a,%a\n", block->line[k], seat->row->finder->method,
					one_arithmetic ? "" : " ", one_arithmetic ? "" : seat->row->finder->arithmetic, seat->answer[k],
					exact);
	}
}

/* ---- times */

static void call_method(void *context, size_t count)
{
	struct seat *seat = context;
	const struct finder *finder = seat->row->finder;
	char why[160];
	touchstone_find(finder->arithmetic, finder->method, seat->row->shape, (void *)seat->work->block.number, count,
					false, seat->answer, why);
}

/* Times all finders over the questions in hand, which are repeated if they are few. */
static void take_times(struct work *work)
{
	struct block *block = &work->block;
	size_t methods = 0;
	for (size_t k = block->count; k < TIMED; k++)
		memcpy(block->number[k], block->number[k % block->count], sizeof block->number[k]);
	for (struct seat *seat = work->seat; seat < work->seat + work->seats; seat++)
		if (seat->row->finder->plugin && !seat->row->faults)
			seat->row->nanoseconds =
				plugin_nanoseconds(seat->row->finder->plugin, block->shape, (void *)block->number, TIMED);
		else if (!seat->row->finder->plugin)
			work->callee[methods++] = (struct call_time){call_method, seat, NAN};
	call_time_measure(work->callee, methods, TIMED);
	for (size_t m = 0; m < methods; m++) {
		const struct seat *seat = work->callee[m].context;
		seat->row->nanoseconds = fmax(0, work->callee[m].nanoseconds);
	}
}

/* ---- one set of questions after another */

static void finish_row(struct grade_row *row)
{
	row->median_ulp = finder_quantile(&row->grade.ulp, 0.5);
	row->p999_ulp = finder_quantile(&row->grade.ulp, 0.999);
	row->max_ulp = finder_quantile(&row->grade.ulp, 1);
	row->median_gap = finder_quantile(&row->grade.gap, 0.5);
	row->max_gap = finder_quantile(&row->grade.gap, 1);
	finder_grade_forget(&row->grade);
}

/* Gives every finder that answers the shape in hand a seat and a row. */
static void take_seats(struct work *work)
{
	const struct grading_plan *plan = work->plan;
	char why[160];
	work->seats = 0;
	for (size_t f = 0; f < plan->finder_count; f++) {
		if (!finder_answers(&plan->finders[f], work->block.shape, why)) continue;
		struct grade_row *row = &work->grading->rows[work->grading->row_count++];
		*row = (struct grade_row){
			.finder = &plan->finders[f],
			.source = work->block.source,
			.shape = work->block.shape,
			.grade = finder_grade_new(work->block.shape),
			.nanoseconds = NAN,
		};
		if (finder_claims(row->finder, row->shape, &row->claim)) row->grade.claim = &row->claim;
		work->seat[work->seats].work = work;
		work->seat[work->seats++].row = row;
	}
}

/* All questions of one shape from one source. */
static bool grade_set(struct work *work, const struct question_source *source, enum touchstone_shape shape)
{
	struct block *block = &work->block;
	block->source = source;
	block->shape = shape;
	block->next = 0;
	block->total = questions_in(work->plan, source, shape);
	if (block->total == 0) return true;
	take_seats(work);
	bool good = true;
	for (uint64_t first = 0; good && first < block->total && !stopped(work); first += BLOCK) {
		good = fill_block(work, first);
		for (size_t s = 0; good && s < work->seats; s++) good = grade_block(&work->seat[s]);
		if (good && work->plan->answers) write_answers(work);
		if (good && first == 0 && !stopped(work) && !work->plan->untimed) take_times(work);
	}
	for (size_t s = 0; s < work->seats; s++) finish_row(work->seat[s].row);
	return good;
}

double grading_questions(const struct grading_plan *plan)
{
	double total = 0;
	char why[160];
	for (size_t s = 0; s < plan->source_count; s++)
		for (int shape = 0; shape < TOUCHSTONE_SHAPES; shape++)
			for (size_t f = 0; f < plan->finder_count; f++)
				if (finder_answers(&plan->finders[f], shape, why))
					total += (double)questions_in(plan, &plan->sources[s], shape);
	return total;
}

static bool prepare(struct work *work)
{
	const struct grading_plan *plan = work->plan;
	work->grading->rows =
		calloc(plan->source_count * TOUCHSTONE_SHAPES * plan->finder_count, sizeof *work->grading->rows);
	work->seat = calloc(plan->finder_count, sizeof *work->seat);
	work->callee = calloc(plan->finder_count, sizeof *work->callee);
	work->oracle = calloc((size_t)plan->threads, sizeof(struct oracle *));
	work->block.number = calloc(BLOCK, sizeof *work->block.number);
	work->block.line = calloc(BLOCK, sizeof *work->block.line);
	bool good =
		work->grading->rows && work->seat && work->callee && work->oracle && work->block.number && work->block.line;
	for (int t = 0; good && t < plan->threads; t++) good = (work->oracle[t] = oracle_create());
	return good || fail(work, "out of memory");
}

static void clear(struct work *work)
{
	for (int t = 0; work->oracle && t < work->plan->threads; t++) oracle_destroy(work->oracle[t]);
	free(work->oracle);
	free(work->seat);
	free(work->callee);
	free(work->block.number);
	free(work->block.line);
}

bool grading_run(const struct grading_plan *plan, struct grading *grading, char error[GRADING_ERROR])
{
	*grading = (struct grading){0};
	struct work work = {.plan = plan,
						.grading = grading,
						.progress = progress_begin("grade", "answers"),
						.total = grading_questions(plan),
						.error = error};
	double began = progress_clock();
	bool good = prepare(&work);
	if (good && plan->answers) fputs("line,method,answer,exact\n", plan->answers);
	for (size_t s = 0; good && s < plan->source_count; s++)
		for (int shape = 0; good && shape < TOUCHSTONE_SHAPES && !stopped(&work); shape++)
			good = grade_set(&work, &plan->sources[s], (enum touchstone_shape)shape);
	progress_end(&work.progress);
	grading->seconds = progress_clock() - began;
	grading->interrupted = stopped(&work);
	clear(&work);
	return good;
}

void grading_free(struct grading *grading)
{
	for (size_t r = 0; r < grading->row_count; r++) finder_grade_free(&grading->rows[r].grade);
	free(grading->rows);
	free(grading->faults);
}

bool grading_finding(const struct grading *grading)
{
	bool finding = grading->fault_count > 0;
	for (size_t r = 0; r < grading->row_count; r++) {
		const struct grade_row *row = &grading->rows[r];
		bool garbage = row->finder->plugin && (row->grade.count[FINDER_NAN] || row->grade.count[FINDER_NEGATIVE]);
		finding |= row->faults || row->grade.broken || garbage;
	}
	return finding;
}
