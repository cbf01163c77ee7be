/* Two sequences of events, by kind and particles, compared as they come: one may be ahead of the other. */
#ifndef VERIFY_SEQUENCE_H
#define VERIFY_SEQUENCE_H

#include "touchstone.h"

struct sequence {
	uint64_t common;           /* events that both have had, one for one the same */
	bool differ;               /* and then came two that are not the same: nothing more is compared */
	bool ended[2];             /* there come no more */
	uint64_t *ahead;           /* those of one that the other has not had yet */
	size_t first, count, room; /* in a ring */
	int side;                  /* whose they are */
};

/* Enters the next event of one side, 0 or 1. Out of memory, the comparison ends where it is. */
void sequence_enter(struct sequence *sequence, int side, const struct touchstone_event *event);

/* One side has come to its end: the two differ when the other goes on. */
void sequence_end(struct sequence *sequence, int side);

/* Forgets everything, and owns nothing. */
void sequence_clear(struct sequence *sequence);

#endif
