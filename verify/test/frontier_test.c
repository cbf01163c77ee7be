/* The frontier of what is cheap and good, against a slow and plain way to it. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "measure/frontier.h"
#include "scene/random.h"

enum { SEED = 20141015 };

/* From left to right, the best are those that are worth more than all before: found by sorting instead. */
static void the_frontier_is_a_rising_staircase(void **state)
{
	(void)state;
	enum { MOST = 40 };
	struct random_state random = random_seed(SEED);
	for (int draw = 0; draw < 3000; draw++) {
		struct frontier_point points[MOST];
		size_t count = 1 + random_below(&random, MOST), best = 0;
		for (size_t p = 0; p < count; p++) {
			double cost = (double)random_below(&random, 12), worth = (double)random_below(&random, 12);
			bool missing = random_below(&random, 20) == 0, exact = random_below(&random, 20) == 0;
			points[p] = (struct frontier_point){missing ? NAN : cost, exact ? INFINITY : worth, draw % 2};
		}
		frontier_find(points, count);
		for (size_t p = 0; p < count; p++) {
			double highest = -INFINITY, beside = -INFINITY; /* of what costs less, and of what costs the same */
			for (size_t q = 0; q < count; q++) {
				if (points[q].cost < points[p].cost) highest = fmax(highest, points[q].worth);
				if (points[q].cost == points[p].cost) beside = fmax(beside, points[q].worth);
			}
			bool expected = !isnan(points[p].cost) && points[p].worth > highest && points[p].worth == beside;
			if (points[p].best != expected)
				fail_msg("draw %d: (%g, %g) is %sbest", draw, points[p].cost, points[p].worth,
						 points[p].best ? "" : "not ");
			best += points[p].best;
		}
		assert_true(best > 0 || count < 3);
	}
	struct frontier_point missing[2] = {{NAN, 1, true}, {1, NAN, true}};
	frontier_find(missing, 2);
	assert_false(missing[0].best || missing[1].best);
}

int main(void)
{
	print_message("seed %d\n", SEED);
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(the_frontier_is_a_rising_staircase),
	};
	return cmocka_run_group_tests(tests, NULL, NULL);
}
