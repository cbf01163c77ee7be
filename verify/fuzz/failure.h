/* What a fuzzer looks for: questions that a finder answers wrongly, told apart by how and where.
 *
 * A question has been failed when there is an event and none was found, or the reverse, when the time is negative or no
 * number, when it is farther off than it may be, or when there is no answer because the process crashed or came to no
 * end. Two questions have been failed when the exact times have one order, even after rounding, and the answers the
 * other. */
#ifndef VERIFY_FUZZ_FAILURE_H
#define VERIFY_FUZZ_FAILURE_H

#include <stdio.h>

#include "oracle/oracle.h"
#include "plugin/finder.h"

enum fuzz_failure {
	FUZZ_NONE,
	FUZZ_MISSED,
	FUZZ_PHANTOM,
	FUZZ_NEGATIVE,
	FUZZ_NAN,
	FUZZ_IMPRECISE,
	FUZZ_MISORDERED,
	FUZZ_CRASH,
	FUZZ_HANG,
	FUZZ_FAILURES
};
const char *fuzz_failure_name(enum fuzz_failure failure); /* "missed" */

/* Whom, what about, and how far off an answer may be. */
struct fuzz_subject {
	const struct finder *finder;
	enum touchstone_shape shape;
	bool claims; /* whether its file says what it does: */
	struct finder_claim claim;
	double bound; /* of an error, in ulp of binary64; INFINITY: any will do */
};

/* `bound` is in ulp of the finder's arithmetic; NaN: what its file claims, or any. */
struct fuzz_subject fuzz_subject(const struct finder *finder, enum touchstone_shape shape, double bound);

/* One question and its answer, or two whose order matters. */
struct fuzz_case {
	int questions; /* 1 or 2 */
	double number[2][TOUCHSTONE_MOST_NUMBERS];
	double answer[2], exact[2]; /* exact: the nearest double to it */
	enum fuzz_failure failure;
	unsigned branch;           /* exact signs of what decides, question by question: fuzz_branch_words() */
	bool promised;             /* the finder's file says that this does not happen, or says nothing at all */
	double ulp;                /* how far off, of a time that was found */
	struct plugin_fault fault; /* of a crash */
};

/* Judges an answer; `fault` is what happened instead of one, or NULL. Fills the case unless nothing is wrong. */
bool fuzz_judge(const struct fuzz_subject *subject, struct oracle *oracle, const double number[TOUCHSTONE_MOST_NUMBERS],
				double answer, const struct plugin_fault *fault, struct fuzz_case *failed);

/* Judges the order of two answers, neither of which was wrong for itself. */
bool fuzz_judge_order(const struct fuzz_subject *subject, struct oracle *oracle,
					  const double (*numbers)[TOUCHSTONE_MOST_NUMBERS], const double *answers,
					  struct fuzz_case *failed);

/* Asks the case's questions anew and fills in what comes of it; whether it fails. */
bool fuzz_try(const struct fuzz_subject *subject, struct oracle *oracle, struct fuzz_case *tried);

/* Whether two failures are one finding: the same wrong, at the same branch. */
bool fuzz_same(const struct fuzz_case *one, const struct fuzz_case *other);

/* "a > 0, b < 0, c > 0, D > 0", the exact signs of the coefficients that a question of the shape has. */
void fuzz_branch_words(enum touchstone_shape shape, unsigned branch, char words[80]);

#endif
