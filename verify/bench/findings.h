/* What a benchmark finds out, and how that becomes rows of numbers that can be stored and compared. */
#ifndef VERIFY_BENCH_FINDINGS_H
#define VERIFY_BENCH_FINDINGS_H

#include "bench/cores.h"
#include "bench/points.h"
#include "measure/spread.h"

struct engine_cost {
	struct sample start_up, event; /* seconds, nanoseconds: one for each repetition */
	double bytes, instructions;    /* per particle; per event, NaN when not counted */
	uint64_t digest;               /* of the events timed; 0 before there is one */
};

/* Where it is measured how two runs side by side fare: among as many particles. */
enum { SPEED_UPS = 2 };
extern const size_t speed_up_particles[SPEED_UPS];

struct findings {
	struct effort effort;
	struct cores cores;
	struct engine_cost engine[POINTS];
	struct sample drop; /* seconds for a million plates */
	struct sample speed_up[SPEED_UPS];
	char uncounted[200]; /* why instructions are not counted; "" when they are */
	bool stopped;        /* by Ctrl-C, before all was measured */
	unsigned faults;     /* runs that failed, or whose events were not those of another time */
};

/* As before anything is measured. */
void findings_begin(struct findings *findings, const struct effort *effort);

/* Whether filtered and unfiltered runs in mpfr:113 had the same events; true while one of them is missing. */
bool findings_agree(const struct findings *findings);

/* ---- rows */

enum quantity { NANOSECONDS, INSTRUCTIONS, BYTES, START_UP, SECONDS, TIMES, QUANTITIES };

/* As it is stored: "nanoseconds_per_event". */
const char *quantity_name(enum quantity quantity);

enum { ROWS = POINTS + 1 + SPEED_UPS, ROW_NAME = POINT_NAME + 20 };

struct row {
	char name[ROW_NAME];
	struct spread value[QUANTITIES]; /* NaN for what it does not have */
};
void findings_rows(const struct findings *findings, struct row rows[ROWS]);

/* ---- demands */

/* What the project asks of itself, beside what was found. */
struct demand {
	const char *what;
	bool at_most; /* or at least */
	double limit;
	struct spread found; /* NaN when not measured */
};
enum { DEMANDS = 12 };
void findings_demands(const struct findings *findings, struct demand demands[DEMANDS]);

/* Whether the median keeps to the limit. */
bool demand_met(const struct demand *demand);

#endif
