#include "num/extended.h"

#define THIS_UNIT unit_extended
#include "engine/engine.inl"
