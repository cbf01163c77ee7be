/* How well a finder answers, held against the exact answers (design, section 5.7), class by class. */
#ifndef VERIFY_FINDER_GRADE_H
#define VERIFY_FINDER_GRADE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "measure/finder_claim.h"
#include "oracle/oracle.h"
#include "touchstone.h"

/* A question to remember a class by. */
struct finder_example {
	bool there;
	uint64_t question; /* its number */
	double number[TOUCHSTONE_MOST_NUMBERS], answer;
};

/* Numbers that are only sorted in the end. */
struct finder_values {
	double *value;
	size_t count, room;
};

struct finder_grade {
	enum touchstone_shape shape;
	uint64_t count[FINDER_CLASSES];
	struct finder_example example[FINDER_CLASSES]; /* the first of its class; of those found the worst, if not exact */
	double worst_ulp;                              /* of that one */
	uint64_t pairs, misordered;                    /* pairs of questions; those whose answers are in the wrong order */
	struct finder_values ulp, gap;                 /* of each event found; of each contact, without its sign */
	const struct finder_claim *claim;              /* to be held to; NULL: none. The caller's */
	uint64_t broken;                               /* answers that break it */
	struct finder_example breach;                  /* the first of them */
};

/* An empty grade, to be freed by finder_grade_free. */
struct finder_grade finder_grade_new(enum touchstone_shape shape);
void finder_grade_free(struct finder_grade *grade);

/* Adds the answers to questions number first .. first + count - 1. In `paired` questions 2k and 2k + 1 belong together,
 * and their order in time, a tie included, is held against the answers' order. False when out of memory. */
bool finder_grade_add(struct finder_grade *grade, struct oracle *oracle, uint64_t first,
					  const double (*numbers)[TOUCHSTONE_MOST_NUMBERS], const double *answers, size_t count,
					  bool paired);

/* Adds what another grade holds. The order in which parts are added does not matter. False when out of memory. */
bool finder_grade_merge(struct finder_grade *grade, const struct finder_grade *part);

/* Lets go of the values, once their quantiles are known; the counts stay. */
void finder_grade_forget(struct finder_grade *grade);

/* All questions but the undefined. */
uint64_t finder_grade_cases(const struct finder_grade *grade);

/* The smallest of the values that at least this share of them does not exceed (exact, by nearest rank): 0.5 for the
 * median, 1 for the maximum. NaN when there are none. Moves the values about. */
double finder_quantile(struct finder_values *values, double share);

/* What has become of a question, and, if its event was found, how far off the answer is in ulp. */
enum finder_class finder_classify(struct oracle *oracle, const struct oracle_time *time, double got, double *ulp);

/* A question as the oracle takes it. */
struct oracle_query finder_question(enum touchstone_shape shape, const double number[TOUCHSTONE_MOST_NUMBERS]);

#endif
