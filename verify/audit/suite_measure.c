/* The measures of a check, and their thresholds. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "audit/suite_source.h"

/* Thresholds fit the nature of what they are for. */
static bool understand_thresholds(const struct suite_place *place, const struct measure_words *words,
								  const struct suite_check *check, struct suite_measure *measure)
{
	struct {
		const char *key, *word;
		double *value, least;
	} const numbers[] = {
		{"at_most", words->at_most, &measure->at_most, -1e300},
		{"at_least", words->at_least, &measure->at_least, -1e300},
		{"at_most_times", words->at_most_times, &measure->at_most_times, 0},
		{"at_least_times", words->at_least_times, &measure->at_least_times, 0},
	};
	bool word = measure->quantity->nature == MEASURE_WORD;
	for (int n = 0; n < 4; n++) {
		*numbers[n].value = NAN;
		if (numbers[n].word && word)
			return suite_refuse(place, numbers[n].key, "%s is a word; accepted: equal", measure->quantity->name);
		if (!suite_number(place, numbers[n].key, numbers[n].word, numbers[n].least, 1e300, numbers[n].value))
			return false;
	}
	measure->equal = words->equal;
	measure->same_in = words->same_in;
	if (words->equal && !word)
		return suite_refuse(place, "equal",
							"%s is a number; accepted: at_most, at_least, at_most_times, at_least_times",
							measure->quantity->name);
	if (!words->same_in) return true;
	if (measure->quantity != &audit_quantities[SCENE_DIGEST])
		return suite_refuse(place, "same_in", "means nothing beside %s; accepted: for a digest",
							measure->quantity->name);
	char error[STORE_ERROR];
	struct scene_file *file = suite_scene(check, words->same_in, error);
	if (!file) return suite_refuse(place, "same_in", "%s", error);
	scene_file_close(file);
	return true;
}

static bool understand_measure(const struct suite_place *place, const struct measure_words *words,
							   const struct suite_check *check, struct suite_measure *measure)
{
	char names[QUANTITY_NAMES], shown[TEXT_SHOWN];
	measure->quantity = audit_quantity_named(check->kind, words->measure ? words->measure : "");
	if (!measure->quantity)
		return suite_refuse(place, "measure", "'%s'; accepted: %s",
							text_shown(shown, words->measure ? words->measure : ""),
							audit_quantity_names(check->kind, names));
	bool claimed = check->kind == CHECK_FIGURE && measure->quantity != &audit_quantities[FIGURE_DIFFERS];
	if (claimed != (words->claim != NULL))
		return suite_refuse(place, "claim",
							claimed ? "missing; accepted: words of a claim's quantity"
									: "means nothing here; accepted: for a claim of a figure");
	measure->claim = words->claim;
	measure->worse = words->worse ? (enum measure_worse) * words->worse : measure->quantity->worse;
	snprintf(measure->name, sizeof measure->name, "%s%s%.50s", measure->quantity->name, claimed ? ": " : "",
			 claimed ? words->claim : "");
	return understand_thresholds(place, words, check, measure);
}

bool suite_measures_understand(const struct suite_place *place, const struct check_words *words,
							   struct suite_check *check)
{
	if (!words->measures) return suite_refuse(place, "measures", "missing; accepted: a list");
	check->measures = calloc(words->measures_count, sizeof *check->measures);
	if (!check->measures) return suite_refuse(place, "", "out of memory");
	check->measure_count = words->measures_count;
	for (unsigned m = 0; m < words->measures_count; m++) {
		struct suite_place inner = *place;
		snprintf(inner.path, sizeof inner.path, "%.60s.measures[%u]", place->path, m);
		if (!understand_measure(&inner, &words->measures[m], check, &check->measures[m])) return false;
		for (unsigned before = 0; before < m; before++)
			if (strcmp(check->measures[before].name, check->measures[m].name) == 0)
				return suite_refuse(&inner, "measure", "'%s' is measured already; accepted: once",
									check->measures[m].name);
	}
	return true;
}
