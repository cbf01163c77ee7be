/* `touchstone run --against`: for how long a run can be trusted. */
#include <math.h>

#include "measure/horizon.h"
#include "program.h"
#include "scene/random.h"
#include "store/scene_file.h"

static const uint64_t seed = 20160914;
static bool brief; /* under sanitizers, where everything takes ten times longer */

/* The same, found by hand. */
static struct horizon find(const char *path, const char *setting, uint64_t start, uint64_t events,
						   const char *arithmetic, const char *against)
{
	char error[STORE_ERROR], reason[160];
	const char *const settings[] = {setting, "equilibrate=0"};
	struct scene_file *file = scene_file_open(path, 2, settings, error);
	if (!file) fail_msg("%s", error);
	file->seed = start;
	struct touchstone_scene scene;
	struct horizon horizon;
	if (!scene_file_build(file, &scene, error)) fail_msg("%s", error);
	const struct touchstone_limits limits = {events, INFINITY, NULL};
	if (!horizon_find(&scene, "stable", arithmetic, against, &limits, NULL, &horizon, reason)) fail_msg("%s", reason);
	scene_free(&scene);
	scene_file_close(file);
	return horizon;
}

static void assert_event(const json_t *json, const struct horizon_event *event, double time)
{
	static const char *const kinds[] = {"contact", "wall", "capture", "release", "bounce"};
	const json_t *particles = json_object_get(json, "particles");
	assert_string_equal(json_text(json, "kind"), kinds[event->kind]);
	assert_true(json_number(json, "time") == time);
	if (event->kind == TOUCHSTONE_WALL) {
		assert_int_equal((int)json_number(json, "particle"), event->first);
		assert_int_equal((int)json_number(json, "wall"), event->second);
	} else {
		assert_int_equal(json_integer_value(json_array_get(particles, 0)), event->first);
		assert_int_equal(json_integer_value(json_array_get(particles, 1)), event->second);
	}
}

/* Gases, wells, walls with gravity, mixtures: without equilibration the horizon is the library's, and the run the one
 * it is without --against. */
static void any_scene_has_a_horizon(void **state)
{
	(void)state;
	static const struct {
		const char *scene, *setting;
	} scenes[] = {{"hard-spheres", "particles=108"}, {"inelastic-spheres", "particles=108"},
				  {"square-well", "particles=256"},  {"square-shoulder", "particles=256"},
				  {"mixture", "particles=100"},      {"discs", "particles=64"},
				  {"column", "particles=9"}};
	struct random_state random = random_seed(seed);
	print_message("seed %llu\n", (unsigned long long)seed);
	for (size_t s = 0; s < sizeof scenes / sizeof *scenes; s++) {
		char path[80], run[160];
		unsigned start = (unsigned)random_below(&random, 1000000), events = brief ? 1000 : 4000;
		snprintf(path, sizeof path, "cases/%s.yaml", scenes[s].scene);
		snprintf(run, sizeof run, "run %s --set %s --set equilibrate=0 --seed %u --events %u --arithmetic binary32",
				 path, scenes[s].setting, start, events);
		json_t *alone = program_json(program_run("%s --json -", run), 0);
		json_t *json = program_json(program_run("%s --against twin --json -", run), 0);
		struct horizon horizon = find(path, scenes[s].setting, start, events, "binary32", "twin");
		print_message("%s: %.3g events per particle\n", scenes[s].scene, json_number(json, "horizon"));
		assert_string_equal(json_text(json, "digest"), json_text(alone, "digest"));
		assert_string_equal(json_text(json, "against"), "twin");
		assert_null(json_object_get(alone, "against"));
		assert_null(json_object_get(alone, "horizon"));
		assert_true(json_number(json, "horizon") == horizon.per_particle);
		assert_true(json_number(json, "horizon_events") == (double)horizon.events);
		assert_true(json_number(json, "horizon_time") == horizon.time);
		assert_int_equal(json_is_true(json_object_get(json, "horizon_differs")), horizon.differ);
		const json_t *parting = json_object_get(json, "parting");
		assert_int_equal(json_is_object(parting), horizon.differ);
		if (horizon.differ && !horizon.here_ends)
			assert_event(json_object_get(parting, "here"), &horizon.here, horizon.here_time);
		if (horizon.differ && !horizon.there_ends)
			assert_event(json_object_get(parting, "there"), &horizon.there, horizon.there_time);
		json_decref(alone);
		json_decref(json);
	}
}

static void assert_said(struct said said, const char *const words[])
{
	assert_int_equal(said.status, 0);
	for (; *words; words++)
		if (!strstr(said.out, *words)) fail_msg("does not say '%s': %s", *words, said.out);
	said_free(&said);
}

#define GAS "run hard-spheres --set particles=108 --set equilibrate=5"

static void people_are_told(void **state)
{
	(void)state;
	assert_said(program_run(GAS " --arithmetic binary32 --against binary64 --events 3000"),
				(const char *const[]){"trust           this run for ", " events per particle: its first ",
									  "then it has a contact of ", "binary64 has a contact of ", NULL});
	assert_said(
		program_run("run cradle --against mpfr:128 --events 1000"),
		(const char *const[]){"trust           all of this run, ", "its 1000 events are those of mpfr:128", NULL});
	assert_said(program_run("run column --set particles=4 --set restitution=0.3 --against twin --events 1e5"),
				(const char *const[]){"trust           ", NULL});
	assert_said(program_run(GAS " --arithmetic short:14 --against binary32 --events 1000 --runs 4 --threads 2"),
				(const char *const[]){"trust           these runs for ", "mean of 4, standard deviation ",
									  ", the shortest ", NULL});
	assert_said(program_run(GAS " --against twin --events 50 --runs 3"),
				(const char *const[]){"3 of them never parted from twin", NULL});
}

/* After equilibration the run begins anew, so that it is the one that was compared: as many events, no more energy. */
static void a_run_that_was_equilibrated_goes_on_from_there(void **state)
{
	(void)state;
	static const char *const scenes[] = {"hard-spheres --set particles=108", "square-well --set particles=256"};
	for (size_t s = 0; s < 2; s++) {
		json_t *json = program_json(program_run("run %s --set equilibrate=5 --events 2000 --against mpfr:128 --measure "
												"conservation --json -",
												scenes[s]),
									0);
		assert_true(json_number(json, "events") == 2000);
		assert_true(json_number(json, "time_begun") > 0);
		assert_true(json_number(json, "time") > json_number(json, "time_begun"));
		assert_true(json_number(json, "horizon_time") > json_number(json, "time_begun"));
		assert_true(fabs(json_number(json_object_get(json, "conservation"), "energy_drift")) < 1e-12);
		json_decref(json);
	}
}

static void several_runs_have_a_spread(void **state)
{
	(void)state;
	json_t *json = program_json(
		program_run(GAS " --arithmetic short:16 --against binary64 --events 2000 --runs 5 --threads 2 --json -"), 0);
	json_t *together = json_object_get(json_object_get(json, "together"), "horizon"), *run;
	double sum = 0, least = INFINITY;
	size_t index;
	json_array_foreach(json_object_get(json, "runs"), index, run)
	{
		sum += json_number(run, "horizon");
		least = fmin(least, json_number(run, "horizon"));
	}
	assert_true(json_number(together, "count") == 5);
	assert_true(fabs(json_number(together, "mean") - sum / 5) < 1e-12 * sum);
	assert_true(json_number(together, "least") == least);
	assert_true(json_number(together, "deviation") > 0);
	assert_true(json_number(together, "open") == 0);
	json_decref(json);
}

static void what_cannot_be_is_refused(void **state)
{
	(void)state;
	program_refused(program_run(GAS " --against binary32"), "--against: binary32 carries 24 bits, no more than the 53");
	program_refused(program_run(GAS " --against decimal"), "--against: no arithmetic 'decimal'");
	program_refused(program_run(GAS " --arithmetic mpfr:200 --against mpfr:128"), "accepted: a finer arithmetic");
	/* where nothing is run there is no horizon */
	json_t *json = program_json(program_run(GAS " --events 0 --against twin --json -"), 0);
	assert_true(json_is_null(json_object_get(json, "horizon")));
	json_decref(json);
}

int main(void)
{
	brief = getenv("TOUCHSTONE_BRIEF");
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(any_scene_has_a_horizon),
		cmocka_unit_test(people_are_told),
		cmocka_unit_test(a_run_that_was_equilibrated_goes_on_from_there),
		cmocka_unit_test(several_runs_have_a_spread),
		cmocka_unit_test(what_cannot_be_is_refused),
	};
	return cmocka_run_group_tests(tests, NULL, NULL);
}
