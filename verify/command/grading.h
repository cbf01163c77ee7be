/* Grades: finders asked the questions of families and files, and how they did. */
#ifndef VERIFY_GRADING_H
#define VERIFY_GRADING_H

#include <stdio.h>

#include "command/progress.h"
#include "family/family.h"
#include "measure/finder_grade.h"
#include "plugin/finder.h"
#include "store/query_file.h"

enum { GRADING_ERROR = 400 }; /* room for a one-line message */

/* Where questions come from: a family, or the lines of a file. */
struct question_source {
	const char *name;
	enum family_origin origin;
	const struct family *family;   /* NULL: a file */
	const struct query_file *file; /* NULL: a family */
};

/* What is to be graded. All belongs to the caller. */
struct grading_plan {
	const struct finder *finders;
	size_t finder_count;
	const struct question_source *sources;
	size_t source_count;
	unsigned shapes; /* bit 1 << enum touchstone_shape for each shape wanted */
	uint64_t cases;  /* of each family and shape */
	uint64_t seed;
	int threads;
	bool untimed;  /* nobody asks how long they take */
	FILE *answers; /* to write each answer to, or NULL */
	const volatile int *stop;
};

/* How one finder did on the questions of one shape from one source. */
struct grade_row {
	const struct finder *finder;
	const struct question_source *source;
	enum touchstone_shape shape;
	struct finder_grade grade;
	double median_ulp, p999_ulp, max_ulp; /* NaN: no event was found */
	double median_gap, max_gap;           /* likewise */
	double nanoseconds;                   /* per call; NaN: it could not be measured */
	uint64_t faults;                      /* of a plug-in; its answers there count as nan */
	bool given_up;                        /* a plug-in, before all questions were asked */
	struct finder_claim claim;            /* what its file claims, when the grade is held to it */
};

/* Something a plug-in did instead of answering. */
struct grade_fault {
	size_t row;
	struct plugin_fault fault;
	long line; /* in its file, or the question's number from 1 */
	double number[TOUCHSTONE_MOST_NUMBERS];
};

struct grading {
	struct grade_row *rows;
	size_t row_count;
	struct grade_fault *faults;
	size_t fault_count;
	uint64_t answered; /* questions, over all finders */
	double seconds;
	bool interrupted;
};

/* How many questions there are, counted once for each finder that answers their shape. */
double grading_questions(const struct grading_plan *plan);

/* Asks and grades, in the order of sources, shapes and finders; the numbers (but for times) do not depend on how many
 * threads do it. False with one line in `error`; end with grading_free either way. */
bool grading_run(const struct grading_plan *plan, struct grading *grading, char error[GRADING_ERROR]);
void grading_free(struct grading *grading);

/* Whether there is something to be woken for: a claim that is not kept, or a plug-in that crashed, did not come to an
 * end, or gave answers that are no times. */
bool grading_finding(const struct grading *grading);

/* ---- telling: a table for people, lines of comma-separated values (design, section 7), a result for the report */
void grading_print(FILE *stream, const struct grading *grading);
void grading_print_findings(FILE *stream, const struct grading *grading); /* only those; nothing if there are none */
void grading_csv(FILE *stream, const struct grading *grading);
struct result *grading_result(const struct grading_plan *plan, const struct grading *grading, const char *name,
							  const char *title); /* NULL: no memory */

/* Which claim a row's finder does not keep, how often, and on which question first; to be freed. */
char *grade_row_broken(const struct grade_row *row);

#endif
