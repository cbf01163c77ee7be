/* One who is asked: a method in an arithmetic, or a plug-in. */
#ifndef VERIFY_FINDER_H
#define VERIFY_FINDER_H

#include "measure/finder_claim.h"
#include "plugin/plugin.h"

struct finder {
	const char *method, *arithmetic; /* a plug-in's name, and binary64 */
	struct plugin *plugin;           /* NULL: a method */
};

/* Whether a finder has an answer for the shape; if not, `error` says why. */
bool finder_answers(const struct finder *finder, enum touchstone_shape shape, char error[160]);

/* What the method's file claims of the finder, for it to be held to; false when that is nothing. */
bool finder_claims(const struct finder *finder, enum touchstone_shape shape, struct finder_claim *claim);

#endif
