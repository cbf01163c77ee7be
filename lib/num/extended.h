/* The arithmetic "extended": the x87 long double of 64 significand bits, where the machine has it. */
#ifndef NUM_EXTENDED_H
#define NUM_EXTENDED_H

#include <float.h>

#if LDBL_MANT_DIG != 64
#error "the arithmetic extended needs a long double of 64 significand bits; leave this unit out on this machine"
#endif

typedef long double num;
enum { num_significand_bits = LDBL_MANT_DIG };
static const char num_name[] = "extended";

#include "native.h"

static inline num root(num a)
{
	return sqrtl(a);
}

#endif
