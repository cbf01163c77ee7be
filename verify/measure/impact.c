#include "measure/impact.h"

#include <math.h>
#include <string.h>

#include "overlap/excess.h"

void impact_begin(struct impact *impact, int bits)
{
	*impact = (struct impact){.bits = bits};
	impact->measured.least = impact->exact.least = INFINITY;
	impact->measured.most = impact->exact.most = -INFINITY;
}

/* Enters a separation of `steps` bars, `excess` ulp, from contact. */
static void enter(struct impact_histogram *histogram, double steps, double excess)
{
	double bar = fmin(fmax(steps, -IMPACT_REACH), IMPACT_REACH);
	histogram->bar[IMPACT_REACH + (int)bar]++;
	histogram->below += excess < 0;
	histogram->above += excess > 0;
	int doublings;
	frexp(excess, &doublings);
	histogram->doubling[!(excess < 0)][doublings < 0                  ? 0
									   : doublings < IMPACT_DOUBLINGS ? doublings
																	  : IMPACT_DOUBLINGS - 1]++;
	histogram->sum += excess;
	histogram->sum_of_squares += excess * excess;
	histogram->least = fmin(histogram->least, excess);
	histogram->most = fmax(histogram->most, excess);
}

/* Whether the numbers just below the contact distance are twice as dense as those above. */
static bool finer_below(double contact)
{
	int exponent;
	return frexp(contact, &exponent) == 0.5;
}

static double ulp_of(double contact, int bits)
{
	int exponent;
	frexp(contact, &exponent);
	return ldexp(1, exponent - bits);
}

/* Whether an excess known to within 2^-30 ulp leaves its bar and its sign in no doubt. */
static bool settled(double steps)
{
	double doubt = 0x1p-30, from_half = fabs(fabs(steps - rint(steps)) - 0.5);
	return from_half > doubt && fabs(steps) > doubt;
}

void impact_see(void *context, struct touchstone_engine *engine, const struct touchstone_event *event)
{
	struct impact *impact = context;
	if (event->kind != TOUCHSTONE_CONTACT) return;
	double terms[3][3 * TOUCHSTONE_MOST_TERMS], distance[TOUCHSTONE_MOST_TERMS];
	int count = touchstone_separation(engine, terms, distance);
	double contact = distance[0];
	double ulp = ulp_of(contact, impact->bits), finer = finer_below(contact) ? 2 : 1;
	impact->count++;
	double steps = (double)event->steps;
	enter(&impact->measured, steps, steps < 0 ? steps / finer : steps);

	double excess = impact->bits <= 53 ? excess_quick(terms, count, distance) / ulp : NAN;
	double exact_steps = excess < 0 ? excess * finer : excess;
	if (impact->bits > 53 || !settled(exact_steps)) {
		impact->forced++;
		excess = excess_exact(terms, count, distance) / ulp;
		exact_steps = excess < 0 ? excess * finer : excess;
	}
	enter(&impact->exact, rint(exact_steps), excess);
}

static void histogram_merge(struct impact_histogram *into, const struct impact_histogram *from)
{
	for (int bar = 0; bar <= 2 * IMPACT_REACH; bar++) into->bar[bar] += from->bar[bar];
	for (int side = 0; side < 2; side++)
		for (int k = 0; k < IMPACT_DOUBLINGS; k++) into->doubling[side][k] += from->doubling[side][k];
	into->below += from->below;
	into->above += from->above;
	into->sum += from->sum;
	into->sum_of_squares += from->sum_of_squares;
	into->least = fmin(into->least, from->least);
	into->most = fmax(into->most, from->most);
}

void impact_merge(struct impact *into, const struct impact *from)
{
	into->count += from->count;
	into->forced += from->forced;
	histogram_merge(&into->measured, &from->measured);
	histogram_merge(&into->exact, &from->exact);
}

double impact_mean(const struct impact_histogram *histogram, uint64_t count)
{
	return histogram->sum / (double)count;
}

double impact_deviation(const struct impact_histogram *histogram, uint64_t count)
{
	double mean = impact_mean(histogram, count);
	return sqrt(fmax(0, histogram->sum_of_squares / (double)count - mean * mean));
}

int impact_mode(const struct impact_histogram *histogram)
{
	int mode = IMPACT_REACH;
	for (int bar = 1; bar < 2 * IMPACT_REACH; bar++) /* the last on either side stands for all beyond */
		if (histogram->bar[bar] > histogram->bar[mode]) mode = bar;
	return mode - IMPACT_REACH;
}
