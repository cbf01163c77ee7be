/* The arithmetic "binary128": IEEE 754 quadruple precision, computed in software by the compiler's library. */
#ifndef NUM_BINARY128_H
#define NUM_BINARY128_H

__extension__ typedef __float128 num;
enum { num_significand_bits = 113 };
static const char num_name[] = "binary128";

#include "native.h"

/* The C library's square root, declared here because not every compiler sees its declaration. It is correctly rounded;
 * libquadmath's sqrtq is not: one result in four is wrong in its last bit. */
extern num sqrtf128(num a);

static inline num root(num a)
{
	return sqrtf128(a);
}

#endif
