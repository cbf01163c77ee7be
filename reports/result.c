#include "result.h"

#include "provenance.h"
#include "schema.h"

#include <math.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

struct result {
	json_t *document;
	bool broken; /* something could not be added, for lack of memory */
};

/* ------------------------------------------------------------------ adding */

/* Takes the value over; NULL for lack of memory. */
static void set(struct result *result, json_t *object, const char *key, json_t *value)
{
	if (json_object_set_new(object, key, value) != 0) result->broken = true;
}

static json_t *append(struct result *result, json_t *array, json_t *value)
{
	if (json_array_append_new(array, value) != 0) result->broken = true;
	return value;
}

static json_t *text(const char *given)
{
	const char *utf8 = given ? given : "";
	json_t *string = json_string(utf8);
	char *copy = string ? NULL : strdup(utf8);
	if (!copy) return string;
	for (char *byte = copy; *byte; byte++)
		if (*byte & 0x80) *byte = '?';
	string = json_string(copy);
	free(copy);
	return string;
}

static json_t *formatted(const char *format, va_list arguments)
{
	char *line = NULL;
	if (vasprintf(&line, format, arguments) < 0) return NULL;
	json_t *string = text(line);
	free(line);
	return string;
}

/* Text that was not given is left out. */
static void set_text(struct result *result, json_t *object, const char *key, const char *given)
{
	if (given) set(result, object, key, text(given));
}

static json_t *names(struct result *result, const char *const given[])
{
	json_t *array = json_array();
	while (given && *given) append(result, array, text(*given++));
	return array;
}

static json_t *list(const struct result *result, const char *key)
{
	return json_object_get(result->document, key);
}

/* ------------------------------------------------------------------ the result */

static json_t *today(void)
{
	char date[sizeof "2024-05-01T12:00:00Z"];
	time_t now = time(NULL);
	struct tm utc;
	gmtime_r(&now, &utc);
	strftime(date, sizeof date, "%Y-%m-%dT%H:%M:%SZ", &utc);
	return json_string(date);
}

struct result *result_new(const char *name, const char *title)
{
	struct result *result = calloc(1, sizeof *result);
	if (!result) return NULL;
	result->document = json_object();
	set(result, result->document, "schema", json_string(RESULT_SCHEMA));
	set(result, result->document, "name", text(name));
	set(result, result->document, "title", text(title));
	set(result, result->document, "date", today());
	set(result, result->document, "complete", json_true());
	set(result, result->document, "machine", provenance());
	const char *const lists[] = {"summary", "claims", "tables", "figures", "notes", "live"};
	for (size_t i = 0; i < sizeof lists / sizeof *lists; i++) set(result, result->document, lists[i], json_array());
	return result;
}

void result_free(struct result *result)
{
	if (!result) return;
	json_decref(result->document);
	free(result);
}

void result_paragraph(struct result *result, const char *format, ...)
{
	va_list arguments;
	va_start(arguments, format);
	append(result, list(result, "summary"), formatted(format, arguments));
	va_end(arguments);
}

void result_note(struct result *result, const char *format, ...)
{
	va_list arguments;
	va_start(arguments, format);
	append(result, list(result, "notes"), formatted(format, arguments));
	va_end(arguments);
}

void result_live(struct result *result, const char *title, const char *query)
{
	append(result, list(result, "live"), json_pack("{s: s, s: s}", "title", title, "query", query));
}

void result_made_by(struct result *result, const char *command, double seconds, const char *revision)
{
	set_text(result, result->document, "command", command);
	set(result, result->document, "seconds", schema_number(seconds));
	set_text(result, result->document, "revision", revision);
}

void result_incomplete(struct result *result, const char *format, ...)
{
	va_list arguments;
	va_start(arguments, format);
	set(result, result->document, "complete", json_false());
	set(result, result->document, "reached", formatted(format, arguments));
	va_end(arguments);
}

void result_claim(struct result *result, const struct result_claim *claim)
{
	static const char *const verdicts[] = {
		[RESULT_AGREES] = "agrees", [RESULT_DIFFERS] = "differs", [RESULT_NOT_COMPARABLE] = "not comparable"};
	json_t *object = append(result, list(result, "claims"), json_object());
	set(result, object, "quantity", text(claim->quantity));
	set(result, object, "reported", text(claim->reported));
	set(result, object, "where", text(claim->where));
	set(result, object, "measured", schema_number(claim->measured));
	if (claim->interval[0] != claim->interval[1])
		set(result, object, "interval",
			json_pack("[o, o]", schema_number(claim->interval[0]), schema_number(claim->interval[1])));
	set_text(result, object, "interval_means", claim->interval_means);
	set_text(result, object, "unit", claim->unit);
	set_text(result, object, "shown", claim->shown);
	if (claim->count) set(result, object, "count", json_integer((json_int_t)claim->count));
	set(result, object, "verdict", json_string(verdicts[claim->verdict]));
	set(result, object, "why", text(claim->why));
}

/* ------------------------------------------------------------------ tables */

struct result_table result_table(struct result *result, const char *title, const char *note,
								 const char *const columns[])
{
	json_t *object = append(result, list(result, "tables"), json_object());
	set(result, object, "title", text(title));
	set_text(result, object, "note", note);
	set(result, object, "columns", names(result, columns));
	set(result, object, "rows", json_array());
	return (struct result_table){result, object};
}

void table_row(struct result_table table)
{
	append(table.result, json_object_get(table.json, "rows"), json_array());
}

static void cell(struct result_table table, json_t *value)
{
	const json_t *rows = json_object_get(table.json, "rows");
	if (json_array_size(rows) == 0) table_row(table);
	append(table.result, json_array_get(rows, json_array_size(rows) - 1), value);
}

void table_text(struct result_table table, const char *format, ...)
{
	va_list arguments;
	va_start(arguments, format);
	cell(table, formatted(format, arguments));
	va_end(arguments);
}

void table_number(struct result_table table, double value)
{
	cell(table, schema_number(value));
}

void table_count(struct result_table table, uint64_t count)
{
	cell(table, json_integer((json_int_t)count));
}

void table_hex(struct result_table table, double value)
{
	table_text(table, "%a", value);
}

void table_shaded(struct result_table table, unsigned level, const char *format, ...)
{
	va_list arguments;
	va_start(arguments, format);
	json_t *object = json_object();
	set(table.result, object, "text", formatted(format, arguments));
	set(table.result, object, "level", json_integer(level));
	cell(table, object);
	va_end(arguments);
}

/* Adds to the cell appended last, which becomes an object if it is only a text. */
static void add_to_cell(struct result_table table, const char *key, const char *value)
{
	const json_t *rows = json_object_get(table.json, "rows");
	json_t *row = json_array_get(rows, json_array_size(rows) - 1),
		   *last = json_array_get(row, json_array_size(row) - 1);
	if (json_is_string(last)) {
		json_t *object = json_object();
		set_text(table.result, object, "text", json_string_value(last));
		if (json_array_set_new(row, json_array_size(row) - 1, object) != 0) table.result->broken = true;
		last = object;
	}
	set_text(table.result, last, key, value);
}

void table_anchor(struct result_table table, const char *name)
{
	add_to_cell(table, "anchor", name);
}

void table_link(struct result_table table, const char *anchor)
{
	add_to_cell(table, "link", anchor);
}

void table_live(struct result_table table, const char *query)
{
	add_to_cell(table, "live", query);
}

void table_unseen(struct result_table table, const char *why)
{
	add_to_cell(table, "unseen", why);
}

/* ------------------------------------------------------------------ figures */

static json_t *axis(struct result *result, const struct figure_axis *axis)
{
	json_t *object = json_object();
	set(result, object, "label", text(axis->label));
	set(result, object, "log", json_integer(axis->logarithmic));
	set(result, object, "range", json_pack("[o, o]", schema_number(axis->range[0]), schema_number(axis->range[1])));
	return object;
}

struct result_figure result_figure(struct result *result, const struct figure_frame *frame)
{
	json_t *object = append(result, list(result, "figures"), json_object());
	set(result, object, "name", text(frame->name));
	set(result, object, "kind", text(frame->kind));
	set(result, object, "title", text(frame->title));
	set(result, object, "caption", text(frame->caption));
	set(result, object, "alternative", text(frame->alternative));
	set(result, object, "x", axis(result, &frame->x));
	set(result, object, "y", axis(result, &frame->y));
	set(result, object, "columns", names(result, frame->columns));
	if (frame->categories) set(result, object, "categories", names(result, frame->categories));
	set(result, object, "series", json_array());
	return (struct result_figure){result, object};
}

struct figure_series figure_series(struct result_figure figure, const char *label, enum series_style style)
{
	static const char *const styles[] = {
		[SERIES_LINE] = "line", [SERIES_POINTS] = "points", [SERIES_BARS] = "bars", [SERIES_ENDS] = "ends"};
	json_t *object = append(figure.result, json_object_get(figure.json, "series"), json_object());
	set(figure.result, object, "label", text(label));
	set(figure.result, object, "style", json_string(styles[style]));
	set(figure.result, object, "rows", json_array());
	return (struct figure_series){figure.result, object, json_array_size(json_object_get(figure.json, "columns"))};
}

void series_row(struct figure_series series, const double *values)
{
	json_t *row = append(series.result, json_object_get(series.json, "rows"), json_array());
	for (size_t i = 0; i < series.width; i++) append(series.result, row, schema_number(values[i]));
}

void series_mark(struct figure_series series, const struct series_mark *mark)
{
	json_t *object = json_object();
	set(series.result, object, "name", text(mark->name));
	set(series.result, object, "title", text(mark->title));
	set_text(series.result, object, "link", mark->link);
	set(series.result, object, "shown", json_boolean(mark->shown));
	if (!json_object_get(series.json, "marks")) set(series.result, series.json, "marks", json_array());
	append(series.result, json_object_get(series.json, "marks"), object);
}

void series_panel(struct figure_series series, const char *row, const char *column, const char *note)
{
	json_t *panel = json_object();
	set(series.result, panel, "row", text(row));
	set(series.result, panel, "column", text(column));
	set(series.result, panel, "note", text(note));
	set(series.result, series.json, "panel", panel);
}

void series_fit(struct figure_series series, double slope, double intercept)
{
	if (!isfinite(slope) || !isfinite(intercept)) return;
	set(series.result, series.json, "fit",
		json_pack("{s: o, s: o}", "slope", schema_number(slope), "intercept", schema_number(intercept)));
}

/* ------------------------------------------------------------------ storing */

bool result_write(const struct result *result, const char *folder, char error[REPORT_ERROR])
{
	const char *name = json_string_value(list(result, "name"));
	char place[REPORT_ERROR / 2];
	snprintf(place, sizeof place, "result %s", name ? name : "without a name");
	if (result->broken) {
		snprintf(error, REPORT_ERROR, "%s: out of memory", place);
		return false;
	}
	struct aside file;
	if (!schema_check(result->document, place, error) || !aside_folder(folder, error) ||
		!aside_open(&file, error, "%s/%s.json", folder, name))
		return false;
	if (json_dumpf(result->document, file.stream, JSON_INDENT(1)) != 0 && !ferror(file.stream)) {
		snprintf(error, REPORT_ERROR, "%s: out of memory", place);
		aside_drop(&file);
		return false;
	}
	fputc('\n', file.stream);
	return aside_keep(&file, error);
}

struct result *result_read(const char *path, char error[REPORT_ERROR])
{
	json_error_t fault;
	json_t *document = json_load_file(path, JSON_REJECT_DUPLICATES, &fault);
	if (!document) {
		if (fault.line > 0)
			snprintf(error, REPORT_ERROR, "%s:%d: damaged result: %s", path, fault.line, fault.text);
		else
			snprintf(error, REPORT_ERROR, "%s: cannot be read as a result: %s", path, fault.text);
		return NULL;
	}
	struct result *result = schema_check(document, path, error) ? calloc(1, sizeof *result) : NULL;
	if (!result)
		json_decref(document);
	else
		result->document = document;
	return result;
}

const json_t *result_document(const struct result *result)
{
	return result->document;
}
