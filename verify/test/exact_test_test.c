/* The exact tests, held against laws that are counted out one by one. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "audit/exact_test.h"
#include "scene/random.h"

enum { SEED = 20261122, TRIALS = 300 };

static double choose(int n, int k)
{
	double ways = 1;
	if (k < 0 || k > n) return 0;
	for (int i = 1; i <= k; i++) ways = ways * (n - k + i) / i;
	return ways;
}

static void assert_near(double got, double exact, const char *what)
{
	if (!(fabs(got - exact) <= 1e-10 * (1 + exact / 1e-3))) fail_msg("%s: %.17g, not %.17g", what, got, exact);
}

/* The chances of at least and of at most a value, from the chances of all. */
static void assert_sides(const double *chance, int most, int value, const double got[3], const char *what)
{
	double at_least = 0, at_most = 0;
	for (int x = 0; x <= most; x++) {
		at_least += x >= value ? chance[x] : 0;
		at_most += x <= value ? chance[x] : 0;
	}
	assert_near(got[WORSE_MORE], at_least, what);
	assert_near(got[WORSE_LESS], at_most, what);
	assert_near(got[WORSE_EITHER], fmin(1, 2 * fmin(at_least, at_most)), what);
}

static void proportions_are_hypergeometric(void **state)
{
	(void)state;
	print_message("seed %d\n", SEED);
	struct random_state random = random_seed(SEED);
	for (int t = 0; t < TRIALS; t++) {
		int trials = 1 + (int)random_below(&random, 20), others = 1 + (int)random_below(&random, 30);
		int hits = (int)random_below(&random, (uint64_t)trials + 1);
		int other_hits = (int)random_below(&random, (uint64_t)others + 1), marked = hits + other_hits;
		double chance[32], got[3];
		for (int x = 0; x <= trials; x++)
			chance[x] = choose(trials, x) * choose(others, marked - x) / choose(trials + others, marked);
		for (int w = 0; w < 3; w++) got[w] = test_proportions(hits, trials, other_hits, others, (enum measure_worse)w);
		assert_sides(chance, trials, hits, got, "proportions");
	}
}

static void rates_are_binomial(void **state)
{
	(void)state;
	struct random_state random = random_seed(SEED + 1);
	for (int t = 0; t < TRIALS; t++) {
		int hits = (int)random_below(&random, 20), others = (int)random_below(&random, 12), all = hits + others;
		double exposure = random_uniform(&random) + 0.01, rest = random_uniform(&random) + 0.01, chance[32], got[3];
		double share = exposure / (exposure + rest);
		for (int x = 0; x <= all; x++) chance[x] = choose(all, x) * pow(share, x) * pow(1 - share, all - x);
		for (int w = 0; w < 3; w++) got[w] = test_rates(hits, exposure, others, rest, (enum measure_worse)w);
		assert_sides(chance, all, hits, got, "rates");
	}
}

/* Twice the rank sum of the chosen values, each rank being that among all, ties sharing theirs. */
static int rank_sum(const double *all, int total, unsigned chosen)
{
	int sum = 0;
	for (int i = 0; i < total; i++)
		for (int j = 0; j < total && (chosen >> i & 1); j++)
			sum += all[j] < all[i] ? 2 : all[j] == all[i] ? 1 + (i == j) : 0;
	return sum;
}

static void ranks_are_counted_out(void **state)
{
	(void)state;
	struct random_state random = random_seed(SEED + 2);
	unsigned told = 0;
	for (int t = 0; t < TRIALS; t++) {
		int count = 1 + (int)random_below(&random, 5), rest = 1 + (int)random_below(&random, 6), total = count + rest;
		double all[12], at_most = 0, at_least = 0;
		for (int k = 0; k < total; k++) all[k] = (double)random_below(&random, t % 2 ? 6 : 1000);
		for (int k = 0; k < count && t % 3 == 0; k++) all[k] += t % 2 ? 4 : 900;
		int sum = rank_sum(all, total, (1u << count) - 1);
		for (unsigned chosen = 0; chosen < 1u << total; chosen++) {
			if (__builtin_popcount(chosen) != count) continue;
			int other = rank_sum(all, total, chosen);
			at_most += other <= sum, at_least += other >= sum;
		}
		at_most /= choose(total, count), at_least /= choose(total, count);
		double less = test_ranks(all, (size_t)count, all + count, (size_t)rest, WORSE_LESS);
		double more = test_ranks(all, (size_t)count, all + count, (size_t)rest, WORSE_MORE);
		if (at_most < 0.1) assert_near(less, at_most, "fewer"), told++;
		if (at_least < 0.1) assert_near(more, at_least, "more"), told++;
		assert_true((less < 0.1) <= (at_most < 0.2) && (more < 0.1) <= (at_least < 0.2));
		assert_near(test_ranks(all, (size_t)count, all + count, (size_t)rest, WORSE_EITHER),
					fmin(1, 2 * fmin(less, more)), "either");
	}
	assert_true(told > TRIALS / 8);
}

/* Large numbers: against the normal law, and far out against the leading term. */
static void large_counts_keep_their_digits(void **state)
{
	(void)state;
	double p = test_proportions(500400, 1e6, 25e6, 50e6, WORSE_MORE); /* 400 above, standard deviation 505 */
	assert_true(p > 0.21 && p < 0.22);
	assert_true(test_proportions(500000, 1e6, 25e6, 50e6, WORSE_LESS) > 0.49);
	p = test_proportions(10, 1e5, 0, 5e6, WORSE_MORE); /* all ten of them in one part of 51 */
	assert_true(fabs(p * pow(51, 10) - 1) < 1e-3);
	p = test_rates(10, 1, 0, 50, WORSE_MORE);
	assert_true(fabs(p * pow(51, 10) - 1) < 1e-9);
	assert_true(test_proportions(0, 1e5, 0, 5e6, WORSE_MORE) == 1 && test_rates(0, 1, 0, 50, WORSE_MORE) == 1);
	double slow[4] = {5, 6, 7, 8}, usual[50];
	for (int k = 0; k < 50; k++) usual[k] = k / 50.0;
	assert_near(test_ranks(slow, 4, usual, 50, WORSE_MORE), 1 / choose(54, 4), "all slower");
	assert_true(test_ranks(usual, 50, usual, 50, WORSE_EITHER) == 1);
	assert_true(test_ranks(slow, 0, usual, 50, WORSE_MORE) == 1);
}

int main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(proportions_are_hypergeometric),
		cmocka_unit_test(rates_are_binomial),
		cmocka_unit_test(ranks_are_counted_out),
		cmocka_unit_test(large_counts_keep_their_digits),
	};
	return cmocka_run_group_tests(tests, NULL, NULL);
}
