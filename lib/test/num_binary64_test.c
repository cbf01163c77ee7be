/* The arithmetic "binary64" against MPFR. */
#include "num/binary64.h"

#include <mpfr.h>

enum { cases = 200000, largest_exponent = 1024 };

static void value(mpfr_t exact, num x)
{
	mpfr_set_d(exact, x, MPFR_RNDN);
}

#include "num_native.inl"
