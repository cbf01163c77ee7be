/* Inside the oracle: exact numbers and the working space. */
#ifndef VERIFY_ORACLE_EXACT_H
#define VERIFY_ORACLE_EXACT_H

#include "oracle/oracle.h"
#include <stddef.h>

enum { SCRATCH = 6, DIGITS = 64 };

/* value = 2^exponent (rational + sign sqrt(radicand)) / divisor, positive; divisor > 0, radicand >= 0, sign +1 or -1.
 */
struct surd {
	mpz_t rational, radicand, divisor;
	int sign;
	long exponent;
	long magnitude; /* 2^magnitude <= value / 2^exponent < 2^(magnitude + 3) */
};

struct oracle {
	bool force_exact;
	uint64_t exact_count;
	mpz_t number[7];             /* the numbers of a query, as integers */
	mpz_t a, b, c, discriminant; /* of a t^2 + 2 b t + c */
	struct surd first, second;   /* the times in question */
	mpz_t digits, other_digits;
	mpz_t scratch[SCRATCH]; /* for the length of one function in surd.c or grade.c */
	mpfr_t rounded;         /* of DIGITS bits */
};

/* ---- dyadic.c: doubles as integers times a power of two */

/* Writes integers such that value[i] = integer[i] * 2^exponent, the exponent as large as they allow, and returns it
 * (0 when all are zero). */
long dyadic_read(size_t count, const double value[], mpz_t integer[]);

/* integer * 2^exponent rounded toward zero. */
double dyadic_to_double(const mpz_t integer, long exponent);

/* Multiplies by 2^bits, bits >= 0. */
void dyadic_shift(mpz_t integer, long bits);

/* ---- shapes.c: the case tables */

/* The exact answer to a query; fills `surd` when it is later. */
enum oracle_event exact_solve(struct oracle *oracle, const struct oracle_query *query, struct surd *surd);

/* The signs of a, b, c and b^2 - a c, turned so that a >= 0. */
void exact_signs(struct oracle *oracle, const struct oracle_query *query, int signs[ORACLE_SIGNS]);

/* ---- surd.c: digits and order of surds */

/* The leading digits: digits * 2^exponent <= value < (digits + 1) * 2^exponent, with `width` to width + 2 bits.
 * Returns whether something is left behind them. Uses scratch[0] and scratch[1]. */
bool surd_digits(struct oracle *oracle, const struct surd *surd, long width, mpz_t digits, long *exponent);

/* Correctly rounded; returns the ternary value. */
int surd_round(struct oracle *oracle, mpfr_t result, const struct surd *surd, mpfr_rnd_t direction);

int surd_compare(struct oracle *oracle, const struct surd *first, const struct surd *second);

/* `value` is finite and positive. */
int surd_compare_double(struct oracle *oracle, const struct surd *surd, double value);

#endif
