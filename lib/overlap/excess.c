#include "overlap/excess.h"

#include "num/twin.h"

/* (|r|^2 - contact^2) / (|r| + contact) in double-double. */
double excess_quick(double terms[3][3 * TOUCHSTONE_MOST_TERMS], int count, const double contact[TOUCHSTONE_MOST_TERMS])
{
	num squares = from_double(0), s = from_double(0);
	for (int axis = 0; axis < 3; axis++) {
		num r = from_double(0);
		for (int term = 0; term < count; term++) r = add(r, from_double(terms[axis][term]));
		squares = add(squares, mul(r, r));
	}
	for (int term = 0; term < TOUCHSTONE_MOST_TERMS && contact[term] != 0; term++)
		s = add(s, from_double(contact[term]));
	return to_double(divide(sub(squares, mul(s, s)), add(root(squares), s)));
}

/* Sums and squares of doubles of any size are held whole. */
double excess_exact(double terms[3][3 * TOUCHSTONE_MOST_TERMS], int count, const double contact[TOUCHSTONE_MOST_TERMS])
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
	for (int term = 0; term < TOUCHSTONE_MOST_TERMS; term++) mpfr_sub_d(squares, squares, contact[term], MPFR_RNDN);
	double excess = mpfr_get_d(squares, MPFR_RNDN);
	mpfr_clears(sum, part, squares, (mpfr_ptr)0);
	return excess;
}

double excess_signed(double terms[3][3 * TOUCHSTONE_MOST_TERMS], int count, const double contact[TOUCHSTONE_MOST_TERMS])
{
	static const double doubt = 0x1p-75; /* terms may be 2^20 times as large as contact */
	double excess = excess_quick(terms, count, contact);
	return fabs(excess) > doubt * contact[0] ? excess : excess_exact(terms, count, contact);
}
