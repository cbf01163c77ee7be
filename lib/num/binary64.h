/* The arithmetic "binary64": the machine's double, the production engine. */
#ifndef NUM_BINARY64_H
#define NUM_BINARY64_H

#include <float.h>

_Static_assert(FLT_EVAL_METHOD == 0, "double operations must round to double, not to something wider");

typedef double num;
enum { num_significand_bits = DBL_MANT_DIG };
static const char num_name[] = "binary64";

#include "native.h"

static inline num root(num a)
{
	return sqrt(a);
}

#endif
