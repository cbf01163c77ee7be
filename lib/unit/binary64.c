#include "num/binary64.h"

#ifndef TOUCHSTONE_WITHOUT_MPFR
#define NUM_HAS_BATCHES
#endif
#define THIS_UNIT unit_binary64
#include "engine/engine.inl"
