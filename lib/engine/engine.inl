/* The whole engine over the arithmetic whose header was included before, in the order in which one part stands on
 * another. The including unit defines THIS_UNIT, the name of the table it exports. */
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "engine/cells.h"
#include "engine/sieve.h"
#include "touchstone.h"
#include "unit/unit.h"

extern const struct unit THIS_UNIT;

#include "num/vector.inl"

#include "overlap/ball_ball.inl"
#include "overlap/ball_plane.inl"

#include "method/naive.inl"
#include "method/stable.inl"

#include "engine/agenda.inl"
#include "engine/state.inl"

#include "engine/motion.inl"
#include "engine/shadow.inl"

#include "engine/search.inl"

#include "engine/collide.inl"
#include "engine/layout.inl"

#include "engine/run.inl"

#include "engine/create.inl"

#include "engine/drop.inl"

#include "engine/face.inl"
