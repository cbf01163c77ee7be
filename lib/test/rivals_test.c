/* Methods that read states from positions: one engine whatever the search and the arithmetic, energy that counts each
 * reading, and what an observer of tests is told. */
#include "step_scenes.h"

static bool brief; /* under sanitizers, where everything takes ten times longer */

static const char *const rivals[] = {"positional", "stretch", "nudge", "last-event"};
enum { RIVALS = sizeof rivals / sizeof *rivals };

static const struct touchstone_step well[] = {{1.5, -1}}, stairs[] = {{1.2, -0.5}, {1.5, 0.25}, {1.7, -0.25}};
static const struct touchstone_potential wells[] = {{{0, 0}, 1, {TOUCHSTONE_CONSTANT, 1}, 1, well}};
static const struct touchstone_potential stair_gas[] = {{{0, 0}, 1, {TOUCHSTONE_CONSTANT, 1}, 3, stairs}};

static struct scene_recipe step_gas(size_t count, const struct touchstone_potential *potential)
{
	struct scene_recipe recipe = gas(3, count, 0.2);
	recipe.potentials = potential;
	recipe.potential_count = 1;
	return recipe;
}

/* What they do is a function of what the last events left: where it is looked for does not matter. */
static void search_does_not_matter(void **state)
{
	(void)state;
	for (int m = 0; m < RIVALS; m++)
		for (int p = 0; p < 2; p++) {
			struct scene_recipe recipe = step_gas(60, p ? stair_gas : wells);
			uint64_t digest[3];
			for (int search = 0; search < 3; search++) {
				recipe.search = (enum touchstone_search)search;
				struct run run = begin(&recipe, "binary64", rivals[m]);
				digest[search] = advance(&run, brief ? 300 : 1000).digest;
				end(&run);
			}
			assert_true(digest[0] == digest[1] && digest[0] == digest[2]);
		}
}

static void equal_precision_means_equal_events(void **state)
{
	(void)state;
	static const char *const equal[][2] = {{"binary64", "mpfr:53"}, {"binary32", "mpfr:24"}, {"short:20", "mpfr:20"}};
	for (int m = 0; m < RIVALS; m++)
		for (int a = 0; a < 3; a++) {
			struct scene_recipe recipe = step_gas(40, stair_gas);
			uint64_t digest[2];
			for (int k = 0; k < 2; k++) {
				struct run run = begin(&recipe, equal[a][k], rivals[m]);
				digest[k] = advance(&run, brief ? 100 : 300).digest;
				end(&run);
			}
			assert_true(digest[0] == digest[1]);
		}
}

/* Without steps there is nothing to read, and positional is stable. */
static void hard_bodies_have_no_states(void **state)
{
	(void)state;
	struct scene_recipe recipe = gas(3, 50, 0.3);
	uint64_t digest[2];
	for (int k = 0; k < 2; k++) {
		struct run run = begin(&recipe, "binary64", k ? "positional" : "stable");
		digest[k] = advance(&run, 1000).digest;
		assert_true(status_of(&run).state_memory == 0);
		end(&run);
	}
	assert_true(digest[0] == digest[1]);
	for (int m = 1; m < RIVALS; m++) { /* the others correct collisions as well, and go on */
		struct run run = begin(&recipe, "binary64", rivals[m]);
		assert_int_equal(advance(&run, 1000).verdict, TOUCHSTONE_DONE);
		end(&run);
	}
}

/* ------------------------------------------------------------------ what is told of tests */

struct audience {
	const struct touchstone_scene *scene;
	struct touchstone_event event;
	uint64_t events, tests, states;
	double reach;
	bool own; /* the event's own pair was told of */
};

static void see(void *context, struct touchstone_engine *engine, const struct touchstone_event *event)
{
	(void)engine;
	struct audience *audience = context;
	if (audience->events && audience->event.kind != TOUCHSTONE_WALL) assert_true(audience->own);
	audience->event = *event;
	audience->events++;
	audience->own = false;
}

/* Of each pair: its tracked state, a separation that is the exact one, and the step that is nearest. */
static void hear(void *context, struct touchstone_engine *engine, const struct touchstone_test *test)
{
	struct audience *audience = context;
	double terms[3][3 * TOUCHSTONE_MOST_TERMS], distance[TOUCHSTONE_MOST_TERMS], square = 0;
	int count = touchstone_separation(engine, terms, distance);
	for (int axis = 0; axis < 3; axis++) {
		double sum = 0;
		for (int term = 0; term < count; term++) sum += terms[axis][term];
		square += sum * sum;
	}
	audience->tests++;
	audience->states += test->state > 0;
	assert_true(test->first < test->second);
	assert_true(test->first == audience->event.first || test->first == audience->event.second ||
				test->second == audience->event.first || test->second == audience->event.second);
	assert_int_equal(test->state, touchstone_pair_state(engine, test->first, test->second));
	const struct touchstone_potential *potential = &audience->scene->potentials[0];
	double limit = potential->steps[potential->step_count - 1 - (size_t)test->step].distance;
	assert_true(distance[0] == limit);
	assert_true(fabs(square / (limit * limit) - 1 - test->excess) < 1e-12);
	assert_true(test->state > 0 || sqrt(square) < 1.7 * audience->reach * (1 + 1e-12));
	if (fabs(test->excess) > 1e-9) assert_int_equal(test->state, test->within);
	audience->own |= test->first == audience->event.first && test->second == audience->event.second;
}

static void tests_are_told(void **state)
{
	(void)state;
	struct scene_recipe recipe = step_gas(200, stair_gas); /* 10 diameters wide: no pair has two images */
	double told[2];
	uint64_t digest[2];
	for (int k = 0; k < 2; k++) {
		struct run run = begin(&recipe, "binary64", "stable");
		struct audience audience = {.scene = &run.scene, .reach = k ? INFINITY : 1.02};
		struct touchstone_listener listener = {hear, &audience, audience.reach, INFINITY, 0};
		touchstone_observe_tests(run.engine, &listener);
		touchstone_run(run.engine, &(struct touchstone_limits){2000, INFINITY, NULL},
					   &(struct touchstone_observer){see, &audience});
		assert_true(audience.events == 2000 && audience.states > 1000);
		assert_true(listener.tests == audience.tests);
		told[k] = (double)audience.tests;
		touchstone_observe_tests(run.engine, NULL);
		digest[k] = advance(&run, 1000).digest;
		assert_true(audience.events == 2000);
		end(&run);
	}
	assert_true(told[1] > 2 * told[0] && digest[0] == digest[1]);
}

int main(void)
{
	brief = getenv("TOUCHSTONE_BRIEF");
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(search_does_not_matter),
		cmocka_unit_test(equal_precision_means_equal_events),
		cmocka_unit_test(hard_bodies_have_no_states),
		cmocka_unit_test(tests_are_told),
	};
	return cmocka_run_group_tests(tests, NULL, NULL);
}
