#include "num/twin.h"

#define THIS_UNIT unit_twin
#include "engine/engine.inl"
