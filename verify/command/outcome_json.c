/* Outcomes as JSON, in the form that outcome.h describes. */
#include "command/outcome.h"

#include <math.h>
#include <stdlib.h>

#include "command/command.h"
#include "command/outcome_states.h"
#include "measure/interval.h"
#include "provenance.h"

static json_t *number(double value)
{
	return isfinite(value) ? json_real(value) : json_null();
}

static json_t *whole(uint64_t value)
{
	return json_integer((json_int_t)value);
}

static json_t *hexadecimal(uint64_t value)
{
	char text[17];
	snprintf(text, sizeof text, "%016llx", (unsigned long long)value);
	return json_string(text);
}

static json_t *numbers(const double *values, int count)
{
	json_t *list = json_array();
	for (int i = 0; i < count; i++) json_array_append_new(list, number(values[i]));
	return list;
}

/* Bars between the outermost that are not empty, the first and the last of all standing for whatever lies beyond. */
static json_t *histogram_json(const struct impact_histogram *histogram, uint64_t count)
{
	int first = 0, last = 2 * IMPACT_REACH;
	while (first < last && !histogram->bar[first]) first++;
	while (last > first && !histogram->bar[last]) last--;
	json_t *bars = json_array();
	for (int bar = first; bar <= last && count > 0; bar++) json_array_append_new(bars, whole(histogram->bar[bar]));
	struct interval interval = interval_of_proportion(histogram->below, count);
	json_t *json = json_object();
	json_object_set_new(json, "below", whole(histogram->below));
	json_object_set_new(json, "above", whole(histogram->above));
	json_object_set_new(json, "fraction_below", number((double)histogram->below / (double)count));
	json_object_set_new(json, "fraction_below_interval", numbers((double[]){interval.low, interval.high}, 2));
	json_object_set_new(json, "mean_ulp", number(impact_mean(histogram, count)));
	json_object_set_new(json, "deviation_ulp", number(impact_deviation(histogram, count)));
	json_object_set_new(json, "least_ulp", number(histogram->least));
	json_object_set_new(json, "most_ulp", number(histogram->most));
	json_object_set_new(json, "first_bar", json_integer(first - IMPACT_REACH));
	json_object_set_new(json, "bars", bars);
	return json;
}

static json_t *impact_json(const struct impact *impact)
{
	json_t *json = json_object();
	json_object_set_new(json, "contacts", whole(impact->count));
	json_object_set_new(json, "measured", histogram_json(&impact->measured, impact->count));
	json_object_set_new(json, "exact", histogram_json(&impact->exact, impact->count));
	return json;
}

static json_t *three_body_json(const struct three_body *three_body)
{
	struct interval events, encounters;
	double rate = three_body_rate(three_body, &events);
	double encounter_rate = three_body_encounter_rate(three_body, &encounters);
	json_t *json = json_object();
	json_object_set_new(json, "contacts", whole(three_body->contacts));
	json_object_set_new(json, "overlapping", whole(three_body->overlapping));
	json_object_set_new(json, "events", whole(three_body->events));
	json_object_set_new(json, "rate", number(rate));
	json_object_set_new(json, "rate_interval", numbers((double[]){events.low, events.high}, 2));
	json_object_set_new(json, "encounters", whole(three_body->encounters));
	json_object_set_new(json, "encounter_rate", number(encounter_rate));
	json_object_set_new(json, "encounter_rate_interval", numbers((double[]){encounters.low, encounters.high}, 2));
	return json;
}

static json_t *conservation_json(const struct outcome *outcome)
{
	const struct conservation *begin = &outcome->conserved[0], *end = &outcome->conserved[1];
	double energy = conservation_energy_drift(begin, end), momentum = conservation_momentum_drift(begin, end);
	double millions = (double)outcome->status.collisions / 1e6;
	const double begun[3] = {begin->momentum[0][0], begin->momentum[1][0], begin->momentum[2][0]};
	const double ended[3] = {end->momentum[0][0], end->momentum[1][0], end->momentum[2][0]};
	json_t *json = json_object();
	json_object_set_new(json, "energy", numbers((double[]){begin->energy[0], end->energy[0]}, 2));
	json_object_set_new(json, "momentum", json_pack("[o, o]", numbers(begun, 3), numbers(ended, 3)));
	json_object_set_new(json, "energy_scale", number(begin->energy_scale));
	json_object_set_new(json, "momentum_scale", number(begin->momentum_scale));
	json_object_set_new(json, "energy_drift", number(energy));
	json_object_set_new(json, "momentum_drift", number(momentum));
	json_object_set_new(json, "energy_drift_per_million", number(energy / millions));
	json_object_set_new(json, "momentum_drift_per_million", number(momentum / millions));
	return json;
}

static json_t *flux_json(const struct touchstone_flux *flux)
{
	return json_pack("{s:o, s:o, s:o, s:o}", "count", whole(flux->count), "mass", number(flux->mass), "momentum",
					 numbers(flux->momentum, 3), "energy", number(flux->energy));
}

static json_t *fluxes_json(const struct outcome *outcome)
{
	json_t *list = json_array();
	for (size_t w = 0; w < outcome->virtual_wall_count; w++)
		json_array_append_new(
			list, json_pack("[o, o]", flux_json(&outcome->fluxes[w][0]), flux_json(&outcome->fluxes[w][1])));
	return list;
}

static void set_run(json_t *json, const struct run_plan *plan, const struct outcome *outcome)
{
	const struct touchstone_status *status = &outcome->status;
	json_object_set_new(json, "seed", whole(outcome->seed));
	json_object_set_new(json, "events", whole(status->events));
	json_object_set_new(json, "collisions", whole(status->collisions));
	json_object_set_new(json, "captures", whole(status->captures));
	json_object_set_new(json, "releases", whole(status->releases));
	json_object_set_new(json, "bounces", whole(status->bounces));
	json_object_set_new(json, "crossings", whole(status->crossings));
	json_object_set_new(json, "captured_pairs", whole(status->captured));
	json_object_set_new(json, "potential_energy", number(status->potential_energy));
	json_object_set_new(json, "kicked_energy", number(status->kicked_energy));
	json_object_set_new(json, "thermostat_energy", number(status->thermostat_energy));
	json_object_set_new(json, "lookups", whole(status->lookups));
	json_object_set_new(json, "time_begun", number(outcome->time_begun));
	json_object_set_new(json, "time", number(status->time));
	json_object_set_new(json, "verdict", json_string(outcome_verdict(outcome)));
	json_object_set_new(json, "reason", json_string(status->reason));
	json_object_set_new(json, "complete", json_boolean(!outcome->interrupted));
	json_object_set_new(json, "digest", hexadecimal(status->digest));
	json_object_set_new(json, "wall_seconds", number(outcome->wall_seconds));
	json_object_set_new(json, "resumed_from", outcome->resumed ? whole(outcome->resumed_from) : json_null());
	json_object_set_new(json, "checkpoints", whole(outcome->checkpoints));
	json_object_set_new(json, "checkpoint_seconds", number(outcome->checkpoint_seconds));
	json_object_set_new(json, "events_per_second", number((double)status->events / outcome->wall_seconds));
	json_object_set_new(json, "collisions_per_second", number((double)status->collisions / outcome->wall_seconds));
	json_object_set_new(json, "bytes_per_particle", number((double)status->memory / (double)outcome->particles));
	json_object_set_new(json, "state_bytes_per_particle",
						number((double)status->state_memory / (double)outcome->particles));
	if (outcome->virtual_wall_count) json_object_set_new(json, "fluxes", fluxes_json(outcome));
	if (outcome->conservation) json_object_set_new(json, "conservation", conservation_json(outcome));
	if (outcome->three_bodies) json_object_set_new(json, "three_body", three_body_json(&outcome->three_body));
	if (plan->against) outcome_set_horizon(json, plan, outcome);
	if (outcome->impact) json_object_set_new(json, "impact", impact_json(outcome->impact));
	if (outcome->states) json_object_set_new(json, "states", states_json(outcome->states));
}

static json_t *together_json(const struct outcome *outcomes, size_t count)
{
	uint64_t events = 0, collisions = 0;
	for (size_t o = 0; o < count; o++) {
		events += outcomes[o].status.events;
		collisions += outcomes[o].status.collisions;
	}
	json_t *json = json_object();
	json_object_set_new(json, "events", whole(events));
	json_object_set_new(json, "collisions", whole(collisions));
	struct three_body three_body;
	if (outcome_three_body(outcomes, count, &three_body))
		json_object_set_new(json, "three_body", three_body_json(&three_body));
	struct impact *impact = outcome_impact(outcomes, count);
	if (impact) json_object_set_new(json, "impact", impact_json(impact));
	free(impact);
	return json;
}

json_t *outcome_json(const struct run_plan *plan, const struct outcome *outcomes, size_t count, json_t *explained)
{
	const struct scene_file *file = plan->file;
	json_t *settings = json_array(), *json = json_object();
	for (size_t s = 0; s < plan->setting_count; s++) json_array_append_new(settings, json_string(plan->settings[s]));
	json_object_set_new(json, "scene", json_string(file->name));
	json_object_set_new(json, "title", json_string(file->title));
	json_object_set_new(json, "file", json_string(plan->path));
	json_object_set_new(json, "settings", settings);
	json_object_set_new(json, "particles", whole(outcomes->particles));
	json_object_set_new(json, "dimensions", json_integer(file->recipe.dimensions));
	json_object_set_new(json, "arithmetic", json_string(file->arithmetic));
	json_object_set_new(json, "bits", json_integer(arithmetic_bits(file->arithmetic)));
	json_object_set_new(json, "method", json_string(file->method));
	set_run(json, plan, outcomes);
	outcome_set_events(json, plan, outcomes);
	json_object_set_new(json, "peak_memory_bytes", whole(outcome_peak_memory()));
	json_object_set_new(json, "machine", provenance());
	if (explained) json_object_set(json, "explained", explained);
	if (count == 1) return json;
	json_t *runs = json_array();
	for (size_t o = 0; o < count; o++) {
		json_t *run = json_object();
		set_run(run, plan, &outcomes[o]);
		outcome_set_events(run, plan, &outcomes[o]);
		json_array_append_new(runs, run);
	}
	json_object_set_new(json, "runs", runs);
	json_object_set_new(json, "together", together_json(outcomes, count));
	if (plan->against)
		json_object_set_new(json_object_get(json, "together"), "horizon", outcome_horizons(outcomes, count));
	return json;
}
