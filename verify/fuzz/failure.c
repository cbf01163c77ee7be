#include "fuzz/failure.h"

#include <math.h>
#include <string.h>

#include "measure/exact_steps.h"
#include "measure/finder_grade.h"

enum { DOUBLE_BITS = 53, BRANCH_BITS = 8 };

const char *fuzz_failure_name(enum fuzz_failure failure)
{
	static const char *const names[FUZZ_FAILURES] = {
		[FUZZ_NONE] = "none",
		[FUZZ_MISSED] = "missed",
		[FUZZ_PHANTOM] = "phantom",
		[FUZZ_NEGATIVE] = "negative",
		[FUZZ_NAN] = "nan",
		[FUZZ_IMPRECISE] = "imprecise",
		[FUZZ_MISORDERED] = "misordered",
		[FUZZ_CRASH] = "crash",
		[FUZZ_HANG] = "hang",
	};
	return names[failure];
}

struct fuzz_subject fuzz_subject(const struct finder *finder, enum touchstone_shape shape, double bound)
{
	struct fuzz_subject subject = {.finder = finder, .shape = shape};
	subject.claims = finder_claims(finder, shape, &subject.claim);
	if (isnan(bound)) bound = subject.claims ? subject.claim.claim.most_ulp : INFINITY;
	int coarser = DOUBLE_BITS - subject.claim.bits;
	subject.bound = coarser > 0 ? ldexp(bound, coarser) : bound;
	return subject;
}

/* ---- where it went wrong */

_Static_assert((int)EXACT_STEPS == ORACLE_SIGNS, "a sign for each step");

/* Two bits for each coefficient: 0 is zero, 1 positive, 2 negative. */
static unsigned branch_of(struct oracle *oracle, const struct oracle_query *query)
{
	int sign[ORACLE_SIGNS];
	unsigned branch = 0;
	oracle_signs(oracle, query, sign);
	for (int step = 0; step < EXACT_STEPS; step++)
		if (exact_step_formula((enum touchstone_shape)query->shape, step))
			branch |= (sign[step] > 0 ? 1u : sign[step] < 0 ? 2u : 0u) << 2 * step;
	return branch;
}

void fuzz_branch_words(enum touchstone_shape shape, unsigned branch, char words[80])
{
	static const char *const names[EXACT_STEPS] = {"a", "b", "c", "D"}, signs[] = "=><";
	size_t length = 0;
	*words = '\0';
	for (int step = 0; step < EXACT_STEPS; step++)
		if (exact_step_formula(shape, step))
			length += (size_t)snprintf(words + length, 80 - length, "%s%s %c 0", length ? ", " : "", names[step],
									   signs[branch >> 2 * step & 3]);
}

bool fuzz_same(const struct fuzz_case *one, const struct fuzz_case *other)
{
	return one->failure == other->failure && one->branch == other->branch && one->promised == other->promised;
}

/* ---- what went wrong */

static enum fuzz_failure failure_of(const struct fuzz_subject *subject, enum finder_class class, double ulp)
{
	switch (class) {
	case FINDER_MISSED:
		return FUZZ_MISSED;
	case FINDER_PHANTOM:
		return FUZZ_PHANTOM;
	case FINDER_NEGATIVE:
		return FUZZ_NEGATIVE;
	case FINDER_NAN:
		return FUZZ_NAN;
	case FINDER_FOUND:
		return ulp > subject->bound ? FUZZ_IMPRECISE : FUZZ_NONE;
	case FINDER_RIGHTLY_NEVER:
	case FINDER_UNDEFINED:
		break;
	}
	return FUZZ_NONE;
}

bool fuzz_judge(const struct fuzz_subject *subject, struct oracle *oracle, const double number[TOUCHSTONE_MOST_NUMBERS],
				double answer, const struct plugin_fault *fault, struct fuzz_case *failed)
{
	struct oracle_query query = finder_question(subject->shape, number);
	if (!oracle_accepts(&query)) return false;
	struct oracle_time time = oracle_solve(oracle, &query);
	double ulp = 0;
	enum finder_class class = FINDER_FOUND;
	bool surely_right = subject->bound == INFINITY && answer > 0 && answer < INFINITY && time.event != ORACLE_NEVER;
	if (!fault && !surely_right) class = finder_classify(oracle, &time, answer, &ulp);
	enum fuzz_failure failure = failure_of(subject, class, ulp);
	if (fault) failure = fault->endless ? FUZZ_HANG : FUZZ_CRASH;
	if (failure == FUZZ_NONE) return false;
	double exact = oracle_round(oracle, &time, MPFR_RNDN);
	*failed = (struct fuzz_case){
		.questions = 1,
		.answer = {answer},
		.exact = {exact},
		.failure = failure,
		.branch = branch_of(oracle, &query),
		.ulp = ulp,
	};
	if (fault) failed->fault = *fault;
	failed->promised =
		fault || !subject->claims || finder_claim_broken(&subject->claim, subject->shape, number, class, exact, ulp);
	memcpy(failed->number[0], number, sizeof failed->number[0]);
	return true;
}

bool fuzz_judge_order(const struct fuzz_subject *subject, struct oracle *oracle,
					  const double (*numbers)[TOUCHSTONE_MOST_NUMBERS], const double *answers, struct fuzz_case *failed)
{
	if (answers[0] == answers[1] || isunordered(answers[0], answers[1])) return false;
	struct oracle_time time[2];
	double exact[2];
	for (int q = 0; q < 2; q++) {
		struct oracle_query query = finder_question(subject->shape, numbers[q]);
		if (!oracle_accepts(&query)) return false;
		time[q] = oracle_solve(oracle, &query);
	}
	int order = oracle_compare(oracle, &time[0], &time[1]);
	if (order == 0 || (order < 0) == (answers[0] < answers[1])) return false;
	for (int q = 0; q < 2; q++) exact[q] = oracle_round(oracle, &time[q], MPFR_RNDN);
	if (exact[0] == exact[1]) return false;
	*failed = (struct fuzz_case){
		.questions = 2,
		.answer = {answers[0], answers[1]},
		.exact = {exact[0], exact[1]},
		.failure = FUZZ_MISORDERED,
		/* times that are correctly rounded keep their order, others promise none */
		.promised = subject->claims && subject->claim.claim.most_ulp <= 0.5,
	};
	memcpy(failed->number, numbers, sizeof failed->number);
	for (int q = 0; q < 2; q++) failed->branch |= branch_of(oracle, &time[q].query) << BRANCH_BITS * q;
	return true;
}

/* ---- once more */

struct happening {
	bool there;
	struct plugin_fault fault;
};

static void note_fault(void *context, const struct plugin_fault *fault)
{
	struct happening *happening = context;
	*happening = (struct happening){true, *fault};
}

bool fuzz_try(const struct fuzz_subject *subject, struct oracle *oracle, struct fuzz_case *tried)
{
	const struct finder *finder = subject->finder;
	const double(*numbers)[TOUCHSTONE_MOST_NUMBERS] = (void *)tried->number;
	struct fuzz_case failed = {0};
	double answer[2];
	char why[160];
	for (int q = 0; q < tried->questions; q++) {
		struct happening happening = {0};
		if (finder->plugin)
			plugin_find(finder->plugin, subject->shape, &numbers[q], 1, &answer[q], note_fault, &happening);
		else if (!touchstone_find(finder->arithmetic, finder->method, subject->shape, &numbers[q], 1, false, &answer[q],
								  why))
			return false;
		bool wrong =
			fuzz_judge(subject, oracle, numbers[q], answer[q], happening.there ? &happening.fault : NULL, &failed);
		if (wrong && tried->questions == 2) return false; /* a failure of another kind */
	}
	if (tried->questions == 2) fuzz_judge_order(subject, oracle, numbers, answer, &failed);
	if (failed.failure == FUZZ_NONE) return false;
	*tried = failed;
	return true;
}
