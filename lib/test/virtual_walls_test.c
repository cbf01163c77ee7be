/* Virtual walls look on and change nothing, and count all that passes. */
#include "step_scenes.h"

static bool brief; /* under sanitizers, where everything takes ten times longer */

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

int main(void)
{
	brief = getenv("TOUCHSTONE_BRIEF");
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(virtual_walls_only_look),
		cmocka_unit_test(laps_are_counted),
		cmocka_unit_test(paths_that_bend_come_back),
	};
	return cmocka_run_group_tests(tests, NULL, NULL);
}
