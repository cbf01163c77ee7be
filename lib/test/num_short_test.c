/* The arithmetic "short" against MPFR at every precision it offers. */
#include "num/short.h"

#include <mpfr.h>

static const int precisions[] = {4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16, 17, 18, 19, 20, 21, 22, 23, 24, 25};
enum { cases = 100000, largest_exponent = 1024, edge_bits = 17, exact_bits = 53 };

static bool offered(int bits)
{
	return bits >= 4 && bits <= 25;
}

static void value(mpfr_t exact, num x)
{
	mpfr_set_d(exact, x, MPFR_RNDN);
}

#include "num_ieee.inl"
