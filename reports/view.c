#include "view.h"

#include "display.h"
#include "marks.h"
#include "schema.h"

#include <math.h>
#include <string.h>

static const char *text_at(const json_t *object, const char *key)
{
	const char *text = json_string_value(json_object_get(object, key));
	return text ? text : "";
}

static void set_text(json_t *object, const char *key, const char *text)
{
	json_object_set_new(object, key, json_string(text));
}

/* ------------------------------------------------------------------ claims */

static const char *class_of(const char *verdict)
{
	return strcmp(verdict, "not comparable") == 0 ? "incomparable" : verdict;
}

/* "0.4982 per event", and the interval "0.4979 to 0.4985 (95 %)" to as many digits as it is wide. */
static void set_measured(json_t *view, const json_t *claim)
{
	double value = schema_double(json_object_get(claim, "measured"));
	const json_t *interval = json_object_get(claim, "interval");
	double low = schema_double(json_array_get(interval, 0)), high = schema_double(json_array_get(interval, 1));
	int digits = interval ? display_digits(fmax(fabs(low), fabs(high)), high - low) : 6;
	char text[DISPLAY_ROOM], from[DISPLAY_ROOM], to[DISPLAY_ROOM];
	display_number(text, value, digits);
	display_number(from, low, digits);
	display_number(to, high, digits);
	const char *shown = text_at(claim, "shown"), *unit = text_at(claim, "unit"),
			   *means = text_at(claim, "interval_means");
	if (*shown)
		set_text(view, "measured", shown);
	else
		json_object_set_new(view, "measured", json_sprintf("%s%s%s", text, *unit ? " " : "", unit));
	if (interval)
		json_object_set_new(view, "interval",
							json_sprintf("%s to %s%s%s%s", from, to, *means ? " (" : "", means, *means ? ")" : ""));
}

static json_t *view_claim(const json_t *claim, size_t index)
{
	json_t *view = json_object();
	json_object_set_new(view, "anchor", json_sprintf("claim-%zu", index + 1));
	const char *const same[] = {"quantity", "reported", "where", "verdict", "why"};
	for (size_t i = 0; i < sizeof same / sizeof *same; i++) set_text(view, same[i], text_at(claim, same[i]));
	set_text(view, "class", class_of(text_at(claim, "verdict")));
	set_measured(view, claim);
	const json_t *count = json_object_get(claim, "count");
	char text[DISPLAY_ROOM];
	if (count) display_count(text, json_integer_value(count));
	if (count) set_text(view, "count", text);
	return view;
}

/* Adds `agrees`, `differs` and `incomparable` as texts, those that are none left out, and `claim_count`. */
static void set_tally(json_t *view, const json_t *claims)
{
	const char *const classes[] = {"agrees", "differs", "incomparable"};
	for (size_t i = 0; i < 3; i++) {
		const json_t *claim;
		size_t at;
		int count = 0;
		json_array_foreach(claims, at, claim) count += strcmp(text_at(claim, "class"), classes[i]) == 0;
		json_object_set_new(view, classes[i], count ? json_integer(count) : json_null());
	}
	json_object_set_new(view, "claim_count", json_boolean(json_array_size(claims) > 0));
}

/* ------------------------------------------------------------------ tables and figures */

/* "number", "hex" (hex floats, to be copied whole, perhaps with a word before them), "command" (the same of command
 * lines), "shade" or "" for prose. */
static const char *cell_class(const json_t *cell)
{
	if (json_object_get(cell, "level")) return "shade";
	const char *text = json_is_object(cell) ? text_at(cell, "text") : json_string_value(cell);
	if (!text || isinf(schema_double(cell))) return "number";
	if (strncmp(text, "touchstone ", 11) == 0) return "command";
	const char *word = strrchr(text, ' ');
	word = word ? word + 1 : text;
	return strncmp(word + (*word == '-'), "0x", 2) == 0 ? "hex" : "";
}

/* What semicolons part goes on lines of its own. */
static void set_shaded(json_t *view, const json_t *cell)
{
	json_t *lines = json_array();
	const char *text = text_at(cell, "text");
	for (size_t length; *text; text += length + strspn(text + length, "; ")) {
		length = strcspn(text, ";");
		json_array_append_new(lines, json_stringn(text, length));
	}
	set_text(view, "text", "");
	json_object_set_new(view, "lines", lines);
	json_object_set_new(view, "class",
						json_sprintf("shade level-%d", (int)json_integer_value(json_object_get(cell, "level"))));
}

/* A command is shown in pieces, an option with its value each, which are not broken. */
static void set_command(json_t *view, const char *text)
{
	json_t *pieces = json_array();
	for (size_t length; *text; text += length + (text[length] == ' ')) {
		const char *next = strstr(text, " --");
		length = next ? (size_t)(next - text) : strlen(text);
		json_array_append_new(pieces, json_stringn(text, length));
	}
	set_text(view, "text", "");
	json_object_set_new(view, "lines", pieces);
}

/* A name and links; `watch` becomes an address where the live page is (page.c). */
static void set_links(json_t *view, const json_t *cell)
{
	static const char *const keys[][2] = {
		{"anchor", "anchor"}, {"link", "leads"}, {"live", "watch"}, {"unseen", "unseen"}};
	for (size_t k = 0; k < sizeof keys / sizeof *keys; k++)
		if (json_object_get(cell, keys[k][0])) set_text(view, keys[k][1], text_at(cell, keys[k][0]));
}

static void set_cell_text(json_t *view, const json_t *cell)
{
	char text[DISPLAY_ROOM];
	if (json_is_object(cell)) {
		set_text(view, "text", text_at(cell, "text"));
		if (json_object_get(cell, "level")) set_shaded(view, cell);
		if (strcmp(cell_class(cell), "command") == 0) set_command(view, text_at(cell, "text"));
		set_links(view, cell);
		return;
	}
	if (json_is_integer(cell))
		display_count(text, json_integer_value(cell));
	else
		display_number(text, schema_double(cell), 6);
	bool written = strcmp(cell_class(cell), "number") != 0;
	set_text(view, "text", written ? json_string_value(cell) : text);
}

/* The class all cells of a column share, those without a value aside. */
static const char *column_class(const json_t *table, size_t column)
{
	const json_t *row;
	size_t i;
	const char *shared = NULL;
	json_array_foreach(json_object_get(table, "rows"), i, row)
	{
		const json_t *cell = json_array_get(row, column);
		if (json_is_null(cell)) continue;
		if (shared && strcmp(shared, cell_class(cell)) != 0) return "";
		shared = cell_class(cell);
	}
	return shared ? shared : "";
}

static json_t *view_table(const json_t *table, const char *name, size_t index)
{
	json_t *view = json_object(), *columns = json_array(), *rows = json_array();
	set_text(view, "title", text_at(table, "title"));
	set_text(view, "note", text_at(table, "note"));
	json_object_set_new(view, "csv", json_sprintf("%s-table-%zu.csv", name, index + 1));
	json_object_set_new(view, "columns", columns);
	json_object_set_new(view, "rows", rows);
	const json_t *heading, *row, *cell;
	size_t i, j;
	json_array_foreach(json_object_get(table, "columns"), i, heading)
	{
		json_t *column = json_object();
		set_text(column, "text", json_string_value(heading));
		set_text(column, "class", column_class(table, i));
		json_array_append_new(columns, column);
	}
	json_array_foreach(json_object_get(table, "rows"), i, row)
	{
		json_t *cells = json_array();
		json_array_foreach(row, j, cell)
		{
			json_t *shown = json_object();
			set_cell_text(shown, cell);
			json_object_set_new(shown, "head", json_boolean(j == 0));
			if (!json_object_get(cell, "level"))
				json_object_set(shown, "class", json_object_get(json_array_get(columns, j), "class"));
			json_array_append_new(cells, shown);
		}
		json_array_append_new(rows, json_pack("{s: o}", "cells", cells));
	}
	return view;
}

static json_t *view_figure(const json_t *figure, const char *name)
{
	json_t *view = json_object();
	const char *const same[] = {"name", "title", "caption", "alternative"};
	for (size_t i = 0; i < sizeof same / sizeof *same; i++) set_text(view, same[i], text_at(figure, same[i]));
	json_object_set_new(view, "stem", json_sprintf("%s-%s", name, text_at(figure, "name")));
	const char *const endings[] = {"svg", "pdf", "csv"};
	for (size_t i = 0; i < 3; i++)
		json_object_set_new(view, endings[i], json_sprintf("%s.%s", text_at(view, "stem"), endings[i]));
	json_object_set_new(view, "answers", json_boolean(marks_any(figure)));
	return view;
}

/* ------------------------------------------------------------------ the result */

static void add_fact(json_t *facts, const char *term, const char *text)
{
	if (*text) json_array_append_new(facts, json_pack("{s: s, s: s}", "term", term, "text", text));
}

static json_t *view_facts(const json_t *document)
{
	const json_t *machine = json_object_get(document, "machine");
	json_t *facts = json_array();
	char text[3 * DISPLAY_ROOM], number[DISPLAY_ROOM];
	add_fact(facts, "Date", text_at(document, "date"));
	display_seconds(number, schema_double(json_object_get(document, "seconds")));
	add_fact(facts, "Time taken", json_object_get(document, "seconds") ? number : "");
	snprintf(text, sizeof text, "%.150s, %d cores", text_at(machine, "processor"),
			 (int)json_integer_value(json_object_get(machine, "cores")));
	add_fact(facts, "Processor", text);
	display_number(number, json_number_value(json_object_get(machine, "memory_bytes")) / (1 << 30), 3);
	snprintf(text, sizeof text, "%s GiB", number);
	add_fact(facts, "Memory", text);
	add_fact(facts, "System", text_at(machine, "system"));
	add_fact(facts, "Compiler", text_at(machine, "compiler"));
	add_fact(facts, "Revision", text_at(document, "revision"));
	return facts;
}

json_t *view_result(const json_t *document)
{
	const char *name = text_at(document, "name");
	json_t *view = json_object(), *claims = json_array(), *tables = json_array(), *figures = json_array();
	const json_t *summary = json_object_get(document, "summary"), *notes = json_object_get(document, "notes"), *item;
	const char *opening = json_string_value(json_array_get(summary, 0));
	size_t i;
	set_text(view, "title", text_at(document, "title"));
	json_object_set_new(view, "page_title", json_sprintf("%s · Touchstone", text_at(document, "title")));
	json_object_set_new(view, "page", json_sprintf("%s.html", name));
	json_object_set_new(view, "json", json_sprintf("%s.json", name));
	set_text(view, "opening", opening ? opening : "");
	if (json_is_false(json_object_get(document, "complete")))
		set_text(view, "incomplete",
				 *text_at(document, "reached") ? text_at(document, "reached") : "The run was stopped.");
	json_object_set(view, "summary", (json_t *)summary);
	json_object_set(view, "notes", (json_t *)notes);
	json_object_set_new(view, "has_notes", json_boolean(json_array_size(notes) > 0));
	set_text(view, "command", text_at(document, "command"));
	json_object_set_new(view, "facts", view_facts(document));
	json_array_foreach(json_object_get(document, "claims"), i, item) json_array_append_new(claims, view_claim(item, i));
	json_array_foreach(json_object_get(document, "tables"), i, item)
		json_array_append_new(tables, view_table(item, name, i));
	json_array_foreach(json_object_get(document, "figures"), i, item)
		json_array_append_new(figures, view_figure(item, name));
	json_object_set_new(view, "claims", claims);
	json_object_set_new(view, "tables", tables);
	json_object_set_new(view, "figures", figures);
	set_tally(view, claims);
	return view;
}

json_t *view_index(const json_t *views)
{
	json_t *index = json_object(), *claims = json_array();
	const json_t *view;
	size_t i;
	json_array_foreach(views, i, view) json_array_extend(claims, json_object_get(view, "claims"));
	set_text(index, "page_title", "Touchstone");
	set_tally(index, claims);
	json_object_set(index, "any_claims", json_object_get(index, "claim_count"));
	json_object_set(index, "results", (json_t *)views);
	json_decref(claims);
	return index;
}
