/* What every arithmetic must keep, compared with MPFR called directly. The including file includes the arithmetic's
 * header and gives
 *     precisions[]       significand bits to test at; those the unit does not offer are passed over
 *     offered(bits)      whether num_choose must accept this many
 *     cases              random operands per precision
 *     largest_exponent   of the range: numbers are below 2^largest_exponent; 0 for MPFR's own range
 *     reference_bits     of MPFR's result; 0 for the working precision
 *     allowed_error[]    per operation, in units of 2^-106 of the result; 0 for correctly rounded
 *     exact_bits         that hold any number of the arithmetic and any double
 *     value(exact, x)    the exact value of a number, with the sign of a zero */

#include <math.h>
#include <pthread.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include <cmocka.h>

#include "num_operands.inl"

enum operation { ADD, SUB, MUL, DIVIDE, ROOT, OPERATIONS };
static const char *const operation_name[] = {"add", "sub", "mul", "divide", "root"};

static num computed(enum operation operation, num a, num b)
{
	switch (operation) {
	case ADD:
		return add(a, b);
	case SUB:
		return sub(a, b);
	case MUL:
		return mul(a, b);
	case DIVIDE:
		return divide(a, b);
	default:
		return root(a);
	}
}

static int by_mpfr(enum operation operation, mpfr_t result, const mpfr_t a, const mpfr_t b)
{
	switch (operation) {
	case ADD:
		return mpfr_add(result, a, b, MPFR_RNDN);
	case SUB:
		return mpfr_sub(result, a, b, MPFR_RNDN);
	case MUL:
		return mpfr_mul(result, a, b, MPFR_RNDN);
	case DIVIDE:
		return mpfr_div(result, a, b, MPFR_RNDN);
	default:
		return mpfr_sqrt(result, a, MPFR_RNDN);
	}
}

/* Rounds a result into an IEEE 754 range, infinities and subnormal numbers included; `ternary` tells how it was
 * rounded already, so that nothing is rounded twice. */
static void limit(mpfr_t result, int ternary, int largest)
{
	mpfr_exp_t least = mpfr_get_emin(), most = mpfr_get_emax();
	mpfr_exp_t limit_least = 4 - largest - mpfr_get_prec(result);
	if (!largest || !mpfr_regular_p(result)) return;
	if (mpfr_get_exp(result) <= largest && mpfr_get_exp(result) >= limit_least + mpfr_get_prec(result)) return;
	mpfr_set_emax(largest);
	mpfr_set_emin(limit_least);
	ternary = mpfr_check_range(result, ternary, MPFR_RNDN);
	mpfr_subnormalize(result, ternary, MPFR_RNDN);
	mpfr_set_emin(least);
	mpfr_set_emax(most);
}

/* Whether `found` is `expected`, to the last bit and the sign of zero, or else within the allowed error of it. */
static bool agrees(const mpfr_t found, const mpfr_t expected, double allowed)
{
	if (mpfr_nan_p(expected) || mpfr_nan_p(found)) return mpfr_nan_p(expected) && mpfr_nan_p(found);
	if (!mpfr_signbit(found) != !mpfr_signbit(expected)) return false;
	if (mpfr_equal_p(found, expected)) return true;
	if (allowed <= 0 || !mpfr_regular_p(found) || !mpfr_regular_p(expected)) return false;
	mpfr_t error;
	mpfr_init2(error, 64);
	mpfr_sub(error, found, expected, MPFR_RNDA);
	mpfr_div(error, error, expected, MPFR_RNDA);
	mpfr_mul_2ui(error, error, 106, MPFR_RNDA);
	bool within = fabs(mpfr_get_d(error, MPFR_RNDA)) <= allowed;
	mpfr_clear(error);
	return within;
}

static void fail_with(const char *what, const mpfr_t a, const mpfr_t b, const mpfr_t found, const mpfr_t expected)
{
	char *text;
	mpfr_asprintf(&text, "%s:%d %s of %Ra and %Ra gave %Ra, expected %Ra", num_name, num_bits(), what, a, b, found,
				  expected);
	print_error("%s\n", text);
	mpfr_free_str(text);
	fail();
}

/* The variables of one comparison. */
struct bench {
	mpfr_t a, b, found, expected;
};

static void bench_open(struct bench *bench)
{
	mpfr_inits2(exact_bits, bench->a, bench->b, bench->found, NULL);
	mpfr_init2(bench->expected, reference_bits ? reference_bits : num_bits());
}

static void bench_close(struct bench *bench)
{
	mpfr_clears(bench->a, bench->b, bench->found, bench->expected, NULL);
}

/* Of a and b, whose exact values are on the bench. */
static void compare(struct bench *bench, enum operation operation, num a, num b)
{
	value(bench->found, computed(operation, a, b));
	limit(bench->expected, by_mpfr(operation, bench->expected, bench->a, bench->b), largest_exponent);
	if (!agrees(bench->found, bench->expected, allowed_error[operation]))
		fail_with(operation_name[operation], bench->a, bench->b, bench->found, bench->expected);
}

static void check(struct bench *bench, enum operation operation, num a, num b)
{
	value(bench->a, a);
	value(bench->b, b);
	compare(bench, operation, a, b);
}

static void check_all(struct bench *bench, num a, num b)
{
	value(bench->a, a);
	value(bench->b, b);
	for (enum operation operation = ADD; operation < OPERATIONS; operation++) compare(bench, operation, a, b);
	if (less(a, b) != (mpfr_less_p(bench->a, bench->b) != 0) || less(b, a) != (mpfr_less_p(bench->b, bench->a) != 0))
		fail_with("less", bench->a, bench->b, bench->a, bench->b);
}

/* Runs `body` at each precision on offer. */
static void at_each_precision(void (*body)(struct bench *bench))
{
	int tested = 0;
	for (size_t i = 0; i < sizeof precisions / sizeof *precisions; i++) {
		struct bench bench;
		if (!num_choose(precisions[i])) continue;
		bench_open(&bench);
		body(&bench);
		bench_close(&bench);
		tested++;
	}
	assert_true(tested > 0);
}

static void operations_body(struct bench *bench)
{
	for (int i = 0; i < cases; i++) {
		num a = random_number();
		check_all(bench, a, random_partner(a));
	}
	for (int i = 0; i < cases / 20; i++) {
		num a, b;
		if (random_hard_quotient(&a, &b)) check(bench, DIVIDE, a, b);
		a = random_hard_square();
		check(bench, ROOT, a, a);
		b = random_number();
		check(bench, ROOT, mul(b, b), b);
		check(bench, DIVIDE, mul(a, b), b);
		check_all(bench, b, b);
		check_all(bench, b, negated(b));
	}
}

/* The first test, while nothing has been chosen yet. */
static void a_precision_is_in_force_from_the_start(void **state)
{
	struct bench bench;
	(void)state;
	assert_true(offered(num_bits()));
	bench_open(&bench);
	operations_body(&bench);
	bench_close(&bench);
}

static void operations_round_as_mpfr_does(void **state)
{
	(void)state;
	at_each_precision(operations_body);
}

static void specials_body(struct bench *bench)
{
	static const double special[] = {0.0, -0.0, 1, -1, 3, INFINITY, -INFINITY, NAN, -NAN};
	const size_t count = sizeof special / sizeof *special;
	for (size_t i = 0; i < count; i++) {
		num a = from_double(special[i]);
		assert_int_equal(is_finite(a), isfinite(special[i]) != 0);
		assert_int_equal(isnan(to_double(a)), isnan(special[i]));
		for (size_t j = 0; j < count; j++) check_all(bench, a, from_double(special[j]));
	}
}

static void zeros_infinities_and_nans(void **state)
{
	(void)state;
	at_each_precision(specials_body);
}

static void negation_body(struct bench *bench)
{
	for (int i = 0; i < cases / 20; i++) {
		num a = i ? random_number() : from_double(0);
		value(bench->a, a);
		value(bench->found, negated(a));
		mpfr_neg(bench->b, bench->a, MPFR_RNDN);
		if (!agrees(bench->found, bench->b, 0)) fail_with("negated", bench->a, bench->a, bench->found, bench->b);
		value(bench->found, negated(negated(a)));
		if (!agrees(bench->found, bench->a, 0)) fail_with("negated", bench->b, bench->b, bench->found, bench->a);
		assert_true(is_finite(a));
	}
}

static void negation_is_exact(void **state)
{
	(void)state;
	at_each_precision(negation_body);
}

/* Any double at all; half of them with long runs of equal bits. */
static double random_double(void)
{
	uint64_t word;
	double result;
	mpz_t bits;
	mpz_init(bits);
	if (random_below(2))
		mpz_urandomb(bits, random_state, 64);
	else
		mpz_rrandomb(bits, random_state, 64);
	word = mpz_get_ui(bits);
	if (random_below(2)) word ^= UINT64_C(1) << 63;
	if (random_below(4) == 0) word &= ~(UINT64_C(0x7fe) << 52); /* subnormal, or just above */
	if (random_below(2)) word = (word & ~(UINT64_C(0x7ff) << 52)) | (uint64_t)(963 + random_below(120)) << 52;
	mpz_clear(bits);
	memcpy(&result, &word, sizeof result);
	return result;
}

static void from_double_body(struct bench *bench)
{
	for (int i = 0; i < cases / 5; i++) {
		double given = random_double();
		num x = from_double(given);
		mpfr_set_d(bench->a, given, MPFR_RNDN);
		value(bench->found, x);
		limit(bench->expected, mpfr_set(bench->expected, bench->a, MPFR_RNDN), largest_exponent);
		if (!agrees(bench->found, bench->expected, 0))
			fail_with("from_double", bench->a, bench->a, bench->found, bench->expected);
		double back = to_double(x);
		if (num_bits() >= 53 && !isnan(given)) assert_memory_equal(&back, &given, sizeof given);
	}
}

static void from_double_rounds_to_nearest_even(void **state)
{
	(void)state;
	at_each_precision(from_double_body);
}

/* A number anywhere around the range of doubles; one in two at, or by its last bit beside, the middle between two. */
static num random_near_doubles(void)
{
	num x = random_integer(num_bits());
	if (num_bits() > 54 && random_below(2)) {
		int bits = random_below(2) ? 54 : 1 + random_below(54);
		num last = scaled(from_double(random_below(3) - 1), -1 - random_below(num_bits() - 54));
		x = add(random_integer(bits), last);
	}
	switch (random_below(3)) {
	case 0:
		return scaled(x, -1100 - num_bits() + random_below(100));
	case 1:
		return scaled(x, 1000 - random_below(num_bits() + 5));
	default:
		return scaled(x, random_around_zero(100));
	}
}

static void to_double_body(struct bench *bench)
{
	mpfr_set_prec(bench->expected, 53);
	for (int i = 0; i < cases / 5; i++) {
		num x = random_near_doubles();
		value(bench->a, x);
		limit(bench->expected, mpfr_set(bench->expected, bench->a, MPFR_RNDN), 1024);
		mpfr_set_d(bench->found, to_double(x), MPFR_RNDN);
		if (!agrees(bench->found, bench->expected, 0))
			fail_with("to_double", bench->a, bench->a, bench->found, bench->expected);
	}
}

static void to_double_rounds_to_nearest_even(void **state)
{
	(void)state;
	at_each_precision(to_double_body);
}

/* Numbers are values: an expression gives what its steps give, and a result may replace its operand. */
static void values_body(struct bench *bench)
{
	for (int i = 0; i < cases / 20; i++) {
		num a = random_number(), b = random_number();
		num sum = add(a, b), difference = sub(a, b), product = mul(sum, difference), quotient = divide(product, b);
		num in_place[2] = {a, b};
		in_place[1] = add(in_place[0], in_place[1]);
		in_place[0] = sub(in_place[0], b);
		in_place[0] = mul(in_place[1], in_place[0]);
		in_place[0] = divide(in_place[0], b);
		value(bench->a, a);
		value(bench->b, b);
		mpfr_set_prec(bench->expected, exact_bits);
		value(bench->expected, quotient);
		value(bench->found, in_place[0]);
		if (!agrees(bench->found, bench->expected, 0))
			fail_with("chain in place", bench->a, bench->b, bench->found, bench->expected);
		value(bench->found, divide(mul(add(a, b), sub(a, b)), b));
		if (!agrees(bench->found, bench->expected, 0))
			fail_with("nested chain", bench->a, bench->b, bench->found, bench->expected);
	}
}

static void numbers_are_values(void **state)
{
	(void)state;
	at_each_precision(values_body);
}

static void only_precisions_on_offer_are_chosen(void **state)
{
	(void)state;
	assert_true(num_choose(precisions[0]));
	for (int bits = -70; bits < 1200; bits++) {
		int before = num_bits();
		assert_int_equal(num_choose(bits), offered(bits));
		assert_int_equal(num_bits(), offered(bits) && bits ? bits : before);
	}
}

static void *choose_others(void *unused)
{
	for (size_t i = 0; i < sizeof precisions / sizeof *precisions; i++) num_choose(precisions[i]);
	return unused;
}

static void precision_belongs_to_its_thread(void **state)
{
	pthread_t thread;
	(void)state;
	assert_true(num_choose(precisions[0]));
	assert_int_equal(pthread_create(&thread, NULL, choose_others, NULL), 0);
	assert_int_equal(pthread_join(thread, NULL), 0);
	assert_int_equal(num_bits(), precisions[0]);
}

#include "num_rests.inl"

static int run_num_tests(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(a_precision_is_in_force_from_the_start),
		cmocka_unit_test(operations_round_as_mpfr_does),
		cmocka_unit_test(zeros_infinities_and_nans),
		cmocka_unit_test(negation_is_exact),
		cmocka_unit_test(from_double_rounds_to_nearest_even),
		cmocka_unit_test(to_double_rounds_to_nearest_even),
		cmocka_unit_test(numbers_are_values),
		cmocka_unit_test(rests_are_what_rounding_left_out),
		cmocka_unit_test(mpfr_and_back),
		cmocka_unit_test(exponents),
		cmocka_unit_test(only_precisions_on_offer_are_chosen),
		cmocka_unit_test(precision_belongs_to_its_thread),
	};
	return cmocka_run_group_tests_name(num_name, tests, seed_random, clear_random);
}
