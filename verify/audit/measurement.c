#include "audit/measurement.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "measure/interval.h"

struct measurement measurement_word(const char *word)
{
	struct measurement measured = {.nature = MEASURE_WORD, .value = NAN, .low = NAN, .high = NAN, .count = 1};
	snprintf(measured.word, sizeof measured.word, "%s", word);
	return measured;
}

static struct measurement counted(enum measure_nature nature, uint64_t hits, double exposure, struct interval interval)
{
	return (struct measurement){
		.nature = nature,
		.value = (double)hits / exposure,
		.low = interval.low,
		.high = interval.high,
		.count = nature == MEASURE_RATE ? hits : (uint64_t)exposure,
		.hits = (double)hits,
		.exposure = exposure,
	};
}

struct measurement measurement_proportion(uint64_t hits, uint64_t trials)
{
	return counted(MEASURE_PROPORTION, hits, (double)trials, interval_of_proportion(hits, trials));
}

struct measurement measurement_rate(uint64_t hits, double exposure)
{
	return counted(MEASURE_RATE, hits, exposure, interval_of_rate(hits, exposure));
}

struct measurement measurement_sample(enum measure_nature nature, const struct sample *sample)
{
	struct spread spread = spread_of(sample);
	return (struct measurement){
		.nature = nature,
		.value = spread.median,
		.low = spread.low,
		.high = spread.high,
		.count = sample->count,
		.sample = *sample,
	};
}

/* ---- words */

static const char *const natures[MEASURE_NATURES] = {"word", "proportion", "rate", "sample", "timing"};
static const char *const ways[] = {"more", "less", "either"};

const char *nature_name(enum measure_nature nature)
{
	return natures[nature];
}

const char *worse_name(enum measure_worse worse)
{
	return ways[worse];
}

static int find(const char *const names[], int count, const char *name)
{
	int at = 0;
	while (at < count && strcmp(names[at], name) != 0) at++;
	return at;
}

bool nature_named(const char *name, enum measure_nature *nature)
{
	int at = find(natures, MEASURE_NATURES, name);
	*nature = (enum measure_nature)at;
	return at < MEASURE_NATURES;
}

bool worse_named(const char *name, enum measure_worse *worse)
{
	int at = find(ways, 3, name);
	*worse = (enum measure_worse)at;
	return at < 3;
}

const char *measurement_text(const struct measurement *measured, char text[MEASUREMENT_TEXT])
{
	switch (measured->nature) {
	case MEASURE_WORD:
		snprintf(text, MEASUREMENT_TEXT, "%s", measured->word);
		break;
	case MEASURE_PROPORTION:
		snprintf(text, MEASUREMENT_TEXT, "%.4g (%.0f of %.0f; 95 %%: %.4g to %.4g)", measured->value, measured->hits,
				 measured->exposure, measured->low, measured->high);
		break;
	case MEASURE_RATE:
		snprintf(text, MEASUREMENT_TEXT, "%.4g (%.0f; 95 %%: %.4g to %.4g)", measured->value, measured->hits,
				 measured->low, measured->high);
		break;
	default:
		snprintf(text, MEASUREMENT_TEXT, "%.4g (median of %" PRIu64 "; quartiles %.4g to %.4g)", measured->value,
				 measured->count, measured->low, measured->high);
	}
	return text;
}
