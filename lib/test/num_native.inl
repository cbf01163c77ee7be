/* What an arithmetic of num/native.h must keep. The including file includes its header and gives
 *     cases, largest_exponent, value    as num_test.inl describes them */

static const int precisions[] = {num_significand_bits};
enum { edge_bits = num_significand_bits, exact_bits = num_significand_bits < 53 ? 53 : num_significand_bits };

static bool offered(int bits)
{
	return bits == 0 || bits == num_significand_bits;
}

#include "num_ieee.inl"
