/* What the live page marks of a run: events as they are executed, and overlaps as they are found whenever the page
 * looks.
 *
 * An overlap counts as a failure when it is deeper than rounding explains: more than 32 units in the last place of 1 in
 * the working arithmetic (stable stays below that, as verify/live/test measures), or in the absolute form of the
 * largest coordinate; and as visible from a tenth of the contact distance on. */
#ifndef VERIFY_WITNESS_H
#define VERIFY_WITNESS_H

#include "measure/three_body.h"
#include "scene/spatial_hash.h"
#include "touchstone.h"

enum { WITNESS_LOG = 12 };

struct witness {
	double rounding;                   /* depth that it may explain */
	uint64_t repeated;                 /* contacts of two that had met each other last, both of them */
	uint64_t parting;                  /* contacts of two that were parting already */
	uint64_t backwards;                /* events before the one before them */
	uint64_t dropped;                  /* pairs found inside each other, none of whose contacts kept them apart */
	uint64_t overlapping, entangled;   /* pairs at the last look; of them, those of the look before as well */
	double deepest, deepest_ever;      /* depth over contact distance */
	double first_failure, first_sight; /* times; NaN: not yet */
	double last_time;
	struct three_body three_body;
	uint64_t seen;                            /* events */
	struct touchstone_event log[WITNESS_LOG]; /* the last of them, event k at k modulo WITNESS_LOG */
	uint32_t *met;                            /* per particle: whom it met last */
	uint32_t *inside;                         /* per particle: whom it was inside at the last look */
	uint32_t count;
};

/* Begins with a scene's start state, to be run in an arithmetic of so many bits; end it with witness_end. False when
 * there is no memory. */
bool witness_begin(struct witness *witness, const struct touchstone_scene *scene, int bits);
void witness_end(struct witness *witness);

/* Sees an event. */
void witness_see(struct witness *witness, struct touchstone_engine *engine, const struct touchstone_event *event);

/* Looks for overlaps among particles at their places now, which is `time`; depth[p] receives how deep p is inside
 * another one, over their contact distance, or 0 where rounding explains it. False when there is no memory. */
bool witness_look(struct witness *witness, const struct touchstone_scene *now, double time, float *depth);

/* The run has ended otherwise than by a limit: a failure, if nothing was one before. */
void witness_stop(struct witness *witness, double time);

#endif
