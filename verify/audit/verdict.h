/* Whether a measure got worse: tonight held against the nights before, by a test that fits its nature.
 *
 *	word                  exact equality with the last good night of the same seed
 *	proportion, rate      test_proportions, test_rates, on counts added up
 *	sample                test_ranks, on the values of different seeds
 *	timing                test_ranks, on the medians of nights: what slows a machine for one night slows all that is
 *	                      timed in it, so repetitions within a night say nothing of the next
 *
 * Tonight is tested alone, and again together with the 1, 3 and 7 good nights before it, so that a small change shows
 * once it has lasted; the smallest chance counts, times the number of tests. What it is held against are the
 * VERDICT_REFERENCE good nights before those. A seed counts once on either side: to measure the same again is to learn
 * nothing. All measures of an audit are then judged together (Holm 1979), so that with nothing changed, no more than a
 * given share of all audits raises an alarm, however many measures there are and however they depend on each other.
 *
 * What is assumed: hits are independent of each other, and nights, while nothing changes, could have come in any order.
 * The first was looked at where it is least obvious, in contacts below the contact distance: over 200 seeds their
 *number scatters 0.91 to 0.94 times as much as the binomial law has it (chi squared per degree of freedom, standard
 *error 0.1; `run hard-spheres --set particles=500 --set equilibrate=10 --events 2e4 --runs 200 --measure impact --json
 *-` at densities 0.1, 0.5, 0.9, and inelastic-spheres), so the tests err on the side of silence.
 */
#ifndef VERIFY_AUDIT_VERDICT_H
#define VERIFY_AUDIT_VERDICT_H

#include "audit/measurement.h"

enum { VERDICT_REFERENCE = 50 };

/* What one audit said of one measure. */
struct night {
	int64_t audit;
	uint64_t seed;
	bool good; /* may be held against: of a whole audit, and not found worse */
	struct measurement measured;
};

struct verdict {
	bool compared; /* there was something to compare with */
	bool worse;    /* set by verdicts_judge */
	double chance; /* that it comes out that far apart though nothing changed */
	size_t nights; /* of them, those tested together, tonight included; and how many good ones they were held against */
	size_t references;
	struct measurement before, now; /* of the references and of those nights together */
	int64_t since;                  /* the audit from which on it is different; that of tonight when nothing is */
};

/* Compares the last of `count` nights, in order of time, with those before it. */
struct verdict verdict_of(const struct night *nights, size_t count, enum measure_worse worse);

/* Decides which of the verdicts of one audit are worse, with that chance (0 to 0.1) that any is while nothing has
 * changed. */
void verdicts_judge(struct verdict *const *verdicts, size_t count, double false_alarms);

/* "1.31 times what it was", "0.02 more", "not what it was". Returns `text`. */
enum { VERDICT_TEXT = 80 };
const char *verdict_change(const struct verdict *verdict, char text[VERDICT_TEXT]);

#endif
