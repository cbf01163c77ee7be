/* Random start positions without overlap. */
#ifndef TOUCHSTONE_INSERTION_H
#define TOUCHSTONE_INSERTION_H

#include "scene/random.h"
#include "touchstone.h"

/* Random sequential addition: particle after particle, the largest sizes first, is put where a uniform draw finds
 * room, half a diameter from every wall. Fills `particles` (the scene's own), whose species are set.
 *
 * Returns how many found room: fewer than all when the tries ran out. Without end, equal particles would fill a share
 * of 0.3841 of space in 3 dimensions, 0.5470 in 2 and 0.7476 in 1 (density 0.7336, 0.6965, 0.7476; Renyi 1958; Zhang
 * and Torquato 2013); see insertion_end for where the tries allowed here end. SIZE_MAX when there is no memory. */
size_t insertion_place(const struct touchstone_scene *scene, struct touchstone_particle *particles,
					   struct random_state *random);

/* The density of equal particles, far from walls, up to which the tries suffice: measured over N = 10^3 to 10^5. */
double insertion_end(int dimensions);

#endif
