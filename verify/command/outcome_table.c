/* Outcomes as a short table for people. */
#include "command/outcome.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "command/outcome_states.h"
#include "measure/interval.h"

void outcome_row(const char *what, const char *format, ...)
{
	va_list arguments;
	va_start(arguments, format);
	printf("%-14s  ", what);
	vprintf(format, arguments);
	va_end(arguments);
	putchar('\n');
}

static double collisions_per_second(const struct outcome *outcome)
{
	return outcome->wall_seconds > 0 ? (double)outcome->status.collisions / outcome->wall_seconds : 0;
}

static bool has_steps(const struct touchstone_status *status)
{
	return status->captures + status->bounces + status->captured > 0;
}

static void print_fluxes(const struct outcome *outcome)
{
	for (size_t w = 0; w < outcome->virtual_wall_count; w++) {
		const struct touchstone_flux *with = outcome->fluxes[w], *against = &outcome->fluxes[w][1];
		char name[40];
		snprintf(name, sizeof name, "virtual wall %zu", w + 1);
		outcome_row(name, "passed %llu times with its normal: mass %g, momentum (%g, %g, %g), energy %g",
					(unsigned long long)with->count, with->mass, with->momentum[0], with->momentum[1],
					with->momentum[2], with->energy);
		outcome_row("", "and %llu times against it: mass %g, momentum (%g, %g, %g), energy %g",
					(unsigned long long)against->count, against->mass, against->momentum[0], against->momentum[1],
					against->momentum[2], against->energy);
	}
}

/* What heat did to the energy, where there is any. */
static void print_heat(const struct outcome *outcome)
{
	const struct touchstone_status *status = &outcome->status;
	if (status->kicked_energy != 0) outcome_row("kicks", "brought in an energy of %.9g", status->kicked_energy);
	if (status->thermostat_energy != 0)
		outcome_row("thermal walls", "brought in an energy of %.9g", status->thermostat_energy);
}

static void print_one(const struct outcome *outcome)
{
	const struct touchstone_status *status = &outcome->status;
	outcome_row("seed", "%llu", (unsigned long long)outcome->seed);
	outcome_row("events", "%llu, of which %llu between particles", (unsigned long long)status->events,
				(unsigned long long)status->collisions);
	if (has_steps(status))
		outcome_row("", "%llu captures, %llu releases, %llu bounces; %llu pairs captured at the end",
					(unsigned long long)status->captures, (unsigned long long)status->releases,
					(unsigned long long)status->bounces, (unsigned long long)status->captured);
	outcome_row("time", "%.17g", status->time);
	if (outcome->time_begun > 0) outcome_row("", "of which %.17g for equilibration", outcome->time_begun);
	outcome_row("verdict", "%s%s%s", outcome_verdict(outcome), status->reason[0] ? ": " : "", status->reason);
	outcome_row("digest", "%016llx", (unsigned long long)status->digest);
	print_fluxes(outcome);
	if (outcome->resumed) outcome_row("resumed", "after %llu events", (unsigned long long)outcome->resumed_from);
	if (outcome->checkpoints)
		outcome_row("checkpoints", "%llu, in %.3g s", (unsigned long long)outcome->checkpoints,
					outcome->checkpoint_seconds);
	print_heat(outcome);
	if (has_steps(status))
		outcome_row("wall time", "%.3g s, %.4g events per second", outcome->wall_seconds,
					(double)status->events / outcome->wall_seconds);
	else
		outcome_row("wall time", "%.3g s, %.4g collisions per second", outcome->wall_seconds,
					collisions_per_second(outcome));
}

static void print_each(const struct outcome *outcomes, size_t count)
{
	printf("\n%20s  %12s  %12s  %12s  %-11s  %-16s  %8s  %12s\n", "seed", "events", "collisions", "time", "verdict",
		   "digest", "wall / s", "collisions/s");
	for (size_t o = 0; o < count; o++) {
		const struct touchstone_status *status = &outcomes[o].status;
		printf("%20llu  %12llu  %12llu  %12.6g  %-11s  %016llx  %8.3f  %12.4g\n", (unsigned long long)outcomes[o].seed,
			   (unsigned long long)status->events, (unsigned long long)status->collisions, status->time,
			   outcome_verdict(&outcomes[o]), (unsigned long long)status->digest, outcomes[o].wall_seconds,
			   collisions_per_second(&outcomes[o]));
	}
	for (size_t o = 0; o < count; o++)
		if (outcomes[o].status.reason[0])
			printf("seed %llu: %s\n", (unsigned long long)outcomes[o].seed, outcomes[o].status.reason);
	putchar('\n');
}

static void print_histogram(const char *what, const struct impact_histogram *histogram, uint64_t count)
{
	struct interval interval = interval_of_proportion(histogram->below, count);
	outcome_row(what,
				"%.4f %% below contact (95 %%: %.4f to %.4f), mean %.4g ulp, deviation %.4g ulp, %.4g to %.4g ulp",
				100 * (double)histogram->below / (double)count, 100 * interval.low, 100 * interval.high,
				impact_mean(histogram, count), impact_deviation(histogram, count), histogram->least, histogram->most);
}

/* A relative change, and what that makes in 10^6 collisions; where either makes no sense it is left out. */
static void print_drift(const char *what, double drift, double collisions)
{
	if (!isfinite(drift))
		outcome_row(what, "at rest at first, so no relative change");
	else if (collisions > 0)
		outcome_row(what, "relative change %.3g, %.3g in 10^6 collisions", drift, drift / collisions * 1e6);
	else
		outcome_row(what, "relative change %.3g", drift);
}

static void print_conservation(const struct run_plan *plan, const struct outcome *outcome)
{
	const struct conservation *begin = &outcome->conserved[0], *end = &outcome->conserved[1];
	double collisions = (double)outcome->status.collisions;
	const struct scene_recipe *recipe = &plan->file->recipe;
	bool pushed = recipe->wall_count > 0;
	for (int axis = 0; axis < 3; axis++) pushed |= recipe->boundary[axis] == SCENE_WALLS || recipe->acceleration[axis];
	outcome_row("energy", "%.17g at first, %.17g at last", begin->energy[0], end->energy[0]);
	print_drift("", conservation_energy_drift(begin, end), collisions);
	double brought = outcome->status.kicked_energy + outcome->status.thermostat_energy;
	if (brought != 0)
		outcome_row("", "kicks and thermal walls brought in %.9g, so that restitution took %.9g", brought,
					brought - (end->energy[0] - begin->energy[0]));
	print_drift("momentum", conservation_momentum_drift(begin, end), collisions);
	if (pushed) outcome_row("", "walls and gravity change it");
}

static void print_three_body(const struct three_body *three_body)
{
	struct interval events, encounters;
	double rate = three_body_rate(three_body, &events);
	double encounter_rate = three_body_encounter_rate(three_body, &encounters);
	outcome_row("three-body", "%llu of %llu contacts: %.3g per contact (95 %%: %.3g to %.3g)",
				(unsigned long long)three_body->events, (unsigned long long)three_body->contacts, rate, events.low,
				events.high);
	outcome_row("", "in %llu encounters: %.3g per contact (95 %%: %.3g to %.3g)",
				(unsigned long long)three_body->encounters, encounter_rate, encounters.low, encounters.high);
}

static void print_measures(const struct run_plan *plan, const struct outcome *outcomes, size_t count)
{
	struct impact *impact = outcome_impact(outcomes, count);
	if (impact && impact->count > 0) {
		outcome_row("impacts", "%llu, by their distance", (unsigned long long)impact->count);
		print_histogram("  as computed", &impact->measured, impact->count);
		print_histogram("  exactly", &impact->exact, impact->count);
	}
	free(impact);
	struct three_body three_body;
	if (outcome_three_body(outcomes, count, &three_body) && three_body.contacts > 0) print_three_body(&three_body);
	for (size_t o = 0; o < count; o++) {
		if ((outcomes[o].conservation || outcomes[o].states) && count > 1)
			outcome_row("seed", "%llu", (unsigned long long)outcomes[o].seed);
		if (outcomes[o].conservation) print_conservation(plan, &outcomes[o]);
		if (outcomes[o].states) states_print(outcomes[o].states);
	}
}

void outcome_print(const struct run_plan *plan, const struct outcome *outcomes, size_t count)
{
	const struct scene_file *file = plan->file;
	outcome_row("scene", "%s: %s", file->name, file->title);
	outcome_row("particles", "%zu in %d dimension%s", outcomes->particles, file->recipe.dimensions,
				file->recipe.dimensions > 1 ? "s" : "");
	if (outcomes->particles < file->recipe.particle_count)
		outcome_row("", "of %zu asked for: no more found room within the packing limit of %g",
					file->recipe.particle_count, file->recipe.packing_limit);
	outcome_row("arithmetic", "%s", file->arithmetic);
	outcome_row("method", "%s", file->method);
	if (count == 1)
		print_one(outcomes);
	else
		print_each(outcomes, count);
	outcome_print_events(plan, outcomes, count);
	if (plan->against) outcome_print_horizon(plan, outcomes, count);
	print_measures(plan, outcomes, count);
	outcome_row("memory", "%.0f bytes per particle, %.1f MB at most in all",
				(double)outcomes->status.memory / (double)outcomes->particles, (double)outcome_peak_memory() / 1e6);
}
