/* What an arithmetic with the exponent range of an IEEE 754 format must keep besides. Asks of the including file what
 * num_test.inl asks, but for the errors allowed, which are none, and
 *     edge_bits    up to how many bits results are rounded correctly at the edges of the range as well */

static const double allowed_error[] = {0, 0, 0, 0, 0};
enum { reference_bits = 0 };

#include "num_test.inl"
#include "test/long_double.h"

static void edge_body(struct bench *bench)
{
	if (num_bits() > edge_bits) return;
	for (int i = 0; i < cases / 20; i++) {
		num a = random_integer(num_bits()), b = random_integer(num_bits());
		int near_end = random_around_zero(2 * num_bits());
		switch (random_below(4)) {
		case 0: /* sums and products that overflow */
			a = scaled(a, largest_exponent - num_bits());
			b = random_below(2) ? scaled(b, near_end) : a;
			break;
		case 1: /* products and quotients that end among the subnormal numbers */
			a = scaled(a, -largest_exponent / 2 + near_end);
			b = scaled(b, (random_below(2) ? -1 : 1) * largest_exponent / 2);
			break;
		case 2: /* quotients that overflow */
			a = scaled(a, largest_exponent / 2);
			b = scaled(b, -largest_exponent / 2 + near_end);
			break;
		default: /* subnormal operands */
			a = scaled(a, -largest_exponent + near_end / 2 - num_bits());
			b = scaled(b, -largest_exponent - near_end / 2);
		}
		check_all(bench, a, b);
	}
}

static void operations_round_at_the_edges_of_the_range(void **state)
{
	(void)state;
	at_each_precision(edge_body);
}

int main(void)
{
	if (!arithmetic_is_whole(num_name)) return 0;
	const struct CMUnitTest tests[] = {cmocka_unit_test(operations_round_at_the_edges_of_the_range)};
	return run_num_tests() + cmocka_run_group_tests_name(num_name, tests, seed_random, clear_random);
}
