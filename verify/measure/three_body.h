/* Three-body events (design, section 5.2; 2014 paper, fig. 5): contacts after which one of the two particles overlaps
 * its partner and a third particle, where the model knows of two-body contacts only. Overlaps are those of the working
 * positions, decided exactly. */
#ifndef VERIFY_THREE_BODY_H
#define VERIFY_THREE_BODY_H

#include "measure/interval.h"
#include "touchstone.h"

struct three_body {
	uint64_t contacts;    /* executed */
	uint64_t overlapping; /* of them: the two then overlap, */
	double depth;         /* by so much in all, */
	double deepest;       /* and by so much at most */
	uint64_t events;      /* of those: one of the two then overlaps a third particle as well */
	uint64_t encounters;  /* of those: the first of its three since one of them met a fourth. What stabilises them
							 follows at once, so that events come in bursts and only encounters are independent */
	uint64_t *trio;       /* per particle: number of the encounter it was in last, until it meets another particle */
	uint32_t particles;
};

/* Starts an empty measurement for so many particles; end it with three_body_end. False when there is no memory. */
bool three_body_begin(struct three_body *three_body, size_t particles);
void three_body_end(struct three_body *three_body);

/* Observes an event; pass to touchstone_run with a struct three_body as the context. */
void three_body_see(void *three_body, struct touchstone_engine *engine, const struct touchstone_event *event);

/* Per contact, with an exact Poisson interval: of events as they are counted, and of encounters. */
double three_body_rate(const struct three_body *three_body, struct interval *interval);
double three_body_encounter_rate(const struct three_body *three_body, struct interval *interval);

/* Adds what another measurement has counted. */
void three_body_merge(struct three_body *into, const struct three_body *from);

#endif
