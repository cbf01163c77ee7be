/* Measures that campaigns keep as text come back bit for bit. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "measure/collapse.h"
#include "measure/course.h"
#include "measure/impact_json.h"
#include "scene/random.h"
#include "store/scene_file.h"

static const uint64_t seed = 20180212;

/* Through text and back, as a store does it. */
static json_t *kept(json_t *json)
{
	char *text = json_dumps(json, JSON_COMPACT);
	json_t *back = json_loads(text, 0, NULL);
	assert_non_null(back);
	json_decref(json);
	free(text);
	return back;
}

/* Fills a structure of 64-bit words with bits at random; counts stay below 2^63. */
static void scramble(struct random_state *random, void *structure, size_t size)
{
	uint64_t *words = structure;
	for (size_t w = 0; w < size / sizeof *words; w++) words[w] = random_below(random, INT64_MAX);
}

static void impacts_come_back(void **state)
{
	(void)state;
	print_message("seed %llu\n", (unsigned long long)seed);
	struct random_state random = random_seed(seed);
	struct impact *one = malloc(sizeof *one), *other = malloc(sizeof *other);
	for (int trial = 0; trial < 20; trial++) {
		memset(one, 0, sizeof *one), memset(other, 0, sizeof *other);
		one->bits = (int)random_below(&random, 1000);
		one->count = random_below(&random, INT64_MAX), one->forced = random_below(&random, INT64_MAX);
		scramble(&random, &one->measured, sizeof one->measured);
		scramble(&random, &one->exact, sizeof one->exact);
		json_t *json = kept(impact_to_json(one));
		struct impact back = impact_from_json(json);
		memcpy(&other->measured, &back.measured, sizeof other->measured);
		memcpy(&other->exact, &back.exact, sizeof other->exact);
		other->bits = back.bits, other->count = back.count, other->forced = back.forced;
		assert_memory_equal(one, other, sizeof *one);
		json_decref(json);
	}
	free(one);
	free(other);
	assert_true(impact_from_json(json_null()).count == 0);
}

/* One from a run, with its infinities where nothing was seen. */
static void a_measured_gas_comes_back(void **state)
{
	(void)state;
	for (uint64_t events = 0; events <= 2000; events += 2000) {
		char error[STORE_ERROR], reason[160];
		const char *const settings[] = {"particles=32"};
		struct scene_file *file = scene_file_open("cases/hard-spheres.yaml", 1, settings, error);
		struct touchstone_scene scene;
		assert_true(file && scene_file_build(file, &scene, error));
		struct touchstone_engine *engine = touchstone_create(&scene, "binary64", "stable", reason);
		struct impact impact;
		impact_begin(&impact, 53);
		touchstone_run(engine, &(struct touchstone_limits){events, INFINITY, NULL},
					   &(struct touchstone_observer){impact_see, &impact});
		json_t *json = kept(impact_to_json(&impact));
		struct impact back = impact_from_json(json);
		assert_true(back.count == events && back.exact.sum == impact.exact.sum);
		assert_memory_equal(&back.measured, &impact.measured, sizeof back.measured);
		assert_memory_equal(&back.exact, &impact.exact, sizeof back.exact);
		json_decref(json);
		touchstone_destroy(engine);
		scene_free(&scene);
		scene_file_close(file);
	}
}

static void collapses_come_back(void **state)
{
	(void)state;
	struct random_state random = random_seed(seed + 1);
	for (int trial = 0; trial < 200; trial++) {
		struct collapse one = {0};
		scramble(&random, &one, sizeof one);
		if (trial % 2) one.worst_plate = INFINITY, one.median_error = -0.0, one.deepest = -0x1p-1074;
		json_t *json = kept(collapse_json(&one));
		struct collapse back = collapse_of_json(json);
		assert_memory_equal(&one, &back, sizeof one);
		json_decref(json);
	}
	assert_true(collapse_of_json(json_null()).plates == 0);
}

int main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(impacts_come_back),
		cmocka_unit_test(a_measured_gas_comes_back),
		cmocka_unit_test(collapses_come_back),
	};
	return cmocka_run_group_tests(tests, NULL, NULL);
}
