#include "num/binary64.h"

#define NUM_HAS_BATCHES
#define THIS_UNIT unit_binary64
#include "engine/engine.inl"
