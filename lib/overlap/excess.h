/* How far two centres are from contact: |r| - contact, of numbers given as exact sums of doubles, in the form in which
 * touchstone_separation() has them. */
#ifndef TOUCHSTONE_EXCESS_H
#define TOUCHSTONE_EXCESS_H

#include "touchstone.h"

/* Where rounding cannot matter: error below 2^-95 of contact as long as no term is many times larger than contact. */
double excess_quick(double terms[3][3 * TOUCHSTONE_MOST_TERMS], int count, const double contact[TOUCHSTONE_MOST_TERMS]);

/* Rounded once, so that its sign is exact. */
double excess_exact(double terms[3][3 * TOUCHSTONE_MOST_TERMS], int count, const double contact[TOUCHSTONE_MOST_TERMS]);

/* The first where it leaves no doubt of the sign, and the second otherwise. */
double excess_signed(double terms[3][3 * TOUCHSTONE_MOST_TERMS], int count,
					 const double contact[TOUCHSTONE_MOST_TERMS]);

#endif
