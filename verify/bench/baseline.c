#include "bench/baseline.h"

#include <errno.h>
#include <libgen.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "command/output.h"
#include "schema.h"

#define BASELINE_SCHEMA "touchstone-bench-1"

struct baseline {
	json_t *document;
};

static const char *text_at(const json_t *object, const char *key)
{
	const char *text = json_string_value(json_object_get(object, key));
	return text ? text : "";
}

/* Three numbers that a measurement can give. */
static bool is_spread(const json_t *numbers)
{
	double value[3];
	if (json_array_size(numbers) != 3) return false;
	for (size_t i = 0; i < 3; i++) {
		value[i] = schema_double(json_array_get(numbers, i));
		if (!(value[i] > 0 && value[i] < INFINITY)) return false;
	}
	return value[1] <= value[0] && value[0] <= value[2];
}

/* The first thing that is wrong with it; false when nothing is. */
static bool faulty(const json_t *document, char what[200])
{
	const json_t *rows = json_object_get(document, "rows"), *row;
	size_t i;
	if (strcmp(text_at(document, "schema"), BASELINE_SCHEMA) != 0)
		return snprintf(what, 200, "the schema is not '%s'", BASELINE_SCHEMA);
	if (!json_is_object(json_object_get(document, "machine"))) return snprintf(what, 200, "it names no machine");
	if (!json_is_array(rows)) return snprintf(what, 200, "rows is not a list");
	json_array_foreach(rows, i, row)
	{
		if (!*text_at(row, "name")) return snprintf(what, 200, "rows[%zu] has no name", i);
		for (int q = 0; q < QUANTITIES; q++) {
			const json_t *numbers = json_object_get(row, quantity_name((enum quantity)q));
			if (numbers && !is_spread(numbers))
				return snprintf(what, 200, "rows[%zu]: %s is not three positive numbers: median, low, high", i,
								quantity_name((enum quantity)q));
		}
	}
	return false;
}

/* Memory differs a little from boot to boot. */
static bool same_machine(const json_t *a, const json_t *b)
{
	double gigabytes[2] = {json_number_value(json_object_get(a, "memory_bytes")) * 0x1p-30,
						   json_number_value(json_object_get(b, "memory_bytes")) * 0x1p-30};
	return strcmp(text_at(a, "processor"), text_at(b, "processor")) == 0 &&
		   json_equal(json_object_get(a, "cores"), json_object_get(b, "cores")) &&
		   fabs(gigabytes[0] - gigabytes[1]) < 1;
}

enum baseline_state baseline_read(const char *path, const json_t *machine, struct baseline **baseline,
								  char error[REPORT_ERROR])
{
	json_error_t fault;
	char what[200];
	*baseline = NULL;
	if (access(path, F_OK) != 0 && errno == ENOENT) {
		snprintf(error, REPORT_ERROR, "%.300s: there is no such file", path);
		return BASELINE_ABSENT;
	}
	json_t *document = json_load_file(path, JSON_REJECT_DUPLICATES, &fault);
	if (!document) {
		if (fault.line > 0)
			snprintf(error, REPORT_ERROR, "%.250s:%d: damaged baseline: %s", path, fault.line, fault.text);
		else
			snprintf(error, REPORT_ERROR, "%.250s: cannot be read as a baseline: %s", path, fault.text);
		return BASELINE_DAMAGED;
	}
	enum baseline_state state = BASELINE_DAMAGED;
	if (faulty(document, what)) {
		snprintf(error, REPORT_ERROR, "%.250s: damaged baseline: %s; accepted: a file written by STORE=1", path, what);
	} else if (!same_machine(json_object_get(document, "machine"), machine)) {
		state = BASELINE_FOREIGN;
		snprintf(error, REPORT_ERROR, "%.250s: from another machine: %.100s", path,
				 text_at(json_object_get(document, "machine"), "processor"));
	} else if ((*baseline = malloc(sizeof **baseline))) {
		(*baseline)->document = document;
		return BASELINE_SOUND;
	} else {
		snprintf(error, REPORT_ERROR, "out of memory");
	}
	json_decref(document);
	return state;
}

void baseline_free(struct baseline *baseline)
{
	if (!baseline) return;
	json_decref(baseline->document);
	free(baseline);
}

const char *baseline_made(const struct baseline *baseline, char text[100])
{
	const char *revision = text_at(baseline->document, "revision");
	snprintf(text, 100, "%.24s%s%.32s, %.24s", text_at(baseline->document, "date"), *revision ? ", revision " : "",
			 revision, text_at(baseline->document, "command"));
	return text;
}

struct spread baseline_value(const struct baseline *baseline, const char *name, enum quantity quantity)
{
	const json_t *row;
	size_t i;
	json_array_foreach(baseline ? json_object_get(baseline->document, "rows") : NULL, i, row)
	{
		const json_t *numbers = json_object_get(row, quantity_name(quantity));
		if (numbers && strcmp(text_at(row, "name"), name) == 0)
			return (struct spread){schema_double(json_array_get(numbers, 0)), schema_double(json_array_get(numbers, 1)),
								   schema_double(json_array_get(numbers, 2))};
	}
	return spread_exact(NAN);
}

double baseline_ratio(const struct baseline *baseline, const struct row *row, enum quantity quantity)
{
	return row->value[quantity].median / baseline_value(baseline, row->name, quantity).median;
}

static json_t *row_document(const struct row *row)
{
	json_t *object = json_pack("{s: s}", "name", row->name);
	for (int q = 0; q < QUANTITIES; q++) {
		const struct spread *value = &row->value[q];
		if (isnan(value->median)) continue;
		json_object_set_new(object, quantity_name((enum quantity)q),
							json_pack("[o, o, o]", schema_number(value->median), schema_number(value->low),
									  schema_number(value->high)));
	}
	return object;
}

bool baseline_write(const char *path, const json_t *document, const struct row *rows, size_t count,
					char error[REPORT_ERROR])
{
	static const char *const kept[] = {"machine", "date", "revision", "command"};
	json_t *baseline = json_pack("{s: s}", "schema", BASELINE_SCHEMA), *list = json_array();
	for (size_t k = 0; k < sizeof kept / sizeof *kept; k++)
		if (json_object_get(document, kept[k])) json_object_set(baseline, kept[k], json_object_get(document, kept[k]));
	for (size_t r = 0; r < count; r++) json_array_append_new(list, row_document(&rows[r]));
	json_object_set_new(baseline, "rows", list);
	char *copy = strdup(path);
	bool written = copy && aside_folder(dirname(copy), error) && output_json(path, baseline, error);
	free(copy);
	json_decref(baseline);
	return written;
}
