#include "measure/collapse.h"

#include "campaign/campaign.h"
#include "scene/random.h"
#include <gsl/gsl_sort.h>
#include <gsl/gsl_statistics_double.h>
#include <math.h>
#include <mpfr.h>
#include <stdlib.h>

enum { BATCH = 256, SAMPLE = 4096, BITS = 2200 };

static void add_terms(mpfr_t sum, const double terms[TOUCHSTONE_MOST_TERMS], int sign)
{
	for (int term = 0; term < TOUCHSTONE_MOST_TERMS && terms[term] != 0; term++)
		mpfr_add_d(sum, sum, sign * terms[term], MPFR_RNDN);
}

double collapse_error(const struct touchstone_drop *drop, const struct touchstone_landing *landing)
{
	mpfr_t exact, part;
	mpfr_init2(exact, BITS);
	mpfr_init2(part, BITS);
	mpfr_set_d(exact, -0.5, MPFR_RNDN);
	add_terms(exact, landing->start, 1);
	add_terms(exact, landing->plate, -1);
	mpfr_mul_ui(exact, exact, 2, MPFR_RNDN);
	mpfr_div_d(exact, exact, -drop->gravity, MPFR_RNDN);
	mpfr_sqrt(exact, exact, MPFR_RNDN);
	mpfr_set_d(part, drop->restitution, MPFR_RNDN);
	mpfr_add_ui(part, part, 1, MPFR_RNDN);
	mpfr_mul(exact, exact, part, MPFR_RNDN);
	mpfr_set_d(part, drop->restitution, MPFR_RNDN);
	mpfr_ui_sub(part, 1, part, MPFR_RNDN);
	mpfr_div(exact, exact, part, MPFR_RNDN);
	mpfr_neg(exact, exact, MPFR_RNDN);
	add_terms(exact, landing->time, 1);
	double error = mpfr_get_d(exact, MPFR_RNDN);
	mpfr_clear(exact);
	mpfr_clear(part);
	return error;
}

/* A plate uniform in [0, 1) with as many bits as the arithmetic can tell apart, drawn 53 at a time. */
static void draw_plate(struct random_state *random, int terms, double plate[TOUCHSTONE_MOST_TERMS])
{
	for (int term = 0; term < TOUCHSTONE_MOST_TERMS; term++)
		plate[term] = term < terms ? ldexp(random_uniform(random), -53 * term) : 0;
}

/* Adds one landing to the sums. */
static void enter(struct collapse *collapse, const struct touchstone_drop *drop,
				  const struct touchstone_landing *landing, double *sample)
{
	collapse->plates++;
	collapse->deepest = fmin(collapse->deepest, landing->gap);
	if (landing->verdict == TOUCHSTONE_HALTED) {
		collapse->events_to_halt += (double)landing->events;
		collapse->halted++;
	} else if (landing->verdict == TOUCHSTONE_COLLAPSED) {
		double error = fabs(collapse_error(drop, landing));
		if (collapse->rested < SAMPLE) sample[collapse->rested] = error;
		if (!(error <= collapse->largest_error))
			collapse->largest_error = error, collapse->worst_plate = landing->plate[0];
		collapse->events_to_rest += (double)landing->events;
		collapse->rested++;
	}
}

bool collapse_measure(const struct collapse_setup *setup, struct collapse *collapse, char error[160])
{
	struct touchstone_drop drop[BATCH];
	struct touchstone_landing landing[BATCH];
	struct random_state random = random_seed(setup->seed);
	double sample[SAMPLE];
	*collapse = (struct collapse){.worst_plate = NAN};
	while (collapse->plates < setup->plates && !(setup->stop && *setup->stop)) {
		size_t count = 0;
		for (; count < BATCH && collapse->plates + count < setup->plates; count++) {
			drop[count] = (struct touchstone_drop){
				.gravity = setup->gravity,
				.restitution = setup->restitution,
				.order = setup->order,
				.most = setup->most,
			};
			draw_plate(&random, (setup->bits + 52) / 53, drop[count].plate);
		}
		if (!touchstone_drop(setup->arithmetic, setup->method, drop, count, landing, NULL, NULL, error)) return false;
		for (size_t i = 0; i < count; i++) enter(collapse, &drop[i], &landing[i], sample);
	}
	size_t sampled = collapse->rested < SAMPLE ? collapse->rested : SAMPLE;
	gsl_sort(sample, 1, sampled);
	collapse->median_error = sampled ? gsl_stats_median_from_sorted_data(sample, 1, sampled) : NAN;
	if (collapse->halted) collapse->events_to_halt /= (double)collapse->halted;
	if (collapse->rested) collapse->events_to_rest /= (double)collapse->rested;
	return true;
}

json_t *collapse_json(const struct collapse *collapse)
{
	return json_pack("{s:I, s:I, s:I, s:o, s:o, s:o, s:o, s:o, s:o}", "plates", (json_int_t)collapse->plates, "halted",
					 (json_int_t)collapse->halted, "rested", (json_int_t)collapse->rested, "events_to_halt",
					 campaign_number(collapse->events_to_halt), "events_to_rest",
					 campaign_number(collapse->events_to_rest), "largest_error",
					 campaign_number(collapse->largest_error), "worst_plate", campaign_number(collapse->worst_plate),
					 "median_error", campaign_number(collapse->median_error), "deepest",
					 campaign_number(collapse->deepest));
}

struct collapse collapse_of_json(const json_t *json)
{
	if (!json_is_object(json)) return (struct collapse){0};
	return (struct collapse){
		.plates = (uint64_t)json_integer_value(json_object_get(json, "plates")),
		.halted = (uint64_t)json_integer_value(json_object_get(json, "halted")),
		.rested = (uint64_t)json_integer_value(json_object_get(json, "rested")),
		.events_to_halt = campaign_value(json, "events_to_halt"),
		.events_to_rest = campaign_value(json, "events_to_rest"),
		.largest_error = campaign_value(json, "largest_error"),
		.worst_plate = campaign_value(json, "worst_plate"),
		.median_error = campaign_value(json, "median_error"),
		.deepest = campaign_value(json, "deepest"),
	};
}
