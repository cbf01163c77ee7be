#include "num/binary32.h"

#define THIS_UNIT unit_binary32
#include "engine/engine.inl"
