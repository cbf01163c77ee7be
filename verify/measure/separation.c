#include "measure/separation.h"

#include "num/twin.h"
#include <math.h>
#include <mpfr.h>

double separation_excess_twin(double terms[3][3 * TOUCHSTONE_MOST_TERMS], int count, double distance)
{
	num squares = from_double(0);
	for (int axis = 0; axis < 3; axis++) {
		num r = from_double(0);
		for (int term = 0; term < count; term++) r = add(r, from_double(terms[axis][term]));
		squares = add(squares, mul(r, r));
	}
	num s = from_double(distance);
	return to_double(divide(sub(squares, mul(s, s)), add(root(squares), s)));
}

double separation_excess_exact(double terms[3][3 * TOUCHSTONE_MOST_TERMS], int count,
							   const double distance[TOUCHSTONE_MOST_TERMS])
{
	mpfr_t sum, squares, part;
	mpfr_inits2(2200, sum, part, (mpfr_ptr)0);
	mpfr_init2(squares, 4500);
	mpfr_set_zero(squares, 1);
	for (int axis = 0; axis < 3; axis++) {
		mpfr_set_zero(sum, 1);
		for (int term = 0; term < count; term++) mpfr_add_d(sum, sum, terms[axis][term], MPFR_RNDN);
		mpfr_set_prec(part, 4500);
		mpfr_sqr(part, sum, MPFR_RNDN);
		mpfr_add(squares, squares, part, MPFR_RNDN);
	}
	mpfr_sqrt(squares, squares, MPFR_RNDN);
	for (int term = 0; term < TOUCHSTONE_MOST_TERMS; term++) mpfr_sub_d(squares, squares, distance[term], MPFR_RNDN);
	double excess = mpfr_get_d(squares, MPFR_RNDN);
	mpfr_clears(sum, part, squares, (mpfr_ptr)0);
	return excess;
}

bool separation_within(const struct touchstone_engine *engine, int bits)
{
	double terms[3][3 * TOUCHSTONE_MOST_TERMS], distance[TOUCHSTONE_MOST_TERMS];
	int count = touchstone_separation(engine, terms, distance);
	double excess = bits <= 53 ? separation_excess_twin(terms, count, distance[0]) : 0;
	if (!(fabs(excess) > 0x1p-90 * distance[0])) excess = separation_excess_exact(terms, count, distance);
	return excess < 0;
}
