/* The 2016 paper's experiment (section 5), how it depends on precision, and what becomes of methods that read states
 * from positions. */
#include "figure/figure.h"
#include "figure/step_gases.h"

#include <stdio.h>
#include <stdlib.h>

/* Gathers what all parts of the page want, the longest runs first; returns how many. */
static size_t gather(bool full, struct step_gas *gases, size_t parts[3])
{
	parts[0] = states_paper_gases(full, gases);
	parts[1] = states_precision_gases(full, gases + parts[0]);
	parts[2] = states_rivals_gases(full, gases + parts[0] + parts[1]);
	return parts[0] + parts[1] + parts[2];
}

struct result *figure_states(const struct figure_setup *setup, char error[512])
{
	struct step_gas *gases = calloc(MOST_STEP_GASES, sizeof *gases);
	struct step_gas_outcome *outcomes = calloc(MOST_STEP_GASES, sizeof *outcomes);
	struct result *result = result_new("states", "Is a pair in its well? What positions say, and what is remembered");
	size_t parts[3] = {0}, count = gases && outcomes && result ? gather(setup->full, gases, parts) : 0, finished;
	if (!count) snprintf(error, 512, "not enough memory");
	bool good = count && step_gases_measure("states", setup, gases, count, outcomes, &finished, error);
	if (good) {
		result_paragraph(result,
						 "In a square well or on a square shoulder a pair's state, captured or not, is part of the "
						 "simulation's state: at the step its position cannot tell, and rounding makes an interval of "
						 "that point. Here the state is tracked, and held against what the exact positions say.");
		states_paper_tell(result, gases, outcomes);
		states_precision_tell(result, gases + parts[0], outcomes + parts[0]);
		states_rivals_tell(result, gases + parts[0] + parts[1], outcomes + parts[0] + parts[1], setup->seed);
		if (finished < count)
			result_incomplete(result, "interrupted after %zu of %zu gases; the next call goes on from there", finished,
							  count);
	}
	free(gases);
	free(outcomes);
	if (good) return result;
	result_free(result);
	return NULL;
}
