/* Numbers of 4 limbs: up to 256 bits. */
#define NUM_LIMBS 4
#include "num_mpfr.inl"
