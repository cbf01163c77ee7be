/* Stepped potentials and virtual walls: single events against their closed forms, one engine whatever the arithmetic
 * and the search, states that are what the positions say wherever positions can say it, and what is conserved. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "scene/potential.h"
#include "scene/random.h"
#include "scene/scene.h"

enum { SEED = 20160301, MOST_EVENTS = 64 };

static bool brief; /* under sanitizers, where everything takes ten times longer */

/* ------------------------------------------------------------------ two particles */

struct seen {
	size_t count;
	struct touchstone_event event[MOST_EVENTS];
};

static void see(void *context, struct touchstone_engine *engine, const struct touchstone_event *event)
{
	struct seen *seen = context;
	if (event->kind < TOUCHSTONE_CROSSING && event->kind != TOUCHSTONE_WALL)
		assert_int_equal(touchstone_pair_state(engine, event->first, event->second), event->before);
	if (seen->count < MOST_EVENTS) seen->event[seen->count++] = *event;
}

/* A pair in open space, of masses 1 and 3, at rest together but for the relative motion; the second at the origin. */
static struct seen watch_pair(const char *arithmetic, const struct touchstone_potential *potential, const double r[3],
							  const double v[3], double velocity[3], double *energy)
{
	const struct touchstone_species species[2] = {{1, 1}, {1, 3}};
	struct touchstone_particle particles[2] = {{.species = 0}, {.species = 1}};
	for (int axis = 0; axis < 3; axis++) {
		particles[0].position[axis] = r[axis];
		particles[0].velocity[axis] = 0.75 * v[axis];
		particles[1].velocity[axis] = -0.25 * v[axis];
	}
	struct touchstone_scene scene = {.dimensions = 3,
									 .particle_count = 2,
									 .particles = particles,
									 .species_count = 2,
									 .species = species,
									 .box = {40, 40, 40},
									 .restitution = {TOUCHSTONE_CONSTANT, 1},
									 .potential_count = 1,
									 .potentials = potential};
	char error[160] = "";
	struct touchstone_engine *engine = touchstone_create(&scene, arithmetic, "stable", error);
	if (!engine) fail_msg("%s", error);
	struct seen seen = {0};
	struct touchstone_observer observer = {see, &seen};
	assert_int_equal(touchstone_run(engine, &(struct touchstone_limits){50, 100, NULL}, &observer), TOUCHSTONE_DONE);
	double position[3], first[3], second[3];
	struct touchstone_status status;
	touchstone_state(engine, 0, position, first);
	touchstone_state(engine, 1, position, second);
	touchstone_status(engine, &status);
	*energy = status.potential_energy;
	for (int axis = 0; axis < 3; axis++) {
		velocity[axis] = first[axis] - second[axis];
		*energy += (first[axis] * first[axis] + 3 * second[axis] * second[axis]) / 2;
	}
	touchstone_destroy(engine);
	return seen;
}

/* Speed along the line of centres after a climb, by energy: reduced mass 3/4. */
static double climbed(double normal, double energy)
{
	return sqrt(normal * normal - 2 * energy / 0.75);
}

static void assert_near(double value, double expected, double roundoff)
{
	if (!(fabs(value - expected) <= 64 * roundoff * fmax(1, fabs(expected))))
		fail_msg("%.17g, expected %.17g", value, expected);
}

/* A pair that comes head-on through steps, and what the paper's figure 1 says happens at each. */
static void events_have_closed_forms(void **state)
{
	(void)state;
	static const char *const arithmetics[] = {"binary64", "mpfr:200", "twin", "extended", "binary128", "mpfr:53"};
	const struct touchstone_step well[] = {{3, -1.5}}, shoulder[] = {{3, 1.5}}, stair[] = {{2, 0.25}, {3, -1}};
	for (int a = 0; a < 6; a++) {
		const double roundoff = 0x1p-53, r[3] = {5, 0, 0};
		double after[3], energy;
		/* (1) capture, (3) core, (2a) release */
		struct touchstone_potential potential = {{1, 0}, 1, {TOUCHSTONE_CONSTANT, 1}, 1, well};
		double v[3] = {-2, 0, 0}, inside = climbed(2, -1.5);
		struct seen seen = watch_pair(arithmetics[a], &potential, r, v, after, &energy);
		assert_int_equal(seen.count, 3);
		assert_int_equal(seen.event[0].kind, TOUCHSTONE_CAPTURE);
		assert_near(seen.event[0].time, 1, roundoff);
		assert_near(seen.event[0].approach, 2, roundoff);
		assert_near(seen.event[0].distance, 3, roundoff);
		assert_near(seen.event[0].impulse, 0.75 * (inside - 2), roundoff);
		assert_true(seen.event[0].before == 0 && seen.event[0].after == 1 && seen.event[0].energy == -1.5);
		assert_int_equal(seen.event[1].kind, TOUCHSTONE_CONTACT);
		assert_near(seen.event[1].time, 1 + 2 / inside, roundoff);
		assert_true(seen.event[1].before == 1 && seen.event[1].after == 1 && seen.event[1].energy == 0);
		assert_int_equal(seen.event[2].kind, TOUCHSTONE_RELEASE);
		assert_near(seen.event[2].time, 1 + 4 / inside, roundoff);
		assert_near(seen.event[2].approach, -inside, roundoff);
		assert_true(seen.event[2].before == 1 && seen.event[2].after == 0 && seen.event[2].energy == 1.5);
		assert_near(after[0], 2, roundoff);
		assert_near(energy, 1.5, roundoff);
		/* an inelastic core, then (2b): too slow to leave, it bounces to and fro */
		potential.restitution.coefficient = 0.5;
		seen = watch_pair(arithmetics[a], &potential, r, v, after, &energy);
		assert_true(seen.count > 10);
		for (size_t k = 1; k < 10; k++)
			assert_int_equal(seen.event[k].kind, k % 2 ? TOUCHSTONE_CONTACT : TOUCHSTONE_BOUNCE);
		assert_near(seen.event[2].time, 1 + 2 / inside + 4 / inside, roundoff);
		assert_true(seen.event[2].before == 1 && seen.event[2].after == 1 && seen.event[2].energy == 0);
		assert_near(seen.event[2].impulse, 0.75 * inside, roundoff);
		/* aslant: only the normal part changes; r = (-, 1, 0) at the step, and the pair passes the core by */
		potential.core = 0.5;
		const double aslant[3] = {5, 1, 0};
		double normal = 2 * sqrt(8.0 / 9), within = climbed(normal, -1.5);
		seen = watch_pair(arithmetics[a], &potential, aslant, v, after, &energy);
		assert_int_equal(seen.count, 2);
		assert_near(seen.event[0].time, (5 - sqrt(8)) / 2, roundoff);
		assert_near(seen.event[0].approach, normal, roundoff);
		assert_near(seen.event[0].impulse, 0.75 * (within - normal), roundoff);
		assert_near(seen.event[1].time - seen.event[0].time, 6 * within / (within * within + 4.0 / 9), roundoff);
		assert_near(energy, 1.5, roundoff);
		/* a shoulder: climbed by the fast, not by the slow */
		potential = (struct touchstone_potential){{0, 1}, 1, {TOUCHSTONE_CONSTANT, 1}, 1, shoulder};
		v[0] = -2.5;
		seen = watch_pair(arithmetics[a], &potential, r, v, after, &energy);
		assert_int_equal(seen.count, 3);
		assert_int_equal(seen.event[0].kind, TOUCHSTONE_CAPTURE);
		assert_near(seen.event[1].time, 2 / 2.5 + 2 / climbed(2.5, 1.5), roundoff);
		assert_near(after[0], 2.5, roundoff);
		v[0] = -1.9;
		seen = watch_pair(arithmetics[a], &potential, r, v, after, &energy);
		assert_int_equal(seen.count, 1);
		assert_int_equal(seen.event[0].kind, TOUCHSTONE_BOUNCE);
		assert_true(seen.event[0].before == 0 && seen.event[0].after == 0);
		assert_near(after[0], 1.9, roundoff);
		/* two steps, and nothing in the middle: in and out again on the other side */
		potential = (struct touchstone_potential){{0, 1}, 0, {TOUCHSTONE_CONSTANT, 1}, 2, stair};
		v[0] = -1;
		seen = watch_pair(arithmetics[a], &potential, r, v, after, &energy);
		assert_int_equal(seen.count, 4);
		double first = climbed(1, -1), second = climbed(first, 1.25);
		assert_true(seen.event[0].after == 1 && seen.event[1].after == 2 && seen.event[2].after == 1);
		assert_true(seen.event[1].energy == 1.25 && seen.event[3].after == 0);
		assert_near(seen.event[3].time, 2 + 2 / first + 4 / second, roundoff);
		assert_near(after[0], -1, roundoff);
	}
}

/* A pair exactly at a step is outside of it, and then what its motion says. */
static void ties_are_outside(void **state)
{
	(void)state;
	const struct touchstone_step well[] = {{3, -1}};
	const struct touchstone_potential potential = {{0, 1}, 1, {TOUCHSTONE_CONSTANT, 1}, 1, well};
	double after[3], energy;
	for (int direction = -1; direction <= 1; direction += 2) {
		const double at[3] = {3, 0, 0}, within[3] = {2.75, 0, 0}, v[3] = {direction, 0, 0};
		struct seen seen = watch_pair("binary64", &potential, at, v, after, &energy);
		assert_int_equal(seen.count, direction < 0 ? 3 : 0);
		seen = watch_pair("binary64", &potential, within, v, after, &energy);
		assert_int_equal(seen.event[0].before, 1);
		assert_int_equal(seen.event[0].kind, direction < 0 ? TOUCHSTONE_CONTACT : TOUCHSTONE_BOUNCE);
	}
}

/* ------------------------------------------------------------------ gases */

static const struct scene_species one_size[] = {{1, {1, 1}}};
static const struct scene_species two_sizes[] = {{0.5, {1, 1}}, {0.5, {0.6, 0.3}}};

static struct scene_recipe gas(int dimensions, size_t count, double density)
{
	return (struct scene_recipe){
		.dimensions = dimensions,
		.particle_count = count,
		.density = density,
		.boundary_restitution = {TOUCHSTONE_CONSTANT, 1},
		.species_count = 1,
		.species = one_size,
		.restitution = {TOUCHSTONE_CONSTANT, 1},
		.positions = SCENE_LATTICE,
		.velocities = SCENE_MAXWELL,
		.temperature = 1,
	};
}

struct run {
	struct touchstone_scene scene;
	struct touchstone_engine *engine;
};

static struct run begin(const struct scene_recipe *recipe, const char *arithmetic, const char *method)
{
	struct run run;
	struct scene_error complaint;
	char error[160] = "";
	if (!scene_build(recipe, SEED, &run.scene, &complaint)) fail_msg("%s %s", complaint.key, complaint.text);
	run.engine = touchstone_create(&run.scene, arithmetic, method, error);
	if (!run.engine) fail_msg("%s", error);
	return run;
}

static struct touchstone_status status_of(const struct run *run)
{
	struct touchstone_status status;
	touchstone_status(run->engine, &status);
	return status;
}

static struct touchstone_status advance(const struct run *run, uint64_t events)
{
	touchstone_run(run->engine, &(struct touchstone_limits){events, INFINITY, NULL}, NULL);
	return status_of(run);
}

static void end(struct run *run)
{
	touchstone_destroy(run->engine);
	scene_free(&run->scene);
}

static const struct touchstone_potential *potential_of(const struct touchstone_scene *scene, uint32_t a, uint32_t b)
{
	for (size_t p = 0; p < scene->potential_count; p++) {
		const uint32_t *species = scene->potentials[p].species;
		if ((species[0] == a && species[1] == b) || (species[0] == b && species[1] == a)) return &scene->potentials[p];
	}
	return NULL;
}

/* By how many steps of its potential a pair is surely within, and may be within, over all images of the second. */
static void states_between(const struct touchstone_scene *scene, const struct touchstone_potential *potential,
						   const double first[3], const double second[3], double unclear, int *least, int *most)
{
	*least = *most = 0;
	for (int image = 0; image < 27; image++) {
		const int shift[3] = {image % 3 - 1, image / 3 % 3 - 1, image / 9 - 1};
		double square = 0;
		for (int axis = 0; axis < 3; axis++) {
			double apart = first[axis] - second[axis] - shift[axis] * scene->box[axis];
			square += shift[axis] && !scene->periodic[axis] ? INFINITY : apart * apart;
		}
		for (size_t s = 0; s < potential->step_count; s++) {
			*least += sqrt(square) < potential->steps[s].distance - unclear;
			*most += sqrt(square) < potential->steps[s].distance + unclear;
		}
	}
}

/* Reads the states of all pairs from the positions by force, and holds the tracked ones against them: they may differ
 * where a pair is as near to a step as `unclear`. */
static void recount(const struct run *run, double unclear)
{
	enum { ROOM = 256 };
	const struct touchstone_scene *scene = &run->scene;
	size_t count = scene->particle_count;
	double(*position)[3] = calloc(count, sizeof *position), velocity[3], energy = 0;
	uint64_t captured = 0;
	for (uint32_t p = 0; p < count; p++) touchstone_state(run->engine, p, position[p], velocity);
	for (uint32_t i = 0; i < count; i++) {
		struct touchstone_captured list[ROOM];
		size_t listed = touchstone_captured(run->engine, i, list, ROOM), found = 0;
		assert_true(listed <= ROOM);
		captured += listed;
		for (uint32_t j = 0; j < count; j++) {
			const struct touchstone_potential *potential =
				potential_of(scene, scene->particles[i].species, scene->particles[j].species);
			if (j == i || !potential) continue;
			int least, most, tracked = 0, closest = 0;
			states_between(scene, potential, position[i], position[j], unclear, &least, &most);
			for (size_t k = 0; k < listed; k++) {
				if (list[k].partner != j) continue;
				found++;
				tracked += list[k].state;
				closest = list[k].state > closest ? list[k].state : closest;
				energy += potential->steps[potential->step_count - (size_t)list[k].state].energy / 2;
			}
			assert_int_equal(touchstone_pair_state(run->engine, i, j), closest);
			if (tracked < least || tracked > most)
				fail_msg("particles %u and %u: within %d steps as tracked, %d to %d by their positions", i, j, tracked,
						 least, most);
		}
		assert_int_equal(found, listed);
	}
	free(position);
	struct touchstone_status status = status_of(run);
	assert_int_equal(2 * status.captured, captured);
	assert_true(fabs(status.potential_energy - energy) <= ldexp(1 + (double)captured, 4 - status.bits) + 1e-12);
}

/* ------------------------------------------------------------------ one engine */

static const struct touchstone_step well[] = {{1.8, -0.75}}, shoulder[] = {{1.8, 0.75}},
									stairs[] = {{1.2, 2}, {1.5, -1}, {1.7, -0.25}, {2, 0.125}};
static const struct touchstone_potential wells[] = {{{0, 0}, 1, {TOUCHSTONE_CONSTANT, 1}, 1, well}};
static const struct touchstone_potential shoulders[] = {{{0, 0}, 1, {TOUCHSTONE_CONSTANT, 1}, 1, shoulder}};
static const struct touchstone_potential soft_stairs[] = {{{0, 0}, 0, {TOUCHSTONE_CONSTANT, 1}, 4, stairs}};

/* Steps of random distances and energies between the species, some of them left as hard bodies. */
struct drawn {
	struct touchstone_potential potentials[3];
	struct touchstone_step steps[3][4];
	struct touchstone_virtual_wall walls[2];
};

static void draw(struct drawn *drawn, struct scene_recipe *recipe, struct random_state *random)
{
	recipe->potentials = drawn->potentials;
	recipe->potential_count = 0;
	for (uint32_t a = 0; a < recipe->species_count; a++)
		for (uint32_t b = 0; b <= a; b++) {
			if (recipe->potential_count && random_below(random, 4) == 0) continue;
			double core = (recipe->species[a].body.diameter + recipe->species[b].body.diameter) / 2;
			size_t number = recipe->potential_count++, count = 1 + random_below(random, 4);
			struct touchstone_step *steps = drawn->steps[number];
			for (size_t s = 0; s < count; s++) {
				double inner = s ? steps[s - 1].distance : core;
				steps[s] = (struct touchstone_step){inner + 0.05 + 0.35 * random_uniform(random),
													2 * random_uniform(random) - 1};
			}
			bool soft = random_below(random, 4) == 0;
			struct touchstone_restitution law = {TOUCHSTONE_CONSTANT, random_below(random, 3) ? 1 : 0.9};
			drawn->potentials[number] = (struct touchstone_potential){{a, b}, soft ? 0 : core, law, count, steps};
		}
	recipe->virtual_walls = drawn->walls;
	recipe->virtual_wall_count = random_below(random, 3);
	for (size_t w = 0; w < 2; w++) {
		int axis = (int)random_below(random, (uint64_t)recipe->dimensions);
		drawn->walls[w] = (struct touchstone_virtual_wall){{0}, {0}};
		drawn->walls[w].point[axis] = 2 * random_uniform(random) - 1;
		drawn->walls[w].normal[axis] = random_below(random, 2) ? 1 : -1;
	}
}

/* A small gas of any kind. */
static struct scene_recipe draw_gas(struct drawn *drawn, struct random_state *random)
{
	int dimensions = 1 + (int)random_below(random, 3);
	struct scene_recipe recipe = gas(dimensions, 20 + random_below(random, 40), 0.1 + 0.4 * random_uniform(random));
	recipe.form = random_below(random, 2) ? TOUCHSTONE_ABSOLUTE : TOUCHSTONE_RELATIVE;
	for (int axis = 0; axis < dimensions; axis++)
		if (random_below(random, 3) == 0) recipe.boundary[axis] = SCENE_WALLS;
	if (random_below(random, 4) == 0) recipe.acceleration[dimensions - 1] = -0.1 * random_uniform(random);
	if (random_below(random, 2)) recipe.species_count = 2, recipe.species = two_sizes, recipe.density *= 0.6;
	draw(drawn, &recipe, random);
	return recipe;
}

/* Bookkeeping never rounds: any cells, and none; and states are what they should be on the way. */
static void search_does_not_matter(void **state)
{
	(void)state;
	static const char *const arithmetics[] = {"binary64", "short:14", "binary32", "twin"};
	static const char *const methods[] = {"stable", "rounded", "compensated", "stable"}; /* in binary64 */
	struct random_state random = random_seed(SEED);
	print_message("seed %d\n", SEED);
	uint64_t events[TOUCHSTONE_CROSSING] = {0};
	for (int trial = 0; trial < (brief ? 8 : 32); trial++) {
		struct drawn drawn;
		struct scene_recipe recipe = draw_gas(&drawn, &random);
		const char *arithmetic = arithmetics[trial % 4], *method = methods[trial % 4 ? 0 : trial / 4 % 4];
		struct touchstone_status by[4];
		for (int sizes = 0; sizes < 4; sizes++) {
			recipe.search = sizes ? TOUCHSTONE_CELLS : TOUCHSTONE_ALL;
			recipe.cell = sizes < 2 ? 0 : sizes * (1 + random_uniform(&random));
			struct run run = begin(&recipe, arithmetic, method);
			recount(&run, 1e-3);
			for (int part = 0; part < 4; part++) {
				by[sizes] = advance(&run, 400);
				recount(&run, trial % 4 == 1 ? 0.1 : 1e-2);
			}
			end(&run);
			if (by[sizes].digest != by[0].digest || by[sizes].crossings != by[0].crossings)
				fail_msg("trial %d (%d dimensions, %s, %s, cells of %g): %016llx after %llu events, but %016llx after "
						 "%llu; %s %s",
						 trial, recipe.dimensions, arithmetic, method, recipe.cell,
						 (unsigned long long)by[sizes].digest, (unsigned long long)by[sizes].events,
						 (unsigned long long)by[0].digest, (unsigned long long)by[0].events, by[sizes].reason,
						 by[0].reason);
		}
		events[TOUCHSTONE_CONTACT] += by[0].collisions;
		events[TOUCHSTONE_CAPTURE] += by[0].captures;
		events[TOUCHSTONE_RELEASE] += by[0].releases;
		events[TOUCHSTONE_BOUNCE] += by[0].bounces;
	}
	for (int kind = 0; kind < TOUCHSTONE_CROSSING; kind++)
		if (kind != TOUCHSTONE_WALL) assert_true(events[kind] > 500);
}

static void assert_same_run(const struct scene_recipe *recipe, uint64_t events, const char *one, const char *other)
{
	struct run first = begin(recipe, one, "stable"), second = begin(recipe, other, "stable");
	struct touchstone_status a = advance(&first, events), b = advance(&second, events);
	print_message("%s and %s: %llu events to t = %.4f, digests %016llx and %016llx\n", one, other,
				  (unsigned long long)a.events, a.time, (unsigned long long)a.digest, (unsigned long long)b.digest);
	assert_int_equal(a.events, events);
	assert_int_equal(a.digest, b.digest);
	assert_int_equal(a.captured, b.captured);
	end(&first);
	end(&second);
}

static void equal_precision_means_equal_events(void **state)
{
	(void)state;
	static const char *const equal[][2] = {{"short:24", "binary32"}, {"mpfr:24", "binary32"},
										   {"mpfr:53", "binary64"},  {"mpfr:11", "short:11"},
										   {"extended", "mpfr:64"},  {"binary128", "mpfr:113"}};
	const struct touchstone_potential *potentials[] = {wells, shoulders, soft_stairs};
	for (int p = 0; p < 3; p++) {
		struct scene_recipe recipe = gas(3, 108, 0.3);
		recipe.potentials = potentials[p];
		recipe.potential_count = 1;
		for (int e = 0; e < 6; e++)
			assert_same_run(&recipe, brief ? 300 : e < 4 ? 3000 : 1000, equal[e][0], equal[e][1]);
	}
}

/* Few bits make many pairs move along the step that they cannot leave, and a plain reflection would leave them there.
 */
static void coarse_pairs_are_not_stuck(void **state)
{
	(void)state;
	static const char *const coarse[] = {"short:11", "short:12", "mpfr:13", "short:14"};
	struct scene_recipe recipe = gas(3, 108, 0.3);
	recipe.potentials = soft_stairs;
	recipe.potential_count = 1;
	for (int a = 0; a < 4; a++) {
		struct run run = begin(&recipe, coarse[a], "stable");
		struct touchstone_status status = advance(&run, brief ? 3000 : 10000);
		if (status.verdict != TOUCHSTONE_DONE) fail_msg("%s: %s", coarse[a], status.reason);
		end(&run);
	}
}

/* ------------------------------------------------------------------ what is conserved */

/* Kinetic and potential energy. */
static double energy_of(const struct run *run, double momentum[3])
{
	double energy = status_of(run).potential_energy;
	memset(momentum, 0, 3 * sizeof *momentum);
	for (uint32_t p = 0; p < run->scene.particle_count; p++) {
		double position[3], velocity[3], mass = run->scene.species[run->scene.particles[p].species].mass;
		touchstone_state(run->engine, p, position, velocity);
		for (int axis = 0; axis < 3; axis++) {
			energy += mass * velocity[axis] * velocity[axis] / 2;
			momentum[axis] += mass * velocity[axis];
		}
	}
	return energy;
}

static void energy_and_momentum_are_conserved(void **state)
{
	(void)state;
	const struct touchstone_potential *potentials[] = {wells, shoulders, soft_stairs};
	for (int p = 0; p < 3; p++) {
		struct scene_recipe recipe = gas(3, 500, 0.3);
		recipe.potentials = potentials[p];
		recipe.potential_count = 1;
		struct run run = begin(&recipe, "binary64", "stable");
		double first[3], last[3], begun = energy_of(&run, first);
		struct touchstone_status status = advance(&run, brief ? 20000 : 200000);
		double ended = energy_of(&run, last), kinetic = ended - status.potential_energy;
		print_message("%g at first, %g at last: changed by %.2g; of %llu events %llu captures, %llu releases, %llu "
					  "bounces, %llu at cores\n",
					  begun, ended, ended / begun - 1, (unsigned long long)status.events,
					  (unsigned long long)status.captures, (unsigned long long)status.releases,
					  (unsigned long long)status.bounces, (unsigned long long)status.collisions);
		assert_true(fabs(ended - begun) < 1e-11 * kinetic);
		for (int axis = 0; axis < 3; axis++) assert_true(fabs(last[axis] - first[axis]) < 1e-10);
		assert_true(status.captures > 0 && status.releases > 0);
		end(&run);
	}
}

/* Core events of a run, in order. */
enum { CORES = 200 };
struct cores {
	size_t count;
	struct touchstone_event event[CORES];
};

static void see_core(void *context, struct touchstone_engine *engine, const struct touchstone_event *event)
{
	(void)engine;
	struct cores *cores = context;
	if (event->kind == TOUCHSTONE_CONTACT && cores->count < CORES) cores->event[cores->count++] = *event;
}

static struct cores cores_of(const struct scene_recipe *recipe)
{
	struct cores cores = {0};
	struct run run = begin(recipe, "mpfr:256", "stable");
	struct touchstone_observer observer = {see_core, &cores};
	while (cores.count < CORES) touchstone_run(run.engine, &(struct touchstone_limits){100, INFINITY, NULL}, &observer);
	end(&run);
	return cores;
}

/* A step without height passes pairs on as they are: with enough digits not to round where it is crossed, the cores
 * meet as hard spheres do. */
static void a_step_of_no_height_is_none(void **state)
{
	(void)state;
	static const struct touchstone_step flat[] = {{1.3, 0}, {1.9, 0}};
	static const struct touchstone_potential flats[] = {{{0, 0}, 1, {TOUCHSTONE_CONSTANT, 0.9}, 2, flat}};
	struct scene_recipe recipe = gas(3, 32, 0.4);
	recipe.restitution.coefficient = 0.9;
	struct cores hard = cores_of(&recipe);
	recipe.potentials = flats;
	recipe.potential_count = 1;
	struct cores stepped = cores_of(&recipe);
	for (size_t k = 0; k < CORES; k++) {
		assert_int_equal(hard.event[k].first, stepped.event[k].first);
		assert_int_equal(hard.event[k].second, stepped.event[k].second);
		assert_true(hard.event[k].time == stepped.event[k].time);
	}
}

/* ------------------------------------------------------------------ virtual walls */

/* Counts what passes, by the observer's own bookkeeping. */
struct passed {
	uint64_t count[2];
	double last;
};

static void see_crossing(void *context, struct touchstone_engine *engine, const struct touchstone_event *event)
{
	struct passed *passed = context;
	assert_true(event->time >= passed->last);
	passed->last = event->time;
	if (event->kind != TOUCHSTONE_CROSSING) return;
	assert_true(event->approach > 0);
	assert_true(fabs(event->distance) < 1e-9);
	assert_int_equal(touchstone_side(engine, event->first, event->second), event->before);
	if (event->second == 0) passed->count[event->after < event->before]++;
}

/* A run with virtual walls is the run without, event for event; and what passes is what is then on the other side. */
static void virtual_walls_only_look(void **state)
{
	(void)state;
	struct random_state random = random_seed(SEED + 1);
	for (int trial = 0; trial < (brief ? 6 : 30); trial++) {
		struct drawn drawn;
		struct scene_recipe recipe = draw_gas(&drawn, &random);
		recipe.virtual_wall_count = 0;
		struct run without = begin(&recipe, "binary64", "stable");
		recipe.virtual_wall_count = 2;
		struct run with = begin(&recipe, "binary64", "stable");
		struct passed passed = {0};
		struct touchstone_observer observer = {see_crossing, &passed};
		int64_t before = 0, after = 0;
		for (uint32_t p = 0; p < recipe.particle_count; p++) before += touchstone_side(with.engine, p, 0);
		touchstone_run(with.engine, &(struct touchstone_limits){2000, INFINITY, NULL}, &observer);
		struct touchstone_status plain = advance(&without, 2000), walled = status_of(&with);
		assert_int_equal(plain.digest, walled.digest);
		assert_int_equal(plain.events, walled.events);
		assert_true(plain.time == walled.time);
		struct touchstone_flux flux[2];
		touchstone_flux(with.engine, 0, flux);
		assert_true(flux[0].count == passed.count[0] && flux[1].count == passed.count[1]);
		for (uint32_t p = 0; p < recipe.particle_count; p++) {
			double position[3], velocity[3], off = 0;
			int side = touchstone_side(with.engine, p, 0);
			after += side;
			touchstone_state(with.engine, p, position, velocity);
			for (int axis = 0; axis < 3; axis++)
				off += with.scene.virtual_walls[0].normal[axis] *
					   (position[axis] - with.scene.virtual_walls[0].point[axis]);
			double box = with.scene.box[0], edge = fmin(fabs(off), fabs(fabs(off) - box / 2));
			if (edge > 1 && (side < 0) != (off < 0))
				fail_msg("trial %d: particle %u is %g from the wall, on side %d", trial, p, off, side);
		}
		int axis = drawn.walls[0].normal[0] != 0 ? 0 : drawn.walls[0].normal[1] != 0 ? 1 : 2;
		int64_t net = (int64_t)flux[0].count - (int64_t)flux[1].count;
		if (!with.scene.periodic[axis]) assert_int_equal(after - before, net);
		end(&without);
		end(&with);
	}
}

/* One particle in a periodic box passes a wall once a lap, and gives it what it carries. */
static void laps_are_counted(void **state)
{
	(void)state;
	for (int place = 0; place < 4; place++) {
		static const double at[] = {0, 1.5, 5, -5}; /* the last two stand on the seam of the box */
		struct touchstone_particle particle = {{0.25, 0, 0}, {-2, 0.5, 0}, 0};
		const struct touchstone_species species = {1, 3};
		const struct touchstone_virtual_wall wall = {{at[place], 0, 0}, {1, 0, 0}};
		struct touchstone_scene scene = {.dimensions = 3,
										 .particle_count = 1,
										 .particles = &particle,
										 .species_count = 1,
										 .species = &species,
										 .periodic = {true, true, true},
										 .box = {10, 10, 10},
										 .virtual_wall_count = 1,
										 .virtual_walls = &wall,
										 .restitution = {TOUCHSTONE_CONSTANT, 1}};
		char error[160] = "";
		struct touchstone_engine *engine = touchstone_create(&scene, "binary64", "stable", error);
		if (!engine) fail_msg("%s", error);
		touchstone_run(engine, &(struct touchstone_limits){1, 5 * 100 + 0.01, NULL}, NULL);
		struct touchstone_flux flux[2];
		touchstone_flux(engine, 0, flux);
		assert_int_equal(flux[0].count, 0);
		assert_int_equal(flux[1].count, 100);
		assert_true(flux[1].mass == 300 && flux[1].momentum[0] == -600 && flux[1].momentum[1] == 150);
		assert_true(flux[1].energy == 100 * 1.5 * 4.25);
		struct touchstone_status status;
		touchstone_status(engine, &status);
		assert_true(status.events == 0 && status.crossings == 100);
		touchstone_destroy(engine);
	}
}

/* A ball thrown up passes a level on its way up and down, again after every bounce. */
static void paths_that_bend_come_back(void **state)
{
	(void)state;
	struct touchstone_particle particle = {{0.5}, {2}, 0};
	const struct touchstone_species species = {1, 1};
	const struct touchstone_wall floor = {{0}, {1}, {TOUCHSTONE_CONSTANT, 1}};
	const struct touchstone_virtual_wall levels[] = {{{1.5}, {1}}, {{2.375}, {-1}}, {{2.75}, {1}}};
	struct touchstone_scene scene = {.dimensions = 1,
									 .particle_count = 1,
									 .particles = &particle,
									 .species_count = 1,
									 .species = &species,
									 .wall_count = 1,
									 .walls = &floor,
									 .box = {10},
									 .acceleration = {-1},
									 .virtual_wall_count = 3,
									 .virtual_walls = levels,
									 .restitution = {TOUCHSTONE_CONSTANT, 1}};
	char error[160] = "";
	static const char *const arithmetics[] = {"binary64", "mpfr:100", "short:20"};
	for (int a = 0; a < 3; a++) {
		struct touchstone_engine *engine = touchstone_create(&scene, arithmetics[a], "stable", error);
		if (!engine) fail_msg("%s", error);
		touchstone_run(engine, &(struct touchstone_limits){50, INFINITY, NULL}, NULL); /* it lands 50 times: h = 2 */
		struct touchstone_flux flux[2];
		for (int level = 0; level < 2; level++) {
			touchstone_flux(engine, (size_t)level, flux);
			assert_int_equal(flux[0].count, 50);
			assert_int_equal(flux[1].count, 50);
		}
		touchstone_flux(engine, 2, flux);
		assert_int_equal(flux[0].count + flux[1].count, 0);
		touchstone_destroy(engine);
	}
}

/* ------------------------------------------------------------------ what is refused */

static void nonsense_is_refused(void **state)
{
	(void)state;
	const struct touchstone_step backwards[] = {{2, -1}, {1.5, 0}}, deep[] = {{0.9, -1}}, endless[] = {{2, INFINITY}},
								 wide[] = {{11, 1}}, sound[] = {{2, -1}};
	const struct touchstone_restitution elastic = {TOUCHSTONE_CONSTANT, 1};
	const struct {
		struct touchstone_potential potential;
		const char *says;
	} bad[] = {
		{{{0, 0}, 1, elastic, 2, backwards}, "steps from the innermost outwards"},
		{{{0, 0}, 1, elastic, 1, deep}, "within the core"},
		{{{0, 0}, 1, elastic, 1, endless}, "accepted: a finite number"},
		{{{0, 0}, 1, elastic, 1, wide}, "its own image"},
		{{{0, 1}, 1, elastic, 1, sound}, "species 0 and 1"},
		{{{0, 0}, 1.5, elastic, 1, sound}, "mean of the diameters"},
		{{{0, 0}, -1, elastic, 1, sound}, "mean of the diameters"},
		{{{0, 0}, 1, {TOUCHSTONE_CONSTANT, 1.5}, 1, sound}, "restitution"},
	};
	for (size_t b = 0; b < sizeof bad / sizeof *bad; b++) {
		struct scene_recipe recipe = gas(3, 100, 0.1);
		struct touchstone_scene scene;
		struct scene_error complaint;
		recipe.potentials = &bad[b].potential;
		recipe.potential_count = 1;
		assert_false(scene_build(&recipe, SEED, &scene, &complaint));
		if (!strstr(complaint.text, bad[b].says)) fail_msg("%s %s", complaint.key, complaint.text);
	}
}

/* Steps by the rule have the volume of their shells: the integral of the potential is kept, whatever their number. */
static void lennard_jones_keeps_its_volume(void **state)
{
	(void)state;
	const struct lennard_jones law = {1.5, 1.1, 0.8, 3};
	struct touchstone_step steps[40];
	for (int dimensions = 1; dimensions <= 3; dimensions++) {
		double integral = 0, volume = 0;
		potential_lennard_jones(&law, dimensions, 1, steps);
		assert_true(steps[0].distance == 3);
		integral = steps[0].energy * (pow(3, dimensions) - pow(0.8, dimensions));
		potential_lennard_jones(&law, dimensions, 40, steps);
		double inner = 0.8;
		for (int s = 0; s < 40; s++) {
			double middle = 1.1 / ((steps[s].distance + inner) / 2), power = pow(middle, 6);
			double shell = pow(steps[s].distance, dimensions) - pow(inner, dimensions);
			volume += steps[s].energy * shell;
			assert_true(steps[s].distance > inner);
			if (s > 4) assert_true(fabs(steps[s].energy - 6 * (power * power - power)) < 0.1);
			inner = steps[s].distance;
		}
		assert_true(fabs(volume - integral) < 1e-12 * fabs(integral) + 1e-11);
	}
}

int main(void)
{
	brief = getenv("TOUCHSTONE_BRIEF");
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(events_have_closed_forms),
		cmocka_unit_test(ties_are_outside),
		cmocka_unit_test(search_does_not_matter),
		cmocka_unit_test(equal_precision_means_equal_events),
		cmocka_unit_test(coarse_pairs_are_not_stuck),
		cmocka_unit_test(energy_and_momentum_are_conserved),
		cmocka_unit_test(a_step_of_no_height_is_none),
		cmocka_unit_test(virtual_walls_only_look),
		cmocka_unit_test(laps_are_counted),
		cmocka_unit_test(paths_that_bend_come_back),
		cmocka_unit_test(nonsense_is_refused),
		cmocka_unit_test(lennard_jones_keeps_its_volume),
	};
	return cmocka_run_group_tests(tests, NULL, NULL);
}
