#include "audit/quantity.h"

#include <stdio.h>
#include <string.h>

const struct quantity_entry audit_quantities[QUANTITIES_OF_AUDITS] = {
	[SCENE_DIGEST] = {"digest", CHECK_SCENE, MEASURE_WORD, WORSE_EITHER, "", "of all events, over all seeds"},
	[SCENE_VERDICT] = {"verdict", CHECK_SCENE, MEASURE_WORD, WORSE_EITHER, "", "of all runs"},
	[SCENE_BELOW_CONTACT] = {"below_contact", CHECK_SCENE, MEASURE_PROPORTION, WORSE_EITHER, "of contacts",
							 "contacts that are truly below the contact distance"},
	[SCENE_SEPARATION_SPREAD] = {"separation_spread", CHECK_SCENE, MEASURE_SAMPLE, WORSE_MORE, "ulp",
								 "standard deviation of the true separation at impact"},
	[SCENE_DEEPEST] = {"deepest_overlap", CHECK_SCENE, MEASURE_SAMPLE, WORSE_MORE, "ulp",
					   "how far below contact the deepest impact truly is"},
	[SCENE_ENERGY_DRIFT] = {"energy_drift", CHECK_SCENE, MEASURE_SAMPLE, WORSE_MORE, "of the energy",
							"size of the energy's change"},
	[SCENE_MOMENTUM_DRIFT] = {"momentum_drift", CHECK_SCENE, MEASURE_SAMPLE, WORSE_MORE, "of the momenta",
							  "size of the momentum's change"},
	[SCENE_EVENT_TIME] = {"nanoseconds_per_event", CHECK_SCENE, MEASURE_TIMING, WORSE_MORE, "ns",
						  "wall time of an event"},
	[SCENE_COLLISION_SPEED] = {"collisions_per_second", CHECK_SCENE, MEASURE_TIMING, WORSE_LESS, "per second",
							   "collisions in a second of wall time"},
	[SCENE_MEMORY] = {"bytes_per_particle", CHECK_SCENE, MEASURE_SAMPLE, WORSE_MORE, "bytes", "memory of the engine"},
	[GRADE_MISSED] = {"missed", CHECK_GRADE, MEASURE_PROPORTION, WORSE_MORE, "of questions",
					  "events that were not found"},
	[GRADE_PHANTOM] = {"phantom", CHECK_GRADE, MEASURE_PROPORTION, WORSE_MORE, "of questions",
					   "events found where there is none"},
	[GRADE_NEGATIVE] = {"negative", CHECK_GRADE, MEASURE_PROPORTION, WORSE_MORE, "of questions", "times before now"},
	[GRADE_NAN] = {"nan", CHECK_GRADE, MEASURE_PROPORTION, WORSE_MORE, "of questions", "answers that are no number"},
	[GRADE_MISORDERED] = {"misordered", CHECK_GRADE, MEASURE_PROPORTION, WORSE_MORE, "of pairs",
						  "pairs of questions whose answers are in the wrong order"},
	[GRADE_BROKEN] = {"broken", CHECK_GRADE, MEASURE_PROPORTION, WORSE_MORE, "of questions",
					  "answers that do not keep the bound the finder's file claims"},
	[GRADE_MEDIAN_ULP] = {"median_ulp", CHECK_GRADE, MEASURE_SAMPLE, WORSE_MORE, "ulp", "median error of a time"},
	[GRADE_LARGEST_ULP] = {"largest_ulp", CHECK_GRADE, MEASURE_SAMPLE, WORSE_MORE, "ulp", "largest error of a time"},
	[GRADE_CALL_TIME] = {"nanoseconds_per_call", CHECK_GRADE, MEASURE_TIMING, WORSE_MORE, "ns",
						 "wall time of an answer"},
	[FIGURE_DIFFERS] = {"differs", CHECK_FIGURE, MEASURE_PROPORTION, WORSE_MORE, "of claims",
						"claims that differ from the paper"},
	[FIGURE_VERDICT] = {"agreement", CHECK_FIGURE, MEASURE_WORD, WORSE_EITHER, "",
						"whether a claim agrees with the paper"},
	[FIGURE_PROPORTION] = {"proportion", CHECK_FIGURE, MEASURE_PROPORTION, WORSE_EITHER, "",
						   "what was measured for a claim that is a proportion"},
	[FIGURE_VALUE] = {"value", CHECK_FIGURE, MEASURE_SAMPLE, WORSE_EITHER, "", "what was measured for a claim"},
};

const struct quantity_entry *audit_quantity_named(enum check_kind kind, const char *name)
{
	for (int q = 0; q < QUANTITIES_OF_AUDITS; q++)
		if (audit_quantities[q].kind == kind && strcmp(audit_quantities[q].name, name) == 0)
			return &audit_quantities[q];
	return NULL;
}

const char *audit_quantity_names(enum check_kind kind, char names[QUANTITY_NAMES])
{
	size_t length = 0;
	names[0] = '\0';
	for (int q = 0; q < QUANTITIES_OF_AUDITS; q++)
		if (audit_quantities[q].kind == kind && length < QUANTITY_NAMES)
			length += (size_t)snprintf(names + length, QUANTITY_NAMES - length, "%s%s", length ? ", " : "",
									   audit_quantities[q].name);
	return names;
}
