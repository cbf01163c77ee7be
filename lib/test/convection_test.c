/* Heat: who takes how much of it, what its kicks and thermal walls do to momentum and energy, and how it begins. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <stdio.h>
#include <stdlib.h>

#include "scene/random.h"
#include "scene/scene.h"
#include "touchstone.h"

enum { SEED = 2024 };

static bool brief; /* under sanitizers, where everything takes ten times longer */

static const struct scene_species one_size[] = {{1, {1, 1}}};

static struct scene_recipe discs(size_t count, double width, double height)
{
	return (struct scene_recipe){
		.dimensions = 2,
		.particle_count = count,
		.box = {width, height},
		.boundary = {SCENE_PERIODIC, SCENE_WALLS},
		.boundary_restitution = {TOUCHSTONE_CONSTANT, 1},
		.species_count = 1,
		.species = one_size,
		.restitution = {TOUCHSTONE_CONSTANT, 0.99},
		.convection = {true, 0.5, 0.5, {0, 1}},
		.packing_limit = 0.4,
		.positions = SCENE_RANDOM,
		.velocities = SCENE_UNIFORM,
	};
}

static void build(const struct scene_recipe *recipe, struct touchstone_scene *scene)
{
	struct scene_error complaint;
	if (!scene_build(recipe, SEED, scene, &complaint)) fail_msg("%s %s", complaint.key, complaint.text);
}

static struct touchstone_engine *make(const struct touchstone_scene *scene, const char *arithmetic)
{
	char error[160] = "";
	struct touchstone_engine *engine = touchstone_create(scene, arithmetic, "stable", error);
	if (!engine) fail_msg("%s", error);
	return engine;
}

static struct touchstone_status advance(struct touchstone_engine *engine, uint64_t events)
{
	touchstone_run(engine, &(struct touchstone_limits){events, INFINITY, NULL}, NULL);
	struct touchstone_status status;
	touchstone_status(engine, &status);
	return status;
}

static struct touchstone_status run(const struct scene_recipe *recipe, const char *arithmetic, uint64_t events)
{
	struct touchstone_scene scene;
	build(recipe, &scene);
	struct touchstone_engine *engine = make(&scene, arithmetic);
	struct touchstone_status status = advance(engine, events);
	touchstone_destroy(engine);
	scene_free(&scene);
	return status;
}

/* An event, and its particles before it. */
struct seen {
	struct touchstone_event event;
	double temperature[2], velocity[2][3];
};

static void look(struct touchstone_engine *engine, const struct touchstone_event *event, double temperature[2],
				 double velocity[2][3])
{
	const uint32_t particles[2] = {event->first, event->kind == TOUCHSTONE_CONTACT ? event->second : event->first};
	for (int p = 0; p < 2; p++) {
		double position[3];
		temperature[p] = touchstone_temperature(engine, particles[p]);
		touchstone_state(engine, particles[p], position, velocity[p]);
	}
}

static void see(void *context, struct touchstone_engine *engine, const struct touchstone_event *event)
{
	struct seen *seen = context;
	seen->event = *event;
	look(engine, event, seen->temperature, seen->velocity);
}

static void assert_near(double x, double y)
{
	if (!(fabs(x - y) <= 1e-13 * (1 + fabs(y)))) fail_msg("%.17g is not %.17g", x, y);
}

/* Event after event: the rules of temperature and kick, word for word. */
static void rules_of_heat(void **state)
{
	(void)state;
	struct random_state random = random_seed(SEED);
	uint64_t pairs = 0, walls[2] = {0};
	for (int trial = 0; trial < (brief ? 4 : 20); trial++) {
		double side = 10 + 10 * random_uniform(&random);
		struct scene_recipe recipe = discs(20 + random_below(&random, 30), side, side);
		struct scene_convection *heat = &recipe.convection;
		heat->kick = 2 * random_uniform(&random) - 1;
		heat->neutral = random_uniform(&random);
		heat->walls[0] = random_uniform(&random), heat->walls[1] = random_uniform(&random);
		struct touchstone_scene scene;
		build(&recipe, &scene);
		struct touchstone_engine *engine = make(&scene, "binary64");
		struct seen seen;
		struct touchstone_observer observer = {see, &seen};
		for (int event = 0; event < 500; event++) {
			double temperature[2], velocity[2][3];
			touchstone_run(engine, &(struct touchstone_limits){1, INFINITY, NULL}, &observer);
			look(engine, &seen.event, temperature, velocity);
			if (seen.event.kind == TOUCHSTONE_WALL) {
				double wall = heat->walls[seen.event.second];
				assert_near(temperature[0], (seen.temperature[0] + wall) / 2);
				assert_near(velocity[0][0], seen.velocity[0][0]);
				assert_near(velocity[0][1], -seen.velocity[0][1]);
				walls[seen.event.second]++;
				continue;
			}
			double mean = (seen.temperature[0] + seen.temperature[1]) / 2;
			assert_near(temperature[0], mean);
			assert_true(temperature[0] == temperature[1]);
			double before[2], after[2];
			for (int axis = 0; axis < 2; axis++) {
				before[axis] = seen.velocity[0][axis] + seen.velocity[1][axis];
				after[axis] = velocity[0][axis] + velocity[1][axis];
			}
			assert_near(after[0], before[0]);
			assert_near(after[1], before[1] - 2 * heat->kick * (mean - heat->neutral));
			pairs++;
		}
		touchstone_destroy(engine);
		scene_free(&scene);
	}
	print_message("seed %d: %llu pairs, %llu and %llu at the walls\n", SEED, (unsigned long long)pairs,
				  (unsigned long long)walls[0], (unsigned long long)walls[1]);
	assert_true(pairs > 500 && walls[0] > 50 && walls[1] > 50);
}

/* What restitution takes, by the observer's own bookkeeping: of equal masses 1. */
static void lose(void *context, struct touchstone_engine *engine, const struct touchstone_event *event)
{
	(void)engine;
	double *lost = context;
	if (event->kind == TOUCHSTONE_CONTACT) *lost += (1 - 0.99 * 0.99) * event->approach * event->approach / 4;
}

static double energy_of(const struct touchstone_engine *engine, size_t count)
{
	double sum = 0;
	for (uint32_t p = 0; p < count; p++) {
		double position[3], velocity[3];
		touchstone_state(engine, p, position, velocity);
		sum += (velocity[0] * velocity[0] + velocity[1] * velocity[1]) / 2;
	}
	return sum;
}

static void books_close(void **state)
{
	(void)state;
	for (int thermal = 0; thermal < 2; thermal++) {
		struct scene_recipe recipe = discs(300, 40, 40);
		recipe.thermostat = thermal ? 0.7 : 0;
		struct touchstone_scene scene;
		build(&recipe, &scene);
		struct touchstone_engine *engine = make(&scene, "binary64");
		double first = energy_of(engine, scene.particle_count), lost = 0;
		struct touchstone_observer observer = {lose, &lost};
		touchstone_run(engine, &(struct touchstone_limits){brief ? 2000 : 20000, INFINITY, NULL}, &observer);
		struct touchstone_status status = advance(engine, 0);
		double last = energy_of(engine, scene.particle_count);
		double expected = first + status.kicked_energy + status.thermostat_energy - lost;
		print_message("energy %.9g + kicks %.9g + thermal walls %.9g - restitution %.9g = %.9g; is %.9g\n", first,
					  status.kicked_energy, status.thermostat_energy, lost, expected, last);
		assert_true(status.kicked_energy > first && (status.thermostat_energy != 0) == thermal);
		assert_true(fabs(last - expected) < 1e-11 * (first + status.kicked_energy + lost));
		touchstone_recount(engine);
		status = advance(engine, 0);
		assert_true(status.kicked_energy == 0 && status.thermostat_energy == 0);
		touchstone_destroy(engine);
		scene_free(&scene);
	}
}

/* The engine is still one, and its search structures still change nothing. */
static void one_engine(void **state)
{
	(void)state;
	static const char *const same[][2] = {
		{"mpfr:53", "binary64"}, {"mpfr:24", "binary32"}, {"mpfr:11", "short:11"}, {"mpfr:7", "short:7"}};
	for (int thermal = 0; thermal < 2; thermal++)
		for (int form = TOUCHSTONE_RELATIVE; form <= TOUCHSTONE_ABSOLUTE; form++) {
			struct scene_recipe recipe = discs(100, 20, 20);
			recipe.thermostat = thermal ? 0.5 : 0;
			recipe.form = form;
			for (size_t i = 0; i < sizeof same / sizeof *same; i++) {
				struct touchstone_status one = run(&recipe, same[i][0], brief ? 200 : 800);
				struct touchstone_status other = run(&recipe, same[i][1], brief ? 200 : 800);
				if (one.digest != other.digest) fail_msg("%s is not %s", same[i][0], same[i][1]);
				assert_int_equal(one.events, other.events);
				assert_true(one.kicked_energy == other.kicked_energy);
			}
			uint64_t digest = run(&recipe, "binary64", 1500).digest;
			recipe.search = TOUCHSTONE_ALL;
			assert_int_equal(run(&recipe, "binary64", 1500).digest, digest);
			recipe.search = TOUCHSTONE_UNSIEVED;
			assert_int_equal(run(&recipe, "binary64", 1500).digest, digest);
		}
}

/* Heat that kicks nobody is not noticed. */
static void heat_without_kicks(void **state)
{
	(void)state;
	struct scene_recipe recipe = discs(200, 30, 30);
	recipe.convection.kick = 0;
	struct touchstone_status warm = run(&recipe, "binary64", 5000);
	recipe.convection.heats = false;
	struct touchstone_status plain = run(&recipe, "binary64", 5000);
	assert_int_equal(warm.digest, plain.digest);
	assert_true(warm.kicked_energy == 0 && warm.memory > plain.memory);
}

struct leaving {
	uint64_t count;
	double across, along; /* sums of squares of the velocity before the next wall, which is that after the last one */
};

static void see_leaving(void *context, struct touchstone_engine *engine, const struct touchstone_event *event)
{
	struct leaving *leaving = context;
	double position[3], velocity[3];
	touchstone_state(engine, event->first, position, velocity);
	if (leaving->count++ == 0) return;
	leaving->across += velocity[1] * velocity[1];
	leaving->along += velocity[0] * velocity[0];
}

/* One disc between thermal walls: kT = 3 along them, twice as much across (Lebowitz and Spohn 1978). The mean of n
 * squares of variance-1 normal numbers has deviation sqrt(2/n), that of n Rayleigh squares 2/sqrt(n). */
static void thermal_walls(void **state)
{
	(void)state;
	struct scene_recipe recipe = discs(1, 5, 5);
	recipe.thermostat = 3;
	recipe.convection.heats = false;
	struct touchstone_scene scene;
	build(&recipe, &scene);
	struct touchstone_engine *engine = make(&scene, "binary64");
	struct leaving leaving = {0};
	struct touchstone_observer observer = {see_leaving, &leaving};
	touchstone_run(engine, &(struct touchstone_limits){20000, INFINITY, NULL}, &observer);
	double n = (double)leaving.count - 1, across = leaving.across / n / 3, along = leaving.along / n / 3;
	print_message("%g draws: mean squares over kT %.4f across (2), %.4f along (1)\n", n, across, along);
	assert_true(n > 19000 && fabs(across - 2) < 5 * 2 / sqrt(n) && fabs(along - 1) < 5 * sqrt(2 / n));
	touchstone_destroy(engine);
	scene_free(&scene);
}

/* Start states: as many as the packing allows, hot above the diagonal, no momentum. */
static void start_states(void **state)
{
	(void)state;
	struct random_state random = random_seed(SEED + 1);
	size_t limited = 0;
	for (int trial = 0; trial < 50; trial++) {
		double width = 2 + 30 * random_uniform(&random), height = 2 + 30 * random_uniform(&random);
		struct scene_recipe recipe = discs(1 + random_below(&random, 500), width, height);
		struct touchstone_scene scene;
		build(&recipe, &scene);
		double covered = (double)scene.particle_count * acos(-1) / 4 / (width * height), momentum[2] = {0};
		assert_true(covered <= 0.4 || scene.particle_count == 1);
		bool fewer = scene.particle_count < recipe.particle_count;
		if (fewer) assert_true(covered > 0.4 - 2.5 / (width * height) || width < 5 || height < 5);
		limited += fewer;
		for (size_t p = 0; p < scene.particle_count; p++) {
			const struct touchstone_particle *particle = &scene.particles[p];
			bool hot = particle->position[0] / width < particle->position[1] / height;
			assert_true(scene.convection.temperatures[p] == hot);
			for (int axis = 0; axis < 2; axis++) momentum[axis] += particle->velocity[axis];
		}
		if (scene.particle_count > 1) assert_true(fabs(momentum[0]) + fabs(momentum[1]) < 1e-12);
		assert_true(scene.convection.wall_temperatures[0] == 0 && scene.convection.wall_temperatures[1] == 1);
		scene_free(&scene);
	}
	print_message("seed %d: %zu of 50 limited by packing\n", SEED + 1, limited);
	assert_in_range(limited, 5, 45);
}

static void nonsense_is_refused(void **state)
{
	(void)state;
	struct touchstone_scene scene;
	struct scene_error complaint;
	struct scene_recipe recipe = discs(10, 10, 10);
	recipe.convection.kick = NAN;
	assert_false(scene_build(&recipe, SEED, &scene, &complaint));
	assert_string_equal(complaint.key, "convection");
	recipe = discs(10, 10, 10);
	recipe.thermostat = -1;
	assert_false(scene_build(&recipe, SEED, &scene, &complaint));
	assert_string_equal(complaint.key, "thermostat");
	recipe = discs(10, 10, 10);
	recipe.packing_limit = 1.5;
	assert_false(scene_build(&recipe, SEED, &scene, &complaint));
	assert_string_equal(complaint.key, "packing_limit");
}

int main(void)
{
	brief = getenv("TOUCHSTONE_BRIEF");
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(rules_of_heat),       cmocka_unit_test(books_close),   cmocka_unit_test(one_engine),
		cmocka_unit_test(heat_without_kicks),  cmocka_unit_test(thermal_walls), cmocka_unit_test(start_states),
		cmocka_unit_test(nonsense_is_refused),
	};
	return cmocka_run_group_tests(tests, NULL, NULL);
}
