/* Particles with steps: one engine whatever the arithmetic and the search, states that are what the positions say
 * wherever positions can say it, and what is conserved. */
#include "step_scenes.h"

#include "test/long_double.h"

static bool brief; /* under sanitizers, where everything takes ten times longer */

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

/* Bookkeeping never rounds: any cells, and none; and states are what they should be on the way. */
static void search_does_not_matter(void **state)
{
	(void)state;
	static const char *const arithmetics[] = {"binary64", "short:14", "binary32", "twin"};
	static const char *const methods[] = {"stable", "rounded", "compensated", "stable"}; /* in binary64 */
	struct random_state random = random_seed(SEED);
	print_message("seed %d\n", SEED);
	uint64_t events[TOUCHSTONE_CROSSING] = {0};
	for (int trial = 0; trial < (brief ? 4 : 10); trial++) {
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
			if (arithmetic_is_whole(equal[e][0]))
				assert_same_run(&recipe, brief ? 200 : e < 4 ? 2000 : 600, equal[e][0], equal[e][1]);
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
		struct touchstone_status status = advance(&run, brief ? 20000 : 60000);
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

int main(void)
{
	brief = getenv("TOUCHSTONE_BRIEF");
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(search_does_not_matter),      cmocka_unit_test(equal_precision_means_equal_events),
		cmocka_unit_test(coarse_pairs_are_not_stuck),  cmocka_unit_test(energy_and_momentum_are_conserved),
		cmocka_unit_test(a_step_of_no_height_is_none),
	};
	return cmocka_run_group_tests(tests, NULL, NULL);
}
