/* The whole engine over the arithmetic whose header was included before, in the order in which one part stands on
 * another. The including unit defines THIS_UNIT, the name of the table it exports. */
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "engine/ahead.h"
#include "engine/bands.h"
#include "engine/cells.h"
#include "engine/memory.h"
#include "engine/pairs.h"
#include "engine/sieve.h"
#include "overlap/excess.h"
#include "scene/potential.h"
#include "scene/random.h"
#include "touchstone.h"
#include "unit/unit.h"

extern const struct unit THIS_UNIT;

#include "num/vector.inl"

#include "num/sum_rest.inl"

#include "overlap/quadratic.inl"

#include "overlap/ball_ball.inl"
#include "overlap/ball_leave.inl"
#include "overlap/ball_plane.inl"
#include "overlap/half_space.inl"
#include "overlap/roots.inl"

#include "finder/claim.inl"
#include "finder/finder.inl"

#include "finder/batch.h"
#include "method/stable.inl"

#include "method/compensated.inl"
#include "method/guarded.inl"
#include "method/kahan.inl"
#include "method/naive.inl"
#include "method/numerical_recipes.inl"
#include "method/rewind.inl"
#ifndef TOUCHSTONE_WITHOUT_MPFR
#include "method/exact_time.h"
#include "method/rounded.inl"
#endif
#include "method/search.inl"
#include "method/shrink.inl"
#include "method/skip.inl"
#include "method/sterbenz.inl"
#include "method/tc.inl"
#include "method/textbook_epsilon.inl"

#include "finder/methods.inl"

#include "engine/agenda.inl"
#include "engine/state.inl"

#include "engine/motion.inl"

#include "engine/potential.inl"

#include "method/last_event.inl"
#include "method/nudge.inl"
#include "method/positional.inl"
#include "method/stretch.inl"

#include "engine/defer.inl"
#include "engine/shadow.inl"

#include "engine/neighbours.inl"

#include "engine/ahead.inl"
#include "engine/residence.inl"
#include "engine/second.inl"

#include "engine/search.inl"

#include "engine/policy.inl"

#include "engine/collide.inl"

#include "engine/convection.inl"
#include "engine/crossing.inl"
#include "engine/layout.inl"
#include "engine/overlaps.inl"
#include "engine/step.inl"
#include "engine/tested.inl"

#include "engine/rescale.inl"
#include "engine/run.inl"

#include "engine/create_states.inl"
#include "engine/snapshot.inl"

#include "engine/create.inl"

#include "engine/drop.inl"

#include "finder/ask.inl"

#ifdef NUM_HAS_BATCHES
#include "finder/ask_vector.inl"
#else
#include "finder/ask_single.inl"
#endif

#include "finder/find.inl"

#include "engine/face.inl"
