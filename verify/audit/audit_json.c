#include <math.h>
#include <string.h>

#include "audit/audit.h"
#include "schema.h"

static const char *const states[] = {"done", "stopped", "not reached", "failed"};

static void set_text(json_t *json, const char *key, const char *text)
{
	if (text && *text) json_object_set_new(json, key, json_string(text));
}

static void set_comparison(json_t *json, const struct verdict *verdict)
{
	bool word = verdict->now.nature == MEASURE_WORD;
	json_object_set_new(json, "chance", json_real(verdict->chance));
	json_object_set_new(json, "nights", json_integer((json_int_t)verdict->nights));
	json_object_set_new(json, "references", json_integer((json_int_t)verdict->references));
	json_object_set_new(json, "before",
						word ? json_string(verdict->before.word) : schema_number(verdict->before.value));
	json_object_set_new(json, "since", json_integer(verdict->since));
}

static json_t *measure_json(const struct audit_check *one, const struct audit_measure *measure)
{
	const struct measurement *measured = &measure->measured;
	const struct quantity_entry *quantity = measure->asked->quantity;
	char shown[MEASUREMENT_TEXT];
	json_t *json = json_object();
	set_text(json, "measure", measure->asked->name);
	set_text(json, "unit", quantity->unit);
	set_text(json, "nature", nature_name(quantity->nature));
	set_text(json, "worse", worse_name(measure->asked->worse));
	json_object_set_new(json, "seconds", json_real(one->seconds / (double)one->check->measure_count));
	if (one->state != AUDIT_DONE) {
		set_text(json, one->state == AUDIT_FAILED ? "error" : "unreached", one->reason);
		return json;
	}
	if (measured->nature == MEASURE_WORD) {
		set_text(json, "word", measured->word);
	} else {
		json_object_set_new(json, "value", schema_number(measured->value));
		json_object_set_new(json, "interval",
							json_pack("[o, o]", schema_number(measured->low), schema_number(measured->high)));
		json_object_set_new(json, "count", json_integer((json_int_t)measured->count));
	}
	set_text(json, "shown", measurement_text(measured, shown));
	set_text(json, "fault", measure->fault);
	set_text(json, "regression", measure->regression);
	if (*measure->fault || *measure->regression)
		json_object_set_new(json, "finding",
							json_sprintf("%s%s%s", measure->fault, *measure->fault && *measure->regression ? "; " : "",
										 measure->regression));
	if (measure->verdict.compared) set_comparison(json, &measure->verdict);
	return json;
}

static json_t *check_json(const struct audit_check *one, json_int_t tally[3])
{
	json_t *json = json_object(), *measures = json_array();
	set_text(json, "check", one->check->name);
	set_text(json, "definition", one->check->definition);
	json_object_set_new(json, "seed", json_integer((json_int_t)one->seed));
	set_text(json, "state", states[one->state]);
	set_text(json, "reason", one->reason);
	json_object_set_new(json, "seconds", json_real(one->seconds));
	for (size_t m = 0; m < one->check->measure_count; m++) {
		json_t *measure = measure_json(one, &one->measures[m]);
		static const char *const keys[3] = {"finding", "error", "unreached"};
		for (int k = 0; k < 3; k++) tally[k] += json_object_get(measure, keys[k]) != NULL;
		json_array_append_new(measures, measure);
	}
	json_object_set_new(json, "measures", measures);
	return json;
}

json_t *audit_json(const struct audit *audit)
{
	const struct audit_plan *plan = audit->plan;
	const struct history_audit *origin = &plan->origin;
	json_t *json = json_object(), *checks = json_array();
	json_int_t tests = 0, tally[3] = {0};
	for (size_t c = 0; c < plan->suite->check_count; c++) {
		json_array_append_new(checks, check_json(&audit->checks[c], tally));
		tests += (json_int_t)plan->suite->checks[c].measure_count;
	}
	set_text(json, "schema", "touchstone-audit-1");
	set_text(json, "suite", plan->suite->name);
	set_text(json, "title", plan->suite->title);
	set_text(json, "date", origin->date);
	json_object_set_new(json, "seed", json_integer((json_int_t)origin->seed));
	set_text(json, "revision", origin->revision);
	set_text(json, "compiler", origin->compiler);
	set_text(json, "machine", origin->machine);
	json_object_set_new(json, "false_alarms", json_real(plan->suite->false_alarms));
	if (plan->budget < INFINITY) json_object_set_new(json, "budget_seconds", json_real(plan->budget));
	json_object_set_new(json, "seconds", json_real(audit->seconds));
	set_text(json, "state", audit->interrupted ? "interrupted" : "complete");
	if (audit->number) json_object_set_new(json, "audit", json_integer(audit->number));
	json_object_set_new(json, "tests", json_integer(tests));
	json_object_set_new(json, "failures", json_integer(tally[0]));
	json_object_set_new(json, "errors", json_integer(tally[1]));
	json_object_set_new(json, "skipped", json_integer(tally[2]));
	json_object_set_new(json, "checks", checks);
	return json;
}
