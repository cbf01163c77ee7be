/* A vessel of hard spheres that can stand anywhere in a box and begin at any time (design, section 4): the same gas,
 * bit for bit, where only the numbers that say where and when are large.
 *
 * It is a cube with a wall on each side. Its start state lies on a grid that doubles hold exactly wherever the vessel
 * is put, and it is put a whole number of places away, so that in the relative form it is the same run everywhere, and,
 * the length of a page being a power of two, the same at every time that is a multiple of it. */
#ifndef VERIFY_VESSEL_H
#define VERIFY_VESSEL_H

#include "measure/course.h"

enum { VESSEL_SPHERES = 256, VESSEL_WIDTH = 8 /* diameters: density 0.5 */ };

struct vessel {
	struct touchstone_scene scene;
	double middle; /* where it stands now, on each axis */
};

/* Fills a vessel in the middle of its box with a gas at kT = 1, equilibrated. False when stopped, and then `error` is
 * empty, or with one line in `error`; otherwise end it with vessel_empty. */
bool vessel_fill(struct vessel *vessel, uint64_t seed, const struct watch *watch, char error[160]);
void vessel_empty(struct vessel *vessel);

/* Puts it as far from the middle of a box of that width as it can stand, in whole steps, on every axis; and where that
 * is: 0, 32 and 496 diameters from the middle in boxes of 10, 100 and 1000. It begins at `clock`. */
double vessel_middle(double box);
void vessel_put(struct vessel *vessel, enum touchstone_form form, double box, double clock);

#endif
