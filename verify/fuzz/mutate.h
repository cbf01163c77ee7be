/* New questions from old ones: bits flipped, exponents moved, numbers copied and exchanged, neighbours by units in the
 * last place, contacts and grazes made exact and then missed by a little. */
#ifndef VERIFY_FUZZ_MUTATE_H
#define VERIFY_FUZZ_MUTATE_H

#include "scene/random.h"
#include "touchstone.h"

/* Changes a question once or a few times. What is finite stays finite. */
void fuzz_mutate(enum touchstone_shape shape, struct random_state *random, double number[TOUCHSTONE_MOST_NUMBERS]);

/* Moves one number by a few units in the last place: to where the event comes a little sooner or later. */
void fuzz_nudge(enum touchstone_shape shape, struct random_state *random, double number[TOUCHSTONE_MOST_NUMBERS]);

/* Rounds toward zero what an arithmetic of so many bits does not hold; of 24 bits, as binary32 has them, within its
 * range. */
void fuzz_fit(enum touchstone_shape shape, int bits, double number[TOUCHSTONE_MOST_NUMBERS]);

#endif
