/* Since when a measure is different: the night that divides all nights best into those before and those after. */
#ifndef VERIFY_AUDIT_CHANGE_POINT_H
#define VERIFY_AUDIT_CHANGE_POINT_H

#include "audit/verdict.h"

/* The audit from which on the measure is higher (`more`) or lower: by likelihood for counts, by least absolute
 * deviations from the medians of both sides for other values. Of words, the first of those nights of the same
 * seed that end with tonight and all say the same. Good and bad nights are looked at alike. */
int64_t change_point(const struct night *nights, size_t count, bool more);

#endif
