/* Numbers of 16 limbs: up to 1024 bits. */
#define NUM_LIMBS 16
#include "num_mpfr.inl"
