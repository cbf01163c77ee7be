/* The arithmetic "twin" against MPFR at 300 bits, with the bounds stated above its functions. */
#include "num/twin.h"

#include <mpfr.h>

static const int precisions[] = {106};
static const double allowed_error[] = {3 + 0x1p-49, 3 + 0x1p-49, 5, 15 + 0x1p-47, 25. / 8};
enum { cases = 200000, largest_exponent = 1024, reference_bits = 300, exact_bits = 2300 };

static bool offered(int bits)
{
	return bits == 0 || bits == 106;
}

static void value(mpfr_t exact, num x)
{
	mpfr_set_d(exact, x.high, MPFR_RNDN);
	if (fabs(x.low) > 0) mpfr_add_d(exact, exact, x.low, MPFR_RNDN);
}

#include "num_test.inl"

/* high + low rounds to high, so that a number has one form only and less() may compare the parts. */
static void results_are_normalised(void **state)
{
	(void)state;
	for (int i = 0; i < cases / 10; i++) {
		num a = random_number(), b = random_partner(a);
		for (enum operation operation = ADD; operation < OPERATIONS; operation++) {
			num result = computed(operation, a, b);
			if (is_finite(result) && !(result.high + result.low == result.high))
				fail_msg("%s of %a %+a and %a %+a", operation_name[operation], a.high, a.low, b.high, b.low);
		}
	}
}

/* Wherever the bounds no longer hold, the high part is still a double's worth: where the exact result is within the
 * range so is what is found, to two units in the last place of a double, and no NaN is made of finite operands. */
static void high_part_lasts_to_the_edges_of_the_range(void **state)
{
	struct bench bench;
	(void)state;
	bench_open(&bench);
	for (int i = 0; i < cases / 10; i++) {
		num a = random_integer(106), b = random_integer(106);
		a = scaled(a, (random_below(2) ? 915 : -1170) + random_around_zero(5));
		b = scaled(b, (random_below(2) ? 915 : -1170) + random_around_zero(5));
		if (random_below(2)) b = random_number();
		for (enum operation operation = ADD; operation < OPERATIONS; operation++) {
			num result = computed(operation, a, b);
			value(bench.a, a);
			value(bench.b, b);
			by_mpfr(operation, bench.expected, bench.a, bench.b);
			double expected = mpfr_get_d(bench.expected, MPFR_RNDN), found = to_double(result);
			bool near = fabs(found - expected) <= 0x1p-51 * fabs(expected) + 0x1p-1073;
			bool overflow = isinf(found) && fabs(expected) >= 0x1.fffffffffffffp1023;
			if (!near && !overflow && !(isnan(found) && isnan(expected)) && found != expected)
				fail_msg("%s of %a %+a and %a %+a", operation_name[operation], a.high, a.low, b.high, b.low);
		}
	}
	bench_close(&bench);
}

int main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(results_are_normalised),
		cmocka_unit_test(high_part_lasts_to_the_edges_of_the_range),
	};
	return run_num_tests() + cmocka_run_group_tests_name(num_name, tests, seed_random, clear_random);
}
