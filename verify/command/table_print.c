#include "command/table_print.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "display.h"

static const char *cell_text(const json_t *cell, char room[DISPLAY_ROOM])
{
	if (json_is_object(cell)) return json_string_value(json_object_get(cell, "text"));
	if (json_is_string(cell)) return json_string_value(cell);
	room[0] = '\0';
	if (json_is_integer(cell)) display_count(room, json_integer_value(cell));
	if (json_is_real(cell)) display_number(room, json_real_value(cell), 6);
	return room;
}

/* The part of a text after so many semicolons, and how long it is; "" when there are fewer. */
static const char *line_of(const char *text, size_t line, size_t *length)
{
	for (; line > 0 && *text; line--) {
		text += strcspn(text, ";");
		text += strspn(text, "; ");
	}
	*length = strcspn(text, ";");
	return text;
}

/* Prints one row, on as many lines as its cells need. */
static void print_row(const json_t *row, const size_t *width)
{
	char room[DISPLAY_ROOM];
	bool more = true;
	for (size_t line = 0; more; line++) {
		more = false;
		for (size_t c = 0; c < json_array_size(row); c++) {
			const char *text = cell_text(json_array_get(row, c), room);
			size_t length, after;
			const char *part = line_of(text, line, &length);
			line_of(text, line + 1, &after);
			more |= after > 0;
			printf("%-*.*s%s", (int)width[c], (int)length, part, c + 1 < json_array_size(row) ? "  " : "\n");
		}
	}
}

void table_print(const struct result *result, size_t number)
{
	const json_t *table = json_array_get(json_object_get(result_document(result), "tables"), number), *row;
	const json_t *columns = json_object_get(table, "columns"), *rows = json_object_get(table, "rows");
	size_t count = json_array_size(columns), *width = calloc(count + 1, sizeof *width), r;
	char room[DISPLAY_ROOM];
	for (size_t c = 0; width && c < count; c++) {
		width[c] = strlen(json_string_value(json_array_get(columns, c)));
		json_array_foreach(rows, r, row)
		{
			size_t length = 1;
			const char *text = cell_text(json_array_get(row, c), room);
			for (size_t line = 0; length > 0; line++) {
				line_of(text, line, &length);
				if (length > width[c]) width[c] = length;
			}
		}
	}
	if (width && count > 0) print_row(columns, width);
	json_array_foreach(rows, r, row)
	{
		if (width) print_row(row, width);
	}
	free(width);
}
