#include "num/short.h"

#define THIS_UNIT unit_short
#include "engine/engine.inl"
