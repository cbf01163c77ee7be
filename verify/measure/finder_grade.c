#include "measure/finder_grade.h"

#include <gsl/gsl_statistics_double.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

_Static_assert((int)TOUCHSTONE_BALL_BALL == ORACLE_BALL_BALL && (int)TOUCHSTONE_BALL_LEAVE == ORACLE_BALL_LEAVE &&
				   (int)TOUCHSTONE_BALL_PLANE == ORACLE_BALL_PLANE && (int)TOUCHSTONE_HALF_SPACE == ORACLE_HALF_SPACE,
			   "shapes of the library and of the oracle are numbered alike");

const char *finder_class_name(enum finder_class class)
{
	static const char *const names[] = {
		[FINDER_FOUND] = "found",        [FINDER_RIGHTLY_NEVER] = "rightly never", [FINDER_MISSED] = "missed",
		[FINDER_PHANTOM] = "phantom",    [FINDER_NEGATIVE] = "negative",           [FINDER_NAN] = "nan",
		[FINDER_UNDEFINED] = "undefined"};
	return names[class];
}

struct oracle_query finder_question(enum touchstone_shape shape, const double number[TOUCHSTONE_MOST_NUMBERS])
{
	struct oracle_query query = {.shape = (enum oracle_shape)shape};
	memcpy(query.number, number, sizeof query.number);
	return query;
}

/* ---- values */

static bool reserve(struct finder_values *values, size_t more)
{
	size_t wanted = values->count + more, room = values->room ? values->room : 1024;
	if (wanted <= values->room) return true;
	while (room < wanted) room *= 2;
	double *larger = reallocarray(values->value, room, sizeof *larger);
	if (!larger) return false;
	values->value = larger;
	values->room = room;
	return true;
}

double finder_quantile(struct finder_values *values, double share)
{
	if (values->count == 0) return NAN;
	double rank = ceil(share * (double)values->count);
	return gsl_stats_select(values->value, 1, values->count, rank > 1 ? (size_t)rank - 1 : 0);
}

/* ---- one answer */

enum finder_class finder_classify(struct oracle *oracle, const struct oracle_time *time, double got, double *ulp)
{
	if (isnan(got)) return FINDER_NAN;
	if (got < 0) return FINDER_NEGATIVE;
	if (time->event == ORACLE_NEVER) return got == INFINITY ? FINDER_RIGHTLY_NEVER : FINDER_PHANTOM;
	*ulp = oracle_error(oracle, time, got);
	return got == INFINITY && *ulp > 0 ? FINDER_MISSED : FINDER_FOUND;
}

/* Whether the bodies touch at that time: then f changes its sign there, and otherwise it has the same on both sides. */
static bool touches(struct oracle *oracle, const struct oracle_time *time)
{
	if (time->event != ORACLE_LATER) return false;
	bool leaves = time->query.shape == ORACLE_BALL_LEAVE;
	bool falls = time->query.shape == ORACLE_BALL_PLANE && time->query.plane.acceleration < 0;
	if (!leaves && !falls) return true;
	double before = oracle_gap(oracle, &time->query, oracle_round(oracle, time, MPFR_RNDD));
	return leaves ? before <= 0 : before >= 0;
}

static void remember(struct finder_example *example, uint64_t question, const double *number, double answer)
{
	*example = (struct finder_example){.there = true, .question = question, .answer = answer};
	memcpy(example->number, number, sizeof example->number);
}

/* An event that was found: how far off, and how far from contact. */
static void add_found(struct finder_grade *grade, struct oracle *oracle, const struct oracle_time *time,
					  uint64_t question, double got, double ulp)
{
	grade->ulp.value[grade->ulp.count++] = ulp;
	if (ulp > grade->worst_ulp) {
		grade->worst_ulp = ulp;
		remember(&grade->example[FINDER_FOUND], question, time->query.number, got);
	}
	if (got < INFINITY && touches(oracle, time))
		grade->gap.value[grade->gap.count++] = fabs(oracle_gap(oracle, &time->query, got));
}

static void add_pair(struct finder_grade *grade, struct oracle *oracle, const struct oracle_time time[2],
					 const double got[2])
{
	int order = oracle_compare(oracle, &time[0], &time[1]);
	grade->pairs++;
	grade->misordered += isunordered(got[0], got[1]) || (got[0] > got[1]) - (got[0] < got[1]) != order;
}

/* ---- many answers */

struct finder_grade finder_grade_new(enum touchstone_shape shape)
{
	return (struct finder_grade){.shape = shape};
}

void finder_grade_forget(struct finder_grade *grade)
{
	free(grade->ulp.value);
	free(grade->gap.value);
	grade->ulp = grade->gap = (struct finder_values){0};
}

void finder_grade_free(struct finder_grade *grade)
{
	finder_grade_forget(grade);
	*grade = finder_grade_new(grade->shape);
}

bool finder_grade_add(struct finder_grade *grade, struct oracle *oracle, uint64_t first,
					  const double (*numbers)[TOUCHSTONE_MOST_NUMBERS], const double *answers, size_t count,
					  bool paired)
{
	if (!reserve(&grade->ulp, count) || !reserve(&grade->gap, count)) return false;
	struct oracle_time time[2];
	bool asked[2] = {false, false};
	for (size_t k = 0; k < count; k++) {
		struct oracle_query query = finder_question(grade->shape, numbers[k]);
		struct oracle_time *now = &time[k % 2];
		enum finder_class class = FINDER_UNDEFINED;
		double ulp = 0;
		asked[k % 2] = oracle_accepts(&query);
		if (asked[k % 2]) {
			*now = oracle_solve(oracle, &query);
			class = finder_classify(oracle, now, answers[k], &ulp);
		}
		grade->count[class]++;
		double exact = grade->claim && asked[k % 2] ? oracle_round(oracle, now, MPFR_RNDN) : NAN;
		if (grade->claim && finder_claim_broken(grade->claim, grade->shape, numbers[k], class, exact, ulp) &&
			grade->broken++ == 0)
			remember(&grade->breach, first + k, numbers[k], answers[k]);
		if (class == FINDER_FOUND)
			add_found(grade, oracle, now, first + k, answers[k], ulp);
		else if (!grade->example[class].there)
			remember(&grade->example[class], first + k, numbers[k], answers[k]);
		if (paired && k % 2 == 1 && asked[0] && asked[1]) add_pair(grade, oracle, time, &answers[k - 1]);
	}
	return true;
}

static bool append(struct finder_values *values, const struct finder_values *more)
{
	if (!reserve(values, more->count)) return false;
	if (more->count) memcpy(values->value + values->count, more->value, more->count * sizeof *more->value);
	values->count += more->count;
	return true;
}

bool finder_grade_merge(struct finder_grade *grade, const struct finder_grade *part)
{
	if (!append(&grade->ulp, &part->ulp) || !append(&grade->gap, &part->gap)) return false;
	for (int class = 0; class < FINDER_CLASSES; class ++) {
		const struct finder_example *mine = &grade->example[class], *other = &part->example[class];
		bool worse = class == FINDER_FOUND && part->worst_ulp != grade->worst_ulp;
		bool better = worse ? part->worst_ulp > grade->worst_ulp : !mine->there || other->question < mine->question;
		if (other->there && better) grade->example[class] = *other;
		grade->count[class] += part->count[class];
	}
	bool sooner = !grade->breach.there || part->breach.question < grade->breach.question;
	if (part->breach.there && sooner) grade->breach = part->breach;
	grade->broken += part->broken;
	grade->worst_ulp = fmax(grade->worst_ulp, part->worst_ulp);
	grade->pairs += part->pairs;
	grade->misordered += part->misordered;
	return true;
}

uint64_t finder_grade_cases(const struct finder_grade *grade)
{
	uint64_t cases = 0;
	for (int class = 0; class < FINDER_UNDEFINED; class ++) cases += grade->count[class];
	return cases;
}
