/* The arithmetic "extended" against MPFR. */
#include "num/extended.h"

#include <mpfr.h>

enum { cases = 200000, largest_exponent = 16384 };

static void value(mpfr_t exact, num x)
{
	mpfr_set_ld(exact, x, MPFR_RNDN);
}

#include "num_native.inl"
