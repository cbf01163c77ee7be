/* Checks of the papers' figures: what is measured for their claims. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "audit/check.h"
#include "command/command.h"
#include "command/interrupt.h"
#include "command/progress.h"
#include "figure/figure.h"
#include "schema.h"

static void show(void *context, double part)
{
	progress_show(context, 100 * part, 100);
}

static const char *text_at(const json_t *object, const char *key)
{
	const char *text = json_string_value(json_object_get(object, key));
	return text ? text : "";
}

static struct measurement count_differing(const json_t *claims)
{
	const json_t *claim;
	size_t i;
	uint64_t differ = 0;
	json_array_foreach(claims, i, claim) differ += strcmp(text_at(claim, "verdict"), "differs") == 0;
	return measurement_proportion(differ, json_array_size(claims));
}

static const json_t *claim_about(const json_t *claims, const char *words)
{
	const json_t *claim;
	size_t i;
	json_array_foreach(claims, i, claim) if (strstr(text_at(claim, "quantity"), words)) return claim;
	return NULL;
}

static bool measure(const struct suite_measure *asked, const json_t *claims, struct measurement *measured,
					char error[STORE_ERROR])
{
	if (asked->quantity == &audit_quantities[FIGURE_DIFFERS]) {
		*measured = count_differing(claims);
		return true;
	}
	const json_t *claim = claim_about(claims, asked->claim);
	if (!claim) {
		snprintf(error, STORE_ERROR, "no claim about '%.60s'; accepted: words of a claim's quantity", asked->claim);
		return false;
	}
	double value = schema_double(json_object_get(claim, "measured"));
	uint64_t count = (uint64_t)json_integer_value(json_object_get(claim, "count"));
	struct sample sample = {0};
	sample_add(&sample, value);
	if (asked->quantity == &audit_quantities[FIGURE_VERDICT]) {
		*measured = measurement_word(text_at(claim, "verdict"));
	} else if (asked->quantity == &audit_quantities[FIGURE_VALUE]) {
		*measured = measurement_sample(MEASURE_SAMPLE, &sample);
	} else if (count > 0 && value >= 0 && value <= 1) {
		*measured = measurement_proportion((uint64_t)llround(value * (double)count), count);
	} else {
		snprintf(error, STORE_ERROR, "what is measured for '%.60s' is no proportion; accepted: value", asked->claim);
		return false;
	}
	return true;
}

bool check_figure(const struct suite_check *check, uint64_t seed, int threads, struct check_value *values,
				  char error[STORE_ERROR])
{
	struct progress progress = progress_begin(check->name, "%");
	const struct figure_setup setup = {.full = check->full,
									   .seed = seed,
									   .threads = threads,
									   .stop = interrupt_flag(),
									   .progress = show,
									   .context = &progress};
	const struct figure_entry *figure = figures;
	while (strcmp(figure->name, check->figure) != 0) figure++; /* the suite's reader has seen that there is one */
	struct result *result = figure->make(&setup, error);
	progress_end(&progress);
	if (!result) return false;
	*error = '\0';
	const json_t *claims = json_object_get(result_document(result), "claims");
	bool good = !interrupted();
	for (size_t m = 0; good && m < check->measure_count; m++)
		good = measure(&check->measures[m], claims, &values[m].measured, error);
	result_free(result);
	return good;
}
