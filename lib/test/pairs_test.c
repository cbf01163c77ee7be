/* Every way of searching pairs in binary64, vector by vector and one by one, gives the same events. The engine is
 * compiled into this program once more, so that each can be put in place by hand. */
#include "num/binary64.h"

#define NUM_HAS_LANES
#define THIS_UNIT unit_under_test
#include "engine/engine.inl"

#include <setjmp.h>
#include <stddef.h>

#include <cmocka.h>

#include "scene/random.h"
#include "scene/scene.h"

enum { SEED = 20160916 };

static struct touchstone_status run(const struct touchstone_scene *scene, pair_search *pairs)
{
	char error[160];
	struct touchstone_engine *engine = engine_create(scene, "stable", error);
	assert_non_null(engine);
	engine->pairs = pairs;
	lay_out(engine);
	engine_run(engine, &(struct touchstone_limits){20000, INFINITY, NULL}, NULL);
	struct touchstone_status status;
	engine_status(engine, &status);
	engine_destroy(engine);
	return status;
}

static void every_search_gives_the_same_events(void **state)
{
	(void)state;
	static const struct scene_species species[] = {{0.5, {1, 1}}, {0.5, {0.7, 0.5}}};
	struct random_state random = random_seed(SEED);
	print_message("seed %d\n", SEED);
	for (int trial = 0; trial < 12; trial++) {
		int dimensions = 1 + trial % 3;
		struct scene_recipe recipe = {
			.dimensions = dimensions,
			.particle_count = 10 + random_bits(&random) % 300,
			.density = 0.02 + 0.6 * random_uniform(&random),
			.boundary_restitution = {TOUCHSTONE_CONSTANT, 1},
			.species_count = 1 + random_bits(&random) % 2,
			.species = species,
			.restitution = {TOUCHSTONE_CONSTANT, random_bits(&random) % 2 ? 1 : 0.9},
			.positions = SCENE_LATTICE,
			.velocities = SCENE_MAXWELL,
			.temperature = 1,
			.form = random_bits(&random) % 2 ? TOUCHSTONE_ABSOLUTE : TOUCHSTONE_RELATIVE,
		};
		struct scene_species one = {1, species[0].body};
		if (recipe.species_count == 1) recipe.species = &one;
		struct touchstone_scene scene;
		struct scene_error wrong;
		if (!scene_build(&recipe, SEED, &scene, &wrong)) fail_msg("%s %s", wrong.key, wrong.text);
		struct touchstone_status single = run(&scene, consider_pairs), other = run(&scene, search_128);
		assert_true(single.events > 1000);
		assert_int_equal(single.digest, other.digest);
#ifdef __x86_64__
		if (__builtin_cpu_supports("avx2")) assert_int_equal(run(&scene, search_256).digest, single.digest);
		if (has_avx512()) assert_int_equal(run(&scene, search_512).digest, single.digest);
#endif
		scene_free(&scene);
	}
}

int main(void)
{
	const struct CMUnitTest tests[] = {cmocka_unit_test(every_search_gives_the_same_events)};
	return cmocka_run_group_tests(tests, NULL, NULL);
}
