/* What was found out about the states of pairs, for people and as JSON. */
#include "command/outcome.h"

#include "command/outcome_states.h"
#include "measure/interval.h"

void states_print(const struct states_outcome *states)
{
	const struct inconsistency *inconsistency = &states->inconsistency;
	const struct misreading *misreading = &states->misreading;
	char text[200];
	printf("%-14s  positions contradict the tracked state, per event (95 %%):\n", "states");
	for (int kind = 0; kind < INCONSISTENCIES; kind++) {
		uint64_t count = inconsistency->count[kind], events = inconsistency->events;
		struct interval interval = interval_of_rate(count, (double)events);
		printf("  %-12s  %llu of %llu, %.3g (%.3g to %.3g): %s\n", inconsistency_name(kind), (unsigned long long)count,
			   (unsigned long long)events, events ? (double)count / (double)events : 0, interval.low, interval.high,
			   inconsistency_about(kind));
	}
	if (misreading->exhausted) printf("%-14s  memory ran out\n", "watcher");
	printf("%-14s  %llu states read otherwise right after the pair's event; first: %s\n", "repeated",
		   (unsigned long long)misreading->repeats, misreading_tell(&misreading->repeated, text));
	printf("%-14s  %llu when a third particle met one of the pair; first: %s\n", "missed",
		   (unsigned long long)misreading->misses, misreading_tell(&misreading->missed, text));
	printf("%-14s  %s\n", "stuck", misreading_tell(&misreading->stuck, text));
	printf("%-14s  %g of potential energy out of nothing\n", "", misreading->energy);
}

static json_t *misread_json(const struct misread_pair *pair)
{
	if (!pair->event) return json_null();
	return json_pack("{s:I, s:f, s:s, s:[i, i], s:o, s:i, s:i}", "event", (json_int_t)pair->event, "time", pair->time,
					 "kind", misreading_event(pair->kind), "pair", (int)pair->first, (int)pair->second, "third",
					 pair->third == UINT32_MAX ? json_null() : json_integer(pair->third), "was", pair->was, "read",
					 pair->read);
}

json_t *states_json(const struct states_outcome *states)
{
	const struct inconsistency *inconsistency = &states->inconsistency;
	const struct misreading *misreading = &states->misreading;
	double events = (double)inconsistency->events;
	json_t *json = json_pack("{s:I}", "tests", (json_int_t)states->listener.tests);
	for (int kind = 0; kind < INCONSISTENCIES; kind++) {
		uint64_t count = inconsistency->count[kind];
		struct interval interval = interval_of_rate(count, events);
		json_t *rate =
			events > 0 ? json_pack("[f, f, f]", (double)count / events, interval.low, interval.high) : json_null();
		json_object_set_new(json, inconsistency_name(kind),
							json_pack("{s:I, s:o}", "count", (json_int_t)count, "per_event", rate));
	}
	json_object_set_new(json, "repeats", json_integer((json_int_t)misreading->repeats));
	json_object_set_new(json, "misses", json_integer((json_int_t)misreading->misses));
	json_object_set_new(json, "energy", json_real(misreading->energy));
	json_object_set_new(json, "repeated", misread_json(&misreading->repeated));
	json_object_set_new(json, "missed", misread_json(&misreading->missed));
	json_object_set_new(json, "stuck", misread_json(&misreading->stuck));
	return json;
}
