#include "num/binary128.h"

#define THIS_UNIT unit_binary128
#include "engine/engine.inl"
