/* The watcher of the failure atlas finds what is known to go wrong, the command of a cell shows what the cell says, and
 * traces mark the events of the 2014 paper's figures 4 and 6. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <stdio.h>
#include <string.h>

#include "measure/failure.h"
#include "program.h"
#include "store/scene_file.h"
#include "test/gas.h"

enum { EVENTS = 2000 };

static struct failure judged_within(uint64_t events, const char *scene_name, const char *arithmetic, const char *method)
{
	char path[400], error[STORE_ERROR];
	snprintf(path, sizeof path, "%s/%s.yaml", TOUCHSTONE_CASES, scene_name);
	struct scene_file *file = scene_file_open(path, 0, NULL, error);
	struct touchstone_scene scene;
	struct failure failure;
	if (!file || !scene_file_build(file, &scene, error)) fail_msg("%s", error);
	const struct touchstone_limits limits = {events, INFINITY, NULL};
	if (!failure_find(&scene, 0, arithmetic, method, &limits, NULL, &failure, error)) fail_msg("%s", error);
	scene_free(&scene);
	scene_file_close(file);
	return failure;
}

static struct failure judged(const char *scene_name, const char *arithmetic, const char *method)
{
	return judged_within(EVENTS, scene_name, arithmetic, method);
}

static void what_is_known_to_go_wrong_is_found(void **state)
{
	(void)state;
	static const struct {
		const char *scene, *arithmetic, *method;
		enum failure_kind kind;
		uint64_t event;
	} known[] = {
		{"three-body", "binary64", "naive", FAILURE_HALTS, 1},
		{"stress/cradle", "binary64", "stable", FAILURE_NONE, 0},
		{"stress/cradle", "binary64", "guarded", FAILURE_PASSES, 2}, /* the struck ball flies through the next */
		{"stress/corner", "binary64", "stable", FAILURE_REST, 0},
		{"stress/corner", "binary64", "guarded", FAILURE_OVER, 14}, /* it has left the plane and is lost */
		{"stress/corner", "binary64", "tc", FAILURE_NONE, 0},       /* it never rests */
		{"stress/near-collapse", "binary64", "skip", FAILURE_ENTANGLES, 709},
		{"stress/near-collapse", "binary64", "rewind", FAILURE_BACKWARDS, 732},
		{"stress/long-times", "short:8", "stable", FAILURE_LOOPS, 384}, /* the clock's step is 2^13 */
		{"stress/dense", "short:8", "stable", FAILURE_GAINS_ENERGY, 10},
	};
	for (size_t k = 0; k < sizeof known / sizeof *known; k++) {
		struct failure failure = judged(known[k].scene, known[k].arithmetic, known[k].method);
		print_message("%s, %s, %s: %s at event %llu: %s\n", known[k].scene, known[k].arithmetic, known[k].method,
					  failure_word(failure.kind), (unsigned long long)failure.event, failure.text);
		assert_int_equal(failure.kind, known[k].kind);
		assert_int_equal(failure.event, known[k].event);
	}
}

/* A scene that has no events left has not failed; neither has one that reaches its time. */
static void an_end_is_no_failure(void **state)
{
	(void)state;
	struct failure failure = judged("three-body", "binary64", "stable");
	assert_int_equal(failure.kind, FAILURE_OVER);
	assert_true(failure_survived(&failure) && failure.event == 3);
}

/* In few bits a gas that cools ends as a flock: the momentum that rounding gives it does not cool. What thermal walls
 * and kicks bring in is no fault. */
static void what_is_conserved_is_kept(void **state)
{
	(void)state;
	struct failure failure = judged_within(9500, "stress/inelastic", "short:9", "stable");
	print_message("%s at event %llu: %s\n", failure_word(failure.kind), (unsigned long long)failure.event,
				  failure.text);
	assert_int_equal(failure.kind, FAILURE_DRIFTS);
	assert_int_equal(failure.event, 9227);
	assert_non_null(strstr(failure.text, "momentum"));
	assert_int_equal(judged_within(9200, "stress/inelastic", "short:9", "stable").kind, FAILURE_NONE);
	assert_int_equal(judged_within(20000, "convection", "binary64", "stable").kind, FAILURE_NONE);
}

/* Cold discs lose most of what they have before thermal walls heat them a thousand times. */
static void heat_is_no_fault(void **state)
{
	(void)state;
	static const double restitutions[] = {1, 0.9, 0.6};
	static const char *const arithmetics[] = {"short:16", "binary64"};
	for (int k = 0; k < 6; k++) {
		struct scene_recipe recipe = gas(2, 100, 0.3);
		struct touchstone_scene scene;
		struct scene_error complaint;
		struct failure failure;
		char error[160];
		recipe.boundary[0] = recipe.boundary[1] = SCENE_WALLS;
		recipe.restitution.coefficient = restitutions[k / 2];
		recipe.thermostat = 1;
		recipe.temperature = 1e-3;
		if (!scene_build(&recipe, 1, &scene, &complaint)) fail_msg("%s %s", complaint.key, complaint.text);
		const struct touchstone_limits limits = {20000, INFINITY, NULL};
		if (!failure_find(&scene, 0, arithmetics[k % 2], "stable", &limits, NULL, &failure, error))
			fail_msg("%s", error);
		if (failure.kind != FAILURE_NONE)
			fail_msg("restitution %g, %s: %s at event %llu: %s", restitutions[k / 2], arithmetics[k % 2],
					 failure_word(failure.kind), (unsigned long long)failure.event, failure.text);
		scene_free(&scene);
	}
}

static void commands_show_their_cells(void **state)
{
	(void)state;
	static const char *const scenes[] = {"cradle", "corner"};
	const char *method;
	for (size_t s = 0; s < 2; s++)
		for (size_t m = 0; (method = touchstone_method_name(m)); m++) {
			char name[40];
			snprintf(name, sizeof name, "stress/%s", scenes[s]);
			struct failure failure = judged(name, "binary64", method);
			json_t *json = program_json(
				program_run("run %s --method %s --events %d --measure failure --json -", name, method, EVENTS),
				!failure_survived(&failure));
			const json_t *told = json_object_get(json, "failure");
			assert_string_equal(json_text(told, "what"), failure_word(failure.kind));
			assert_int_equal(json_integer_value(json_object_get(told, "event")), failure.event);
			json_decref(json);
		}
}

/* Of the stable rule's three events the third is stabilising; rewind goes back in time at its second. */
static void traces_mark_events(void **state)
{
	(void)state;
	json_t *json = program_json(program_run("run three-body --trace --json -"), 0), *event;
	const json_t *trace = json_object_get(json, "trace");
	size_t index;
	assert_int_equal(json_array_size(trace), 3);
	json_array_foreach(trace, index, event)
	{
		assert_int_equal(json_is_true(json_object_get(event, "stabilising")), index == 2);
		assert_int_equal(json_integer_value(json_object_get(event, "steps")), -1);
		assert_false(json_is_true(json_object_get(event, "backwards")));
	}
	json_decref(json);
	json = program_json(program_run("run three-body --method rewind --trace --json -"), 0);
	event = json_array_get(json_object_get(json, "trace"), 1);
	assert_true(json_is_true(json_object_get(event, "backwards")));
	json_decref(json);
	program_refused(program_run("run three-body --trace --runs 2"), "--trace");
	struct said said = program_run("run three-body --trace");
	assert_non_null(strstr(said.out, "stabilising"));
	said_free(&said);
}

int main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(what_is_known_to_go_wrong_is_found), cmocka_unit_test(an_end_is_no_failure),
		cmocka_unit_test(what_is_conserved_is_kept),          cmocka_unit_test(heat_is_no_fault),
		cmocka_unit_test(commands_show_their_cells),          cmocka_unit_test(traces_mark_events),
	};
	return cmocka_run_group_tests(tests, NULL, NULL);
}
