#include "num/binary64.h"

#define THIS_UNIT unit_binary64
#include "engine/engine.inl"
