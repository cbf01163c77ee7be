#include "measure/horizon.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { SLICE = 256 }; /* events that each runs ahead of the other */

/* One of the two, with the events of the slice at hand. */
struct runner {
	struct touchstone_engine *engine;
	struct horizon_event event[SLICE];
	double time[SLICE];
	size_t count;
};

static void see(void *context, struct touchstone_engine *engine, const struct touchstone_event *event)
{
	(void)engine;
	struct runner *runner = context;
	runner->time[runner->count] = event->time;
	runner->event[runner->count++] = (struct horizon_event){event->kind, event->first, event->second};
}

static void run_slice(struct runner *runner, uint64_t most, const struct touchstone_limits *limits,
					  const struct watch *watch)
{
	const struct touchstone_observer observer = {see, runner};
	const struct touchstone_limits slice = {most, limits->time, watch ? watch->stop : NULL};
	runner->count = 0;
	touchstone_run(runner->engine, &slice, &observer);
}

static bool same(const struct horizon_event *one, const struct horizon_event *other)
{
	return one->kind == other->kind && one->first == other->first && one->second == other->second;
}

/* Takes over the events that both have in common; true when the sequences go on alike. */
static bool agree(struct horizon *horizon, const struct runner *here, const struct runner *there, uint32_t particles)
{
	size_t most = here->count < there->count ? here->count : there->count, k = 0;
	for (; k < most && same(&here->event[k], &there->event[k]); k++) {
		horizon->events++;
		horizon->per_particle += (here->event[k].kind == TOUCHSTONE_WALL ? 1.0 : 2.0) / particles;
		horizon->time = there->time[k];
	}
	if (k == here->count && k == there->count) return true;
	horizon->differ = true;
	horizon->here_ends = k == here->count;
	horizon->there_ends = k == there->count;
	if (!horizon->here_ends) horizon->here = here->event[k], horizon->here_time = here->time[k];
	if (!horizon->there_ends) horizon->there = there->event[k], horizon->there_time = there->time[k];
	return false;
}

static void follow(struct runner *here, struct runner *there, const struct touchstone_limits *limits,
				   const struct watch *watch, struct horizon *horizon)
{
	struct touchstone_status now;
	touchstone_status(here->engine, &now);
	while (horizon->events < limits->events) {
		uint64_t left = limits->events - horizon->events, most = left < SLICE ? left : SLICE;
		run_slice(here, most, limits, watch);
		run_slice(there, most, limits, watch);
		horizon->stopped = watch && watch->stop && *watch->stop;
		if (horizon->stopped || !agree(horizon, here, there, now.count) || here->count < most) return;
		touchstone_status(here->engine, &now);
		if (watch && watch->progress) watch->progress(watch->context, most, &now);
	}
}

int horizon_bits(const char *arithmetic, char error[160])
{
	static const struct touchstone_particle particle = {0};
	static const struct touchstone_species species = {1, 1};
	const struct touchstone_scene scene = {.dimensions = 1,
										   .particle_count = 1,
										   .particles = &particle,
										   .species_count = 1,
										   .species = &species,
										   .box = {8},
										   .restitution = {TOUCHSTONE_CONSTANT, 1}};
	struct touchstone_status status = {0};
	struct touchstone_engine *engine = touchstone_create(&scene, arithmetic, touchstone_method_name(0), error);
	if (!engine) return 0;
	touchstone_status(engine, &status);
	touchstone_destroy(engine);
	return status.bits;
}

bool horizon_possible(const char *arithmetic, const char *reference, char error[160])
{
	int bits = horizon_bits(arithmetic, error), finer = bits ? horizon_bits(reference, error) : 0;
	if (!bits || !finer) return false;
	if (finer > bits || strcmp(arithmetic, reference) == 0) return true;
	snprintf(error, 160, "%.40s carries %d bits, no more than the %d of %.40s; accepted: a finer arithmetic", reference,
			 finer, bits, arithmetic);
	return false;
}

bool horizon_find(const struct touchstone_scene *scene, const char *method, const char *arithmetic,
				  const char *reference, const struct touchstone_limits *limits, const struct watch *watch,
				  struct horizon *horizon, char error[160])
{
	*horizon = (struct horizon){0};
	if (!horizon_possible(arithmetic, reference, error)) return false;
	unsigned bits = (unsigned)horizon_bits(arithmetic, error);
	struct touchstone_scene shared = *scene; /* with places of one size in both */
	if (!shared.grain || shared.grain > bits) shared.grain = bits;
	struct runner here = {.engine = touchstone_create(&shared, arithmetic, method, error)};
	struct runner there = {.engine = here.engine ? touchstone_create(&shared, reference, method, error) : NULL};
	if (there.engine) follow(&here, &there, limits, watch, horizon);
	touchstone_destroy(here.engine);
	touchstone_destroy(there.engine);
	return there.engine;
}

struct horizon_spread horizon_spread(const struct horizon *horizons, size_t count)
{
	struct horizon_spread spread = {.mean = NAN, .deviation = NAN};
	double sum = 0, squares = 0;
	for (size_t h = 0; h < count; h++) {
		if (horizons[h].stopped) continue;
		spread.count++;
		spread.open += !horizons[h].differ;
		sum += horizons[h].per_particle;
	}
	if (spread.count == 0) return spread;
	spread.mean = sum / (double)spread.count;
	for (size_t h = 0; h < count; h++)
		if (!horizons[h].stopped) squares += pow(horizons[h].per_particle - spread.mean, 2);
	if (spread.count > 1) spread.deviation = sqrt(squares / (double)(spread.count - 1));
	return spread;
}
