/* The arithmetic "binary32" against MPFR. */
#include "num/binary32.h"

#include <mpfr.h>

enum { cases = 200000, largest_exponent = 128 };

static void value(mpfr_t exact, num x)
{
	mpfr_set_flt(exact, x, MPFR_RNDN);
}

#include "num_native.inl"
