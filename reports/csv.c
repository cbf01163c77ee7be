#include "csv.h"

#include <stdbool.h>
#include <string.h>

static void write_text(FILE *stream, const char *text)
{
	if (!text[strcspn(text, ",\"\n\r")]) {
		fputs(text, stream);
		return;
	}
	fputc('"', stream);
	for (; *text; text++) {
		if (*text == '"') fputc('"', stream);
		fputc(*text, stream);
	}
	fputc('"', stream);
}

static void write_row(FILE *stream, const json_t *cells)
{
	const json_t *cell;
	size_t i;
	json_array_foreach(cells, i, cell)
	{
		if (i > 0) fputc(',', stream);
		if (json_is_object(cell)) cell = json_object_get(cell, "text");
		if (json_is_string(cell)) write_text(stream, json_string_value(cell));
		if (json_is_integer(cell)) fprintf(stream, "%" JSON_INTEGER_FORMAT, json_integer_value(cell));
		if (json_is_real(cell)) fprintf(stream, "%.17g", json_real_value(cell));
	}
	fputc('\n', stream);
}

void csv_table(FILE *stream, const json_t *table)
{
	const json_t *row;
	size_t i;
	write_row(stream, json_object_get(table, "columns"));
	json_array_foreach(json_object_get(table, "rows"), i, row) write_row(stream, row);
}

/* Whether points of the figure have names. */
static bool has_names(const json_t *figure)
{
	const json_t *series;
	size_t i;
	json_array_foreach(json_object_get(figure, "series"), i, series) if (json_object_get(series, "marks")) return true;
	return false;
}

void csv_figure(FILE *stream, const json_t *figure)
{
	const json_t *series, *row;
	size_t i, j;
	bool named = has_names(figure);
	fputs(named ? "panel_row,panel_column,series,name," : "panel_row,panel_column,series,", stream);
	write_row(stream, json_object_get(figure, "columns"));
	json_array_foreach(json_object_get(figure, "series"), i, series)
	{
		json_array_foreach(json_object_get(series, "rows"), j, row)
		{
			const json_t *panel = json_object_get(series, "panel");
			const char *const keys[] = {"row", "column"};
			for (size_t k = 0; k < 2; k++) {
				const char *name = json_string_value(json_object_get(panel, keys[k]));
				write_text(stream, name ? name : "");
				fputc(',', stream);
			}
			write_text(stream, json_string_value(json_object_get(series, "label")));
			fputc(',', stream);
			if (named) {
				const json_t *mark = json_array_get(json_object_get(series, "marks"), j);
				const char *name = json_string_value(json_object_get(mark, "name"));
				write_text(stream, name ? name : "");
				fputc(',', stream);
			}
			write_row(stream, row);
		}
	}
}
