/* The arithmetic "mpfr:P": GNU MPFR at any precision from 2 bits to what NUM_LIMBS, which the including unit defines,
 * can hold: 64 bits a limb. The exponent range is MPFR's own.
 *
 * A number holds its limbs and no pointer, so that it is copied by assignment and needs neither init nor clear.
 * Before each operation the header that MPFR works with is laid over the limbs (MPFR manual, "Custom Interface", whose
 * macros write the same four fields, but ask of what kind the number is; that would cost a tenth of a run's time);
 * nothing is allocated. All bytes zero is a NaN. */
#ifndef NUM_MPFR_H
#define NUM_MPFR_H

#include <mpfr.h>
#include <stdbool.h>
#include <stdint.h>
#include <string.h>

#ifndef NUM_LIMBS
#error "define NUM_LIMBS, the 64-bit limbs of a significand, before including num/mpfr.h"
#endif

_Static_assert(GMP_NUMB_BITS == 64, "limbs must be of 64 bits");

typedef struct {
	uint64_t mark;              /* MPFR's exponent, counted from the one that it has for NaN: num_mark */
	int precision;              /* bits of this number */
	int sign;                   /* 1 or -1 */
	mp_limb_t limbs[NUM_LIMBS]; /* only those that the precision asks for are set, and only in a regular number */
} num;

static const char num_name[] = "mpfr";
enum { num_largest_exponent = (1 << 30) - 1 };

/* The working precision of this thread, kept as a processor keeps its rounding mode in a register: results have it,
 * operands may have another. */
static _Thread_local int num_precision = 53;

/* Chooses the significand bits of this thread; false, changing nothing, when the arithmetic does not have them. */
static inline bool num_choose(int bits)
{
	if (bits < 2 || bits > NUM_LIMBS * GMP_NUMB_BITS) return false;
	num_precision = bits;
	return true;
}

/* Significand bits in force. */
static inline int num_bits(void)
{
	return num_precision;
}

static inline uint64_t num_mark(mpfr_exp_t exponent)
{
	return (uint64_t)exponent - (uint64_t)__MPFR_EXP_NAN;
}

static inline mpfr_exp_t num_exponent(num x)
{
	return (mpfr_exp_t)(x.mark + (uint64_t)__MPFR_EXP_NAN);
}

/* Marks next to each other stand for zero (which comes before 0, for NaN), infinity, and from there on what has a
 * significand. */
static inline bool num_zero(num x)
{
	return x.mark + 1 == 0;
}

static inline bool num_regular(num x)
{
	return x.mark + 1 > 2;
}

/* Lays MPFR's header over a number, which must outlive it. */
static inline void num_expose(mpfr_ptr header, num *number)
{
	header->_mpfr_prec = number->precision;
	header->_mpfr_sign = number->sign;
	header->_mpfr_exp = num_exponent(*number);
	header->_mpfr_d = number->limbs;
}

/* The same over a number that is about to be computed. */
static inline void num_expose_result(mpfr_ptr header, num *number)
{
	*header = (__mpfr_struct){num_precision, 1, __MPFR_EXP_NAN, number->limbs};
	number->precision = num_precision;
}

/* Takes what MPFR left in the header of a result; the limbs are in place already. */
static inline void num_collect(num *number, mpfr_srcptr header)
{
	number->sign = header->_mpfr_sign;
	number->mark = num_mark(header->_mpfr_exp);
}

typedef int num_operation(mpfr_ptr result, mpfr_srcptr a, mpfr_srcptr b, mpfr_rnd_t rounding);

static inline num num_apply(num_operation *operation, num *a, num *b)
{
	num result;
	mpfr_t header, header_a, header_b;
	num_expose(header_a, a);
	num_expose(header_b, b);
	num_expose_result(header, &result);
	operation(header, header_a, header_b, MPFR_RNDN);
	num_collect(&result, header);
	return result;
}

/* Rounded to nearest, ties to even. What fits is laid out here, for it is asked for often: the first bit of a
 * significand is the first bit of the last limb. */
static inline num from_double(double value)
{
	num result;
	result.precision = num_precision;
	uint64_t word;
	memcpy(&word, &value, sizeof word);
	int biased = (int)(word >> 52 & 0x7ff), limbs = (result.precision + 63) / 64;
	if (word << 1 == 0 || (biased > 0 && biased < 0x7ff && result.precision >= 53)) {
		result.sign = word >> 63 ? -1 : 1;
		result.mark = num_mark(word << 1 == 0 ? __MPFR_EXP_ZERO : biased - 1022);
		for (int l = 0; l < limbs - 1; l++) result.limbs[l] = 0;
		result.limbs[limbs - 1] = UINT64_C(1) << 63 | word << 11;
		return result;
	}
	mpfr_t header;
	num_expose_result(header, &result);
	mpfr_set_d(header, value, MPFR_RNDN);
	num_collect(&result, header);
	return result;
}

/* Rounded to nearest, ties to even, once: to a subnormal double as well. */
static inline double to_double(num x)
{
	mpfr_exp_t exponent = num_exponent(x);
	if (exponent > -1021 && exponent < 1024) { /* far from both ends of a double's range */
		enum { BEHIND = 11 };                  /* bits of the first limb that a double does not have */
		int last = (x.precision - 1) / GMP_NUMB_BITS;
		uint64_t first = x.limbs[last], more = 0, kept = first >> BEHIND;
		while (last--) more |= x.limbs[last];
		uint64_t rest = (first & ((1 << BEHIND) - 1)) | (more != 0), half = 1 << (BEHIND - 1);
		kept += (rest + half - 1 + (kept & 1)) >> BEHIND;
		uint64_t word = ((uint64_t)(exponent + 1021) << 52) + kept; /* the leading bit counts one exponent up */
		word |= (uint64_t)(x.sign < 0) << 63;
		double value;
		memcpy(&value, &word, sizeof value);
		return value;
	}
	if (num_zero(x)) return x.sign < 0 ? -0.0 : 0.0;
	mpfr_t header;
	num_expose(header, &x);
	return mpfr_get_d(header, MPFR_RNDN);
}

#include "num/mpfr_two_limbs.h"

static inline num add(num a, num b)
{
	return num_fit(&a, &b) ? num_sum(&a, &b, 1) : num_apply(mpfr_add, &a, &b);
}

static inline num sub(num a, num b)
{
	return num_fit(&a, &b) ? num_sum(&a, &b, -1) : num_apply(mpfr_sub, &a, &b);
}

static inline num mul(num a, num b)
{
	return num_fit(&a, &b) ? num_product(&a, &b) : num_apply(mpfr_mul, &a, &b);
}

static inline num divide(num a, num b)
{
	return num_apply(mpfr_div, &a, &b);
}

static inline num root(num a)
{
	num result;
	mpfr_t header, header_a;
	num_expose(header_a, &a);
	num_expose_result(header, &result);
	mpfr_sqrt(header, header_a, MPFR_RNDN);
	num_collect(&result, header);
	return result;
}

/* Exact, at the precision that the number has. */
static inline num negated(num a)
{
	a.sign = -a.sign;
	return a;
}

static inline num magnitude(num a)
{
	a.sign = a.sign < 0 ? -a.sign : a.sign;
	return a;
}

/* Whether a < b; false when either is not a number. */
static inline bool less(num a, num b)
{
	if (num_zero(b)) return a.sign < 0 && a.mark + 1 > 1; /* and is no NaN */
	if (num_zero(a)) return b.sign > 0 && b.mark + 1 > 1;
	bool regular = num_regular(a) && num_regular(b);
	if (regular && a.sign != b.sign) return a.sign < b.sign;
	if (regular && a.mark != b.mark) return (a.mark < b.mark) == (a.sign > 0);
	mp_limb_t first = a.limbs[(a.precision - 1) / 64], other = b.limbs[(b.precision - 1) / 64];
	if (regular && first != other) return (first < other) == (a.sign > 0);
	mpfr_t header_a, header_b;
	num_expose(header_a, &a);
	num_expose(header_b, &b);
	return mpfr_less_p(header_a, header_b) != 0;
}

static inline bool is_finite(num a)
{
	return num_regular(a) || num_zero(a);
}

/* To be kept: a number is its exponent, its kind and as many limbs as its precision asks for; where it has no
 * significand, the exponent and the limbs are zero. */
enum { num_words_are_doubles = 0 };

static inline int num_limbs(void)
{
	return (num_precision + GMP_NUMB_BITS - 1) / GMP_NUMB_BITS;
}

static inline int num_words(void)
{
	return 2 + num_limbs();
}

static inline void to_words(num x, uint64_t *words)
{
	int kind = num_regular(x) ? MPFR_REGULAR_KIND
			   : num_zero(x)  ? MPFR_ZERO_KIND
			   : x.mark       ? MPFR_INF_KIND
							  : MPFR_NAN_KIND;
	bool regular = kind == MPFR_REGULAR_KIND;
	words[0] = regular ? (uint64_t)num_exponent(x) : 0;
	words[1] = (uint64_t)(int64_t)(kind * x.sign);
	for (int l = 0; l < num_limbs(); l++) words[2 + l] = regular ? x.limbs[l] : 0;
}

/* False when the words are those of no number of this arithmetic. */
static inline bool from_words(const uint64_t *words, num *x)
{
	static const mpfr_exp_t without[] = {__MPFR_EXP_NAN, __MPFR_EXP_INF, __MPFR_EXP_ZERO}; /* by kind */
	int64_t exponent = (int64_t)words[0], kind = (int64_t)words[1];
	int limbs = num_limbs(), unused = limbs * GMP_NUMB_BITS - num_precision;
	if (kind < -MPFR_REGULAR_KIND || kind > MPFR_REGULAR_KIND) return false;
	x->precision = num_precision;
	x->sign = kind < 0 ? -1 : 1;
	kind *= x->sign;
	x->mark = num_mark(kind == MPFR_REGULAR_KIND ? exponent : without[kind]);
	for (int l = 0; l < limbs; l++) x->limbs[l] = words[2 + l];
	if (kind != MPFR_REGULAR_KIND) return exponent == 0;
	bool in_range = exponent >= mpfr_get_emin() && exponent <= mpfr_get_emax();
	return in_range && x->limbs[limbs - 1] >> 63 && !(x->limbs[0] & ((UINT64_C(1) << unused) - 1));
}

/* a b + c, rounded once. */
static inline num fused(num a, num b, num c)
{
	num result;
	mpfr_t header, header_a, header_b, header_c;
	num_expose(header_a, &a);
	num_expose(header_b, &b);
	num_expose(header_c, &c);
	num_expose_result(header, &result);
	mpfr_fma(header, header_a, header_b, header_c, MPFR_RNDN);
	num_collect(&result, header);
	return result;
}

/* What the rounding of a product left out, exactly. */
static inline num product_rest(num a, num b, num product)
{
	return fused(a, b, negated(product));
}

/* x = f 2^exponent with 1/2 <= |f| < 1; 0 for zero. */
static inline long exponent_of(num x)
{
	return num_regular(x) ? num_exponent(x) : 0;
}

/* x 2^exponent. */
static inline num times_power(num x, long exponent)
{
	num result;
	mpfr_t header, header_x;
	num_expose(header_x, &x);
	num_expose_result(header, &result);
	mpfr_mul_2si(header, header_x, exponent, MPFR_RNDN);
	num_collect(&result, header);
	return result;
}

/* Bits that hold this number. */
static inline int num_exact_bits(num x)
{
	return x.precision;
}

/* Exactly, into an `exact` of num_exact_bits. */
static inline void to_mpfr(mpfr_ptr exact, num x)
{
	mpfr_t header;
	num_expose(header, &x);
	mpfr_set(exact, header, MPFR_RNDN);
}

/* Rounded to nearest, ties to even. */
static inline num from_mpfr(mpfr_srcptr x)
{
	num result;
	mpfr_t header;
	num_expose_result(header, &result);
	mpfr_set(header, x, MPFR_RNDN);
	num_collect(&result, header);
	return result;
}

#endif
