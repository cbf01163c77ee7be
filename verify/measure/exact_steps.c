#include "measure/exact_steps.h"

#include <math.h>
#include <mpfr.h>

const char *exact_step_formula(enum touchstone_shape shape, enum exact_step step)
{
	static const char *const formulas[TOUCHSTONE_SHAPES][EXACT_STEPS] = {
		[TOUCHSTONE_BALL_BALL] = {"v.v", "r.v", "r.r - contact^2", "b^2 - a c"},
		[TOUCHSTONE_BALL_LEAVE] = {"v.v", "r.v", "r.r - contact^2", "b^2 - a c"},
		[TOUCHSTONE_BALL_PLANE] = {"acceleration", "speed", "distance - contact", "b^2 - 2 a c"},
		[TOUCHSTONE_HALF_SPACE] = {NULL, "speed", "distance", NULL},
	};
	return formulas[shape][step];
}

/* sum += x y */
static void add_product(mpq_t sum, double x, double y)
{
	mpq_t first, second;
	mpq_inits(first, second, NULL);
	mpq_set_d(first, x);
	mpq_set_d(second, y);
	mpq_mul(first, first, second);
	mpq_add(sum, sum, first);
	mpq_clears(first, second, NULL);
}

/* discriminant = b^2 - factor a c */
static void set_discriminant(mpq_t value[EXACT_STEPS], unsigned factor)
{
	mpq_t product;
	mpq_init(product);
	mpq_set_ui(product, factor, 1);
	mpq_mul(product, product, value[STEP_A]);
	mpq_mul(product, product, value[STEP_C]);
	mpq_mul(value[STEP_DISCRIMINANT], value[STEP_B], value[STEP_B]);
	mpq_sub(value[STEP_DISCRIMINANT], value[STEP_DISCRIMINANT], product);
	mpq_clear(product);
}

void exact_steps_init(struct exact_steps *steps, enum touchstone_shape shape,
					  const double number[TOUCHSTONE_MOST_NUMBERS])
{
	mpq_t *value = steps->value;
	steps->shape = shape;
	for (int s = 0; s < EXACT_STEPS; s++) mpq_init(value[s]);
	if (shape == TOUCHSTONE_BALL_BALL || shape == TOUCHSTONE_BALL_LEAVE) {
		const double *r = number, *v = number + 3;
		for (int axis = 0; axis < 3; axis++) {
			add_product(value[STEP_A], v[axis], v[axis]);
			add_product(value[STEP_B], r[axis], v[axis]);
			add_product(value[STEP_C], r[axis], r[axis]);
		}
		add_product(value[STEP_C], -number[6], number[6]);
		set_discriminant(value, 1);
		return;
	}
	mpq_set_d(value[STEP_C], number[0]);
	mpq_set_d(value[STEP_B], number[1]);
	if (shape == TOUCHSTONE_HALF_SPACE) return;
	mpq_set_d(value[STEP_A], number[2]);
	add_product(value[STEP_C], -1, number[3]);
	set_discriminant(value, 2);
}

void exact_steps_clear(struct exact_steps *steps)
{
	for (int s = 0; s < EXACT_STEPS; s++) mpq_clear(steps->value[s]);
}

double exact_step_error(const mpq_t exact, double got)
{
	if (!isfinite(got)) return fabs(got);
	mpfr_t digits;
	mpq_t difference;
	mpfr_init2(digits, 64);
	mpq_init(difference);
	mpfr_set_q(digits, exact, MPFR_RNDZ);
	long ulp = mpfr_zero_p(digits) ? -1074 : (long)mpfr_get_exp(digits) - 53;
	mpq_set_d(difference, got);
	mpq_sub(difference, difference, exact);
	mpfr_set_q(digits, difference, MPFR_RNDN);
	mpfr_mul_2si(digits, digits, ulp > -1074 ? -ulp : 1074, MPFR_RNDN);
	double error = fabs(mpfr_get_d(digits, MPFR_RNDN));
	mpq_clear(difference);
	mpfr_clear(digits);
	return error;
}
