#define NUM_LIMBS 2
#include "num/mpfr.h"

#define THIS_UNIT unit_mpfr2
#include "engine/engine.inl"
