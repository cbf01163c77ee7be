/* The oracle's times against the stable rule itself (2014 paper, eq. 10), evaluated without rounding: a time is right
 * when the rule fails just before it and holds just after it, a bracket of thousands of bits. */
#include "oracle_inputs.h"
#include <float.h>

enum {
	CASES = 150000,
	BRACKET_BITS = 3000,
	EXACT_BITS = 26000, /* enough for every sum and product of the rule: their exactness is asserted */
};

/* Times that bracket an answer, and room for the rule's values at one of them. */
struct exact_rule {
	mpfr_t lower, upper, value, slope, work;
};

static struct exact_rule *make_rule(void)
{
	static struct exact_rule rule;
	mpfr_inits2(BRACKET_BITS, rule.lower, rule.upper, NULL);
	mpfr_inits2(EXACT_BITS, rule.value, rule.slope, rule.work, NULL);
	return &rule;
}

static void drop_rule(struct exact_rule *rule)
{
	mpfr_clears(rule->lower, rule->upper, rule->value, rule->slope, rule->work, NULL);
}

/* |r + v t|^2 - contact^2, and half its slope. */
static int evaluate_balls(struct exact_rule *rule, const double number[7], const mpfr_t t)
{
	int inexact = mpfr_set_d(rule->value, number[6], MPFR_RNDN);
	inexact |= mpfr_sqr(rule->value, rule->value, MPFR_RNDN);
	mpfr_neg(rule->value, rule->value, MPFR_RNDN);
	mpfr_set_zero(rule->slope, 1);
	for (int axis = 0; axis < 3; axis++) {
		inexact |= mpfr_mul_d(rule->work, t, number[3 + axis], MPFR_RNDN);
		inexact |= mpfr_add_d(rule->work, rule->work, number[axis], MPFR_RNDN);
		inexact |= mpfr_fma(rule->value, rule->work, rule->work, rule->value, MPFR_RNDN);
		inexact |= mpfr_mul_d(rule->work, rule->work, number[3 + axis], MPFR_RNDN);
		inexact |= mpfr_add(rule->slope, rule->slope, rule->work, MPFR_RNDN);
	}
	return inexact;
}

/* distance - contact + speed t + acceleration t^2 / 2, and its slope. */
static int evaluate_plane(struct exact_rule *rule, const double number[4], const mpfr_t t)
{
	int inexact = mpfr_set_d(rule->value, number[0], MPFR_RNDN);
	inexact |= mpfr_sub_d(rule->value, rule->value, number[3], MPFR_RNDN);
	inexact |= mpfr_mul_d(rule->slope, t, number[2], MPFR_RNDN);
	inexact |= mpfr_div_2ui(rule->work, rule->slope, 1, MPFR_RNDN);
	inexact |= mpfr_add_d(rule->work, rule->work, number[1], MPFR_RNDN);
	inexact |= mpfr_add_d(rule->slope, rule->slope, number[1], MPFR_RNDN);
	inexact |= mpfr_fma(rule->value, rule->work, t, rule->value, MPFR_RNDN);
	return inexact;
}

/* Whether f(t) <= 0 and f'(t) < 0. */
static bool rule_holds(struct exact_rule *rule, const struct oracle_query *query, const mpfr_t t)
{
	double number[7];
	memcpy(number, query->number, sizeof number);
	if (query->shape == ORACLE_HALF_SPACE) number[2] = number[3] = 0;
	int inexact = is_of_balls(query) ? evaluate_balls(rule, number, t) : evaluate_plane(rule, number, t);
	check(inexact == 0, query, "the reference is not exact");
	int side = query->shape == ORACLE_BALL_LEAVE ? -1 : 1;
	return side * mpfr_sgn(rule->value) <= 0 && side * mpfr_sgn(rule->slope) < 0;
}

static bool rule_holds_at(struct exact_rule *rule, const struct oracle_query *query, double t)
{
	mpfr_set_d(rule->lower, t, MPFR_RNDN);
	return rule_holds(rule, query, rule->lower);
}

/* The closest approach, or the peak, as well as doubles tell. */
static double turning_point(const struct oracle_query *query)
{
	const double *n = query->number;
	if (!is_of_balls(query)) return -n[1] / n[2];
	return -(n[0] * n[3] + n[1] * n[4] + n[2] * n[5]) / (n[3] * n[3] + n[4] * n[4] + n[5] * n[5]);
}

/* The rule's times form one interval that has no end, or ends at the turning point: never means none of these. */
static void check_never(struct exact_rule *rule, const struct oracle_query *query)
{
	double turn = turning_point(query);
	double sample[] = {0, DBL_TRUE_MIN, 1, DBL_MAX, turn, nextafter(turn, 0), turn * (1 - 1e-7), fabs(any_exponent())};
	for (size_t i = 0; i < sizeof sample / sizeof *sample; i++)
		if (sample[i] >= 0 && sample[i] <= DBL_MAX)
			check(!rule_holds_at(rule, query, sample[i]), query, "an event where there is none");
}

/* Proves the time, which must be later than zero; leaves it strictly between `lower` and `upper`. */
static void check_bracket(struct both *both, struct exact_rule *rule, const struct oracle_time *time)
{
	const struct oracle_query *query = &time->query;
	int down = oracle_round_mpfr(both->quick, rule->lower, time, MPFR_RNDD);
	int up = oracle_round_mpfr(both->exact, rule->upper, time, MPFR_RNDU);
	check(down <= 0 && up >= 0 && (down == 0) == (up == 0), query, "ternary value");
	if (down == 0) mpfr_nextbelow(rule->lower);
	if (up == 0) mpfr_nextabove(rule->upper);
	check(mpfr_sgn(rule->lower) > 0, query, "positive");
	check(!rule_holds(rule, query, rule->lower), query, "the rule before");
	check(rule_holds(rule, query, rule->upper), query, "the rule after");
}

/* Both ends of the bracket rounded agree (nearly always), and then the oracle must agree with them. */
static void check_roundings(struct both *both, struct exact_rule *rule, const struct oracle_time *time)
{
	mpfr_t found, below_it, above_it;
	mpfr_inits2(2 + below(BRACKET_BITS / 2), found, below_it, above_it, NULL);
	for (int i = 0; i < 4; i++) {
		double expected = mpfr_get_d(rule->lower, directions[i]);
		bool known = same_double(expected, mpfr_get_d(rule->upper, directions[i]));
		check(!known || same_double(oracle_round(both->quick, time, directions[i]), expected), &time->query, "double");
		int ternary = oracle_round_mpfr(both->exact, found, time, directions[i]);
		mpfr_set(below_it, rule->lower, directions[i]);
		mpfr_set(above_it, rule->upper, directions[i]);
		known = mpfr_equal_p(below_it, above_it);
		check(!known || mpfr_equal_p(found, below_it), &time->query, "many bits");
		check(ternary <= 0 || mpfr_cmp(found, rule->lower) > 0, &time->query, "ternary above");
		check(ternary >= 0 || mpfr_cmp(found, rule->upper) < 0, &time->query, "ternary below");
		check(ternary != 0 || (mpfr_cmp(found, rule->lower) > 0 && mpfr_cmp(found, rule->upper) < 0), &time->query,
			  "ternary exact");
	}
	mpfr_clears(found, below_it, above_it, NULL);
}

/* |got - t| / ulp(t) for the t in the bracket, and whether the filter's estimate is as near as it claims. */
static void check_error(struct both *both, struct exact_rule *rule, const struct oracle_time *time)
{
	double nearest = oracle_round(both->exact, time, MPFR_RNDN);
	double got = below(3) ? steps_away(nearest, below(9) - 4) : fabs(any_exponent());
	if (!isfinite(got)) return;
	mpfr_exp_t last = mpfr_get_exp(rule->upper) - 53;
	mpfr_set_d(rule->work, got, MPFR_RNDN);
	mpfr_sub(rule->work, rule->work, rule->lower, MPFR_RNDN);
	mpfr_div_2si(rule->work, rule->work, last < -1074 ? -1074 : last, MPFR_RNDN);
	double expected = fabs(mpfr_get_d(rule->work, MPFR_RNDN));
	double tolerance = 1e-9 * expected + DBL_TRUE_MIN;
	struct oracle *oracles[] = {both->quick, both->exact};
	for (int i = 0; i < 2 && expected > 1e-100; i++) {
		double error = oracle_error(oracles[i], time, got);
		check(error == expected || fabs(error - expected) <= tolerance, &time->query, "error");
	}
	mpfr_set_d(rule->work, time->estimate.high, MPFR_RNDN);
	mpfr_add_d(rule->work, rule->work, time->estimate.low, MPFR_RNDN);
	mpfr_sub(rule->work, rule->work, rule->lower, MPFR_RNDN);
	mpfr_abs(rule->work, rule->work, MPFR_RNDN);
	check(mpfr_cmp_d(rule->work, time->estimate.bound) <= 0, &time->query, "the filter's bound");
}

/* Of two brackets that do not meet the order is plain. */
static void check_order_of_brackets(struct both *both, struct exact_rule *rule, struct exact_rule *before,
									const struct oracle_time *time, const struct oracle_time *time_before)
{
	int expected = mpfr_cmp(rule->lower, before->upper) >= 0 ? 1 : mpfr_cmp(rule->upper, before->lower) <= 0 ? -1 : 0;
	if (expected == 0) return;
	check(oracle_compare(both->quick, time, time_before) == expected, &time->query, "order");
	check(oracle_compare(both->exact, time_before, time) == -expected, &time->query, "order reversed");
}

static struct oracle_time check_query(struct both *both, struct exact_rule *rule, const struct oracle_query *query)
{
	struct oracle_time time = oracle_solve(both->quick, query);
	check(time.event == oracle_solve(both->exact, query).event, query, "existence");
	if (time.event == ORACLE_NEVER) check_never(rule, query);
	if (time.event == ORACLE_NOW)
		check(rule_holds_at(rule, query, 0) || rule_holds_at(rule, query, DBL_TRUE_MIN), query, "now");
	if (time.event != ORACLE_LATER) return time;
	check_bracket(both, rule, &time);
	check_roundings(both, rule, &time);
	check_error(both, rule, &time);
	return time;
}

static void test_times_obey_the_rule(void **state)
{
	struct exact_rule *rule = make_rule(), before;
	struct oracle_time time_before = {.event = ORACLE_NEVER};
	mpfr_inits2(BRACKET_BITS, before.lower, before.upper, NULL);
	int later = 0;
	for (int i = 0; i < CASES; i++) {
		struct oracle_query query;
		families[i % FAMILIES](&query);
		struct oracle_time time = check_query(*state, rule, &query);
		if (time.event != ORACLE_LATER) continue;
		if (later++) check_order_of_brackets(*state, rule, &before, &time, &time_before);
		time_before = time;
		mpfr_swap(before.lower, rule->lower);
		mpfr_swap(before.upper, rule->upper);
	}
	print_message("%d of %d times bracketed to %d bits\n", later, CASES, BRACKET_BITS);
	assert_true(later > CASES / 4);
	mpfr_clears(before.lower, before.upper, NULL);
	drop_rule(rule);
}

/* a t^2 + b t + c, where published solvers fail (Goualard's QuadraticEquation.jl and others). */
static const double hard_quadratics[][3] = {
	{1, 0x1p27, 0x1.8p-1},
	{1, -1e9, 1},
	{0x1.fffffffffffffp+511, -0x1.fffffffffffffp+511, -0x1.fffffffffffffp+511},
	{8, 0x1p800, -0x1p500},
	{0x1p600, 0x1p-1, -0x1p600},
	{0x1p600, 0x1p-1, -0x1p-600},
	{0x1p600, -0x1p-600, -0x1p-600},
	{0x1p-550, 0x1p-552, 0x1p-550},
	{1, 0x1.0000000000001p0, 0x1.0000000000002p-2},
	{0x1p600, 0x1.0000000000001p600, 0x1.0000000000002p598},
	{1, 0x1.0000000000001p-511, 0x1p-1024},
	{0x1p1022, 1, 0x1p-1024},
	{0x1p-1073, -0x1p-1073, -0x1p-1073},
	{-158114166017, 316227766017, -158113600000},
	{-312499999999, 707106781186, -4e11},
	{0x1.8p-1026, 0, -0x1p1022},
	{2, 0, 3},
	{0, 0x1p600, 0x1p600},
	{0, 2, -0x1p-1073},
	{0, 0, 0},
	{0, 0, 1},
	{1, 2, 0x1.fffffffffffffp-1},
	{1, 2, 0x1.0000000000001p0},
};

/* A quadratic as a ball over a plane, with every choice of signs. */
static void check_quadratic(struct both *both, struct exact_rule *rule, const double quadratic[3])
{
	for (int signs = 0; signs < 4; signs++) {
		double turn = signs & 1 ? -1 : 1, back = signs & 2 ? -1 : 1;
		struct oracle_query query = {
			.shape = ORACLE_BALL_PLANE,
			.plane = {turn * quadratic[2], back * turn * quadratic[1], 2 * turn * quadratic[0], 0},
		};
		check_query(both, rule, &query);
	}
}

static void test_hard_quadratics(void **state)
{
	struct exact_rule *rule = make_rule();
	for (size_t i = 0; i < sizeof hard_quadratics / sizeof *hard_quadratics; i++)
		check_quadratic(*state, rule, hard_quadratics[i]);
	double fibonacci[79] = {0, 1};
	for (int n = 2; n <= 78; n++) {
		fibonacci[n] = fibonacci[n - 1] + fibonacci[n - 2];
		double scale = ldexp(1, 52 - ilogb(fibonacci[n]));
		check_quadratic(*state, rule, (double[3]){fibonacci[n], -2 * fibonacci[n - 1], fibonacci[n - 2]});
		check_quadratic(*state, rule,
						(double[3]){floor(fibonacci[n] * scale * 0.9), -2 * floor(fibonacci[n - 1] * scale * 0.9),
									floor(fibonacci[n - 2] * scale * 0.9)});
	}
	drop_rule(rule);
}

int main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test_setup_teardown(test_times_obey_the_rule, make_oracles, drop_oracles),
		cmocka_unit_test_setup_teardown(test_hard_quadratics, make_oracles, drop_oracles),
	};
	seed_inputs();
	int failed = cmocka_run_group_tests(tests, NULL, NULL);
	mpfr_free_cache();
	return failed;
}
