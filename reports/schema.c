#include "schema.h"

#include "figure.h"
#include "result.h"

#include <math.h>
#include <stdarg.h>
#include <string.h>

json_t *schema_number(double value)
{
	if (isnan(value)) return json_null();
	return isinf(value) ? json_string(value > 0 ? "inf" : "-inf") : json_real(value);
}

double schema_double(const json_t *number)
{
	if (json_is_number(number)) return json_number_value(number);
	const char *text = json_string_value(number);
	if (!text) return NAN;
	return strcmp(text, "inf") == 0 ? INFINITY : strcmp(text, "-inf") == 0 ? -INFINITY : NAN;
}

/* Where we are in the document, for messages: "fig3.json: claims[2]". */
struct place {
	const char *document;
	const char *list; /* NULL: the document itself */
	size_t index;
	char *error;
};

__attribute__((format(printf, 2, 3))) static bool wrong(const struct place *place, const char *format, ...)
{
	int length = place->list
					 ? snprintf(place->error, REPORT_ERROR, "%s: %s[%zu]: ", place->document, place->list, place->index)
					 : snprintf(place->error, REPORT_ERROR, "%s: ", place->document);
	if (length >= REPORT_ERROR) return false;
	va_list arguments;
	va_start(arguments, format);
	vsnprintf(place->error + length, (size_t)(REPORT_ERROR - length), format, arguments);
	va_end(arguments);
	return false;
}

static bool one_of(const char *const choices[], const char *text)
{
	while (*choices && strcmp(*choices, text) != 0) choices++;
	return *choices;
}

/* Names become parts of file names and addresses. */
static bool is_name(const char *text)
{
	return *text && text[strspn(text, "abcdefghijklmnopqrstuvwxyz0123456789-_")] == '\0';
}

static bool is_number(const json_t *value)
{
	return json_is_number(value) || json_is_null(value) || (json_is_string(value) && isinf(schema_double(value)));
}

/* Parameters of the live page: they become part of an address. */
static bool is_query(const char *text)
{
	static const char allowed[] = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789=&@:.-";
	return text[strspn(text, allowed)] == '\0';
}

static bool is_any(const char *text)
{
	return text;
}

/* What may be missing, and must be sound where it is there. */
static bool is_optional(const json_t *value, bool (*sound)(const char *))
{
	return !value || (json_is_string(value) && sound(json_string_value(value)));
}

/* Text with a shade, a name or links. */
static bool is_rich(const json_t *value)
{
	const json_t *level = json_object_get(value, "level");
	json_int_t shade = json_integer_value(level);
	return json_is_string(json_object_get(value, "text")) &&
		   (!level || (json_is_integer(level) && shade >= 0 && shade < TABLE_LEVELS)) &&
		   is_optional(json_object_get(value, "anchor"), is_name) &&
		   is_optional(json_object_get(value, "link"), is_name) &&
		   is_optional(json_object_get(value, "live"), is_query) &&
		   is_optional(json_object_get(value, "unseen"), is_any);
}

static bool is_cell(const json_t *value)
{
	return json_is_string(value) || is_number(value) || is_rich(value);
}

static bool check_texts(const struct place *place, const char *key, const json_t *array)
{
	for (size_t i = 0; i < json_array_size(array); i++)
		if (!json_is_string(json_array_get(array, i))) return wrong(place, "%s[%zu] is not text", key, i);
	return json_is_array(array) || wrong(place, "%s is not a list", key);
}

static bool check_rows(const struct place *place, const json_t *rows, const json_t *columns,
					   bool (*accepted)(const json_t *))
{
	if (!json_is_array(rows)) return wrong(place, "rows is not a list");
	for (size_t i = 0; i < json_array_size(rows); i++) {
		const json_t *row = json_array_get(rows, i);
		if (json_array_size(row) != json_array_size(columns))
			return wrong(place, "row %zu has %zu values, where there are %zu columns", i, json_array_size(row),
						 json_array_size(columns));
		for (size_t j = 0; j < json_array_size(row); j++)
			if (!accepted(json_array_get(row, j)))
				return wrong(place, "row %zu, column %zu: neither a number nor what else may stand there", i, j);
	}
	return true;
}

static bool check_claim(const struct place *place, json_t *claim)
{
	static const char *const verdicts[] = {"agrees", "differs", "not comparable", NULL};
	json_error_t fault;
	const char *text, *verdict;
	const json_t *measured, *low = NULL, *high = NULL;
	json_int_t count;
	if (json_unpack_ex(claim, &fault, 0,
					   "{s: s, s: s, s: s, s: s, s: s, s: o, s?: [o, o!], s?: s, s?: s, s?: s, s?: I}", "quantity",
					   &text, "reported", &text, "where", &text, "why", &text, "verdict", &verdict, "measured",
					   &measured, "interval", &low, &high, "interval_means", &text, "unit", &text, "shown", &text,
					   "count", &count) != 0)
		return wrong(place, "%s", fault.text);
	if (!is_number(measured)) return wrong(place, "measured is not a number");
	if (low && !(is_number(low) && is_number(high))) return wrong(place, "interval is not two numbers");
	return one_of(verdicts, verdict) || wrong(place, "verdict is '%s', not agrees, differs or not comparable", verdict);
}

static bool check_table(const struct place *place, json_t *table)
{
	json_error_t fault;
	const char *text;
	const json_t *columns, *rows;
	if (json_unpack_ex(table, &fault, 0, "{s: s, s?: s, s: o, s: o}", "title", &text, "note", &text, "columns",
					   &columns, "rows", &rows) != 0)
		return wrong(place, "%s", fault.text);
	return check_texts(place, "columns", columns) && check_rows(place, rows, columns, is_cell);
}

static bool check_marks(const struct place *place, const json_t *marks, const json_t *rows)
{
	if (!marks) return true;
	if (!json_is_array(marks) || json_array_size(marks) != json_array_size(rows))
		return wrong(place, "series: marks is not a list as long as its rows");
	for (size_t i = 0; i < json_array_size(marks); i++) {
		json_error_t fault;
		const char *text;
		int shown;
		if (json_unpack_ex(json_array_get(marks, i), &fault, 0, "{s: s, s: s, s?: s, s: b}", "name", &text, "title",
						   &text, "link", &text, "shown", &shown) != 0)
			return wrong(place, "series: marks[%zu]: %s", i, fault.text);
	}
	return true;
}

static bool check_series(const struct place *place, json_t *series, const json_t *columns)
{
	static const char *const styles[] = {"line", "points", "bars", "ends", NULL};
	json_error_t fault;
	const char *text, *style;
	const json_t *rows;
	double slope, intercept;
	if (json_unpack_ex(series, &fault, 0, "{s: s, s: s, s: o, s?: {s: s, s: s, s: s}, s?: {s: F, s: F}}", "label",
					   &text, "style", &style, "rows", &rows, "panel", "row", &text, "column", &text, "note", &text,
					   "fit", "slope", &slope, "intercept", &intercept) != 0)
		return wrong(place, "series: %s", fault.text);
	if (!one_of(styles, style)) return wrong(place, "series style is '%s', not line, points, bars or ends", style);
	return check_rows(place, rows, columns, is_number) && check_marks(place, json_object_get(series, "marks"), rows);
}

static bool check_figure(const struct place *place, json_t *figure)
{
	json_error_t fault;
	const char *text, *name, *kind;
	const json_t *columns, *categories = NULL, *series, *from, *to;
	json_int_t base;
	if (json_unpack_ex(figure, &fault, 0,
					   "{s: s, s: s, s: s, s: s, s: s, s: {s: s, s: I, s: [o, o!]}, s: {s: s, s: I, s: [o, o!]},"
					   " s: o, s?: o, s: o}",
					   "name", &name, "kind", &kind, "title", &text, "caption", &text, "alternative", &text, "x",
					   "label", &text, "log", &base, "range", &from, &to, "y", "label", &text, "log", &base, "range",
					   &from, &to, "columns", &columns, "categories", &categories, "series", &series) != 0)
		return wrong(place, "%s", fault.text);
	if (!is_name(name)) return wrong(place, "name '%s' has more than letters a to z, digits, '-' and '_'", name);
	if (!check_texts(place, "columns", columns) || (categories && !check_texts(place, "categories", categories)))
		return false;
	if (!json_is_array(series)) return wrong(place, "series is not a list");
	const char *missing = figure_missing_column(kind, columns);
	if (missing) return wrong(place, "a figure of kind '%s' needs a column '%s'", kind, missing);
	for (size_t i = 0; i < json_array_size(series); i++)
		if (!check_series(place, json_array_get(series, i), columns)) return false;
	return true;
}

static bool check_each(const json_t *document, struct place place, const char *list,
					   bool (*check)(const struct place *, json_t *))
{
	const json_t *array = json_object_get(document, list);
	if (!json_is_array(array)) return wrong(&place, "%s is not a list", list);
	place.list = list;
	for (place.index = 0; place.index < json_array_size(array); place.index++)
		if (!check(&place, json_array_get(array, place.index))) return false;
	return true;
}

/* Figures of the same name would be drawn into the same files. */
static bool check_distinct(struct place place, const json_t *figures)
{
	place.list = "figures";
	for (place.index = 0; place.index < json_array_size(figures); place.index++) {
		const json_t *name = json_object_get(json_array_get(figures, place.index), "name");
		for (size_t i = 0; i < place.index; i++)
			if (json_equal(name, json_object_get(json_array_get(figures, i), "name")))
				return wrong(&place, "name '%s' is taken by figures[%zu]", json_string_value(name), i);
	}
	return true;
}

/* How many cells of all tables are so named. */
static size_t anchors(const json_t *tables, const char *name)
{
	size_t t, r, c, count = 0;
	const json_t *table, *row, *cell;
	json_array_foreach(tables, t, table) json_array_foreach(json_object_get(table, "rows"), r, row)
		json_array_foreach(row, c, cell)
	{
		const char *anchor = json_string_value(json_object_get(cell, "anchor"));
		count += anchor && strcmp(anchor, name) == 0;
	}
	return count;
}

/* Links of cells lead to cells. */
static bool check_links(struct place place, const json_t *tables)
{
	place.list = "tables";
	size_t r, c;
	const json_t *table, *row, *cell;
	json_array_foreach(tables, place.index, table) json_array_foreach(json_object_get(table, "rows"), r, row)
		json_array_foreach(row, c, cell)
	{
		const char *link = json_string_value(json_object_get(cell, "link"));
		const char *anchor = json_string_value(json_object_get(cell, "anchor"));
		if (link && anchors(tables, link) == 0)
			return wrong(&place, "row %zu, column %zu: a link to '%s', and no cell is so named", r, c, link);
		if (anchor && anchors(tables, anchor) > 1)
			return wrong(&place, "row %zu, column %zu: another cell is named '%s' too", r, c, anchor);
	}
	return true;
}

static bool check_live(const struct place *place, json_t *live)
{
	const char *title, *query;
	json_error_t fault;
	if (json_unpack_ex(live, &fault, 0, "{s: s, s: s}", "title", &title, "query", &query) != 0)
		return wrong(place, "%s", fault.text);
	return is_query(query) || wrong(place, "'%s' are no parameters of the live page", query);
}

bool schema_check(const json_t *document, const char *name, char error[REPORT_ERROR])
{
	struct place place = {.document = name, .error = error};
	json_t *root = (json_t *)document; /* json_unpack only reads, but is not declared so */
	const char *schema = json_string_value(json_object_get(root, "schema"));
	if (!schema) return wrong(&place, "not a result: it names no schema; accepted is " RESULT_SCHEMA);
	if (strcmp(schema, RESULT_SCHEMA) != 0)
		return wrong(&place, "has schema '%s', which this version does not know; accepted is " RESULT_SCHEMA, schema);
	json_error_t fault;
	const char *text, *own;
	const json_t *any = NULL;
	json_int_t number;
	int complete;
	if (json_unpack_ex(root, &fault, 0,
					   "{s: s, s: s, s: s, s: b, s?: s, s?: s, s?: o, s?: s, s: {s: s, s: I, s: I, s: s, s: s}}",
					   "name", &own, "title", &text, "date", &text, "complete", &complete, "reached", &text, "command",
					   &text, "seconds", &any, "revision", &text, "machine", "processor", &text, "cores", &number,
					   "memory_bytes", &number, "system", &text, "compiler", &text) != 0)
		return wrong(&place, "%s", fault.text);
	if (!is_name(own)) return wrong(&place, "name '%s' has more than letters a to z, digits, '-' and '_'", own);
	if (any && !is_number(any)) return wrong(&place, "seconds is not a number");
	return check_texts(&place, "summary", json_object_get(root, "summary")) &&
		   check_texts(&place, "notes", json_object_get(root, "notes")) &&
		   (!json_object_get(root, "live") || check_each(root, place, "live", check_live)) &&
		   check_each(root, place, "claims", check_claim) && check_each(root, place, "tables", check_table) &&
		   check_links(place, json_object_get(root, "tables")) && check_each(root, place, "figures", check_figure) &&
		   check_distinct(place, json_object_get(root, "figures"));
}
