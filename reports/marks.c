#include "marks.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

bool marks_any(const json_t *figure)
{
	const json_t *series;
	size_t i;
	json_array_foreach(json_object_get(figure, "series"), i, series) if (json_object_get(series, "marks")) return true;
	return false;
}

static const char *text_at(const json_t *object, const char *key)
{
	const char *text = json_string_value(json_object_get(object, key));
	return text ? text : "";
}

/* Escaped for text and attributes. */
static void write_escaped(FILE *stream, const char *text)
{
	for (; *text; text++) {
		static const char marks[] = "&<>\"'";
		static const char *const entities[] = {"&amp;", "&lt;", "&gt;", "&quot;", "&#39;"};
		const char *mark = strchr(marks, *text);
		if (mark)
			fputs(entities[mark - marks], stream);
		else
			fputc((unsigned char)*text < ' ' && *text != '\n' ? ' ' : *text, stream);
	}
}

static bool leads_somewhere(const char *link, const json_t *pages)
{
	const json_t *page;
	size_t i;
	json_array_foreach(pages, i, page)
	{
		const char *name = json_string_value(page);
		if (strlen(name) == strcspn(link, "#") && strncmp(link, name, strlen(name)) == 0) return true;
	}
	return false;
}

static void write_mark(FILE *stream, const json_t *mark, const json_t *pages, double x, double y)
{
	const char *link = text_at(mark, "link");
	bool leads = leads_somewhere(link, pages);
	fputs(leads ? "<a class=\"mark\" target=\"_top\" xlink:href=\"" : "<g class=\"mark\"", stream);
	if (leads) write_escaped(stream, link);
	fputs(leads ? "\"><title>" : "><title>", stream);
	write_escaped(stream, text_at(mark, "title"));
	fprintf(stream, "</title><circle cx=\"%.2f\" cy=\"%.2f\" r=\"8\"/></%s>\n", x, y, leads ? "a" : "g");
}

/* Discs of points with words beside them are to lie above the others. */
static void write_marks(FILE *stream, const json_t *figure, const json_t *pages, FILE *places, bool shown)
{
	char line[200];
	rewind(places);
	while (fgets(line, sizeof line, places)) {
		double at[4];
		if (sscanf(line, "%lf %lf %lf %lf", &at[0], &at[1], &at[2], &at[3]) != 4) continue;
		if (!(at[0] >= 0 && at[1] >= 0) || !isfinite(at[2]) || !isfinite(at[3])) continue;
		const json_t *series = json_array_get(json_object_get(figure, "series"), (size_t)at[0]);
		const json_t *mark = json_array_get(json_object_get(series, "marks"), (size_t)at[1]);
		if (mark && json_is_true(json_object_get(mark, "shown")) == shown)
			write_mark(stream, mark, pages, at[2], at[3]);
	}
}

static void write_between(FILE *stream, const char *text, const char *open, const char *close)
{
	fputs(open, stream);
	write_escaped(stream, text);
	fputs(close, stream);
}

/* The drawing with its name exchanged and the layer in front of its end. */
static bool write_layered(FILE *stream, const char *drawing, const json_t *figure, const json_t *pages, FILE *places)
{
	const char *name = strstr(drawing, "<title>"), *named = strstr(drawing, "</desc>"), *end = NULL;
	for (const char *at = drawing; (at = strstr(at, "</svg>")); at++) end = at;
	if (!name || !named || !end) return false;
	fwrite(drawing, 1, (size_t)(name - drawing), stream);
	write_between(stream, text_at(figure, "title"), "<title>", "</title>\n");
	write_between(stream, text_at(figure, "alternative"), "<desc>", "</desc>\n");
	fputs("<style>.mark circle { fill: #fff; fill-opacity: 0; } "
		  ".mark:hover circle, .mark:focus circle { stroke: #24292f; stroke-width: 1.5; }</style>\n",
		  stream);
	named += strlen("</desc>");
	fwrite(named, 1, (size_t)(end - named), stream);
	for (int shown = 0; shown < 2; shown++) write_marks(stream, figure, pages, places, shown);
	fputs(end, stream);
	return true;
}

bool marks_add(const json_t *figure, const json_t *pages, const char *places, const char *svg, char error[REPORT_ERROR])
{
	char *drawing = NULL;
	size_t room = 0;
	FILE *read = fopen(svg, "r"), *where = fopen(places, "r");
	bool good = read && where && getdelim(&drawing, &room, '\0', read) > 0;
	if (read) fclose(read);
	FILE *stream = good ? fopen(svg, "w") : NULL;
	good = stream && write_layered(stream, drawing, figure, pages, where) && !ferror(stream);
	if (stream) good = fclose(stream) == 0 && good;
	if (where) fclose(where);
	free(drawing);
	if (!good) snprintf(error, REPORT_ERROR, "the points of the drawing cannot be marked");
	return good;
}
