/* The exact coefficients of a question, and how far off a finder's are. */
#ifndef VERIFY_EXACT_STEPS_H
#define VERIFY_EXACT_STEPS_H

#include <gmp.h>

#include "touchstone.h"

enum exact_step { STEP_A, STEP_B, STEP_C, STEP_DISCRIMINANT };
enum { EXACT_STEPS = 4 };

/* As in struct touchstone_steps: f(t) = a t^2 + 2 b t + c and b^2 - a c for balls, a t^2 / 2 + b t + c and b^2 - 2 a c
 * for a plane; b t + c for a half-space. Sums and products of doubles, which are rational numbers. */
struct exact_steps {
	enum touchstone_shape shape;
	mpq_t value[EXACT_STEPS];
};

/* Whether questions of the shape have this coefficient, and how it is written: "b = r.v". NULL when there is none. */
const char *exact_step_formula(enum touchstone_shape shape, enum exact_step step);

/* The coefficients of a question of finite numbers; end with exact_steps_clear. */
void exact_steps_init(struct exact_steps *steps, enum touchstone_shape shape,
					  const double number[TOUCHSTONE_MOST_NUMBERS]);
void exact_steps_clear(struct exact_steps *steps);

/* |got - exact| / ulp(exact) with ulp(x) = 2^(floor(log2 |x|) - 52), at least 2^-1074 (there, for 0 too), to a relative
 * 1e-15. Infinity for an infinity, NaN for a NaN. */
double exact_step_error(const mpq_t exact, double got);

#endif
