/* Random numbers: known answers, moments, and the same bits whatever the compiler. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#include <cmocka.h>

#include "scene/random.h"

enum { DRAWS = 400000 };
static const uint64_t seed = 20141127;

/* The generators' published reference output. */
static void known_answers(void **state)
{
	(void)state;
	struct random_state seeded = random_seed(0);
	const uint64_t splitmix[] = {0xe220a8397b1dcdaf, 0x6e789e6aa1b965f4, 0x06c45d188009454f, 0xf88bb8a8724c81ec};
	for (int i = 0; i < 4; i++) assert_true(seeded.word[i] == splitmix[i]);
	struct random_state counted = {{1, 2, 3, 4}};
	const uint64_t xoshiro[] = {11520, 0, 1509978240, 1215971899390074240, 1216172134540287360};
	for (int i = 0; i < 5; i++) assert_true(random_bits(&counted) == xoshiro[i]);
}

static void uniform_fills_the_interval(void **state)
{
	(void)state;
	struct random_state random = random_seed(seed);
	double sum = 0, least = 1, most = 0;
	uint64_t bits = 0;
	for (int i = 0; i < DRAWS; i++) {
		double u = random_uniform(&random);
		assert_true(u >= 0 && u < 1);
		bits |= (uint64_t)(u * 0x1p53);
		sum += u;
		least = u < least ? u : least;
		most = u > most ? u : most;
	}
	assert_true(fabs(sum / DRAWS - 0.5) < 5 * sqrt(1.0 / 12 / DRAWS));
	assert_true(least < 1e-4 && most > 1 - 1e-4);
	assert_true(bits == (UINT64_C(1) << 53) - 1);
}

static void below_is_even(void **state)
{
	(void)state;
	struct random_state random = random_seed(seed);
	int count[7] = {0};
	for (int i = 0; i < DRAWS; i++) count[random_below(&random, 7)]++;
	double expected = DRAWS / 7.0, square = 0;
	for (int i = 0; i < 7; i++) square += (count[i] - expected) * (count[i] - expected) / expected;
	assert_true(square < 22.5); /* chi squared of 6 degrees of freedom, one in a thousand */
	for (int i = 0; i < 100; i++) assert_true(random_below(&random, UINT64_C(1) << 63 | 1) <= UINT64_C(1) << 63);
}

/* Moments to the fourth and the distribution at several points, each within five standard errors. */
static void normal_is_normal(void **state)
{
	(void)state;
	struct random_state random = random_seed(seed);
	const double edge[] = {-3, -2, -1, -0.25, 0, 0.5, 1, 1.5, 2.5, 3.5};
	enum { EDGES = sizeof edge / sizeof *edge };
	double moment[5] = {0};
	int below[EDGES] = {0};
	for (int i = 0; i < DRAWS; i++) {
		double x = random_normal(&random), power = 1;
		for (int m = 1; m <= 4; m++) moment[m] += (power *= x) / DRAWS;
		for (int e = 0; e < EDGES; e++) below[e] += x < edge[e];
	}
	assert_true(fabs(moment[1]) < 5 * sqrt(1.0 / DRAWS));
	assert_true(fabs(moment[2] - 1) < 5 * sqrt(2.0 / DRAWS));
	assert_true(fabs(moment[3]) < 5 * sqrt(15.0 / DRAWS));
	assert_true(fabs(moment[4] - 3) < 5 * sqrt(96.0 / DRAWS));
	for (int e = 0; e < EDGES; e++) {
		double share = erfc(-edge[e] / sqrt(2)) / 2;
		assert_true(fabs((double)below[e] / DRAWS - share) < 5 * sqrt(share * (1 - share) / DRAWS));
	}
}

/* Recorded once; any compiler, level of optimisation or machine must repeat it. */
static void same_bits_everywhere(void **state)
{
	(void)state;
	struct random_state random = random_seed(1);
	uint64_t digest = UINT64_C(0xcbf29ce484222325);
	for (int i = 0; i < 10000; i++) {
		union {
			double number;
			uint64_t bits;
		} drawn = {random_normal(&random)};
		digest = (digest ^ drawn.bits) * UINT64_C(0x100000001b3);
	}
	printf("digest of 10000 normal numbers: %016llx\n", (unsigned long long)digest);
	assert_true(digest == UINT64_C(0xdf0c7808c0c22063));
}

int main(void)
{
	printf("seed %llu\n", (unsigned long long)seed);
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(uniform_fills_the_interval), cmocka_unit_test(below_is_even),
		cmocka_unit_test(normal_is_normal),           cmocka_unit_test(known_answers),
		cmocka_unit_test(same_bits_everywhere),
	};
	return cmocka_run_group_tests(tests, NULL, NULL);
}
