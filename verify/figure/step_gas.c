#include "figure/step_gas.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <time.h>

#include "measure/conservation.h"
#include "scene/scene.h"

const char *step_gas_name(const struct step_gas *gas)
{
	return gas->shoulder ? "square-shoulder" : "square-well";
}

uint64_t step_gas_events(const struct step_gas *gas)
{
	return gas->events + course_events(gas->equilibrate, gas->particles);
}

static bool build(const struct step_gas *gas, uint64_t seed, struct touchstone_scene *scene, char error[320])
{
	static const struct scene_species ball = {1, {1, 1}};
	const struct touchstone_step step = {3, gas->shoulder ? 1 : -1};
	const struct touchstone_potential potential = {{0, 0}, 1, {TOUCHSTONE_CONSTANT, 1}, 1, &step};
	const struct scene_recipe recipe = {
		.dimensions = 3,
		.particle_count = gas->particles,
		.density = 1e-3,
		.boundary_restitution = {TOUCHSTONE_CONSTANT, 1},
		.species_count = 1,
		.species = &ball,
		.restitution = {TOUCHSTONE_CONSTANT, 1},
		.potential_count = 1,
		.potentials = &potential,
		.positions = SCENE_LATTICE,
		.velocities = SCENE_MAXWELL,
		.temperature = 1,
		.form = gas->form,
	};
	struct scene_error wrong;
	if (scene_build(&recipe, seed, scene, &wrong)) return true;
	snprintf(error, 320, "%s: %s", wrong.key, wrong.text);
	return false;
}

static double clock_now(void)
{
	struct timespec now;
	clock_gettime(CLOCK_MONOTONIC, &now);
	return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

static void advance(void *context, uint64_t events, const struct touchstone_status *now)
{
	(void)now;
	struct step_campaign *campaign = context;
	uint64_t done = atomic_fetch_add(&campaign->done, events) + events;
#pragma omp critical(figure_progress)
	if (campaign->setup->progress)
		campaign->setup->progress(campaign->setup->context, fmin(1, (double)done / (double)campaign->all));
}

/* Runs an engine made from the scene, and measures. */
static void measure(const struct step_gas *gas, struct step_campaign *campaign, const struct touchstone_scene *scene,
					struct touchstone_engine *engine, struct step_gas_outcome *outcome)
{
	struct watch watch = {campaign->setup->stop, advance, campaign};
	struct touchstone_limits limits = {.events = gas->events, .time = INFINITY};
	outcome->stopped = gas->equilibrate > 0 && !course_equilibrate(engine, gas->equilibrate, &watch);
	if (outcome->stopped) return;
	outcome->begun = true;
	struct touchstone_observer observer = {inconsistency_see, &outcome->inconsistency};
	struct touchstone_listener listener = {misreading_test, &outcome->misreading, inconsistency_reach, INFINITY, 0};
	if (gas->watched) {
		misreading_begin(&outcome->misreading, scene, engine);
		observer = (struct touchstone_observer){misreading_see, &outcome->misreading};
	}
	touchstone_observe_tests(engine, gas->watched ? &listener : &outcome->inconsistency.listener);
	struct conservation begin = conservation_of(scene, engine);
	double clock = clock_now();
	outcome->stopped = !course_run(engine, &limits, &observer, &watch);
	outcome->seconds = clock_now() - clock;
	struct conservation end = conservation_of(scene, engine);
	outcome->energy_drift = conservation_energy_drift(&begin, &end);
	touchstone_status(engine, &outcome->end);
	misreading_end(&outcome->misreading);
}

void step_gas_run(const struct step_gas *gas, struct step_campaign *campaign, struct step_gas_outcome *outcome)
{
	struct touchstone_scene scene;
	*outcome = (struct step_gas_outcome){0};
	if (!build(gas, campaign->setup->seed, &scene, outcome->error)) return;
	struct touchstone_engine *engine = touchstone_create(&scene, gas->arithmetic, gas->method, outcome->error);
	struct touchstone_status status = {0};
	if (engine) touchstone_status(engine, &status);
	if (engine && inconsistency_begin(&outcome->inconsistency, status.bits, gas->particles))
		measure(gas, campaign, &scene, engine, outcome);
	else if (engine)
		snprintf(outcome->error, sizeof outcome->error, "not enough memory");
	inconsistency_end(&outcome->inconsistency);
	touchstone_destroy(engine);
	scene_free(&scene);
}

void step_gas_command(const struct step_gas *gas, uint64_t seed, char command[320])
{
	snprintf(command, 320,
			 "touchstone run %s --method %s --arithmetic %s --set particles=%zu --set form=%s --set equilibrate=%g "
			 "--seed %" PRIu64 " --events %" PRIu64 " --measure states",
			 step_gas_name(gas), gas->method, gas->arithmetic, gas->particles,
			 gas->form == TOUCHSTONE_ABSOLUTE ? "absolute" : "relative", gas->equilibrate, seed, gas->events);
}
