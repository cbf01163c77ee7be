/* The exact oracle on questions with known answers: order, edges of the range, errors, gaps, and what it refuses. */
#include "oracle_inputs.h"
#include <float.h>

static struct oracle_query plane(double distance, double speed, double acceleration)
{
	return (struct oracle_query){.shape = ORACLE_BALL_PLANE, .plane = {distance, speed, acceleration, 0}};
}

static struct oracle_query crossing(double distance, double speed)
{
	return (struct oracle_query){.shape = ORACLE_HALF_SPACE, .plane = {.distance = distance, .speed = speed}};
}

static struct oracle_query balls(enum oracle_shape shape, double x, double y, double vx, double vy, double contact)
{
	return (struct oracle_query){.shape = shape, .ball = {{x, y, 0}, {vx, vy, 0}, contact}};
}

static void test_order_of_known_times(void **state)
{
	struct both *both = *state;
	struct oracle_query two[] = {balls(ORACLE_BALL_BALL, 3, 0, -1, 0, 1),
								 balls(ORACLE_BALL_LEAVE, 0, 0, 1, 0, 2),
								 plane(2, 0, -1),
								 plane(2, -1, 0),
								 crossing(0x1p-1073, -0x1p-1074),
								 plane(4, -3, 1)};
	struct oracle_query root_of_two[] = {balls(ORACLE_BALL_LEAVE, 0, 0, 1, 1, 2), plane(1, 0, -1),
										 balls(ORACLE_BALL_LEAVE, 0, 0, 0x1p-1000, 0x1p-1000, 0x1p-999)};
	struct oracle_query never = plane(1, 1, 0), now = plane(-1, -1, 0);
	for (int i = 0; i < 6; i++)
		for (int k = 0; k < 6; k++) check_order(both, two[i], two[k], 0);
	for (int i = 0; i < 3; i++) {
		for (int k = 0; k < 3; k++) check_order(both, root_of_two[i], root_of_two[k], 0);
		check_order(both, root_of_two[i], two[i], -1);
		check_order(both, root_of_two[i], crossing(1.4142135623730950, -1), 1);
		check_order(both, root_of_two[i], crossing(1.4142135623730951, -1), -1);
		check_order(both, root_of_two[i], never, -1);
		check_order(both, root_of_two[i], now, 1);
	}
	check_order(both, never, never, 0);
	check_order(both, now, now, 0);

	/* Quotients of Fibonacci numbers lie on alternating sides of (sqrt(5) - 1) / 2, the nearest to within 2^-106. */
	double before = 1, after = 1;
	for (int n = 1; after < 0x1p52; n++) {
		double next = before + after;
		before = after, after = next;
		check_order(both, crossing(before, -after), plane(1, -1, -2), n % 2 ? -1 : 1);
		check_order(both, crossing(before, -after), crossing(after, -(before + after)), n % 2 ? -1 : 1);
	}
}

static void test_edges(void **state)
{
	struct both *both = *state;
	const struct {
		struct oracle_query query;
		enum oracle_event event;
		double nearest, down, up;
	} edges[] = {
		{balls(ORACLE_BALL_BALL, 1, 0, -1, 0, 1), ORACLE_NOW, 0, 0, 0},
		{balls(ORACLE_BALL_BALL, 0.5, 0, 1, 0, 1), ORACLE_NEVER, INFINITY, INFINITY, INFINITY},
		{balls(ORACLE_BALL_BALL, 0, 0, -1, 0, 1), ORACLE_NEVER, INFINITY, INFINITY, INFINITY},
		{balls(ORACLE_BALL_BALL, 3, 1, -1, 0, 1), ORACLE_NEVER, INFINITY, INFINITY, INFINITY},
		{balls(ORACLE_BALL_BALL, 3, -0.0, -1, 0, 0.0), ORACLE_NEVER, INFINITY, INFINITY, INFINITY},
		{balls(ORACLE_BALL_LEAVE, 0, 0, 0, 0, 1), ORACLE_NEVER, INFINITY, INFINITY, INFINITY},
		{balls(ORACLE_BALL_LEAVE, 1, 0, 1, 0, 1), ORACLE_NOW, 0, 0, 0},
		{balls(ORACLE_BALL_LEAVE, 2, 0, 0, 1, 1), ORACLE_NOW, 0, 0, 0},
		{balls(ORACLE_BALL_LEAVE, 1, 0, -1, 0, 1), ORACLE_LATER, 2, 2, 2},
		{balls(ORACLE_BALL_LEAVE, 5, 1, -2, 0, 1), ORACLE_LATER, 2.5, 2.5, 2.5},
		{balls(ORACLE_BALL_LEAVE, 5, 3, -2, 0, 1), ORACLE_LATER, 2.5, 2.5, 2.5},
		{plane(0, 0, -1), ORACLE_NOW, 0, 0, 0},
		{plane(-1, 1, -1), ORACLE_LATER, 1, 1, 1},
		{plane(-0.5, 1, -1), ORACLE_LATER, 1, 1, 1},
		{plane(0.5, -1, 1), ORACLE_NEVER, INFINITY, INFINITY, INFINITY},
		{plane(-1, 0, 1), ORACLE_NEVER, INFINITY, INFINITY, INFINITY},
		{plane(0, -1, 1), ORACLE_NOW, 0, 0, 0},
		{crossing(-0.0, -1), ORACLE_NOW, 0, 0, 0},
		{crossing(1, -0.0), ORACLE_NEVER, INFINITY, INFINITY, INFINITY},
		{crossing(1, -3), ORACLE_LATER, 0x1.5555555555555p-2, 0x1.5555555555555p-2, 0x1.5555555555556p-2},
		{crossing(DBL_MAX, -0.5), ORACLE_LATER, INFINITY, DBL_MAX, INFINITY},
		{crossing(DBL_TRUE_MIN, -2), ORACLE_LATER, 0, 0, DBL_TRUE_MIN},
		{crossing(3 * DBL_TRUE_MIN, -2), ORACLE_LATER, 2 * DBL_TRUE_MIN, DBL_TRUE_MIN, 2 * DBL_TRUE_MIN},
		{crossing(DBL_TRUE_MIN, -DBL_MAX), ORACLE_LATER, 0, 0, DBL_TRUE_MIN},
		{crossing(DBL_MAX, -DBL_TRUE_MIN), ORACLE_LATER, INFINITY, DBL_MAX, INFINITY},
		{balls(ORACLE_BALL_BALL, DBL_MAX, 0, -DBL_MAX, 0, 0x1p1023), ORACLE_LATER, 0x1.fffffffffffffp-2,
		 0x1.ffffffffffffep-2, 0x1.fffffffffffffp-2},
	};
	for (size_t i = 0; i < sizeof edges / sizeof *edges; i++)
		for (int way = 0; way < 2; way++) {
			struct oracle *oracle = way ? both->exact : both->quick;
			const struct oracle_query *query = &edges[i].query;
			struct oracle_time time = oracle_solve(oracle, query);
			check(time.event == edges[i].event, query, "event");
			check(same_double(oracle_round(oracle, &time, MPFR_RNDN), edges[i].nearest), query, "nearest");
			check(same_double(oracle_round(oracle, &time, MPFR_RNDD), edges[i].down), query, "down");
			check(same_double(oracle_round(oracle, &time, MPFR_RNDZ), edges[i].down), query, "toward zero");
			check(same_double(oracle_round(oracle, &time, MPFR_RNDU), edges[i].up), query, "up");
		}
}

static void test_errors_and_gaps_of_known_answers(void **state)
{
	struct both *both = *state;
	struct oracle_query two = balls(ORACLE_BALL_BALL, 3, 0, -1, 0, 1), third = crossing(1, -3);
	struct oracle_query never = plane(1, 1, 0), now = crossing(0, -1), tiny = crossing(DBL_TRUE_MIN, -2);
	struct oracle_query beyond = crossing(DBL_MAX, -0.5), far = balls(ORACLE_BALL_LEAVE, 0x1p1000, 0, 1, 0, 0x1p-1000);
	const struct {
		const struct oracle_query *query;
		double got, error;
	} errors[] = {
		{&two, 2, 0},
		{&two, 2 + 0x1p-51, 1},
		{&two, 2 - 0x1p-52, 0.5},
		{&two, -2, 0x1p53},
		{&two, INFINITY, INFINITY},
		{&third, 0x1.5555555555555p-2, 1.0 / 3},
		{&never, INFINITY, 0},
		{&never, 1, INFINITY},
		{&now, 0, 0},
		{&now, -0.0, 0},
		{&now, 3 * DBL_TRUE_MIN, 3},
		{&tiny, 0, 0.5},
		{&tiny, DBL_TRUE_MIN, 0.5},
		{&beyond, INFINITY, 0},
		{&beyond, -INFINITY, INFINITY},
		{&beyond, 0, 0x1.fffffffffffffp52},
	};
	for (size_t i = 0; i < sizeof errors / sizeof *errors; i++)
		for (int way = 0; way < 2; way++) {
			struct oracle *oracle = way ? both->exact : both->quick;
			struct oracle_time time = oracle_solve(oracle, errors[i].query);
			double error = oracle_error(oracle, &time, errors[i].got);
			check(error == errors[i].error || fabs(error - errors[i].error) <= 1e-9 * errors[i].error, &time.query,
				  "error");
			assert_true(isnan(oracle_error(oracle, &time, NAN)));
		}
	struct oracle_query falling = plane(1, 0, -1), diagonal = balls(ORACLE_BALL_BALL, 1, 1, -1, -1, 1);
	assert_true(oracle_gap(both->quick, &two, 2) == 0);
	assert_true(oracle_gap(both->quick, &two, 2 - 0x1p-52) == 0x1p-52);
	assert_true(oracle_gap(both->quick, &two, 3) == -1);
	assert_true(oracle_gap(both->quick, &falling, 1) == 0.5);
	assert_true(oracle_gap(both->quick, &falling, 0x1p600) == -INFINITY);
	assert_true(oracle_gap(both->quick, &third, 0x1.5555555555555p-2) == 0x1p-54);
	assert_true(fabs(oracle_gap(both->quick, &diagonal, 0) / (sqrt(2) - 1) - 1) < 1e-12);
	assert_true(fabs(oracle_gap(both->quick, &far, 0) / 0x1p1000 - 1) < 1e-12);
	assert_true(isnan(oracle_gap(both->quick, &two, INFINITY)));
}

static void test_only_finite_numbers_are_accepted(void **state)
{
	(void)state;
	struct oracle_query query = balls(ORACLE_BALL_BALL, 3, 0, -1, 0, 1);
	assert_true(oracle_accepts(&query));
	query.ball.contact = NAN;
	assert_false(oracle_accepts(&query));
	query.shape = ORACLE_BALL_PLANE;
	assert_true(oracle_accepts(&query));
	query.plane.contact = -INFINITY;
	assert_false(oracle_accepts(&query));
	query.shape = ORACLE_HALF_SPACE;
	assert_true(oracle_accepts(&query));
	query.plane.speed = INFINITY;
	assert_false(oracle_accepts(&query));
}

int main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test_setup_teardown(test_order_of_known_times, make_oracles, drop_oracles),
		cmocka_unit_test_setup_teardown(test_edges, make_oracles, drop_oracles),
		cmocka_unit_test_setup_teardown(test_errors_and_gaps_of_known_answers, make_oracles, drop_oracles),
		cmocka_unit_test(test_only_finite_numbers_are_accepted),
	};
	int failed = cmocka_run_group_tests(tests, NULL, NULL);
	mpfr_free_cache();
	return failed;
}
