/* What goes wrong in a gas of hard spheres, counted: overlaps at impact and three-body events (measure/three_body.h),
 * repeated events and entangled pairs. */
#ifndef VERIFY_MISHAPS_H
#define VERIFY_MISHAPS_H

#include "measure/three_body.h"

struct mishaps {
	struct three_body three_body;
	uint64_t repeated;  /* contacts of a pair of which neither has had another event since their last one */
	uint64_t entangled; /* pairs found overlapping deeply at two looks in a row, once a look */
	double deep;        /* what a deep overlap is: MISHAP_DEEP units in the last place of a contact distance of 1 */
	uint32_t *partner;  /* per particle: 1 + whom it met last; 0: nobody, or a wall */
	uint32_t *deeply;   /* per particle: 1 + whom it overlapped most deeply at the last look; 0: nobody */
};

enum { MISHAP_DEEP = 16 };

/* Starts an empty measurement for so many particles in an arithmetic of so many bits; end it with mishaps_end. False,
 * with nothing to end, when there is no memory. */
bool mishaps_begin(struct mishaps *mishaps, size_t particles, int bits);
void mishaps_end(struct mishaps *mishaps);

/* Observes an event; pass to touchstone_run with a struct mishaps as the context. */
void mishaps_see(void *mishaps, struct touchstone_engine *engine, const struct touchstone_event *event);

/* Looks at every particle for deep overlaps. Looks should be some ten collisions per particle apart: what overlaps by
 * chance has long parted by then. */
void mishaps_look(struct mishaps *mishaps, const struct touchstone_engine *engine);

#endif
