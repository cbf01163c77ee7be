/* The horizon of trust: where two arithmetics part, from start states that both are given alike. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <stdlib.h>
#include <string.h>

#include "measure/horizon.h"
#include "measure/start_state.h"
#include "scene/random.h"
#include "scene/scene.h"

enum { SEED = 20160914, SPHERES = 108 };

static bool brief; /* under sanitizers, where everything takes ten times longer */
static char error[160];

/* A gas of hard spheres, equilibrated. */
static struct touchstone_scene gas(uint64_t seed, enum touchstone_form form)
{
	static const struct scene_species ball = {1, {1, 1}};
	struct touchstone_scene scene;
	struct scene_error wrong;
	const struct scene_recipe recipe = {.dimensions = 3,
										.particle_count = SPHERES,
										.density = 0.5,
										.boundary_restitution = {TOUCHSTONE_CONSTANT, 1},
										.species_count = 1,
										.species = &ball,
										.restitution = {TOUCHSTONE_CONSTANT, 1},
										.positions = SCENE_LATTICE,
										.velocities = SCENE_MAXWELL,
										.temperature = 1,
										.form = form};
	if (!scene_build(&recipe, seed, &scene, &wrong)) fail_msg("%s: %s", wrong.key, wrong.text);
	struct touchstone_particle *particles = calloc(SPHERES, sizeof *particles);
	if (!start_state(&scene, 10, NULL, particles, error)) fail_msg("%s", error);
	free((void *)scene.particles);
	scene.particles = particles;
	return scene;
}

static struct horizon horizon_of(const struct touchstone_scene *scene, const char *arithmetic, const char *reference,
								 uint64_t events)
{
	struct horizon horizon;
	const struct touchstone_limits limits = {.events = events, .time = INFINITY};
	if (!horizon_find(scene, "stable", arithmetic, reference, &limits, NULL, &horizon, error)) fail_msg("%s", error);
	return horizon;
}

static uint64_t any_seed(int draw)
{
	struct random_state random = random_seed(SEED + (uint64_t)draw);
	return random_below(&random, 1000);
}

/* An arithmetic is of one mind with itself, and with another that carries as many bits. */
static void equals_never_differ(void **state)
{
	(void)state;
	static const char *const pairs[][2] = {
		{"short:12", "short:12"}, {"binary32", "binary32"},   {"binary64", "binary64"},
		{"twin", "twin"},         {"binary128", "binary128"}, {"mpfr:80", "mpfr:80"},
	};
	for (int form = 0; form < 2; form++) {
		struct touchstone_scene scene = gas(any_seed(form), (enum touchstone_form)form);
		for (size_t p = 0; p < sizeof pairs / sizeof *pairs; p++) {
			uint64_t events = brief ? 300 : 3001;
			struct horizon horizon = horizon_of(&scene, pairs[p][0], pairs[p][1], events);
			assert_false(horizon.differ);
			assert_false(horizon.stopped);
			assert_int_equal(horizon.events, events);
			assert_true(fabs(horizon.per_particle - 2.0 * (double)events / SPHERES) < 1e-9);
			assert_true(horizon.time > 0);
		}
		scene_free(&scene);
	}
}

/* The event that is told apart is told as the two engines execute it. */
struct witness {
	struct horizon_event event;
	uint64_t left;
};

static void see(void *context, struct touchstone_engine *engine, const struct touchstone_event *event)
{
	(void)engine;
	struct witness *witness = context;
	witness->event = (struct horizon_event){event->kind, event->first, event->second};
	witness->left--;
}

static struct horizon_event event_of(const struct touchstone_scene *scene, const char *arithmetic, uint64_t number)
{
	struct witness witness = {.left = number + 1};
	struct touchstone_engine *engine = touchstone_create(scene, arithmetic, "stable", error);
	const struct touchstone_limits limits = {.events = number + 1, .time = INFINITY};
	touchstone_run(engine, &limits, &(struct touchstone_observer){see, &witness});
	touchstone_destroy(engine);
	assert_int_equal(witness.left, 0);
	return witness.event;
}

static void the_first_difference_is_there(void **state)
{
	(void)state;
	for (int draw = 0; draw < 4; draw++) {
		struct touchstone_scene scene = gas(any_seed(10 + draw), TOUCHSTONE_RELATIVE);
		struct horizon horizon = horizon_of(&scene, "binary32", "binary64", UINT64_MAX);
		scene.grain = 24;
		struct horizon_event here = event_of(&scene, "binary32", horizon.events);
		struct horizon_event there = event_of(&scene, "binary64", horizon.events);
		assert_true(horizon.differ && !horizon.here_ends && !horizon.there_ends);
		assert_memory_equal(&here, &horizon.here, sizeof here);
		assert_memory_equal(&there, &horizon.there, sizeof there);
		assert_memory_not_equal(&here, &there, sizeof here);
		/* all but the last of the events before are the same: the sequences part here and not sooner */
		here = event_of(&scene, "binary32", horizon.events - 1);
		there = event_of(&scene, "binary64", horizon.events - 1);
		assert_memory_equal(&here, &there, sizeof here);
		scene_free(&scene);
	}
}

/* More bits, more trust: over the same start states the mean horizon grows with every step, and about in proportion to
 * the bits. */
static void finer_arithmetic_is_trusted_longer(void **state)
{
	(void)state;
	static const char *const ladder[] = {"short:12", "binary32", "binary64", "binary128"};
	enum { RUNGS = sizeof ladder / sizeof *ladder, MOST = 6 };
	struct horizon horizon[RUNGS][MOST];
	int starts = brief ? 2 : MOST;
	for (int s = 0; s < starts; s++) {
		struct touchstone_scene scene = gas(any_seed(20 + s), TOUCHSTONE_RELATIVE);
		for (int r = 0; r < RUNGS; r++) horizon[r][s] = horizon_of(&scene, ladder[r], "mpfr:256", UINT64_MAX);
		scene_free(&scene);
	}
	struct horizon_spread before = {0};
	for (int r = 0; r < RUNGS; r++) {
		struct horizon_spread spread = horizon_spread(horizon[r], (size_t)starts);
		print_message("%-10s %.3f +- %.3f events per particle\n", ladder[r], spread.mean, spread.deviation);
		assert_int_equal(spread.count, starts);
		assert_int_equal(spread.open, 0);
		assert_true(spread.mean > before.mean);
		before = spread;
	}
	double slope = (before.mean - horizon_spread(horizon[1], (size_t)starts).mean) / (113 - 24);
	double between =
		(horizon_spread(horizon[2], (size_t)starts).mean - horizon_spread(horizon[1], (size_t)starts).mean) / (53 - 24);
	assert_true(slope > 0.1 && slope < 2); /* each event takes between half a bit and ten */
	assert_true(fabs(between - slope) < 0.5 * slope);
}

/* Two walls and a ball count one particle to an event; where nothing happens any more, nothing differs. */
static void walls_count_once_and_ends_are_no_difference(void **state)
{
	(void)state;
	const struct touchstone_particle particles[2] = {{{-1.25, 0, 0}, {1, 0, 0}, 0}, {{1.25, 0, 0}, {-0.5, 0, 0}, 0}};
	const struct touchstone_wall walls[2] = {{{-2, 0, 0}, {1, 0, 0}, {TOUCHSTONE_CONSTANT, 1}},
											 {{2, 0, 0}, {-1, 0, 0}, {TOUCHSTONE_CONSTANT, 1}}};
	const struct touchstone_species ball = {1, 1};
	struct touchstone_scene scene = {.dimensions = 1,
									 .particle_count = 2,
									 .particles = particles,
									 .species_count = 1,
									 .species = &ball,
									 .box = {8},
									 .restitution = {TOUCHSTONE_CONSTANT, 1}};
	struct horizon open = horizon_of(&scene, "binary32", "binary64", 10);
	assert_false(open.differ);
	assert_int_equal(open.events, 1); /* they meet, then part for ever */
	assert_true(open.per_particle == 1);

	scene.walls = walls;
	scene.wall_count = 2;
	struct horizon walled = horizon_of(&scene, "binary64", "mpfr:128", 3);
	assert_false(walled.differ);
	assert_true(walled.per_particle == (2 + 1 + 1) / 2.0); /* a contact, then each at its wall */
}

/* So does every event at a step of a potential: two particles go into their well, collide, come out. */
static void an_event_of_a_pair_counts_twice(void **state)
{
	(void)state;
	const struct touchstone_particle particles[2] = {{{-2.25, 0, 0}, {1, 0, 0}, 0}, {{2.25, 0, 0}, {-0.5, 0, 0}, 0}};
	const struct touchstone_species ball = {1, 1};
	const struct touchstone_step well = {2, -0.25};
	const struct touchstone_potential potential = {{0, 0}, 1, {TOUCHSTONE_CONSTANT, 1}, 1, &well};
	struct touchstone_scene scene = {.dimensions = 1,
									 .particle_count = 2,
									 .particles = particles,
									 .species_count = 1,
									 .species = &ball,
									 .box = {8},
									 .restitution = {TOUCHSTONE_CONSTANT, 1},
									 .potential_count = 1,
									 .potentials = &potential};
	struct horizon horizon = horizon_of(&scene, "binary64", "mpfr:128", 10);
	assert_false(horizon.differ);
	assert_int_equal(horizon.events, 3);
	assert_true(horizon.per_particle == 3);
}

static void a_watch_stops_it_and_is_told(void **state)
{
	(void)state;
	struct touchstone_scene scene = gas(any_seed(30), TOUCHSTONE_RELATIVE);
	const volatile int stop = 1;
	struct horizon horizon;
	const struct touchstone_limits limits = {.events = 1000, .time = INFINITY};
	assert_true(horizon_find(&scene, "stable", "binary32", "binary64", &limits, &(struct watch){&stop, NULL, NULL},
							 &horizon, error));
	assert_true(horizon.stopped && !horizon.differ);
	assert_int_equal(horizon_spread(&horizon, 1).count, 0);
	assert_true(isnan(horizon_spread(&horizon, 1).mean));
	scene_free(&scene);
}

static void what_cannot_be_is_said(void **state)
{
	(void)state;
	static const struct {
		const char *arithmetic, *reference, *method, *words;
	} wrong[] = {
		{"decimal", "mpfr:256", "stable", "no arithmetic 'decimal'"},
		{"binary64", "decimal", "stable", "no arithmetic 'decimal'"},
		{"binary64", "binary32", "stable", "binary32 carries 24 bits, no more than the 53 of binary64"},
		{"binary64", "mpfr:53", "stable", "mpfr:53 carries 53 bits"},
		{"binary32", "binary64", "kahan", "kahan"},
	};
	struct touchstone_scene scene = gas(1, TOUCHSTONE_RELATIVE);
	const struct touchstone_limits limits = {.events = 10, .time = INFINITY};
	for (size_t w = 0; w < sizeof wrong / sizeof *wrong; w++) {
		struct horizon horizon;
		assert_false(horizon_find(&scene, wrong[w].method, wrong[w].arithmetic, wrong[w].reference, &limits, NULL,
								  &horizon, error));
		if (!strstr(error, wrong[w].words)) fail_msg("'%s' does not say '%s'", error, wrong[w].words);
	}
	assert_int_equal(horizon_bits("short:7", error), 7);
	assert_int_equal(horizon_bits("mpfr:1024", error), 1024);
	scene_free(&scene);
}

/* What is handed on is where the particles are, to the last bit of a double. */
static void a_start_state_is_that_of_the_equilibrated_engine(void **state)
{
	(void)state;
	struct touchstone_scene scene = gas(any_seed(40), TOUCHSTONE_RELATIVE);
	struct touchstone_particle found[SPHERES];
	assert_true(start_state(&scene, 3, NULL, found, error));
	struct touchstone_engine *engine = touchstone_create(&scene, "binary64", "stable", error);
	const struct touchstone_limits limits = {.events = 3 * SPHERES / 2, .time = INFINITY};
	touchstone_run(engine, &limits, NULL);
	for (uint32_t i = 0; i < SPHERES; i++) {
		double position[3], velocity[3];
		touchstone_state(engine, i, position, velocity);
		assert_memory_equal(found[i].position, position, sizeof position);
		assert_memory_equal(found[i].velocity, velocity, sizeof velocity);
		assert_int_equal(found[i].species, 0);
	}
	touchstone_destroy(engine);
	scene_free(&scene);
	const volatile int stop = 1;
	scene = gas(2, TOUCHSTONE_RELATIVE);
	assert_false(start_state(&scene, 3, &(struct watch){&stop, NULL, NULL}, found, error));
	assert_string_equal(error, "");
	scene_free(&scene);
}

int main(void)
{
	brief = getenv("TOUCHSTONE_BRIEF");
	print_message("seed %d\n", SEED);
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(equals_never_differ),
		cmocka_unit_test(the_first_difference_is_there),
		cmocka_unit_test(finer_arithmetic_is_trusted_longer),
		cmocka_unit_test(walls_count_once_and_ends_are_no_difference),
		cmocka_unit_test(an_event_of_a_pair_counts_twice),
		cmocka_unit_test(a_watch_stops_it_and_is_told),
		cmocka_unit_test(what_cannot_be_is_said),
		cmocka_unit_test(a_start_state_is_that_of_the_equilibrated_engine),
	};
	return cmocka_run_group_tests(tests, NULL, NULL);
}
