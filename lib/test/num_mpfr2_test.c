/* Numbers of 2 limbs: up to 128 bits. */
#define NUM_LIMBS 2
#include "num_mpfr.inl"
