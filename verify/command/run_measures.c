#include "command/run_measures.h"

#include <stdio.h>
#include <string.h>

const struct run_measure_entry run_measures[] = {
	{"impact", RUN_IMPACT, "separation at each contact, as computed and exactly"},
	{"conservation", RUN_CONSERVATION, "energy and momentum, at first and at last"},
	{"three-body", RUN_THREE_BODY, "contacts after which a particle overlaps its partner and a third"},
	{"failure", RUN_FAILURE, "a second run, watched for what goes wrong first, as in the failure atlas"},
	{"states", RUN_STATES,
	 "pairs whose positions contradict their tracked state, and whether the method is misled by them"},
	{0}};

unsigned run_measure_named(const char *name)
{
	for (const struct run_measure_entry *entry = run_measures; entry->name; entry++)
		if (strcmp(entry->name, name) == 0) return entry->measure;
	return 0;
}

const char *run_measure_names(char names[RUN_MEASURE_NAMES])
{
	size_t length = 0;
	for (const struct run_measure_entry *entry = run_measures; entry->name && length < RUN_MEASURE_NAMES; entry++)
		length += (size_t)snprintf(names + length, RUN_MEASURE_NAMES - length, "%s%s", length ? ", " : "", entry->name);
	return names;
}
