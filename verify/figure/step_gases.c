#include "figure/step_gases.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "figure/figure_campaign.h"

struct gases {
	const char *name;
	const struct figure_setup *setup;
	const struct step_gas *gas;
};

static void piece_key(void *context, size_t piece, char key[CAMPAIGN_KEY])
{
	const struct gases *gases = context;
	step_gas_key(&gases->gas[piece], gases->setup->seed, key);
}

/* In wells clusters grow, whose particles have many partners to be asked. */
static double piece_cost(void *context, size_t piece)
{
	const struct step_gas *gas = &((const struct gases *)context)->gas[piece];
	bool software = strncmp(gas->arithmetic, "mpfr", strlen("mpfr")) == 0;
	return (double)step_gas_events(gas) * (gas->shoulder ? 1 : 2) * (software ? 10 : 1);
}

/* ------------------------------------------------------------------ outcomes as JSON */

static json_t *whole(uint64_t value)
{
	return json_integer((json_int_t)value);
}

static uint64_t count_of(const json_t *object, const char *member)
{
	return (uint64_t)json_integer_value(json_object_get(object, member));
}

static json_t *pair_json(const struct misread_pair *pair)
{
	return json_pack("{s:o, s:o, s:i, s:o, s:o, s:o, s:i, s:i}", "event", whole(pair->event), "time",
					 campaign_number(pair->time), "kind", (int)pair->kind, "first", whole(pair->first), "second",
					 whole(pair->second), "third", whole(pair->third), "was", pair->was, "read", pair->read);
}

static struct misread_pair pair_of(const json_t *object, const char *member)
{
	const json_t *pair = json_object_get(object, member);
	return (struct misread_pair){.event = count_of(pair, "event"),
								 .time = campaign_value(pair, "time"),
								 .kind = (enum touchstone_kind)count_of(pair, "kind"),
								 .first = (uint32_t)count_of(pair, "first"),
								 .second = (uint32_t)count_of(pair, "second"),
								 .third = (uint32_t)count_of(pair, "third"),
								 .was = (int)count_of(pair, "was"),
								 .read = (int)count_of(pair, "read")};
}

static json_t *outcome_json(const struct step_gas_outcome *outcome)
{
	const struct misreading *misreading = &outcome->misreading;
	const struct touchstone_status *end = &outcome->end;
	json_t *counts = json_array();
	for (int kind = 0; kind < INCONSISTENCIES; kind++)
		json_array_append_new(counts, whole(outcome->inconsistency.count[kind]));
	json_t *misread = json_pack("{s:o, s:o, s:o, s:o, s:o, s:o, s:o}", "events", whole(misreading->events), "repeats",
								whole(misreading->repeats), "misses", whole(misreading->misses), "energy",
								campaign_number(misreading->energy), "repeated", pair_json(&misreading->repeated),
								"missed", pair_json(&misreading->missed), "stuck", pair_json(&misreading->stuck));
	return json_pack("{s:o, s:o, s:o, s:o, s:o, s:o, s:i, s:o, s:{s:f}}", "counted",
					 whole(outcome->inconsistency.events), "counts", counts, "misread", misread, "events",
					 whole(end->events), "time", campaign_number(end->time), "captured", whole(end->captured),
					 "verdict", (int)end->verdict, "energy_drift", campaign_number(outcome->energy_drift), "made",
					 "seconds", outcome->seconds);
}

static struct step_gas_outcome outcome_of(const json_t *piece)
{
	const json_t *misread = json_object_get(piece, "misread"), *counts = json_object_get(piece, "counts");
	struct step_gas_outcome outcome = {
		.begun = true,
		.inconsistency.events = count_of(piece, "counted"),
		.misreading = {.events = count_of(misread, "events"),
					   .repeats = count_of(misread, "repeats"),
					   .misses = count_of(misread, "misses"),
					   .energy = campaign_value(misread, "energy"),
					   .repeated = pair_of(misread, "repeated"),
					   .missed = pair_of(misread, "missed"),
					   .stuck = pair_of(misread, "stuck")},
		.end = {.events = count_of(piece, "events"),
				.time = campaign_value(piece, "time"),
				.captured = count_of(piece, "captured"),
				.verdict = (enum touchstone_verdict)count_of(piece, "verdict")},
		.energy_drift = campaign_value(piece, "energy_drift"),
		.seconds = json_number_value(json_object_get(json_object_get(piece, "made"), "seconds")),
	};
	for (size_t kind = 0; kind < INCONSISTENCIES; kind++)
		outcome.inconsistency.count[kind] = (uint64_t)json_integer_value(json_array_get(counts, kind));
	return outcome;
}

/* ------------------------------------------------------------------ making them */

static const uint64_t long_run = 10000000; /* events: minutes */

static json_t *make_piece(void *context, size_t piece, const struct campaign_watch *watch, char error[CAMPAIGN_ERROR])
{
	const struct gases *gases = context;
	const struct step_gas *gas = &gases->gas[piece];
	struct figure_piece progress = {watch, 0, (double)step_gas_events(gas)};
	struct watch look = {watch->stop, figure_piece_report, &progress};
	struct step_gas_outcome outcome;
	char *kept = NULL;
	bool keep = gases->setup->folder && !gas->watched && gas->events >= long_run;
	if (keep && asprintf(&kept, "%s/%s-%zu.checkpoint", gases->setup->folder, gases->name, piece) < 0) kept = NULL;
	step_gas_run(gas, gases->setup->seed, kept, &look, &outcome);
	free(kept);
	snprintf(error, CAMPAIGN_ERROR, "%s", outcome.error);
	return *outcome.error || outcome.stopped ? NULL : outcome_json(&outcome);
}

bool step_gases_measure(const char *name, const struct figure_setup *setup, const struct step_gas *gas, size_t count,
						struct step_gas_outcome *outcomes, size_t *finished, char error[512])
{
	struct gases gases = {name, setup, gas};
	const struct campaign campaign = {name, count, piece_key, piece_cost, make_piece, &gases};
	json_t *results = figure_campaign_run(&campaign, setup, error);
	if (!results) return false;
	*finished = campaign_finished(results);
	for (size_t g = 0; g < count; g++) {
		const json_t *piece = json_array_get(results, g);
		outcomes[g] = json_is_object(piece) ? outcome_of(piece) : (struct step_gas_outcome){0};
	}
	json_decref(results);
	return true;
}
