/* The arithmetic "mpfr", of the NUM_LIMBS that the including file defines, against MPFR called in place. */
#include "num/mpfr.h"

static const int precisions[] = {2,   3,   4,   8,   11,  24,  25,  53,  63,  64,  65,  106, 113,  124, 125,
								 126, 127, 128, 129, 191, 192, 193, 255, 256, 257, 512, 577, 1023, 1024};
static const double allowed_error[] = {0, 0, 0, 0, 0};
enum {
	cases = 24000 / (NUM_LIMBS + 2),
	largest_exponent = 0,
	reference_bits = 0,
	exact_bits = NUM_LIMBS * 64,
};

static bool offered(int bits)
{
	return bits >= 2 && bits <= NUM_LIMBS * 64;
}

static void value(mpfr_t exact, num x)
{
	mpfr_t header;
	num_expose(header, &x);
	mpfr_set(exact, header, MPFR_RNDN);
}

#include "num_test.inl"

static unsigned allocations;

static void *counting_allocate(size_t bytes)
{
	allocations++;
	return malloc(bytes);
}

static void *counting_reallocate(void *block, size_t before, size_t bytes)
{
	(void)before;
	allocations++;
	return realloc(block, bytes);
}

static void plain_free(void *block, size_t bytes)
{
	(void)bytes;
	free(block);
}

static void operations_allocate_nothing(void **state)
{
	(void)state;
	for (size_t i = 0; i < sizeof precisions / sizeof *precisions; i++) {
		if (!num_choose(precisions[i])) continue;
		num a = random_number(), b = random_partner(a);
		double sum = 0;
		mp_set_memory_functions(counting_allocate, counting_reallocate, plain_free);
		allocations = 0;
		for (enum operation operation = ADD; operation < OPERATIONS; operation++)
			sum += to_double(computed(operation, a, b)) + less(a, b) + is_finite(negated(a));
		unsigned counted = allocations;
		mp_set_memory_functions(NULL, NULL, NULL);
		if (counted) fail_msg("%u allocations at %d bits (%g)", counted, precisions[i], sum);
	}
}

/* Operands keep the precision they were made with; the result has that in force. */
static void precisions_mix(void **state)
{
	(void)state;
	for (int i = 0; i < cases; i++) {
		struct bench bench;
		num_choose(2 + random_below(NUM_LIMBS * 64 - 1));
		num a = random_number();
		num_choose(2 + random_below(NUM_LIMBS * 64 - 1));
		num b = random_number();
		num_choose(2 + random_below(NUM_LIMBS * 64 - 1));
		bench_open(&bench);
		check_all(&bench, a, b);
		bench_close(&bench);
	}
}

static num squared(num x, int times)
{
	while (times--) x = mul(x, x);
	return x;
}

/* MPFR's numbers go from 2^-(2^30) to just below 2^(2^30 - 1). */
static void range_is_that_of_mpfr(void **state)
{
	num zero = from_double(0), half = from_double(0.5);
	(void)state;
	assert_true(is_finite(squared(from_double(2), 29)));
	assert_false(is_finite(squared(from_double(2), 30)));
	assert_true(less(zero, squared(half, 30)));
	assert_false(less(zero, squared(half, 31)));
	assert_true(is_finite(squared(half, 31)));
	assert_true(isinf(to_double(squared(from_double(2), 20))));
	assert_true(to_double(squared(half, 20)) <= 0);
}

int main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(operations_allocate_nothing),
		cmocka_unit_test(precisions_mix),
		cmocka_unit_test(range_is_that_of_mpfr),
	};
	return run_num_tests() + cmocka_run_group_tests_name(num_name, tests, seed_random, clear_random);
}
