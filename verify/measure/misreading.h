/* A watcher of states: does a method ever take a pair for what its events did not make it? It keeps a ledger of its
 * own, written at the start and by events only, and holds against it the state by which every pair is tested and every
 * event is executed (2016 paper, sections 2 and 5). What it finds is named by these criteria:
 *
 *     repeated    the two have just had an event with each other, and in the search after it they are read as what they
 *                 were before: they will have it once more
 *     missed      a third particle has met one of the two, and they are read as what they never became: they were
 *                 moved over a step, or beyond it, without an event
 *     stuck       the same event of the same pair for the MISREADING_STUCK-th time in a row, at no later time
 *     energy      what pairs gained in potential energy by being read otherwise, which no particle paid in speed
 *
 * After each misreading the ledger follows the method, so that each is counted once. */
#ifndef VERIFY_MISREADING_H
#define VERIFY_MISREADING_H

#include "touchstone.h"

enum { MISREADING_STUCK = 16 };

/* The first of its sort. */
struct misread_pair {
	uint64_t event; /* the event, counted from 1 where watching began, after which it was read; 0: there was none */
	double time;
	enum touchstone_kind kind;     /* of that event */
	uint32_t first, second, third; /* the pair; whom one of them met (missed only; else UINT32_MAX) */
	int was, read;                 /* states: as its events left it, and as it was read */
};

struct misreading {
	const struct touchstone_scene *scene; /* of its potentials; belongs to the caller */
	uint64_t events, repeats, misses;     /* so far */
	double energy;                        /* potential energy out of nothing, so far */
	struct misread_pair repeated, missed, stuck;
	struct touchstone_event last; /* how the run of like events at hand began */
	uint64_t alike;               /* events in that run */
	void *ledger;                 /* of pairs in states other than 0: a tree of search.h */
	bool exhausted;               /* memory ran out: nothing later is known */
};

/* Begins to watch an engine made from the scene, as it now stands. */
void misreading_begin(struct misreading *misreading, const struct touchstone_scene *scene,
					  struct touchstone_engine *engine);
void misreading_end(struct misreading *misreading);

/* For touchstone_run, and for a listener to all tests within inconsistency_reach; with the watcher as the context. */
void misreading_see(void *misreading, struct touchstone_engine *engine, const struct touchstone_event *event);
void misreading_test(void *misreading, struct touchstone_engine *engine, const struct touchstone_test *test);

/* One of its firsts in words, "none" where there was none; and a word for a kind of event. */
const char *misreading_tell(const struct misread_pair *pair, char text[200]);
const char *misreading_event(enum touchstone_kind kind);

#endif
