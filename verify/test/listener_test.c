/* What listeners to tests hear: that shadows spare most of the work makes no difference to what is counted, in random
 * scenes, in any arithmetic and by any method, those that lose track of states included. */
#include <math.h>
#include <time.h>

#include "measure/inconsistency.h"
#include "program.h"
#include "scene/random.h"
#include "scene/scene.h"

static bool brief; /* under sanitizers, where everything takes ten times longer */
static struct random_state randomness;

static double between(double low, double high)
{
	return low + (high - low) * random_uniform(&randomness);
}

static size_t below(size_t count)
{
	return (size_t)between(0, (double)count);
}

/* What came of a run. */
struct heard {
	uint64_t told, tests, digest;
	struct inconsistency inconsistency;
};

static void hear(void *context, struct touchstone_engine *engine, const struct touchstone_test *test)
{
	struct heard *heard = context;
	heard->told++;
	inconsistency_test(&heard->inconsistency, engine, test);
}

static struct heard run(const struct touchstone_scene *scene, const char *arithmetic, const char *method,
						bool everything, uint64_t events)
{
	struct heard heard = {0};
	char error[160];
	struct touchstone_status status;
	struct touchstone_engine *engine = touchstone_create(scene, arithmetic, method, error);
	if (!engine) fail_msg("%s", error);
	touchstone_status(engine, &status);
	assert_true(inconsistency_begin(&heard.inconsistency, status.bits, scene->particle_count));
	struct touchstone_listener listener = heard.inconsistency.listener;
	listener.tested = hear, listener.context = &heard;
	if (everything) listener.margin = INFINITY;
	touchstone_observe_tests(engine, &listener);
	/* In few bits a method may lose all meetings, and then nothing else would end the run for long. */
	static const double end = 1000;
	touchstone_run(engine, &(struct touchstone_limits){events, end, NULL},
				   &(struct touchstone_observer){inconsistency_see, &heard.inconsistency});
	touchstone_status(engine, &status);
	heard.tests = listener.tests;
	heard.digest = status.digest;
	inconsistency_end(&heard.inconsistency);
	touchstone_destroy(engine);
	return heard;
}

/* A gas of one or two species, of which some pairs have steps. */
static bool random_scene(struct touchstone_scene *scene)
{
	static const double energies[] = {-1, 0.5, 1, -0.3};
	static const struct touchstone_restitution elastic = {TOUCHSTONE_CONSTANT, 1};
	static const struct scene_species balls[] = {{1, {1, 1}}, {1, {0.7, 2}}};
	struct touchstone_step steps[2][3];
	struct touchstone_potential potentials[2];
	for (size_t p = 0; p < 2; p++) {
		double core = below(3) ? 1 : 0, distance = core;
		size_t count = 1 + below(3);
		for (size_t s = 0; s < count; s++) {
			distance += between(0.2, 0.9);
			steps[p][s] = (struct touchstone_step){distance, energies[below(4)]};
		}
		potentials[p] = (struct touchstone_potential){{0, (uint32_t)p}, core, elastic, count, steps[p]};
	}
	bool mixed = below(3) == 0;
	const struct scene_recipe recipe = {.dimensions = (int)below(2) + 2,
										.particle_count = (size_t)between(20, 80),
										.density = below(2) ? 0.02 : between(0.1, 0.4),
										.boundary_restitution = elastic,
										.species_count = mixed ? 2 : 1,
										.species = balls,
										.restitution = elastic,
										.potential_count = mixed ? 2 : 1,
										.potentials = potentials,
										.velocities = SCENE_MAXWELL,
										.temperature = 1,
										.form = below(2) ? TOUCHSTONE_RELATIVE : TOUCHSTONE_ABSOLUTE,
										.search = below(10) ? TOUCHSTONE_CELLS : TOUCHSTONE_ALL};
	struct scene_error complaint;
	return scene_build(&recipe, (uint64_t)between(1, 1e9), scene, &complaint);
}

static void shadows_change_no_count(void **state)
{
	(void)state;
	static const char *const arithmetics[] = {"short:6",  "short:10", "short:14", "short:20",
											  "binary32", "binary64", "binary64", "mpfr:40"};
	static const char *const methods[] = {"stable", "stable", "positional", "stretch", "nudge", "last-event"};
	uint64_t tests = 0, told = 0, wrong = 0;
	for (int trial = 0, trials = brief ? 10 : 30; trial < trials; trial++) {
		struct touchstone_scene scene;
		const char *arithmetic = arithmetics[below(8)], *method = methods[below(6)];
		if (strncmp(arithmetic, "mpfr", 4) == 0) method = "stable"; /* the others ask for every pair */
		if (!random_scene(&scene)) continue;
		uint64_t events = brief ? 200 : 600;
		struct heard all = run(&scene, arithmetic, method, true, events);
		struct heard some = run(&scene, arithmetic, method, false, events);
		if (memcmp(all.inconsistency.count, some.inconsistency.count, sizeof some.inconsistency.count) != 0 ||
			all.tests != some.tests || all.digest != some.digest || all.told != all.tests || some.told > all.told)
			fail_msg("trial %d: counts differ by %s in %s", trial, method, arithmetic);
		tests += all.tests, told += some.told;
		for (int kind = 0; kind < INCONSISTENCIES; kind++) wrong += some.inconsistency.count[kind];
		scene_free(&scene);
	}
	print_message("%llu tests, %llu of them told; %llu inconsistencies\n", (unsigned long long)tests,
				  (unsigned long long)told, (unsigned long long)wrong);
	assert_true(tests > (brief ? 500 : 5000) && told < tests * 2 / 3 && wrong > (brief ? 50 : 500));
}

int main(void)
{
	uint64_t seed = (uint64_t)time(NULL);
	const char *chosen = getenv("TOUCHSTONE_SEED");
	if (chosen) seed = strtoull(chosen, NULL, 0);
	brief = getenv("TOUCHSTONE_BRIEF");
	print_message("seed %llu\n", (unsigned long long)seed);
	randomness = random_seed(seed);
	const struct CMUnitTest tests[] = {cmocka_unit_test(shadows_change_no_count)};
	return cmocka_run_group_tests(tests, NULL, NULL);
}
