/* The same gas at any time and in any place: bit for bit in the relative form, ever coarser in the absolute one. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <stdlib.h>
#include <string.h>

#include "measure/time_place.h"
#include "measure/vessel.h"
#include "scene/random.h"

enum { SEED = 20140807 };

static bool brief; /* under sanitizers, where everything takes ten times longer */
static char error[160];

static struct touchstone_status run(struct vessel *vessel, enum touchstone_form form, double box, double clock)
{
	struct touchstone_status status;
	vessel_put(vessel, form, box, clock);
	struct touchstone_engine *engine = touchstone_create(&vessel->scene, "binary64", "stable", error);
	if (!engine) fail_msg("%s", error);
	touchstone_run(engine, &(struct touchstone_limits){brief ? 500 : 5000, INFINITY, NULL}, NULL);
	touchstone_status(engine, &status);
	touchstone_destroy(engine);
	return status;
}

/* The digest holds the exact time of every event: where the vessel stands does not show in it, nor, once the clock is
 * taken off, when it began. */
static void the_relative_form_is_the_same_everywhere(void **state)
{
	(void)state;
	struct random_state random = random_seed(SEED);
	for (int draw = 0; draw < 3; draw++) {
		struct vessel vessel;
		if (!vessel_fill(&vessel, random_bits(&random), NULL, error)) fail_msg("%s", error);
		struct touchstone_status here = run(&vessel, TOUCHSTONE_RELATIVE, 10, 0);
		struct touchstone_status absolute = run(&vessel, TOUCHSTONE_ABSOLUTE, 10, 0);
		double boxes[] = {100, 1000, 20 + floor(4000 * random_uniform(&random))};
		for (size_t b = 0; b < sizeof boxes / sizeof *boxes; b++) {
			assert_true(run(&vessel, TOUCHSTONE_RELATIVE, boxes[b], 0).digest == here.digest);
			assert_true(vessel_middle(boxes[b]) + VESSEL_WIDTH / 2.0 <= boxes[b] / 2);
		}
		assert_true(run(&vessel, TOUCHSTONE_ABSOLUTE, 1000, 0).digest != absolute.digest);
		double clock = 1000 * (double)(1 + random_below(&random, 1000));
		assert_true(fabs(run(&vessel, TOUCHSTONE_RELATIVE, 10, clock).time - clock - here.time) < 1e-15 * 1e6);
		assert_true(run(&vessel, TOUCHSTONE_RELATIVE, 10, 0).digest == here.digest); /* and back again */
		vessel_empty(&vessel);
	}
}

static void add_all(struct sight sight[SITUATIONS][FORMS], const json_t *measured)
{
	for (size_t k = 0; k < SITUATIONS * FORMS; k++)
		time_place_add(&sight[k / FORMS][k % FORMS], measured, k / FORMS, (enum touchstone_form)(k % FORMS));
}

/* In the relative form every sight is the first one again; in the absolute one the error follows the last bit of the
 * clock (2^-23 at 10^9, times speeds of about 2) and of the position (2^-44 at 500). */
static void sights_widen_as_the_last_bit_says(void **state)
{
	(void)state;
	struct sight(*sight)[FORMS] = calloc(SITUATIONS, sizeof *sight);
	for (uint64_t vessel = 0; vessel < (brief ? 1 : 2); vessel++) {
		json_t *measured = time_place_measure(SEED + vessel, NULL, error);
		if (!measured) fail_msg("%s", error);
		assert_int_equal(json_array_size(measured), SITUATIONS * FORMS);
		add_all(sight, measured);
		json_decref(measured);
	}
	for (size_t s = 0; s < SITUATIONS; s++) {
		const struct sight *base = &sight[s < SITUATIONS / 2 ? 0 : SITUATIONS / 2][TOUCHSTONE_RELATIVE];
		const struct sight *one = &sight[s][TOUCHSTONE_RELATIVE];
		print_message("%s %-14s relative %.3g ulp, absolute %.3g ulp\n", situations[s].arithmetic, situations[s].name,
					  time_place_deviation(one), time_place_deviation(&sight[s][TOUCHSTONE_ABSOLUTE]));
		uint64_t all = 0;
		for (size_t side = 0; side < 2; side++)
			for (size_t k = 0; k < IMPACT_DOUBLINGS; k++) all += one->doubling[side][k];
		assert_true(all == one->contacts && one->contacts > 1000 * one->vessels);
		assert_true(one->contacts == base->contacts && one->sum == base->sum && one->squares == base->squares);
		assert_memory_equal(one->doubling, base->doubling, sizeof one->doubling);
	}
	const double ulp = 0x1p-52, expected[] = {0, 0x1p-43, 0x1p-33, 0x1p-23, 0x1p-47, 0x1p-44};
	for (size_t s = 1; s < SITUATIONS / 2; s++) {
		double found = time_place_deviation(&sight[s][TOUCHSTONE_ABSOLUTE]) * ulp;
		assert_true(found > 0.1 * expected[s] && found < 3 * expected[s]);
		assert_true(sight[s][TOUCHSTONE_ABSOLUTE].horizon[0] < sight[s][TOUCHSTONE_RELATIVE].horizon[0]);
	}
	free(sight);
}

static void a_watch_stops_it(void **state)
{
	(void)state;
	const volatile int stop = 1;
	assert_null(time_place_measure(SEED, &(struct watch){.stop = &stop}, error));
	assert_string_equal(error, "");
}

int main(void)
{
	brief = getenv("TOUCHSTONE_BRIEF");
	print_message("seed %d\n", SEED);
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(the_relative_form_is_the_same_everywhere),
		cmocka_unit_test(sights_widen_as_the_last_bit_says),
		cmocka_unit_test(a_watch_stops_it),
	};
	return cmocka_run_group_tests(tests, NULL, NULL);
}
