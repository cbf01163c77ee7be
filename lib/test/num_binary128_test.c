/* The arithmetic "binary128" against MPFR. */
#include "num/binary128.h"

#include <mpfr.h>

enum { cases = 100000, largest_exponent = 16384 };

/* Declared here because MPFR's header spells the type in a way that not every compiler knows. */
extern int mpfr_set_float128(mpfr_ptr result, num x, mpfr_rnd_t rounding);

static void value(mpfr_t exact, num x)
{
	mpfr_set_float128(exact, x, MPFR_RNDN);
}

#include "num_native.inl"
