#include "audit/change_point.h"

#include <gsl/gsl_statistics_double.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

static int64_t words_since(const struct night *nights, size_t count)
{
	const struct night *tonight = &nights[count - 1];
	int64_t since = tonight->audit;
	for (size_t at = count - 1; at-- > 0;) {
		if (nights[at].seed != tonight->seed) continue;
		if (strcmp(nights[at].measured.word, tonight->measured.word) != 0) break;
		since = nights[at].audit;
	}
	return since;
}

/* What the hits on one side add to the logarithm of their likelihood, at the rate they have. */
static double information(double hits, double exposure, bool proportion)
{
	double information = hits > 0 ? hits * log(hits / exposure) : 0, misses = exposure - hits;
	if (proportion && misses > 0) information += misses * log(misses / exposure);
	return information;
}

static int64_t counts_since(const struct night *nights, size_t count, bool more)
{
	double hits[2] = {0}, exposure[2] = {0}, best = -INFINITY;
	bool proportion = nights[count - 1].measured.nature == MEASURE_PROPORTION;
	int64_t since = nights[count - 1].audit;
	for (size_t k = 0; k < count; k++) hits[0] += nights[k].measured.hits, exposure[0] += nights[k].measured.exposure;
	for (size_t k = count; k-- > 1;) { /* night k is the first of those after */
		hits[0] -= nights[k].measured.hits, exposure[0] -= nights[k].measured.exposure;
		hits[1] += nights[k].measured.hits, exposure[1] += nights[k].measured.exposure;
		double likely = information(hits[0], exposure[0], proportion) + information(hits[1], exposure[1], proportion);
		bool that_way = (hits[1] / exposure[1] > hits[0] / exposure[0]) == more;
		if (that_way && likely > best) best = likely, since = nights[k].audit;
	}
	return since;
}

/* How far values are from their median, all together. */
static double deviation(const double *values, size_t count, double *room, double *median)
{
	double sum = 0;
	memcpy(room, values, count * sizeof *room);
	*median = gsl_stats_median(room, 1, count);
	for (size_t k = 0; k < count; k++) sum += fabs(values[k] - *median);
	return sum;
}

static int64_t values_since(const struct night *nights, size_t count, bool more)
{
	double *values = calloc(2 * count, sizeof *values), best = INFINITY, before, after;
	int64_t since = nights[count - 1].audit;
	for (size_t k = 0; k < count && values; k++) values[k] = nights[k].measured.value;
	for (size_t k = count; values && k-- > 1;) { /* night k is the first of those after */
		double cost = deviation(values, k, values + count, &before);
		cost += deviation(values + k, count - k, values + count, &after);
		if ((after > before) == more && cost < best) best = cost, since = nights[k].audit;
	}
	free(values);
	return since;
}

int64_t change_point(const struct night *nights, size_t count, bool more)
{
	switch (nights[count - 1].measured.nature) {
	case MEASURE_WORD:
		return words_since(nights, count);
	case MEASURE_PROPORTION:
	case MEASURE_RATE:
		return counts_since(nights, count, more);
	default:
		return values_since(nights, count, more);
	}
}
