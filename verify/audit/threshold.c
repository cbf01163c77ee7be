/* Thresholds: what a suite demands of a value, whatever chance may have to do with it. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "audit/audit.h"

enum { LAST_NIGHTS = 10 };

/* The median of the last good nights, and how many there were. */
static double last_good(const struct night *nights, size_t count, size_t *found)
{
	struct sample sample = {0};
	for (size_t n = count; n-- > 0 && sample.count < LAST_NIGHTS;)
		if (nights[n].good) sample_add(&sample, nights[n].measured.value);
	*found = sample.count;
	return spread_of(&sample).median;
}

static void judge_word(const struct suite_measure *asked, const struct check_value *value, char fault[AUDIT_TEXT])
{
	const char *word = value->measured.word;
	if (asked->equal && strcmp(word, asked->equal) != 0)
		snprintf(fault, AUDIT_TEXT, "%s, where %.40s is asked for", word, asked->equal);
	else if (asked->same_in && strcmp(word, value->other) != 0)
		snprintf(fault, AUDIT_TEXT, "%s, but %s in %.40s", word, value->other, asked->same_in);
}

/* Whether the value is on the right side of a limit; NaN is on none, and no limit is kept by all. */
static bool keeps(double value, double limit, bool at_most)
{
	return isnan(limit) || (at_most ? value <= limit : value >= limit);
}

bool threshold_asks(const struct suite_measure *asked)
{
	return asked->equal || asked->same_in || !isnan(asked->at_most) || !isnan(asked->at_least);
}

void threshold_judge(const struct suite_measure *asked, const struct check_value *value, const struct night *nights,
					 size_t night_count, char fault[AUDIT_TEXT])
{
	const double times[2] = {asked->at_most_times, asked->at_least_times},
				 limits[2] = {asked->at_most, asked->at_least};
	static const char *const words[2] = {"at most", "at least"};
	double found = value->measured.value;
	*fault = '\0';
	if (value->measured.nature == MEASURE_WORD) {
		judge_word(asked, value, fault);
		return;
	}
	for (int side = 0; side < 2 && !*fault; side++) {
		size_t good;
		double last = last_good(nights, night_count, &good);
		if (!keeps(found, limits[side], side == 0))
			snprintf(fault, AUDIT_TEXT, "%.4g, where %s %.4g is asked for", found, words[side], limits[side]);
		else if (good > 0 && !keeps(found, times[side] * last, side == 0))
			snprintf(fault, AUDIT_TEXT, "%.4g, where %s %.4g times %.4g is asked for, the median of %zu good nights",
					 found, words[side], times[side], last, good);
	}
}
