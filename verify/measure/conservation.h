/* Conservation (design, section 5.5): energy and momentum of a configuration, summed in double-double, so that the sum
 * over 10^6 particles errs by less than the last bit of what it is printed with.
 *
 * What is summed is the state as touchstone_state gives it, rounded to double: a drift of less than 2^-53 relative is
 * not seen, in whatever arithmetic the engine works. */
#ifndef VERIFY_CONSERVATION_H
#define VERIFY_CONSERVATION_H

#include "touchstone.h"

struct conservation {
	double energy[2];      /* unevaluated sum, larger part first: of m v^2/2 - m g.x, and of the pairs' steps by their
							  tracked states. Along periodic axes gravity has no potential, and none is counted */
	double momentum[3][2]; /* the same, of m v on each axis */
	double energy_scale;   /* sum of m v^2/2 + |m g.x|, and the size of the steps' sum: what a change of energy is to be
							  held against */
	double momentum_scale; /* sum of m |v|: the same for momentum */
};

/* Of the engine's particles at the time of its last event; `scene` is what the engine was made from. */
struct conservation conservation_of(const struct touchstone_scene *scene, const struct touchstone_engine *engine);

/* (end - begin) of the energy over its scale at the beginning; NaN where there was none. */
double conservation_energy_drift(const struct conservation *begin, const struct conservation *end);

/* The same for |end - begin| of the momentum. Walls and gravity change it, as they should. */
double conservation_momentum_drift(const struct conservation *begin, const struct conservation *end);

#endif
