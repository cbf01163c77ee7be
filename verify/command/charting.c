#include "command/charting.h"

#include <stdlib.h>

bool chart_run(const struct chart_plan *plan, struct chart *chart, char error[GRADING_ERROR])
{
	double began = progress_clock();
	*chart = (struct chart){.finders = calloc(plan->finder_count + 1, sizeof *chart->finders),
							.engines = calloc(plan->engine_count + 1, sizeof *chart->engines)};
	snprintf(error, GRADING_ERROR, "out of memory");
	bool good = chart->finders && chart->engines && chart_finders(plan, chart, error) &&
				chart_engines(plan, chart, began, error);
	chart->seconds = progress_clock() - began;
	chart->interrupted = plan->stop && *plan->stop;
	return good;
}

void chart_free(const struct chart_plan *plan, struct chart *chart)
{
	for (size_t e = 0; chart->engines && e < plan->engine_count; e++) free(chart->engines[e].horizons);
	free(chart->engines);
	free(chart->finders);
}
