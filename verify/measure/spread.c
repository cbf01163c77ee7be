#include "measure/spread.h"

#include <gsl/gsl_sort.h>
#include <gsl/gsl_statistics_double.h>
#include <math.h>

void sample_add(struct sample *sample, double value)
{
	if (sample->count < SAMPLE_MOST) sample->value[sample->count++] = value;
}

struct spread spread_exact(double value)
{
	return (struct spread){value, value, value};
}

struct spread spread_of(const struct sample *sample)
{
	double sorted[SAMPLE_MOST];
	size_t count = 0;
	for (size_t i = 0; i < sample->count; i++)
		if (!isnan(sample->value[i])) sorted[count++] = sample->value[i];
	if (count == 0) return spread_exact(NAN);
	gsl_sort(sorted, 1, count);
	return (struct spread){gsl_stats_median_from_sorted_data(sorted, 1, count),
						   gsl_stats_quantile_from_sorted_data(sorted, 1, count, 0.25),
						   gsl_stats_quantile_from_sorted_data(sorted, 1, count, 0.75)};
}

struct spread spread_of_ratio(const struct sample *over, const struct sample *under)
{
	struct sample ratio = {0};
	for (size_t i = 0; i < over->count && i < under->count; i++) sample_add(&ratio, over->value[i] / under->value[i]);
	return spread_of(&ratio);
}
