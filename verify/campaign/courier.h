/* Pieces of a campaign go to other ranks, and their results come back: rank 0 keeps the store and hands out, each of
 * the others makes one piece at a time. Messages are JSON: {"piece": 3, "key": "..."} there; {"piece": 3, "result":
 * {...}}, or "error", or neither of the two when stopped, back; {} asks for the first piece, and sends home. */
#ifndef VERIFY_CAMPAIGN_COURIER_H
#define VERIFY_CAMPAIGN_COURIER_H

#include "campaign/ranks.h"
#include "campaign/work.h"

/* On rank 0: serves the others until all are sent home, or an end is asked for; then `say` (NULL: standard error) is
 * told which piece each of them was at. */
void courier_serve(struct campaign_work *work, const struct ranks *ranks, int size,
				   void (*say)(void *context, const char *line), void *context);

/* On another rank: makes what it is given until it is sent home or an end is asked for. */
void courier_make(const struct campaign *campaign, const struct ranks *ranks, const volatile int *stop);

#endif
