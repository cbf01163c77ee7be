/* A gas of equal hard spheres kept as it is for as long as one likes, though its particles lose energy at every
 * collision.
 *
 * Whenever its speeds have halved, the unit of time is doubled (touchstone_rescale): exact, and no event of hard
 * spheres depends on it. Left to itself a gas of restitution 0.5 would leave the range of binary64 after some 6000
 * collisions per particle. Rounding gives the gas as a whole a small velocity that does not cool with it; before that
 * matters it is taken away, and the gas goes on from there in a new engine. A gas that ends (collapses, halts,
 * diverges) is followed by another from the next start state, and what was counted while it was ending is not counted.
 */
#ifndef VERIFY_KEPT_GAS_H
#define VERIFY_KEPT_GAS_H

#include "measure/conservation.h"
#include "measure/course.h"
#include "measure/mishaps.h"

struct kept_setup {
	size_t particles; /* 4 k^3 fill the lattice they start from */
	double density, restitution;
	const char *arithmetic, *method;
	enum touchstone_form form;
	double clock;       /* at which a gas of the absolute form begins */
	double equilibrate; /* elastic collisions per particle before anything else, */
	double settle;      /* and then inelastic ones that are not counted */
	uint64_t events;    /* to be counted */
	int starts;         /* start states to be tried at most */
	int halvings;       /* of speeds, before the unit of time changes; 1 unless this is what is tried */
	uint64_t seed;
};

/* What came of it. */
struct kept_gas {
	struct mishaps mishaps;
	uint64_t collapsed, halted, diverged; /* gases that ended so */
	uint64_t starts, recentred;           /* start states; velocities of the whole taken away */
	uint64_t dropped;                     /* events of gases that were ending */
	int64_t cooled;                       /* powers of two by which speeds fell */
	double drift;                         /* relative change of the energy, summed up; only for elastic gases */
};

/* True when all events are counted, or as many as the start states gave. False when stopped on the way, and then
 * `error` is empty, or with one line in `error`. */
bool kept_gas_run(const struct kept_setup *setup, const struct watch *watch, struct kept_gas *gas, char error[320]);
void kept_gas_free(struct kept_gas *gas);

#endif
