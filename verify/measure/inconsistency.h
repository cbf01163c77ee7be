/* Logical inconsistency (design, section 5.4; 2016 paper, section 5): how often the state of a pair, read from where
 *its particles are, differs from the state that is tracked. The reading is exact: of the working positions, with a pair
 * exactly at a step outside of it. The paper's one figure does not say what was counted; here is all it may have been.
 *
 *	struct inconsistency inconsistency;
 *	if (!inconsistency_begin(&inconsistency, bits, particles)) ...
 *	touchstone_observe_tests(engine, &inconsistency.listener);
 *	touchstone_run(engine, &limits, &(struct touchstone_observer){inconsistency_see, &inconsistency});
 *	touchstone_observe_tests(engine, NULL);
 *	inconsistency_end(&inconsistency); */
#ifndef VERIFY_INCONSISTENCY_H
#define VERIFY_INCONSISTENCY_H

#include "touchstone.h"

/* How far beyond its outermost step a pair is of interest: no rounding that a run survives reaches so far. */
static const double inconsistency_reach = 1.02;

enum inconsistency_kind {
	INCONSISTENT_EXECUTED, /* the pair whose event it is, when it is executed */
	INCONSISTENT_FOUND,    /* that pair, as it stood when the event was found: what Alder and Wainwright store */
	INCONSISTENT_AFTER,    /* that pair, when it is next tested: right after its event */
	INCONSISTENT_LATER,    /* that pair, when it is first tested for an event of another */
	INCONSISTENT_OTHERS,   /* all other pairs of the two, at the event and in the tests right after it: the positions
							  are the same, since an impulse moves nobody */
};
enum { INCONSISTENCIES = 5 };

/* What a particle's last event was. */
struct inconsistency_last {
	uint64_t event;   /* its number; 0: none yet */
	uint32_t partner; /* UINT32_MAX: a wall */
	uint32_t misread; /* with whom it was inconsistent in the tests after it; UINT32_MAX: with nobody */
};

struct inconsistency {
	int bits;                            /* of the working arithmetic */
	struct touchstone_listener listener; /* hears of all tests whose state may not be that which the positions say */
	uint64_t events;                     /* seen */
	uint64_t count[INCONSISTENCIES];     /* how often */
	struct inconsistency_last *last;     /* per particle */
	struct inconsistency_last before[2]; /* of the particles of the event at hand, what came before it */
	uint32_t met[2];                     /* those particles */
};

/* An empty measurement for an arithmetic of so many significand bits; false when there is no memory. */
bool inconsistency_begin(struct inconsistency *inconsistency, int bits, size_t particles);
void inconsistency_end(struct inconsistency *inconsistency);

/* For touchstone_run, and for a listener that hears of no less; with the measurement, which stays where it began, as
 * the context. */
void inconsistency_see(void *inconsistency, struct touchstone_engine *engine, const struct touchstone_event *event);
void inconsistency_test(void *inconsistency, struct touchstone_engine *engine, const struct touchstone_test *test);

/* Adds the counts of another measurement. */
void inconsistency_merge(struct inconsistency *into, const struct inconsistency *from);

/* A word for the kind, and what is counted in a few more. */
const char *inconsistency_name(enum inconsistency_kind kind);
const char *inconsistency_about(enum inconsistency_kind kind);

#endif
