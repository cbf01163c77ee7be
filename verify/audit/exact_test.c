#include "audit/exact_test.h"

#include <gsl/gsl_cdf.h>
#include <gsl/gsl_sort.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* From the chances of at least, and of at most, as many. */
static double chance(double at_least, double at_most, enum measure_worse worse)
{
	double p = worse == WORSE_MORE ? at_least : worse == WORSE_LESS ? at_most : 2 * fmin(at_least, at_most);
	return fmin(1, fmax(0, p));
}

static double log_choose(double n, double k)
{
	return lgamma(n + 1) - lgamma(k + 1) - lgamma(n - k + 1);
}

/* Of `all` things `marked` are marked; so many are drawn. The chance that `hits` of them or more are marked, summed
 * from there outwards: small when `hits` is beyond the mean. */
static double upper_tail(double hits, double drawn, double marked, double all)
{
	double most = fmin(drawn, marked), least = fmax(0, drawn + marked - all), sum = 0;
	if (hits > most) return 0;
	if (hits <= least) return 1;
	double term = exp(log_choose(drawn, hits) + log_choose(all - drawn, marked - hits) - log_choose(all, marked));
	for (double x = hits; x <= most && term > 1e-17 * sum; x++) {
		sum += term;
		term *= (drawn - x) * (marked - x) / ((x + 1) * (all - drawn - marked + x + 1));
	}
	return sum;
}

double test_proportions(double hits, double trials, double reference_hits, double reference_trials,
						enum measure_worse worse)
{
	double marked = hits + reference_hits, all = trials + reference_trials, mean = trials * marked / all;
	/* Fewer of the marked are as many more of the others. */
	double at_least, at_most;
	if (hits > mean) {
		at_least = upper_tail(hits, trials, marked, all);
		at_most = 1 - upper_tail(hits + 1, trials, marked, all);
	} else {
		at_most = upper_tail(trials - hits, trials, all - marked, all);
		at_least = 1 - upper_tail(trials - hits + 1, trials, all - marked, all);
	}
	return chance(at_least, at_most, worse);
}

double test_rates(double hits, double exposure, double reference_hits, double reference_exposure,
				  enum measure_worse worse)
{
	double all = hits + reference_hits, share = exposure / (exposure + reference_exposure);
	double at_least = hits > 0 ? gsl_cdf_beta_P(share, hits, all - hits + 1) : 1;
	double at_most = hits < all ? gsl_cdf_beta_Q(share, hits + 1, all - hits) : 1;
	return chance(at_least, at_most, worse);
}

/* ---- ranks */

/* Twice the ranks of all values, so that those of ties are whole: the first `count` belong to the set in question.
 * Returns what ties take from the variance, as the sum of t^3 - t. */
static double rank(const double *all, size_t total, size_t *order, size_t *doubled)
{
	double ties = 0;
	gsl_sort_index(order, all, 1, total);
	for (size_t from = 0, to; from < total; from = to) {
		for (to = from + 1; to < total && !(all[order[to]] > all[order[from]]);) to++;
		double tied = (double)(to - from);
		ties += tied * (tied * tied - 1);
		for (size_t k = from; k < to; k++) doubled[order[k]] = from + 1 + to;
	}
	return ties;
}

/* Among all ways to choose `count` of the ranks, the share of those whose sum is at most `sum`. */
static double lower_tail(const size_t *doubled, size_t total, size_t count, size_t sum)
{
	double *ways = calloc((count + 1) * (sum + 1), sizeof *ways), few = 0;
	if (!ways) return 1;
	ways[0] = 1; /* of row j, how many choices of j ranks have that sum */
	for (size_t r = 0; r < total; r++)
		for (size_t j = count < r + 1 ? count : r + 1; j > 0; j--)
			for (size_t s = doubled[r]; s <= sum; s++)
				ways[j * (sum + 1) + s] += ways[(j - 1) * (sum + 1) + s - doubled[r]];
	for (size_t s = 0; s <= sum; s++) few += ways[count * (sum + 1) + s];
	free(ways);
	return few / round(exp(log_choose((double)total, (double)count)));
}

/* The chance of a rank sum at most that of the first `count` values. */
static double chance_of_less(const double *all, size_t total, size_t count, size_t *order, size_t *doubled)
{
	size_t sum = 0;
	double ties = rank(all, total, order, doubled), n = (double)count, N = (double)total;
	for (size_t k = 0; k < count; k++) sum += doubled[k];
	double variance = n * (N - n) / 3 * (N + 1 - ties / (N * (N - 1)));
	double beyond = ((double)sum - n * (N + 1)) / sqrt(variance);
	if (!(variance > 0)) return 1;
	return beyond > -1 ? gsl_cdf_ugaussian_P(beyond) : lower_tail(doubled, total, count, sum);
}

double test_ranks(const double *values, size_t count, const double *reference, size_t reference_count,
				  enum measure_worse worse)
{
	size_t total = count + reference_count;
	double *all = calloc(total + 1, sizeof *all), less = 1, more = 1;
	size_t *order = calloc(total + 1, sizeof *order), *doubled = calloc(total + 1, sizeof *doubled);
	if (all && order && doubled && count > 0 && reference_count > 0) {
		memcpy(all, values, count * sizeof *all);
		memcpy(all + count, reference, reference_count * sizeof *all);
		if (worse != WORSE_MORE) less = chance_of_less(all, total, count, order, doubled);
		for (size_t k = 0; k < total; k++) all[k] = -all[k];
		if (worse != WORSE_LESS) more = chance_of_less(all, total, count, order, doubled);
	}
	free(all);
	free(order);
	free(doubled);
	return chance(more, less, worse);
}
