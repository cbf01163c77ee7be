#include "plugin/finder.h"

#include <stdio.h>

#include "measure/horizon.h"
#include "store/query_file.h"

bool finder_answers(const struct finder *finder, enum touchstone_shape shape, char error[160])
{
	if (!finder->plugin) return touchstone_find(finder->arithmetic, finder->method, shape, NULL, 0, false, NULL, error);
	snprintf(error, 160, "%.80s has no finder for %s", finder->method, shape_name(shape));
	return plugin_answers(finder->plugin, shape);
}

bool finder_claims(const struct finder *finder, enum touchstone_shape shape, struct finder_claim *claim)
{
	char why[160];
	claim->arithmetic = finder->arithmetic;
	claim->bits = horizon_bits(finder->arithmetic, why);
	return !finder->plugin && touchstone_finder_claim(finder->arithmetic, finder->method, shape, &claim->claim, why);
}
