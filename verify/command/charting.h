/* Speed against accuracy, measured here and now: finders of event times, and engines. */
#ifndef VERIFY_CHARTING_H
#define VERIFY_CHARTING_H

#include <stdio.h>

#include "command/grading.h"
#include "measure/finder_bits.h"
#include "measure/horizon.h"
#include "measure/interval.h"

enum { CHART_ORIGINS = 2 /* enum family_origin */, CHART_SPHERES = 500 };

/* What is to be charted. All belongs to the caller. */
struct chart_plan {
	const struct finder *finders; /* those of one method side by side */
	size_t finder_count;
	const struct finder *engines; /* methods that engines run by, in arithmetics of at most CHART_MOST_BITS */
	size_t engine_count;
	uint64_t cases; /* questions of each family */
	int starts;     /* start states that horizons are taken from */
	double seconds; /* for all of it, about: fewer questions and start states where these do not fit; 0: no limit */
	uint64_t seed;
	int threads; /* for what is not timed; the numbers do not depend on it */
	const volatile int *stop;
	/* Told the grades of each method's finders; may be NULL. */
	void (*graded)(void *context, const struct grading_plan *plan, const struct grading *grading);
	void *context;
};

/* A finder of contacts between balls, on the questions of one origin. */
struct chart_side {
	uint64_t cases, missed, phantom, negative, nan;
	struct interval faults;          /* of missed and phantom together, per question */
	double bits, median, least;      /* of 99.9 % of the answers, of half of them, of all (finder_bits.h) */
	double throughput, latency;      /* nanoseconds per call: one after the other, and each waiting for the last */
	double times_stable;             /* throughput over that of `stable` in binary64 */
	bool best_bits[2], best_rate[2]; /* on the frontier of bits, of faults: by throughput, by latency */
};

/* An engine over CHART_SPHERES elastic hard spheres at density 0.5. */
struct chart_engine {
	char reference[16]; /* the finer arithmetic it is held against */
	int bits;
	double nanoseconds, times_stable; /* per event */
	struct horizon_spread horizon;
	bool best;
	struct horizon *horizons; /* of each start state */
};

struct chart {
	struct chart_side (*finders)[CHART_ORIGINS];
	struct chart_engine *engines;
	uint64_t cases; /* as many as fitted */
	int starts;
	double seconds;
	bool interrupted;
};

enum { CHART_MOST_BITS = 512 }; /* whose reference carries twice as many */

/* Measures everything. False with one line in `error`; end with chart_free either way. */
bool chart_run(const struct chart_plan *plan, struct chart *chart, char error[GRADING_ERROR]);
void chart_free(const struct chart_plan *plan, struct chart *chart);

/* Its two halves, for chart_run: `began` is when it all began by progress_clock. */
bool chart_finders(const struct chart_plan *plan, struct chart *chart, char error[GRADING_ERROR]);
bool chart_engines(const struct chart_plan *plan, struct chart *chart, double began, char error[GRADING_ERROR]);

/* ---- telling: lines of comma-separated values (design, section 7), a table for people, a result for the report */
void chart_csv(FILE *stream, const struct chart_plan *plan, const struct chart *chart);
void chart_print(FILE *stream, const struct chart_plan *plan, const struct chart *chart);
void chart_figures(struct result *result, const struct chart_plan *plan, const struct chart *chart); /* its figures */
struct result *chart_result(const struct chart_plan *plan, const struct chart *chart); /* NULL: no memory */

#endif
