/* For how long a run can be trusted, as outcomes tell it. */
#include "command/outcome.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

static const char *const kinds[] = {
	[TOUCHSTONE_CONTACT] = "contact", [TOUCHSTONE_WALL] = "wall",     [TOUCHSTONE_CAPTURE] = "capture",
	[TOUCHSTONE_RELEASE] = "release", [TOUCHSTONE_BOUNCE] = "bounce", [TOUCHSTONE_CROSSING] = "crossing",
};

/* ---- for people */

/* An event in words: "a contact of 3 and 7 at t = 0.25". */
static const char *in_words(char text[120], const struct horizon_event *event, double time, bool ends)
{
	if (ends)
		snprintf(text, 120, "no event left");
	else if (event->kind == TOUCHSTONE_WALL)
		snprintf(text, 120, "%u at wall %u at t = %.17g", event->first, event->second, time);
	else
		snprintf(text, 120, "a %s of %u and %u at t = %.17g", kinds[event->kind], event->first, event->second, time);
	return text;
}

static void print_one(const struct run_plan *plan, const struct horizon *horizon)
{
	unsigned long long events = horizon->events;
	if (horizon->differ) {
		char here[120], there[120];
		outcome_row("trust", "this run for %.4g events per particle: its first %llu events, until t = %.17g",
					horizon->per_particle, events, horizon->time);
		outcome_row("", "then it has %s;", in_words(here, &horizon->here, horizon->here_time, horizon->here_ends));
		outcome_row("", "%s has %s", plan->against,
					in_words(there, &horizon->there, horizon->there_time, horizon->there_ends));
	} else if (horizon->stopped) {
		outcome_row("trust", "this run for %.4g events per particle or more: so far %llu events are those of %s",
					horizon->per_particle, events, plan->against);
	} else {
		outcome_row("trust", "all of this run, %.4g events per particle: its %llu events are those of %s",
					horizon->per_particle, events, plan->against);
	}
}

/* Their horizons in a row, of those that were compared to the end; the caller frees them. */
static struct horizon *gather(const struct outcome *outcomes, size_t count, size_t *found)
{
	struct horizon *horizons = calloc(count, sizeof *horizons);
	*found = 0;
	for (size_t o = 0; horizons && o < count; o++)
		if (outcomes[o].compared && !outcomes[o].horizon.stopped) horizons[(*found)++] = outcomes[o].horizon;
	return horizons;
}

static double least(const struct horizon *horizons, size_t count)
{
	double least = INFINITY;
	for (size_t h = 0; h < count; h++) least = fmin(least, horizons[h].per_particle);
	return least;
}

void outcome_print_horizon(const struct run_plan *plan, const struct outcome *outcomes, size_t count)
{
	if (count == 1) {
		if (outcomes->compared) print_one(plan, &outcomes->horizon);
		return;
	}
	size_t found;
	struct horizon *horizons = gather(outcomes, count, &found);
	struct horizon_spread spread = horizon_spread(horizons, found);
	if (found > 1)
		outcome_row("trust",
					"these runs for %.4g events per particle: mean of %zu, standard deviation %.3g, the shortest %.4g",
					spread.mean, found, spread.deviation, least(horizons, found));
	if (spread.open)
		outcome_row("", "%zu of them never parted from %s, so that the mean is too low", spread.open, plan->against);
	free(horizons);
}

/* ---- for programs */

static json_t *event_json(const struct horizon_event *event, double time, bool ends)
{
	if (ends) return json_null();
	if (event->kind == TOUCHSTONE_WALL)
		return json_pack("{s:s, s:i, s:i, s:f}", "kind", kinds[event->kind], "particle", (int)event->first, "wall",
						 (int)event->second, "time", time);
	return json_pack("{s:s, s:[i, i], s:f}", "kind", kinds[event->kind], "particles", (int)event->first,
					 (int)event->second, "time", time);
}

void outcome_set_horizon(json_t *run, const struct run_plan *plan, const struct outcome *outcome)
{
	const struct horizon *horizon = &outcome->horizon;
	json_object_set_new(run, "against", json_string(plan->against));
	json_object_set_new(run, "horizon", outcome->compared ? json_real(horizon->per_particle) : json_null());
	if (!outcome->compared) return;
	json_object_set_new(run, "horizon_events", json_integer((json_int_t)horizon->events));
	json_object_set_new(run, "horizon_time", json_real(horizon->time));
	json_object_set_new(run, "horizon_differs", json_boolean(horizon->differ));
	if (!horizon->differ) return;
	json_object_set_new(run, "parting",
						json_pack("{s:o, s:o}", "here",
								  event_json(&horizon->here, horizon->here_time, horizon->here_ends), "there",
								  event_json(&horizon->there, horizon->there_time, horizon->there_ends)));
}

static json_t *number(double value)
{
	return isfinite(value) ? json_real(value) : json_null();
}

json_t *outcome_horizons(const struct outcome *outcomes, size_t count)
{
	size_t found;
	struct horizon *horizons = gather(outcomes, count, &found);
	struct horizon_spread spread = horizon_spread(horizons, found);
	json_t *json = json_pack("{s:I, s:o, s:o, s:o, s:I}", "count", (json_int_t)spread.count, "mean",
							 number(spread.mean), "deviation", number(spread.deviation), "least",
							 number(least(horizons, found)), "open", (json_int_t)spread.open);
	free(horizons);
	return json;
}
