/* The 2016 paper's experiment (section 5), how it depends on precision, and what becomes of methods that read states
 * from positions. */
#include "figure/figure.h"
#include "figure/step_gas.h"

#include <inttypes.h>
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
	struct step_campaign campaign = {.setup = setup};
	size_t parts[3] = {0}, count = gases && outcomes && result ? gather(setup->full, gases, parts) : 0;
	if (!count) snprintf(error, 512, "not enough memory");
	for (size_t g = 0; g < count; g++) campaign.all += step_gas_events(&gases[g]);
#pragma omp parallel for schedule(dynamic, 1) num_threads(setup->threads)
	for (size_t g = 0; g < count; g++)
		if (!(setup->stop && *setup->stop)) step_gas_run(&gases[g], &campaign, &outcomes[g]);
	bool good = count > 0, stopped = false;
	for (size_t g = 0; g < count && good; g++) {
		good = !*outcomes[g].error;
		if (!good) snprintf(error, 512, "%s", outcomes[g].error);
		stopped |= outcomes[g].stopped || !outcomes[g].begun;
	}
	if (good) {
		result_paragraph(result,
						 "In a square well or on a square shoulder a pair's state, captured or not, is part of the "
						 "simulation's state: at the step its position cannot tell, and rounding makes an interval of "
						 "that point. Here the state is tracked, and held against what the exact positions say.");
		states_paper_tell(result, gases, outcomes);
		states_precision_tell(result, gases + parts[0], outcomes + parts[0]);
		states_rivals_tell(result, gases + parts[0] + parts[1], outcomes + parts[0] + parts[1], setup->seed);
		if (stopped)
			result_incomplete(result, "interrupted after %" PRIu64 " of %" PRIu64 " events", (uint64_t)campaign.done,
							  campaign.all);
	}
	free(gases);
	free(outcomes);
	if (good) return result;
	result_free(result);
	return NULL;
}
