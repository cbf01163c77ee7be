#define NUM_LIMBS 4
#include "num/mpfr.h"

#define THIS_UNIT unit_mpfr4
#include "engine/engine.inl"
