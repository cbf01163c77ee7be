/* The arithmetic "binary32": the machine's float. */
#ifndef NUM_BINARY32_H
#define NUM_BINARY32_H

#include <float.h>

_Static_assert(FLT_EVAL_METHOD == 0, "float operations must round to float, not to something wider");

typedef float num;
enum { num_significand_bits = FLT_MANT_DIG };
static const char num_name[] = "binary32";

#include "native.h"

static inline num root(num a)
{
	return sqrtf(a);
}

#endif
