/* Checks of finders: one method asked the questions of one family, once for each seed. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "audit/check.h"
#include "command/grading.h"
#include "command/interrupt.h"

/* What all seeds together count. */
struct tally {
	uint64_t class[FINDER_CLASSES], cases, pairs, misordered, broken;
	struct sample median, largest, nanoseconds;
};

static bool add(struct tally *tally, const struct grading_plan *plan, char error[STORE_ERROR])
{
	struct grading grading;
	bool good = grading_run(plan, &grading, error);
	if (good && grading.interrupted) good = false;
	for (size_t r = 0; good && r < grading.row_count; r++) {
		const struct grade_row *row = &grading.rows[r];
		for (int c = 0; c < FINDER_CLASSES; c++) tally->class[c] += row->grade.count[c];
		tally->cases += finder_grade_cases(&row->grade);
		tally->pairs += row->grade.pairs;
		tally->misordered += row->grade.misordered;
		tally->broken += row->grade.broken;
		sample_add(&tally->median, row->median_ulp);
		sample_add(&tally->largest, row->max_ulp);
		sample_add(&tally->nanoseconds, row->nanoseconds);
	}
	grading_free(&grading);
	return good;
}

static struct measurement measure(const struct quantity_entry *entry, const struct tally *tally)
{
	switch ((enum audit_quantity)(entry - audit_quantities)) {
	case GRADE_MISSED:
		return measurement_proportion(tally->class[FINDER_MISSED], tally -> cases);
	case GRADE_PHANTOM:
		return measurement_proportion(tally->class[FINDER_PHANTOM], tally -> cases);
	case GRADE_NEGATIVE:
		return measurement_proportion(tally->class[FINDER_NEGATIVE], tally -> cases);
	case GRADE_NAN:
		return measurement_proportion(tally->class[FINDER_NAN], tally -> cases);
	case GRADE_MISORDERED:
		return measurement_proportion(tally->misordered, tally->pairs);
	case GRADE_BROKEN:
		return measurement_proportion(tally->broken, tally->cases);
	case GRADE_MEDIAN_ULP:
		return measurement_sample(entry->nature, &tally->median);
	case GRADE_LARGEST_ULP:
		return measurement_sample(entry->nature, &tally->largest);
	default:
		return measurement_sample(entry->nature, &tally->nanoseconds);
	}
}

bool check_grade(const struct suite_check *check, uint64_t seed, double share, int threads, struct check_value *values,
				 char error[STORE_ERROR])
{
	bool untimed = true;
	for (size_t m = 0; m < check->measure_count; m++)
		untimed &= check->measures[m].quantity != &audit_quantities[GRADE_CALL_TIME];
	const struct finder finder = {.method = check->method, .arithmetic = check->arithmetic};
	const struct question_source source = {
		.name = check->family->name, .origin = check->family->origin, .family = check->family};
	struct grading_plan plan = {
		.finders = &finder,
		.finder_count = 1,
		.sources = &source,
		.source_count = 1,
		.shapes = 1u << check->shape,
		.cases = (uint64_t)ceil(share * (double)check->cases),
		.threads = threads,
		.untimed = untimed || share < 1,
		.stop = interrupt_flag(),
	};
	struct tally tally = {0};
	for (uint64_t k = 0; k < (share < 1 ? 1 : check->seeds); k++) {
		plan.seed = seed + k;
		if (!add(&tally, &plan, error)) return false;
	}
	for (size_t m = 0; m < check->measure_count; m++) values[m].measured = measure(check->measures[m].quantity, &tally);
	return true;
}
