/* The exact oracle on random inputs: the filter against the integers, inputs that are related exactly, ties, gaps,
 * memory. */
#include "measure/exact_steps.h"

#include "oracle_inputs.h"
#include <float.h>
#include <gmp.h>

enum {
	CASES = 1200000,       /* through the filter and through the integers */
	RELATED_CASES = 50000, /* of inputs that are related to each other */
	SIGN_CASES = 60000,    /* beside fractions */
};

/* Within the tolerance that the error promises, where the error is a normal double. */
static bool same_error(double x, double y)
{
	return x == y || fabs(x - y) <= fmax(2e-9 * fabs(y), DBL_MIN);
}

static void compare_ways(struct both *both, const struct oracle_time *time, const struct oracle_time *exact, int i)
{
	const struct oracle_query *query = &time->query;
	mpfr_rnd_t direction = directions[1 + i % 3];
	double nearest = oracle_round(both->exact, exact, MPFR_RNDN);
	double directed = oracle_round(both->exact, exact, direction), got = steps_away(nearest, below(9) - 4);
	check(same_double(oracle_round(both->quick, time, MPFR_RNDN), nearest), query, "nearest");
	check(same_double(oracle_round(both->quick, time, direction), directed), query, "directed");
	if (direction == MPFR_RNDU)
		check(nearest == directed || nearest == nextafter(directed, 0), query, "up");
	else
		check(nearest == directed || nearest == nextafter(directed, INFINITY), query, "down");

	/* The order with a double comes from squaring, rounding from square roots: they must agree. */
	int order = oracle_compare_double(both->exact, exact, got);
	check(oracle_compare_double(both->quick, time, got) == order, query, "order with a double");
	if (got != directed) check(order == (got < directed ? 1 : -1), query, "order beside a rounding");
	if (got == directed) check(direction == MPFR_RNDU ? order <= 0 : order >= 0, query, "order at a rounding");
	if (i % 4 == 0)
		check(same_error(oracle_error(both->quick, time, got), oracle_error(both->exact, exact, got)), query, "error");
}

static void test_filter_agrees_with_integers(void **state)
{
	struct both *both = *state;
	struct oracle_time before = {.event = ORACLE_NEVER}, exact_before = before;
	size_t count[3] = {0}, by_filter = 0;
	for (int i = 0; i < CASES; i++) {
		struct oracle_query query;
		families[i % FAMILIES](&query);
		struct oracle_time time = oracle_solve(both->quick, &query), exact = oracle_solve(both->exact, &query);
		check(time.event == exact.event, &query, "existence");
		count[time.event]++;
		if (time.event != ORACLE_LATER) continue;
		by_filter += time.estimate.bound < INFINITY;
		compare_ways(both, &time, &exact, i / FAMILIES);
		int order = oracle_compare(both->exact, &exact, &exact_before);
		check(oracle_compare(both->quick, &time, &before) == order, &query, "order");
		before = time, exact_before = exact;
	}
	print_message("%zu never, %zu now, %zu later, of these %zu by the filter\n", count[ORACLE_NEVER], count[ORACLE_NOW],
				  count[ORACLE_LATER], by_filter);
	for (int event = 0; event < 3; event++) assert_true(count[event] > CASES / 20);
	assert_true(by_filter > CASES / 20 && by_filter < count[ORACLE_LATER]);
}

/* Fractions are a third way, which turns nothing and has no common unit. */
static void test_signs_are_those_of_fractions(void **state)
{
	struct both *both = *state;
	size_t count[EXACT_STEPS][3] = {0};
	for (int i = 0; i < SIGN_CASES; i++) {
		struct oracle_query query;
		families[i % FAMILIES](&query);
		enum touchstone_shape shape = (enum touchstone_shape)query.shape;
		int quick[ORACLE_SIGNS], exact[ORACLE_SIGNS];
		oracle_signs(both->quick, &query, quick);
		oracle_signs(both->exact, &query, exact);
		struct exact_steps steps;
		exact_steps_init(&steps, shape, query.number);
		for (int s = 0; s < EXACT_STEPS; s++) {
			if (!exact_step_formula(shape, s)) continue;
			int sign = mpq_sgn(steps.value[s]);
			check(quick[s] == (sign > 0) - (sign < 0), &query, "sign by the filter");
			check(exact[s] == (sign > 0) - (sign < 0), &query, "sign by integers");
			count[s][1 + exact[s]]++;
		}
		exact_steps_clear(&steps);
	}
	for (int s = 0; s < EXACT_STEPS; s++)
		for (int sign = -1; sign <= 1; sign++) assert_true(count[s][1 + sign] > SIGN_CASES / 1000);
}

/* ---- related inputs */

/* Whether no number would lose bits or overflow when multiplied by 2^shift. */
static bool scales(double x, int shift)
{
	return x == 0 || same_double(ldexp(ldexp(x, shift), -shift), x);
}

/* Lengths times 2^length and speeds times 2^speed. */
static bool rescale(struct oracle_query *query, int length, int speed)
{
	int of_balls[7] = {length, length, length, speed, speed, speed, length};
	int of_plane[7] = {length, speed, 2 * speed - length, length};
	bool exact = true;
	for (int i = 0; i < 7; i++) {
		int shift = is_of_balls(query) ? of_balls[i] : of_plane[i];
		exact &= scales(query->number[i], shift);
		query->number[i] = ldexp(query->number[i], shift);
	}
	return exact;
}

/* Axes exchanged or turned around, particles exchanged, the sign of the contact distance: the time is the same. */
static void transform_balls(struct oracle_query *query)
{
	double *r = query->ball.r, *v = query->ball.v;
	int axis = below(3), other = below(3);
	double swapped_r = r[axis], swapped_v = v[axis];
	r[axis] = r[other], v[axis] = v[other];
	r[other] = swapped_r, v[other] = swapped_v;
	axis = below(3);
	r[axis] = -r[axis], v[axis] = -v[axis];
	query->ball.contact *= below(2) ? -1 : 1;
	if (below(2))
		for (axis = 0; axis < 3; axis++) r[axis] = -r[axis], v[axis] = -v[axis];
}

static void test_related_inputs(void **state)
{
	struct both *both = *state;
	for (int i = 0; i < RELATED_CASES; i++) {
		struct oracle_query query;
		families[i % FAMILIES](&query);
		struct oracle_query moved = query, scaled = query;
		if (is_of_balls(&moved)) transform_balls(&moved);
		struct oracle_time time = oracle_solve(both->quick, &query), same = oracle_solve(both->quick, &moved);
		check(time.event == same.event && oracle_compare(both->quick, &time, &same) == 0, &query, "transformed");
		check(oracle_compare(both->exact, &same, &time) == 0, &query, "transformed, exactly");

		int length = below(400) - 200, speed = below(400) - 200;
		if (!rescale(&scaled, length, speed)) continue;
		struct oracle_time later = oracle_solve(both->exact, &scaled);
		check(time.event == later.event, &query, "scaled");
		double original = oracle_round(both->quick, &time, MPFR_RNDD),
			   found = oracle_round(both->exact, &later, MPFR_RNDD);
		bool normal = original >= DBL_MIN && original < DBL_MAX && found >= DBL_MIN && found < DBL_MAX;
		check(!normal || found == ldexp(original, length - speed), &query, "scaled time");
		if (length == speed) check(oracle_compare(both->exact, &time, &later) == 0, &query, "equal scales");
	}
}

/* Cut to 24 significant bits. */
static double shortened(double x)
{
	uint64_t pattern;
	memcpy(&pattern, &x, sizeof x);
	pattern &= ~(uint64_t)0x1fffffff;
	memcpy(&x, &pattern, sizeof x);
	return x;
}

/* Three times the lengths and the speeds of a random pair is an exact tie with other integers; a step more in the
 * contact distance makes it earlier. */
static void test_ties_of_random_pairs(void **state)
{
	struct both *both = *state;
	int later = 0;
	for (int i = 0; i < RELATED_CASES; i++) {
		struct oracle_query query, threefold;
		families[i % FAMILIES](&query);
		if (!is_of_balls(&query)) continue;
		for (int k = 0; k < 7; k++) query.number[k] = shortened(query.number[k]);
		threefold = query;
		for (int k = 0; k < 7; k++) threefold.number[k] *= 3;
		if (!oracle_accepts(&threefold)) continue;
		check_order(both, query, threefold, 0);
		if (query.shape != ORACLE_BALL_BALL || oracle_solve(both->quick, &query).event != ORACLE_LATER) continue;
		later++;
		threefold.ball.contact = steps_away(fabs(threefold.ball.contact), 1);
		struct oracle_time wider = oracle_solve(both->quick, &threefold);
		if (wider.event == ORACLE_LATER && threefold.ball.contact > 1e-5 && fabs(query.ball.r[0]) < 1e5)
			check_order(both, query, threefold, 1);
	}
	assert_true(later > RELATED_CASES / 20);
}

/* ---- what is left at contact */

/* A body that is free, and stopped no later than its event, is still free, and in contact just when the time is exact.
 */
static void test_gaps_of_random_answers(void **state)
{
	struct both *both = *state;
	int exact_times = 0;
	for (int i = 0; i < RELATED_CASES; i++) {
		struct oracle_query query;
		families[i % FAMILIES](&query);
		struct oracle_time time = oracle_solve(both->quick, &query);
		bool meets = time.event == ORACLE_LATER && query.shape != ORACLE_BALL_LEAVE;
		if (!meets || oracle_gap(both->quick, &query, 0) < 1e-200) continue; /* gaps that underflow are zero */
		double down = oracle_round(both->quick, &time, MPFR_RNDD), gap = oracle_gap(both->quick, &query, down);
		bool exact = oracle_compare_double(both->quick, &time, down) == 0;
		check(exact ? gap == 0 : gap > 0, &query, "gap");
		exact_times += exact;
	}
	print_message("%d exact times\n", exact_times);
	assert_true(exact_times > RELATED_CASES / 500);
}

/* ---- memory */

static size_t allocations;

static void *count_allocation(size_t size)
{
	allocations++;
	return malloc(size);
}

static void *count_reallocation(void *block, size_t old_size, size_t size)
{
	(void)old_size;
	allocations++;
	return realloc(block, size);
}

static void release(void *block, size_t size)
{
	(void)size;
	free(block);
}

static void ask_everything(struct oracle *oracle, mpfr_t many_bits)
{
	struct oracle_time before = {.event = ORACLE_NEVER};
	for (int i = 0; i < 2000; i++) {
		struct oracle_query query;
		families[i % FAMILIES](&query);
		struct oracle_time time = oracle_solve(oracle, &query);
		double nearest = oracle_round(oracle, &time, MPFR_RNDN);
		oracle_round_mpfr(oracle, many_bits, &time, MPFR_RNDN);
		oracle_compare(oracle, &before, &time);
		oracle_compare_double(oracle, &time, nearest);
		oracle_error(oracle, &time, nearest);
		oracle_gap(oracle, &query, nearest);
		before = time;
	}
}

static void test_nothing_is_allocated_in_the_long_run(void **state)
{
	(void)state;
	mp_set_memory_functions(count_allocation, count_reallocation, release);
	struct oracle *oracle = oracle_create();
	assert_non_null(oracle);
	oracle_force_exact(oracle, true);
	mpfr_t many_bits;
	mpfr_init2(many_bits, 500);
	uint64_t start = random_state;
	ask_everything(oracle, many_bits);
	assert_true(allocations > 0);
	allocations = 0;
	random_state = start;
	ask_everything(oracle, many_bits);
	assert_int_equal(allocations, 0);
	assert_true(oracle_exact_count(oracle) > 4000);
	oracle_destroy(oracle);
	mpfr_clear(many_bits);
	mp_set_memory_functions(NULL, NULL, NULL);
}

int main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test_setup_teardown(test_filter_agrees_with_integers, make_oracles, drop_oracles),
		cmocka_unit_test_setup_teardown(test_signs_are_those_of_fractions, make_oracles, drop_oracles),
		cmocka_unit_test_setup_teardown(test_related_inputs, make_oracles, drop_oracles),
		cmocka_unit_test_setup_teardown(test_ties_of_random_pairs, make_oracles, drop_oracles),
		cmocka_unit_test_setup_teardown(test_gaps_of_random_answers, make_oracles, drop_oracles),
		cmocka_unit_test(test_nothing_is_allocated_in_the_long_run),
	};
	seed_inputs();
	int failed = cmocka_run_group_tests(tests, NULL, NULL);
	mpfr_free_cache();
	return failed;
}
