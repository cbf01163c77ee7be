#define NUM_LIMBS 16
#include "num/mpfr.h"

#define THIS_UNIT unit_mpfr16
#include "engine/engine.inl"
