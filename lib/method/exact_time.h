/* When an event happens, enclosed between two numbers as close together as is wanted: what stands behind `rounded`
 * where twice the precision cannot tell. Integers (GMP) decide whether there is an event; MPFR, rounding down and up,
 * encloses its time. */
#ifndef METHOD_EXACT_TIME_H
#define METHOD_EXACT_TIME_H

#include <gmp.h>
#include <mpfr.h>
#include <stdbool.h>

#include "touchstone.h"

enum exact_event {
	EXACT_NEVER,
	EXACT_NOW,
	EXACT_LATER, /* at the earlier or the later root of a t^2 + 2 b t + c */
};

/* An integer times a power of two. */
struct exact_number {
	mpz_t integer;
	long exponent;
};

struct exact_time {
	enum exact_event event;
	bool turned; /* a, b and c are the negatives of the question's, so that a >= 0 */
	bool parts;  /* the later root, else the earlier */
	struct exact_number number[TOUCHSTONE_MOST_NUMBERS];
	struct exact_number a, b, c, discriminant;
	mpfr_t low, high;
	mpfr_t least_sum, most_sum;
	mpz_t scratch;
};

/* Memory for one question after another, owned by the caller. */
void exact_time_open(struct exact_time *time);
void exact_time_close(struct exact_time *time);

/* Decides, from the numbers of a question (finite, in the order of touchstone.h), whether there is an event. A plane's
 * quadratic is acceleration t^2 + 2 speed t + 2 gap. */
void exact_time_decide(struct exact_time *time, enum touchstone_shape shape, mpfr_t number[]);

/* Of an event later: low <= time <= high, both of `precision` bits. They are equal from some precision on, if the time
 * is a binary fraction at all. */
void exact_time_enclose(struct exact_time *time, mpfr_prec_t precision);

#endif
