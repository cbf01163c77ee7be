/* How families are made, for the files that make them. Questions are numbers alone; what is drawn depends on nothing
 * but the seed, and uses + - * /, square roots and powers of two only, so that it is the same on every machine. Draws
 * that make up one number, or the arguments of one call, are statements of their own: their order must not be the
 * compiler's. */
#ifndef VERIFY_FAMILY_MAKE_H
#define VERIFY_FAMILY_MAKE_H

#include "family/family.h"
#include "scene/random.h"

/* Makes the question of one index; `number` holds zeros before, and what the shape has no use for is zeroed after.
 * `random` is the question's own; of a paired
 * family questions 2k and 2k + 1 get the same. */
typedef void family_make(enum touchstone_shape shape, struct random_state *random, uint64_t index,
						 double number[TOUCHSTONE_MOST_NUMBERS]);

/* Harvests a block of so many questions from a run that depends on nothing but the seed. False with one line in
 * `error` when memory ran out or the run cannot be. */
enum { FAMILY_BLOCK = 4096 };
typedef bool family_harvest(enum touchstone_shape shape, uint64_t seed, double (*numbers)[TOUCHSTONE_MOST_NUMBERS],
							char error[160]);

family_make make_near_contact, make_just_overlapping, make_receding, make_at_rest;
family_make make_grazing, make_double_root;
family_make make_scale_ratios, make_overflow, make_underflow, make_subnormal, make_huge_times, make_zeros;
family_make make_patterns, make_ties, make_quadratics;
family_harvest harvest_dense, harvest_dilute, harvest_inelastic, harvest_wells, harvest_bouncing_ball;

#endif
