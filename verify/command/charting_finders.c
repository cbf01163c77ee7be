/* The finders' half of the chart: how many bits, how often wrong, how fast. */
#include "command/charting.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "measure/call_time.h"
#include "measure/frontier.h"

enum {
	BLOCK = 4096, /* questions of a family at a time: as many as harvested ones are made together */
	TRIAL = 64,   /* questions of a family that show how long the others will take */
	TIMED = 2048, /* calls that are timed together */
	POOL = 8,     /* times as many questions, in turn, so that no branch is predicted from memory */
};
static const enum touchstone_shape shape = TOUCHSTONE_BALL_BALL;

typedef double question[TOUCHSTONE_MOST_NUMBERS];

struct work {
	const struct chart_plan *plan;
	struct chart *chart;
	struct question_source *source; /* families of either origin that ask about balls */
	size_t sources;
	struct oracle *oracle;
	struct finder_truth *truth;
	struct finder_bits *bits; /* of each finder, for either origin */
	char *error;
};

static bool stopped(const struct chart_plan *plan)
{
	return plan->stop && *plan->stop;
}

static bool fail(struct work *work, const char *why)
{
	snprintf(work->error, GRADING_ERROR, "%s", why);
	return false;
}

/* ---- bits */

/* The questions from number `first` on of one family, all finders. */
static bool add_block(struct work *work, const struct question_source *source, uint64_t first, size_t count)
{
	question number[BLOCK];
	char why[160];
	if (!family_fill(source->family, shape, work->plan->seed, first, count, number, why)) return fail(work, why);
	finder_truth_solve(work->truth, work->oracle, shape, (void *)number, count);
	for (size_t f = 0; f < work->plan->finder_count; f++) {
		const struct finder *finder = &work->plan->finders[f];
		struct finder_bits *bits = &work->bits[CHART_ORIGINS * f + source->origin];
		if (!finder_bits_add(bits, work->truth, work->oracle, finder->arithmetic, finder->method, why))
			return fail(work, why);
	}
	return true;
}

/* Blocks of one family after those of another. */
static bool add_bits(struct work *work, uint64_t cases, struct progress *progress)
{
	for (size_t f = 0; f < CHART_ORIGINS * work->plan->finder_count; f++) finder_bits_begin(&work->bits[f]);
	for (uint64_t first = 0; first < cases; first += BLOCK)
		for (size_t s = 0; s < work->sources && !stopped(work->plan); s++) {
			size_t count = cases - first < BLOCK ? (size_t)(cases - first) : BLOCK;
			if (!add_block(work, &work->source[s], first, count)) return false;
			if (progress) progress_show(progress, (double)(first + count * s / work->sources), (double)cases);
		}
	return true;
}

static bool find_bits(struct work *work)
{
	struct progress progress = progress_begin("bits", "questions of each family");
	bool good = add_bits(work, work->chart->cases, &progress);
	progress_end(&progress);
	for (size_t f = 0; good && f < work->plan->finder_count; f++)
		for (int origin = 0; origin < CHART_ORIGINS; origin++) {
			const struct finder_bits *bits = &work->bits[CHART_ORIGINS * f + (size_t)origin];
			struct chart_side *side = &work->chart->finders[f][origin];
			side->bits = finder_bits_of_share(bits, 0.999);
			side->median = finder_bits_of_share(bits, 0.5);
			side->least = bits->found ? bits->least : NAN;
		}
	return good;
}

/* How many questions of each family there is time for: a third of it goes into bits and grades. */
static bool fit_cases(struct work *work)
{
	const struct chart_plan *plan = work->plan;
	work->chart->cases = plan->cases;
	if (plan->seconds <= 0) return true;
	double began = progress_clock();
	if (!add_bits(work, TRIAL, NULL)) return false;
	double each = 2 * (progress_clock() - began) / TRIAL; /* bits take about as long as grades */
	double fitting = fmax(TRIAL, floor(plan->seconds / 3 / each));
	if (fitting < (double)plan->cases) work->chart->cases = (uint64_t)fitting;
	return true;
}

/* ---- faults */

static void add_row(struct chart_side *side, const struct grade_row *row)
{
	side->cases += finder_grade_cases(&row->grade);
	side->missed += row->grade.count[FINDER_MISSED];
	side->phantom += row->grade.count[FINDER_PHANTOM];
	side->negative += row->grade.count[FINDER_NEGATIVE];
	side->nan += row->grade.count[FINDER_NAN];
}

/* Grades the finders of one method, `first` being the first of them; returns how many they are, 0 for a failure. */
static size_t grade_method(struct work *work, size_t first)
{
	const struct chart_plan *plan = work->plan;
	const struct finder *finders = &plan->finders[first];
	size_t count = 1;
	while (first + count < plan->finder_count && strcmp(finders[count].method, finders->method) == 0) count++;
	const struct grading_plan grades = {
		.finders = finders,
		.finder_count = count,
		.sources = work->source,
		.source_count = work->sources,
		.shapes = 1u << shape,
		.cases = work->chart->cases,
		.seed = plan->seed,
		.threads = plan->threads,
		.untimed = true,
		.stop = plan->stop,
	};
	struct grading grading;
	bool good = grading_run(&grades, &grading, work->error);
	for (size_t r = 0; good && r < grading.row_count; r++) {
		const struct grade_row *row = &grading.rows[r];
		add_row(&work->chart->finders[first + (size_t)(row->finder - finders)][row->source->origin], row);
	}
	if (good && plan->graded) plan->graded(plan->context, &grades, &grading);
	grading_free(&grading);
	return good ? count : 0;
}

static bool find_faults(struct work *work)
{
	const struct chart_plan *plan = work->plan;
	for (size_t first = 0, count; first < plan->finder_count && !stopped(plan); first += count)
		if ((count = grade_method(work, first)) == 0) return false;
	for (size_t f = 0; f < plan->finder_count; f++)
		for (int origin = 0; origin < CHART_ORIGINS; origin++) {
			struct chart_side *side = &work->chart->finders[f][origin];
			side->faults = interval_of_proportion(side->missed + side->phantom, side->cases);
		}
	return true;
}

/* ---- times */

struct caller {
	const struct finder *finder;
	question *number; /* POOL * TIMED of them */
	size_t turn;
	bool chained;
	double answer[TIMED];
};

static void call_finder(void *context, size_t count)
{
	struct caller *caller = context;
	char why[160];
	touchstone_find(caller->finder->arithmetic, caller->finder->method, shape,
					(void *)(caller->number + caller->turn * TIMED), count, caller->chained, caller->answer, why);
	if (count) caller->turn = (caller->turn + 1) % POOL;
}

/* Questions of all families of an origin in turn. */
static bool mix_questions(struct work *work, enum family_origin origin, question number[POOL * TIMED])
{
	size_t families = 0, place = 0;
	char why[160];
	for (size_t s = 0; s < work->sources; s++) families += work->source[s].origin == origin;
	size_t each = (POOL * TIMED + families - 1) / families;
	question *own = calloc(each, sizeof *own);
	bool good = own || fail(work, "out of memory");
	for (size_t s = 0; good && s < work->sources; s++) {
		if (work->source[s].origin != origin) continue;
		good = family_fill(work->source[s].family, shape, work->plan->seed, 0, each, own, why) || fail(work, why);
		for (size_t k = place++, from = 0; good && k < POOL * TIMED; k += families, from++)
			memcpy(number[k], own[from], sizeof number[k]);
	}
	free(own);
	return good;
}

/* Times so many of the finders side by side, with `stable` in binary64 among them to compare with. */
static void time_some(struct work *work, size_t first, size_t count, enum family_origin origin, question *number,
					  struct caller *caller, struct call_time *callee)
{
	static const struct finder yardstick = {.method = "stable", .arithmetic = "binary64"};
	for (size_t c = 0; c <= 2 * count; c++) {
		caller[c].finder = c < 2 * count ? &work->plan->finders[first + c / 2] : &yardstick;
		caller[c].number = number;
		caller[c].turn = 0;
		caller[c].chained = c < 2 * count && c % 2;
		callee[c] = (struct call_time){call_finder, &caller[c], NAN};
	}
	call_time_measure(callee, 2 * count + 1, TIMED);
	for (size_t f = 0; f < count; f++) {
		struct chart_side *side = &work->chart->finders[first + f][origin];
		side->throughput = callee[2 * f].nanoseconds;
		side->latency = callee[2 * f + 1].nanoseconds;
		side->times_stable = side->throughput / callee[2 * count].nanoseconds;
	}
}

static bool find_times(struct work *work)
{
	enum { TOGETHER = 31 }; /* with both of their ways and the yardstick, as many as are timed in turn */
	question *number = calloc(POOL * TIMED, sizeof *number);
	struct caller *caller = calloc(2 * TOGETHER + 1, sizeof *caller);
	struct call_time callee[2 * TOGETHER + 1];
	bool good = (number && caller) || fail(work, "out of memory");
	struct progress progress = progress_begin("times", "finders");
	size_t all = work->plan->finder_count;
	for (int origin = 0; good && origin < CHART_ORIGINS; origin++) {
		good = mix_questions(work, (enum family_origin)origin, number);
		for (size_t first = 0; good && first < all && !stopped(work->plan); first += TOGETHER) {
			size_t count = all - first < TOGETHER ? all - first : TOGETHER;
			time_some(work, first, count, (enum family_origin)origin, number, caller, callee);
			progress_show(&progress, (double)((size_t)origin * all + first + count), (double)(CHART_ORIGINS * all));
		}
	}
	progress_end(&progress);
	free(caller);
	free(number);
	return good;
}

/* ---- the frontier, and the whole */

static bool find_frontiers(struct work *work)
{
	size_t count = work->plan->finder_count;
	struct frontier_point *point = calloc(count, sizeof *point);
	if (!point) return fail(work, "out of memory");
	for (int kind = 0; kind < 4 * CHART_ORIGINS; kind++) {
		bool waits = kind & 1, faults = kind & 2;
		for (size_t f = 0; f < count; f++) {
			const struct chart_side *side = &work->chart->finders[f][kind / 4];
			double share = side->cases ? (double)(side->missed + side->phantom) / (double)side->cases : NAN;
			point[f] =
				(struct frontier_point){waits ? side->latency : side->throughput, faults ? -share : side->bits, false};
		}
		frontier_find(point, count);
		for (size_t f = 0; f < count; f++) {
			struct chart_side *side = &work->chart->finders[f][kind / 4];
			*(faults ? &side->best_rate[waits] : &side->best_bits[waits]) = point[f].best;
		}
	}
	free(point);
	return true;
}

static bool prepare(struct work *work)
{
	size_t families = 0, finders = work->plan->finder_count;
	while (family_at(families)) families++;
	work->source = calloc(families, sizeof *work->source);
	work->bits = calloc(CHART_ORIGINS * finders, sizeof *work->bits);
	work->oracle = oracle_create();
	int most = 53;
	for (size_t f = 0; f < finders; f++) {
		char why[160];
		int bits = horizon_bits(work->plan->finders[f].arithmetic, why);
		most = bits > most ? bits : most;
	}
	work->truth = finder_truth_create(BLOCK, most);
	if (!work->source || !work->bits || !work->oracle || !work->truth) return fail(work, "out of memory");
	for (size_t f = 0; f < families; f++) {
		const struct family *family = family_at(f);
		if (family->shapes & 1u << shape)
			work->source[work->sources++] = (struct question_source){family->name, family->origin, family, NULL};
	}
	for (size_t f = 0; f < finders; f++)
		for (int origin = 0; origin < CHART_ORIGINS; origin++) {
			struct chart_side *side = &work->chart->finders[f][origin];
			side->bits = side->median = side->least = side->throughput = side->latency = side->times_stable = NAN;
		}
	return true;
}

bool chart_finders(const struct chart_plan *plan, struct chart *chart, char error[GRADING_ERROR])
{
	struct work work = {.plan = plan, .chart = chart, .error = error};
	bool good = prepare(&work) && fit_cases(&work) && find_bits(&work) && find_faults(&work) && find_times(&work) &&
				find_frontiers(&work);
	finder_truth_destroy(work.truth);
	oracle_destroy(work.oracle);
	free(work.bits);
	free(work.source);
	return good;
}
