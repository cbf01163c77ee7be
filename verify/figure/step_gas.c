#include "figure/step_gas.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <time.h>
#include <unistd.h>

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

void step_gas_key(const struct step_gas *gas, uint64_t seed, char key[STEP_GAS_KEY])
{
	snprintf(key, STEP_GAS_KEY,
			 "scene=%s method=%s arithmetic=%s particles=%zu form=%s equilibrate=%g seed=%" PRIu64 " events=%" PRIu64
			 " count=%s",
			 step_gas_name(gas), gas->method, gas->arithmetic, gas->particles,
			 gas->form == TOUCHSTONE_ABSOLUTE ? "absolute" : "relative", gas->equilibrate, seed, gas->events,
			 gas->watched ? "misreadings" : "inconsistencies");
}

static double clock_now(void)
{
	struct timespec now;
	clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
	return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

static const uint64_t kept_every = 10000000; /* events: a minute or so */

static void advance(void *context, uint64_t events, const struct touchstone_status *now)
{
	struct step_gas_run *run = context;
	if (run->watch->progress) run->watch->progress(run->watch->context, events, now);
	run->since += events;
	if (!run->kept || run->since < kept_every) return;
	step_gas_keep(run);
	run->since = 0;
}

/* From where counting began, or from the checkpoint, to the end. */
static void count(struct step_gas_run *run)
{
	const struct step_gas *gas = run->gas;
	struct step_gas_outcome *outcome = run->outcome;
	struct watch watch = {run->watch->stop, advance, run};
	struct touchstone_limits limits = {.events = gas->events - outcome->inconsistency.events, .time = INFINITY};
	struct touchstone_observer observer = {inconsistency_see, &outcome->inconsistency};
	struct touchstone_listener listener = {misreading_test, &outcome->misreading, inconsistency_reach, INFINITY, 0};
	outcome->begun = true;
	if (gas->watched) {
		misreading_begin(&outcome->misreading, &run->scene, run->engine);
		observer = (struct touchstone_observer){misreading_see, &outcome->misreading};
	}
	touchstone_observe_tests(run->engine, gas->watched ? &listener : &outcome->inconsistency.listener);
	double clock = clock_now();
	outcome->stopped = !course_run(run->engine, &limits, &observer, &watch);
	touchstone_observe_tests(run->engine, NULL);
	outcome->seconds += clock_now() - clock;
	struct conservation end = conservation_of(&run->scene, run->engine);
	outcome->energy_drift = conservation_energy_drift(&run->begin, &end);
	touchstone_status(run->engine, &outcome->end);
	misreading_end(&outcome->misreading);
	if (outcome->misreading.exhausted) snprintf(outcome->error, sizeof outcome->error, "not enough memory");
	if (run->kept && outcome->stopped) step_gas_keep(run);
	if (run->kept && !outcome->stopped) unlink(run->kept);
}

/* Takes a new engine to where counting begins; false when stopped on the way. */
static bool begin(struct step_gas_run *run)
{
	double collisions = run->gas->equilibrate;
	run->outcome->stopped = collisions > 0 && !course_equilibrate(run->engine, collisions, run->watch);
	run->begin = conservation_of(&run->scene, run->engine);
	return !run->outcome->stopped;
}

/* The same for one that was kept. */
static bool go_on(struct step_gas_run *run)
{
	if (!run->kept || !step_gas_go_on(run)) return false;
	const struct watch *watch = run->watch;
	uint64_t left = run->gas->events - run->outcome->inconsistency.events;
	touchstone_status(run->engine, &run->outcome->end);
	if (watch->progress) watch->progress(watch->context, step_gas_events(run->gas) - left, &run->outcome->end);
	return true;
}

void step_gas_run(const struct step_gas *gas, uint64_t seed, const char *kept, const struct watch *watch,
				  struct step_gas_outcome *outcome)
{
	struct step_gas_run run = {.gas = gas, .seed = seed, .kept = kept, .watch = watch, .outcome = outcome};
	*outcome = (struct step_gas_outcome){0};
	if (!build(gas, seed, &run.scene, outcome->error)) return;
	run.engine = touchstone_create(&run.scene, gas->arithmetic, gas->method, outcome->error);
	if (run.engine) touchstone_status(run.engine, &outcome->end);
	if (run.engine && !inconsistency_begin(&outcome->inconsistency, outcome->end.bits, gas->particles))
		snprintf(outcome->error, sizeof outcome->error, "not enough memory");
	else if (run.engine && (go_on(&run) || begin(&run)))
		count(&run);
	inconsistency_end(&outcome->inconsistency);
	touchstone_destroy(run.engine);
	scene_free(&run.scene);
}

void step_gas_command(const struct step_gas *gas, uint64_t seed, char command[320])
{
	snprintf(command, 320,
			 "touchstone run %s --method %s --arithmetic %s --set particles=%zu --set form=%s --set equilibrate=%g "
			 "--seed %" PRIu64 " --events %" PRIu64 " --measure states",
			 step_gas_name(gas), gas->method, gas->arithmetic, gas->particles,
			 gas->form == TOUCHSTONE_ABSOLUTE ? "absolute" : "relative", gas->equilibrate, seed, gas->events);
}
