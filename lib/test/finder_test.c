/* Finders without an oracle: every way of asking gives the same answers, arithmetics of the same precision agree to the
 * last bit, and what cannot be answered is said so. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "scene/random.h"
#include "test/long_double.h"
#include "touchstone.h"

enum { COUNT = 517, SEED = 20140501 }; /* no multiple of any vector's width */

static const char *const arithmetics[] = {"short:4", "short:24",  "binary32", "binary64", "extended",
										  "twin",    "binary128", "mpfr:24",  "mpfr:53",  "mpfr:1024"};
enum { ARITHMETICS = sizeof arithmetics / sizeof *arithmetics };

static double question[COUNT][TOUCHSTONE_MOST_NUMBERS];

static void draw_questions(void)
{
	struct random_state random = random_seed(SEED);
	print_message("seed %d\n", SEED);
	for (int k = 0; k < COUNT; k++) {
		for (int i = 0; i < TOUCHSTONE_MOST_NUMBERS; i++) question[k][i] = 4 * random_uniform(&random) - 2;
		for (int i = 0; i < 3; i++) question[k][3 + i] -= question[k][i];
		if (k % 3 == 0) question[k][6] = 0.1;
		if (k % 5 == 0) /* few bits: zeros, ties, touches */
			for (int i = 0; i < TOUCHSTONE_MOST_NUMBERS; i++) question[k][i] = rint(question[k][i]);
		if (k % 7 == 0) { /* a last bit from contact */
			question[k][6] = 1 + question[k][6] / 4;
			question[k][0] = nextafter(question[k][6], k % 2 ? 0 : 9);
			question[k][1] = question[k][2] = 0;
		}
	}
}

/* False when the method has no finder for the shape. */
static bool ask(const char *arithmetic, const char *method, int shape, bool chained, double time[COUNT])
{
	char error[160] = "";
	const double(*numbers)[TOUCHSTONE_MOST_NUMBERS] = (const double(*)[TOUCHSTONE_MOST_NUMBERS])question;
	if (touchstone_find(arithmetic, method, (enum touchstone_shape)shape, numbers, COUNT, chained, time, error))
		return true;
	assert_non_null(strstr(error, "has no finder for"));
	return false;
}

/* Two NaNs are alike; zeros of different sign are not. */
static bool same(double x, double y)
{
	return (isnan(x) && isnan(y)) || memcmp(&x, &y, sizeof x) == 0;
}

static void every_way_of_asking_gives_the_same(void **state)
{
	(void)state;
	const char *method;
	for (int a = 0; a < ARITHMETICS; a++)
		for (int m = 0; (method = touchstone_finder_name((size_t)m)); m++)
			for (int shape = 0; shape < TOUCHSTONE_SHAPES; shape++) {
				double together[COUNT], chained[COUNT];
				if (!ask(arithmetics[a], method, shape, false, together)) continue;
				assert_true(ask(arithmetics[a], method, shape, true, chained));
				for (int k = 0; k < COUNT; k++) {
					struct touchstone_steps steps;
					char error[160];
					assert_true(touchstone_find_steps(arithmetics[a], method, (enum touchstone_shape)shape, question[k],
													  &steps, error));
					if (!same(together[k], chained[k]) || !same(together[k], steps.time))
						fail_msg("%s in %s, shape %d: %a together, %a chained, %a by steps", method, arithmetics[a],
								 shape, together[k], chained[k], steps.time);
				}
			}
}

static void assert_agree(const char *first, const char *second)
{
	const char *method;
	int found = 0;
	for (int m = 0; (method = touchstone_finder_name((size_t)m)); m++)
		for (int shape = 0; shape < TOUCHSTONE_SHAPES; shape++) {
			double time[COUNT], other[COUNT];
			if (!ask(first, method, shape, false, time)) continue;
			assert_true(ask(second, method, shape, false, other));
			for (int k = 0; k < COUNT; k++) {
				found += time[k] > 0 && time[k] < INFINITY;
				if (!same(time[k], other[k]))
					fail_msg("%s, shape %d: %a in %s, %a in %s", method, shape, time[k], first, other[k], second);
			}
		}
	assert_true(found > COUNT);
}

static void one_precision_is_one_arithmetic(void **state)
{
	(void)state;
	assert_agree("mpfr:53", "binary64");
	assert_agree("mpfr:24", "binary32");
	assert_agree("short:24", "binary32");
	if (arithmetic_is_whole("extended")) assert_agree("mpfr:64", "extended");
	assert_agree("mpfr:113", "binary128");
	assert_agree("short:5", "mpfr:5");
}

/* An answer that every method must get right in every arithmetic. */
static void simple_questions(void **state)
{
	(void)state;
	static const double number[][TOUCHSTONE_MOST_NUMBERS] = {
		{3, 0, 0, -1, 0, 0, 1}, {1, 0, 0, 1, 0, 0, 3}, {2.5, 0, -1, 0.5}, {3, -2}};
	const char *method;
	for (int a = 0; a < ARITHMETICS; a++)
		for (int m = 0; (method = touchstone_finder_name((size_t)m)); m++)
			for (int shape = 0; shape < TOUCHSTONE_SHAPES; shape++) {
				double time;
				char error[160];
				if (touchstone_find(arithmetics[a], method, (enum touchstone_shape)shape, &number[shape], 1, false,
									&time, error))
					assert_true(time == (shape == TOUCHSTONE_HALF_SPACE ? 1.5 : 2));
			}
}

static void steps_are_those_of_the_overlap_function(void **state)
{
	(void)state;
	static const double balls[] = {3, 1, 0, -2, 0, 0, 2}, plane[TOUCHSTONE_MOST_NUMBERS] = {3, -2, 4, 1};
	const char *method;
	char error[160];
	struct touchstone_steps steps;
	for (int a = 0; a < ARITHMETICS; a++)
		for (int m = 0; (method = touchstone_finder_name((size_t)m)); m++) {
			assert_true(touchstone_find_steps(arithmetics[a], method, TOUCHSTONE_BALL_BALL, balls, &steps, error));
			if (strcmp(method, "sterbenz") != 0) assert_true(steps.discriminant == 12); /* which scales first */
			assert_true(steps.a == 4 && steps.b == -6 && steps.c == 6);
			if (!touchstone_find_steps(arithmetics[a], method, TOUCHSTONE_BALL_PLANE, plane, &steps, error)) continue;
			assert_true(steps.a == 4 && steps.b == -2 && steps.c == 2 && steps.discriminant == -12);
			assert_true(steps.time == INFINITY);
		}
	const double receding[] = {3, 0, 0, 1, 0, 0, 1};
	assert_true(touchstone_find_steps("binary64", "stable", TOUCHSTONE_BALL_BALL, receding, &steps, error));
	assert_true(steps.b == 3 && isnan(steps.a) && isnan(steps.c) && isnan(steps.discriminant));
}

/* Whatever it is asked, a finder answers; `rounded` says of what is not finite that it is no number. */
static void numbers_that_are_not_finite(void **state)
{
	(void)state;
	static const double special[] = {INFINITY, -INFINITY, NAN, 0, -0.0, 0x1p-1074, 0x1.fffffffffffffp1023};
	static const int count[] = {7, 7, 4, 2};
	const char *method;
	for (int a = 0; a < ARITHMETICS; a++)
		for (int m = 0; arithmetic_is_whole(arithmetics[a]) && (method = touchstone_finder_name((size_t)m)); m++)
			for (int shape = 0; shape < TOUCHSTONE_SHAPES; shape++)
				for (int k = 0; k < 7 * 7; k++) {
					double number[1][TOUCHSTONE_MOST_NUMBERS] = {{3, 0, 1, -1, 0, 0.5, 1}}, time = -1;
					char error[160];
					number[0][k % 7] = special[k / 7];
					if (!touchstone_find(arithmetics[a], method, (enum touchstone_shape)shape,
										 (const double(*)[TOUCHSTONE_MOST_NUMBERS])number, 1, false, &time, error))
						continue;
					bool asked = k % 7 < count[shape];
					if (strcmp(method, "rounded") == 0 && asked && !isfinite(special[k / 7])) assert_true(isnan(time));
				}
}

static void names_and_refusals(void **state)
{
	(void)state;
	char error[160];
	double time;
	struct touchstone_claim claim;
	const double(*numbers)[TOUCHSTONE_MOST_NUMBERS] = (const double(*)[TOUCHSTONE_MOST_NUMBERS])question;
	for (size_t m = 0; touchstone_method_name(m); m++) {
		bool borrows = !touchstone_find("binary64", touchstone_method_name(m), TOUCHSTONE_BALL_BALL, numbers, 1, false,
										&time, error);
		if (borrows) assert_non_null(strstr(error, "has no finder of its own"));
		if (!borrows) assert_string_equal(touchstone_method_name(m), touchstone_finder_name(m));
		assert_true(touchstone_drop("binary64", touchstone_method_name(m), NULL, 0, NULL, NULL, NULL, error));
	}
	assert_false(touchstone_find("binary64", "fastest", TOUCHSTONE_BALL_BALL, numbers, 1, false, &time, error));
	assert_non_null(strstr(error, "no method 'fastest'; known are stable, naive, guarded, compensated, rounded"));
	assert_string_equal(error + strlen(error) - strlen(" and more"), " and more");
	assert_false(touchstone_find("decimal", "stable", TOUCHSTONE_BALL_BALL, numbers, 1, false, &time, error));
	assert_non_null(strstr(error, "no arithmetic 'decimal'"));
	assert_false(touchstone_find("binary64", "kahan", TOUCHSTONE_BALL_PLANE, numbers, 1, false, &time, error));
	assert_string_equal(error, "method 'kahan' has no finder for ball-plane");
	assert_false(touchstone_drop("binary64", "kahan", NULL, 0, NULL, NULL, NULL, error));
	assert_non_null(strstr(error, "finder only"));
	assert_false(touchstone_finder_claim("binary64", "naive", TOUCHSTONE_BALL_BALL, &claim, error));
	assert_string_equal(error, "method 'naive' claims nothing");
	assert_true(touchstone_finder_claim("binary64", "rounded", TOUCHSTONE_BALL_BALL, &claim, error));
	assert_true(claim.most_ulp == 0.5 && claim.never_misses && claim.never_phantom);
}

int main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(every_way_of_asking_gives_the_same),
		cmocka_unit_test(one_precision_is_one_arithmetic),
		cmocka_unit_test(simple_questions),
		cmocka_unit_test(steps_are_those_of_the_overlap_function),
		cmocka_unit_test(numbers_that_are_not_finite),
		cmocka_unit_test(names_and_refusals),
	};
	draw_questions();
	return cmocka_run_group_tests(tests, NULL, NULL);
}
