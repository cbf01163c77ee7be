#include "measure/kept_gas.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "scene/scene.h"

/* The gas at hand. */
struct keeper {
	const struct kept_setup *setup;
	const struct watch *watch;
	struct kept_gas *gas;
	struct touchstone_scene scene;
	struct touchstone_engine *engine;
	double temperature, drag; /* of the particles; of the gas as a whole, the same for its mean velocity */
	char *error;
};

static bool begin_engine(struct keeper *keeper, const struct touchstone_scene *scene)
{
	touchstone_destroy(keeper->engine);
	keeper->engine = touchstone_create(scene, keeper->setup->arithmetic, keeper->setup->method, keeper->error);
	return keeper->engine;
}

static bool begin_scene(struct keeper *keeper)
{
	static const struct scene_species ball = {1, {1, 1}};
	const struct kept_setup *setup = keeper->setup;
	struct scene_recipe recipe = {
		.dimensions = 3,
		.particle_count = setup->particles,
		.density = setup->density,
		.boundary_restitution = {TOUCHSTONE_CONSTANT, 1},
		.species_count = 1,
		.species = &ball,
		.restitution = {TOUCHSTONE_CONSTANT, setup->restitution},
		.positions = SCENE_LATTICE,
		.velocities = SCENE_MAXWELL,
		.temperature = 1,
		.form = setup->form,
		.clock = setup->clock,
	};
	struct scene_error wrong;
	if (scene_build(&recipe, setup->seed + (keeper->gas->starts << 32), &keeper->scene, &wrong)) return true;
	snprintf(keeper->error, 320, "%s: %s", wrong.key, wrong.text);
	return false;
}

static struct conservation look(struct keeper *keeper)
{
	struct conservation now = conservation_of(&keeper->scene, keeper->engine);
	double count = (double)keeper->setup->particles;
	keeper->drag = 0;
	for (int axis = 0; axis < 3; axis++) keeper->drag += pow(now.momentum[axis][0] / count, 2) / 3;
	keeper->temperature = 2 * now.energy[0] / (3 * count) - keeper->drag;
	return now;
}

/* Goes on from the same positions and with the velocities relative to the mean. */
static bool recentre(struct keeper *keeper)
{
	struct touchstone_scene scene = keeper->scene;
	struct touchstone_status status;
	double mean[3] = {0};
	struct touchstone_particle *particles = malloc(scene.particle_count * sizeof *particles);
	if (!particles) {
		snprintf(keeper->error, 320, "not enough memory for %zu particles", scene.particle_count);
		return false;
	}
	touchstone_status(keeper->engine, &status);
	for (uint32_t p = 0; p < scene.particle_count; p++) {
		particles[p].species = 0;
		touchstone_state(keeper->engine, p, particles[p].position, particles[p].velocity);
		for (int axis = 0; axis < 3; axis++) mean[axis] += particles[p].velocity[axis] / (double)scene.particle_count;
	}
	for (uint32_t p = 0; p < scene.particle_count; p++)
		for (int axis = 0; axis < 3; axis++) particles[p].velocity[axis] -= mean[axis];
	scene.particles = particles;
	scene.clock = keeper->setup->form == TOUCHSTONE_ABSOLUTE ? fmax(status.time, keeper->setup->clock) : 0;
	bool begun = begin_engine(keeper, &scene);
	free(particles);
	keeper->gas->recentred++;
	return begun;
}

/* Keeps the gas as warm as it began. */
static bool keep(struct keeper *keeper)
{
	static const double little = 0x1p-12; /* of the temperature */
	int step = keeper->setup->halvings, exponent = 0;
	if (!(keeper->temperature > 0 && keeper->temperature < INFINITY)) return true;
	double warmth = log2(keeper->temperature) / 2;
	if (fabs(warmth) >= step) exponent = -(int)warmth;
	exponent = exponent > 64 ? 64 : exponent < -64 ? -64 : exponent;
	if (exponent && touchstone_rescale(keeper->engine, exponent)) keeper->gas->cooled += exponent;
	return keeper->drag <= little * keeper->temperature || recentre(keeper);
}

/* Counts of which the last may have to be taken back. */
struct tally {
	struct three_body three_body;
	uint64_t repeated, entangled;
	double drift;
};

static struct tally tally_of(const struct kept_gas *gas)
{
	return (struct tally){gas->mishaps.three_body, gas->mishaps.repeated, gas->mishaps.entangled, gas->drift};
}

static void take_back(struct kept_gas *gas, const struct tally *tally)
{
	gas->dropped += gas->mishaps.three_body.contacts - tally->three_body.contacts;
	gas->mishaps.three_body = tally->three_body; /* its list of trios is the same one */
	gas->mishaps.repeated = tally->repeated;
	gas->mishaps.entangled = tally->entangled;
	gas->drift = tally->drift;
}

static void enter_end(struct kept_gas *gas, enum touchstone_verdict verdict)
{
	gas->collapsed += verdict == TOUCHSTONE_COLLAPSED;
	gas->halted += verdict == TOUCHSTONE_HALTED;
	gas->diverged += verdict == TOUCHSTONE_DIVERGED;
}

/* So many events of the gas at hand, in slices of ten collisions per particle, counted or not. Tells how it ended; a
 * gas that is ending takes its last two slices with it. False when stopped or wrong. */
static bool follow(struct keeper *keeper, uint64_t events, bool counted, enum touchstone_verdict *verdict)
{
	static const double looks_apart = 10;
	struct kept_gas *gas = keeper->gas;
	const struct touchstone_observer observer = {mishaps_see, &gas->mishaps};
	const uint64_t slice = course_events(looks_apart, keeper->setup->particles);
	struct tally tally[2] = {tally_of(gas), tally_of(gas)};
	*verdict = TOUCHSTONE_DONE;
	for (uint64_t left = events, part; left > 0; left -= part) {
		struct touchstone_limits limits = {.events = part = slice < left ? slice : left, .time = INFINITY};
		struct touchstone_status status;
		struct conservation before = look(keeper);
		if (!course_run(keeper->engine, &limits, counted ? &observer : NULL, keeper->watch)) return false;
		touchstone_status(keeper->engine, &status);
		struct conservation after = look(keeper);
		*verdict = status.verdict;
		if (*verdict != TOUCHSTONE_DONE) {
			take_back(gas, &tally[0]);
			return true;
		}
		if (counted && part == slice) mishaps_look(&gas->mishaps, keeper->engine);
		if (counted) gas->drift += conservation_energy_drift(&before, &after);
		tally[0] = tally[1];
		tally[1] = tally_of(gas);
		if (!keep(keeper)) return false;
	}
	return true;
}

/* One start state, as far as it goes. */
static bool run_start(struct keeper *keeper)
{
	const struct kept_setup *setup = keeper->setup;
	struct kept_gas *gas = keeper->gas;
	enum touchstone_verdict verdict;
	if (!begin_scene(keeper)) return false;
	gas->starts++;
	uint64_t settle = course_events(setup->settle, setup->particles);
	bool well = begin_engine(keeper, &keeper->scene) &&
				course_equilibrate(keeper->engine, setup->equilibrate, keeper->watch) &&
				follow(keeper, settle, false, &verdict);
	if (well && verdict == TOUCHSTONE_DONE)
		well = follow(keeper, setup->events - gas->mishaps.three_body.contacts, true, &verdict);
	if (well) enter_end(gas, verdict);
	scene_free(&keeper->scene);
	touchstone_destroy(keeper->engine);
	keeper->engine = NULL;
	return well;
}

bool kept_gas_run(const struct kept_setup *setup, const struct watch *watch, struct kept_gas *gas, char error[320])
{
	*gas = (struct kept_gas){0};
	*error = '\0';
	struct keeper keeper = {.setup = setup, .watch = watch, .gas = gas, .error = error};
	struct touchstone_status status;
	if (!begin_scene(&keeper)) return false;
	bool well = begin_engine(&keeper, &keeper.scene);
	if (well) touchstone_status(keeper.engine, &status);
	scene_free(&keeper.scene);
	touchstone_destroy(keeper.engine);
	keeper.engine = NULL;
	if (!well) return false;
	if (!mishaps_begin(&gas->mishaps, setup->particles, status.bits)) {
		snprintf(error, 320, "not enough memory for %zu particles", setup->particles);
		return false;
	}
	while (well && gas->mishaps.three_body.contacts < setup->events && gas->starts < (uint64_t)setup->starts)
		well = run_start(&keeper);
	return well;
}

void kept_gas_free(struct kept_gas *gas)
{
	mishaps_end(&gas->mishaps);
}
