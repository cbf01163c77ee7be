#include "measure/time_place.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "measure/horizon.h"
#include "measure/three_body.h"
#include "measure/vessel.h"

/* What binary32 shows after 10^3, binary64 shows after 10^3 2^29, some 10^11 or 10^12. */
const struct situation situations[SITUATIONS] = {
	{"binary64", "t = 0, box 10", 0, 10}, {"binary64", "t = 1000", 1e3, 10}, {"binary64", "t = 10^6", 1e6, 10},
	{"binary64", "t = 10^9", 1e9, 10},    {"binary64", "box 100", 0, 100},   {"binary64", "box 1000", 0, 1000},
	{"binary32", "t = 0, box 10", 0, 10}, {"binary32", "t = 10", 10, 10},    {"binary32", "t = 100", 100, 10},
	{"binary32", "t = 1000", 1e3, 10},    {"binary32", "box 100", 0, 100},   {"binary32", "box 1000", 0, 1000},
};

/* Both measures of one run. */
struct observed {
	struct impact impact;
	struct three_body three_body;
};

static void see(void *context, struct touchstone_engine *engine, const struct touchstone_event *event)
{
	struct observed *observed = context;
	impact_see(&observed->impact, engine, event);
	three_body_see(&observed->three_body, engine, event);
}

static json_t *counts(const uint64_t *count, size_t most)
{
	json_t *list = json_array();
	for (size_t k = 0; k < most; k++) json_array_append_new(list, json_integer((json_int_t)count[k]));
	return list;
}

static json_t *observed_json(const struct observed *observed, const struct horizon *horizon)
{
	const struct impact_histogram *exact = &observed->impact.exact;
	return json_pack("{s:I, s:I, s:f, s:f, s:[o, o], s:I, s:I, s:f}", "contacts", (json_int_t)observed->impact.count,
					 "below", (json_int_t)exact->below, "sum", exact->sum, "squares", exact->sum_of_squares,
					 "doublings", counts(exact->doubling[0], IMPACT_DOUBLINGS),
					 counts(exact->doubling[1], IMPACT_DOUBLINGS), "three_body",
					 (json_int_t)observed->three_body.events, "encounters", (json_int_t)observed->three_body.encounters,
					 "horizon", horizon->per_particle);
}

/* Runs the vessel where it stands. */
static bool observe(const struct vessel *vessel, const char *arithmetic, const struct watch *watch,
					struct observed *observed, char error[160])
{
	const struct touchstone_limits limits = {.events = UINT64_MAX, .time = vessel->scene.clock + VESSEL_TIME};
	struct touchstone_engine *engine = touchstone_create(&vessel->scene, arithmetic, "stable", error);
	if (!engine) return false;
	*error = '\0';
	impact_begin(&observed->impact, horizon_bits(arithmetic, error));
	bool through = course_run(engine, &limits, &(struct touchstone_observer){see, observed}, watch);
	touchstone_destroy(engine);
	return through;
}

static json_t *measure(struct vessel *vessel, const struct situation *situation, enum touchstone_form form,
					   const struct watch *watch, char error[160])
{
	const struct touchstone_limits all = {.events = course_events(10000, VESSEL_SPHERES), .time = INFINITY};
	struct observed *observed = calloc(1, sizeof *observed);
	struct horizon horizon;
	json_t *json = NULL;
	vessel_put(vessel, form, situation->box, situation->clock);
	if (!observed || !three_body_begin(&observed->three_body, VESSEL_SPHERES)) {
		snprintf(error, 160, "out of memory");
	} else {
		bool good =
			observe(vessel, situation->arithmetic, watch, observed, error) &&
			horizon_find(&vessel->scene, "stable", situation->arithmetic, "mpfr:256", &all, watch, &horizon, error);
		if (good && !horizon.stopped) json = observed_json(observed, &horizon);
		three_body_end(&observed->three_body);
	}
	free(observed);
	return json;
}

json_t *time_place_measure(uint64_t seed, const struct watch *watch, char error[160])
{
	struct vessel vessel;
	if (!vessel_fill(&vessel, seed, watch, error)) return NULL;
	json_t *list = json_array(), *one = NULL;
	for (size_t k = 0; k < SITUATIONS * FORMS; k++) {
		one = measure(&vessel, &situations[k / FORMS], (enum touchstone_form)(k % FORMS), watch, error);
		if (!one) break;
		json_array_append_new(list, one);
	}
	vessel_empty(&vessel);
	if (one) return list;
	json_decref(list);
	return NULL;
}

static uint64_t count_of(const json_t *json, const char *key)
{
	return (uint64_t)json_integer_value(json_object_get(json, key));
}

void time_place_add(struct sight *sight, const json_t *measured, size_t situation, enum touchstone_form form)
{
	const json_t *one = json_array_get(measured, situation * FORMS + form), *sides = json_object_get(one, "doublings");
	sight->contacts += count_of(one, "contacts");
	sight->below += count_of(one, "below");
	sight->three_body += count_of(one, "three_body");
	sight->encounters += count_of(one, "encounters");
	sight->sum += json_real_value(json_object_get(one, "sum"));
	sight->squares += json_real_value(json_object_get(one, "squares"));
	for (size_t side = 0; side < 2; side++)
		for (size_t k = 0; k < IMPACT_DOUBLINGS; k++)
			sight->doubling[side][k] += (uint64_t)json_integer_value(json_array_get(json_array_get(sides, side), k));
	sight->horizon[sight->vessels++] = json_real_value(json_object_get(one, "horizon"));
}

double time_place_deviation(const struct sight *sight)
{
	double contacts = (double)sight->contacts, mean = sight->sum / contacts;
	return sqrt(fmax(0, sight->squares / contacts - mean * mean));
}
