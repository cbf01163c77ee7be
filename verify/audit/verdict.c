#include "audit/verdict.h"

#include <gsl/gsl_statistics_double.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "audit/change_point.h"
#include "audit/exact_test.h"

enum { WINDOWS = 4, RECENT_VALUES = 16 }; /* more of a sample would only make the ranks slow to count out */
static const size_t windows[WINDOWS] = {1, 2, 4, 8};

/* Nights taken together. */
struct pool {
	enum measure_nature nature;
	size_t nights, room, taken; /* room: for so many values */
	uint64_t seed[VERDICT_REFERENCE];
	uint64_t hits;
	double exposure, value[SAMPLE_MOST];
};

static bool is_counted(enum measure_nature nature)
{
	return nature == MEASURE_PROPORTION || nature == MEASURE_RATE;
}

/* Adds a night unless its seed is there already; a night of a timing is one value, whatever its seed. */
static void pool_add(struct pool *pool, const struct night *night)
{
	const struct measurement *measured = &night->measured;
	bool timed = pool->nature == MEASURE_TIMING;
	for (size_t k = 0; k < pool->nights && !timed; k++)
		if (pool->seed[k] == night->seed) return;
	pool->seed[pool->nights++] = night->seed;
	pool->hits += is_counted(pool->nature) ? (uint64_t)measured->hits : 0;
	pool->exposure += measured->exposure;
	for (size_t k = 0; k < measured->sample.count && !timed && pool->taken < pool->room; k++)
		if (!isnan(measured->sample.value[k])) pool->value[pool->taken++] = measured->sample.value[k];
	if (timed && pool->taken < pool->room && !isnan(measured->value)) pool->value[pool->taken++] = measured->value;
}

static struct measurement pool_measurement(const struct pool *pool)
{
	if (pool->nature == MEASURE_PROPORTION) return measurement_proportion(pool->hits, (uint64_t)pool->exposure);
	if (pool->nature == MEASURE_RATE) return measurement_rate(pool->hits, pool->exposure);
	struct sample sample = {0};
	for (size_t k = 0; k < pool->taken; k++) sample_add(&sample, pool->value[k]);
	return measurement_sample(pool->nature, &sample);
}

/* The value alone: intervals are only worked out for what is told. */
static double pool_value(const struct pool *pool)
{
	if (is_counted(pool->nature)) return (double)pool->hits / pool->exposure;
	return gsl_stats_median(memcpy((double[SAMPLE_MOST]){0}, pool->value, sizeof pool->value), 1, pool->taken);
}

static double test(const struct pool *now, const struct pool *before, enum measure_worse worse)
{
	if (is_counted(now->nature) && !(now->exposure > 0 && before->exposure > 0)) return 1;
	if (now->nature == MEASURE_PROPORTION)
		return test_proportions((double)now->hits, now->exposure, (double)before->hits, before->exposure, worse);
	if (now->nature == MEASURE_RATE)
		return test_rates((double)now->hits, now->exposure, (double)before->hits, before->exposure, worse);
	return test_ranks(now->value, now->taken, before->value, before->taken, worse);
}

/* A night that is back where it was raises no alarm, however bad those before it were. */
static bool tonight_agrees(double tonight, double now, double before, enum measure_worse worse)
{
	if (worse == WORSE_EITHER) return (tonight - before) * (now - before) > 0;
	return worse == WORSE_MORE ? tonight > before : tonight < before;
}

/* Tests so many nights together. False when there are not so many, or none before them. */
static bool test_window(struct verdict *verdict, const struct night *nights, size_t count, size_t window,
						enum measure_worse worse)
{
	enum measure_nature nature = nights[count - 1].measured.nature;
	struct pool now = {.nature = nature, .room = RECENT_VALUES}, before = {.nature = nature, .room = VERDICT_REFERENCE};
	size_t at = count - 1;
	pool_add(&now, &nights[at]);
	while (at > 0 && now.nights < window)
		if (nights[--at].good) pool_add(&now, &nights[at]);
	if (now.nights < window) return false;
	while (at > 0 && before.nights < VERDICT_REFERENCE)
		if (nights[--at].good) pool_add(&before, &nights[at]);
	if (before.nights == 0) return false;

	bool agrees = tonight_agrees(nights[count - 1].measured.value, pool_value(&now), pool_value(&before), worse);
	double chance = agrees ? fmin(1, WINDOWS * test(&now, &before, worse)) : 1;
	if (verdict->compared && chance >= verdict->chance) return true;
	verdict->compared = true;
	verdict->chance = chance;
	verdict->nights = now.nights;
	verdict->references = before.nights;
	verdict->before = pool_measurement(&before);
	verdict->now = pool_measurement(&now);
	return true;
}

/* Words are compared with the last good night of the same seed. */
static void compare_words(struct verdict *verdict, const struct night *nights, size_t count)
{
	const struct night *tonight = &nights[count - 1];
	for (size_t at = count - 1; at-- > 0;) {
		if (!nights[at].good || nights[at].seed != tonight->seed) continue;
		verdict->compared = true;
		verdict->chance = strcmp(nights[at].measured.word, tonight->measured.word) == 0 ? 1 : 0;
		verdict->references = 1;
		verdict->before = nights[at].measured;
		return;
	}
}

struct verdict verdict_of(const struct night *nights, size_t count, enum measure_worse worse)
{
	const struct night *tonight = &nights[count - 1];
	struct verdict verdict = {.chance = 1, .nights = 1, .before = tonight->measured, .now = tonight->measured};
	if (tonight->measured.nature == MEASURE_WORD)
		compare_words(&verdict, nights, count);
	else
		for (int w = 0; w < WINDOWS; w++) test_window(&verdict, nights, count, windows[w], worse);
	bool more = worse == WORSE_EITHER ? verdict.now.value > verdict.before.value : worse == WORSE_MORE;
	verdict.since = verdict.chance < 0.1 ? change_point(nights, count, more) : tonight->audit;
	return verdict;
}

/* ---- all together */

static int by_chance(const void *a, const void *b)
{
	double one = (*(struct verdict *const *)a)->chance, other = (*(struct verdict *const *)b)->chance;
	return (one > other) - (one < other);
}

void verdicts_judge(struct verdict *const *verdicts, size_t count, double false_alarms)
{
	struct verdict **tested = calloc(count + 1, sizeof *tested);
	size_t tests = 0;
	for (size_t v = 0; v < count; v++) {
		bool word = verdicts[v]->now.nature == MEASURE_WORD; /* equal or not, and chance has no part in it */
		verdicts[v]->worse = word && verdicts[v]->compared && verdicts[v]->chance == 0;
		if (!word && verdicts[v]->compared && tested) tested[tests++] = verdicts[v];
	}
	if (tested) qsort(tested, tests, sizeof *tested, by_chance);
	for (size_t v = 0; v < tests && tested[v]->chance <= false_alarms / (double)(tests - v); v++)
		tested[v]->worse = true;
	free(tested);
}

const char *verdict_change(const struct verdict *verdict, char text[VERDICT_TEXT])
{
	double now = verdict->now.value, before = verdict->before.value;
	if (verdict->now.nature == MEASURE_WORD)
		snprintf(text, VERDICT_TEXT, "%.30s, not %.30s", verdict->now.word, verdict->before.word);
	else if (before > 0 && now > 0)
		snprintf(text, VERDICT_TEXT, "%.4g times what it was: %.4g, not %.4g", now / before, now, before);
	else
		snprintf(text, VERDICT_TEXT, "%.4g, not %.4g", now, before);
	return text;
}
