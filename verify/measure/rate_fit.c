#include "measure/rate_fit.h"

#include <math.h>
#include <stdbool.h>

static double expected(const struct rate_fit *fit, const struct rung_count *rung)
{
	return rung->events * exp2(fit->intercept - fit->exponent * rung->bits);
}

/* One of Newton's steps towards the largest likelihood, and the inverse of the curvature there. Bits are counted from
 * `middle`, so that the two directions hardly lean on each other. False where there is nothing to go by. */
static bool step(const struct rung_count *rung, size_t rungs, double at[2], double middle, double inverse[2][2])
{
	double slope[2] = {0}, curve[2][2] = {{0}};
	for (size_t r = 0; r < rungs; r++) {
		double x[2] = {M_LN2, -M_LN2 * (rung[r].bits - middle)};
		double mean = rung[r].events * exp(at[0] * x[0] + at[1] * x[1]);
		for (int i = 0; i < 2; i++) {
			slope[i] += ((double)rung[r].count - mean) * x[i];
			for (int j = 0; j < 2; j++) curve[i][j] += mean * x[i] * x[j];
		}
	}
	double determinant = curve[0][0] * curve[1][1] - curve[0][1] * curve[1][0];
	if (!(determinant > 0)) return false;
	for (int i = 0; i < 2; i++)
		for (int j = 0; j < 2; j++) inverse[i][j] = (i == j ? curve[1 - i][1 - j] : -curve[i][j]) / determinant;
	for (int i = 0; i < 2; i++) {
		double by = inverse[i][0] * slope[0] + inverse[i][1] * slope[1];
		at[i] += fmin(fmax(by, -2), 2); /* the likelihood is concave: short steps always arrive */
	}
	return true;
}

struct rate_fit rate_fit(const struct rung_count *rung, size_t rungs, double burst)
{
	struct rate_fit fit = {.rungs = 0, .exponent = NAN, .intercept = NAN, .dispersion = fmax(1, burst)};
	double events = 0, counts = 0, middle = 0, inverse[2][2];
	size_t counted = 0;
	for (size_t r = 0; r < rungs; r++) {
		double count = (double)rung[r].count;
		fit.rungs += rung[r].events > 0;
		counted += count > 0;
		counts += count;
		events += rung[r].events;
		middle += count * rung[r].bits;
	}
	if (counted < 2) return fit;
	middle /= counts;
	double at[2] = {log2(counts / events), 1};
	for (int k = 0; k < 200; k++)
		if (!step(rung, rungs, at, middle, inverse)) return fit;
	fit.exponent = at[1];
	fit.intercept = at[0] + at[1] * middle;
	double squares = 0;
	for (size_t r = 0; r < rungs; r++) {
		double mean = expected(&fit, &rung[r]);
		if (mean > 0) squares += pow((double)rung[r].count - mean, 2) / mean;
	}
	if (fit.rungs > 2) fit.dispersion = fmax(fit.dispersion, squares / (double)(fit.rungs - 2));
	double a = inverse[0][0], b = inverse[0][1], c = inverse[1][1];
	fit.covariance[0][0] = fit.dispersion * (a + 2 * middle * b + middle * middle * c);
	fit.covariance[0][1] = fit.covariance[1][0] = fit.dispersion * (b + middle * c);
	fit.covariance[1][1] = fit.dispersion * c;
	return fit;
}

double rate_fit_at(const struct rate_fit *fit, double bits, struct interval *interval)
{
	static const double quantile = 1.959963984540054;
	double middle = fit->intercept - fit->exponent * bits;
	double variance = fit->covariance[0][0] - 2 * bits * fit->covariance[0][1] + bits * bits * fit->covariance[1][1];
	double half = quantile * sqrt(fmax(0, variance));
	*interval = (struct interval){exp2(middle - half), exp2(middle + half)};
	return exp2(middle);
}

double rate_fit_exponent_error(const struct rate_fit *fit)
{
	return sqrt(fit->covariance[1][1]);
}
