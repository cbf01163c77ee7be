#include "figure.h"

#include "embed.h"
#include "marks.h"
#include "schema.h"

#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <spawn.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

EMBED(plot_style, "plots/style.gp");
EMBED(plot_impact_histogram, "plots/impact-histogram.gp");
EMBED(plot_trajectory, "plots/trajectory.gp");
EMBED(plot_scaling, "plots/scaling.gp");
EMBED(plot_curves, "plots/curves.gp");
EMBED(plot_bars, "plots/bars.gp");
EMBED(plot_discs, "plots/discs.gp");
EMBED(plot_frontier, "plots/frontier.gp");
EMBED(plot_trend, "plots/trend.gp");
EMBED(plot_map, "plots/map.gp");

static const struct kind {
	const char *name, *script;
	const char *columns[6]; /* handed to the script in this order; NULL after the last */
} kinds[] = {
	{"impact-histogram", plot_impact_histogram, {"left", "right", "height"}},
	{"trajectory", plot_trajectory, {"time", "height", "remaining"}},
	{"scaling", plot_scaling, {"bits", "error"}},
	{"curves", plot_curves, {"x", "y", "low", "high"}},
	{"bars", plot_bars, {"category", "value", "low", "high"}},
	{"discs", plot_discs, {"x", "radius", "speed", "touched"}},
	{"frontier", plot_frontier, {"x", "y", "low", "high", "best"}},
	{"trend", plot_trend, {"time", "y", "low", "high"}},
	{"map", plot_map, {"x", "y", "value"}},
};

static const struct kind *kind_of(const char *name)
{
	for (size_t i = 0; i < sizeof kinds / sizeof *kinds; i++)
		if (strcmp(kinds[i].name, name) == 0) return &kinds[i];
	return NULL;
}

static const char *text_at(const json_t *object, const char *key)
{
	const char *text = json_string_value(json_object_get(object, key));
	return text ? text : "";
}

/* Where the text stands in a list of texts; the length of the list when it does not. */
static size_t position(const json_t *texts, const char *text)
{
	size_t i = 0;
	while (i < json_array_size(texts) && strcmp(json_string_value(json_array_get(texts, i)), text) != 0) i++;
	return i;
}

const char *figure_missing_column(const char *kind, const json_t *columns)
{
	const struct kind *known = kind_of(kind);
	for (const char *const *column = known ? known->columns : NULL; column && *column; column++)
		if (position(columns, *column) == json_array_size(columns)) return *column;
	return NULL;
}

/* ------------------------------------------------------------------ what the plot script is told */

/* A text in gnuplot's single quotes, where nothing is expanded; marks of its enhanced text are made plain. */
static void write_quoted(FILE *stream, const char *text)
{
	fputc('\'', stream);
	for (; *text; text++) {
		if (strchr("\\{}^_@&~", *text)) fputc('\\', stream);
		if (*text == '\'') fputc('\'', stream);
		fputc((unsigned char)*text < ' ' ? ' ' : *text, stream);
	}
	fputc('\'', stream);
}

static void write_number(FILE *stream, double value)
{
	if (isfinite(value))
		fprintf(stream, "%.17g", value);
	else
		fputs("NaN", stream);
}

static void write_texts(FILE *stream, const char *name, const json_t *texts)
{
	fprintf(stream, "%s_count = %zu\narray %s[%zu]\n", name, json_array_size(texts), name, json_array_size(texts) + 1);
	for (size_t i = 0; i < json_array_size(texts); i++) {
		fprintf(stream, "%s[%zu] = ", name, i + 1);
		write_quoted(stream, json_string_value(json_array_get(texts, i)));
		fputc('\n', stream);
	}
}

static void write_axis(FILE *stream, const char *name, const json_t *axis)
{
	const json_t *range = json_object_get(axis, "range");
	double low = schema_double(json_array_get(range, 0)), high = schema_double(json_array_get(range, 1));
	fprintf(stream, "%s_label = ", name);
	write_quoted(stream, text_at(axis, "label"));
	fprintf(stream, "\n%s_log = %d\n%s_given = %d\n", name, (int)json_integer_value(json_object_get(axis, "log")), name,
			low < high);
	fprintf(stream, "%s_low = %.17g\n%s_high = %.17g\n", name, low < high ? low : 0, name, low < high ? high : 1);
}

/* The series, and the rows and columns of panels they stand in. */
static void write_series(FILE *stream, const json_t *figure)
{
	const json_t *all = json_object_get(figure, "series"), *series;
	json_t *labels = json_array(), *rows = json_array(), *columns = json_array();
	size_t count = json_array_size(all), i;
	fprintf(stream, "array style[%zu]\narray row[%zu]\narray column[%zu]\narray note[%zu]\n", count + 1, count + 1,
			count + 1, count + 1);
	fprintf(stream, "array slope[%zu]\narray intercept[%zu]\n", count + 1, count + 1);
	json_array_foreach(all, i, series)
	{
		const json_t *panel = json_object_get(series, "panel"), *fit = json_object_get(series, "fit");
		const char *in_row = text_at(panel, "row"), *in_column = text_at(panel, "column");
		json_array_append_new(labels, json_string(text_at(series, "label")));
		if (position(rows, in_row) == json_array_size(rows)) json_array_append_new(rows, json_string(in_row));
		if (position(columns, in_column) == json_array_size(columns))
			json_array_append_new(columns, json_string(in_column));
		fprintf(stream, "style[%zu] = '%s'; row[%zu] = %zu; column[%zu] = %zu; note[%zu] = ", i + 1,
				text_at(series, "style"), i + 1, position(rows, in_row) + 1, i + 1, position(columns, in_column) + 1,
				i + 1);
		write_quoted(stream, text_at(panel, "note"));
		fprintf(stream, "; slope[%zu] = ", i + 1);
		write_number(stream, schema_double(json_object_get(fit, "slope")));
		fprintf(stream, "; intercept[%zu] = ", i + 1);
		write_number(stream, schema_double(json_object_get(fit, "intercept")));
		fputc('\n', stream);
	}
	write_texts(stream, "series", labels);
	write_texts(stream, "rows", rows);
	write_texts(stream, "columns", columns);
	json_decref(labels), json_decref(rows), json_decref(columns);
}

/* What is printed beside a point, as gnuplot reads a text among data. */
static void write_words(FILE *stream, const json_t *mark)
{
	const char *words = json_is_true(json_object_get(mark, "shown")) ? text_at(mark, "name") : "";
	fputc('"', stream);
	for (; *words; words++)
		fputc(*words == '"' || *words == '\\' || (unsigned char)*words < ' ' ? ' ' : *words, stream);
	fputc('"', stream);
}

/* The points, one block a series, the kind's columns in the kind's order, and what is printed beside them. */
static void write_data(FILE *stream, const json_t *figure, const struct kind *kind)
{
	const json_t *names = json_object_get(figure, "columns"), *series, *row;
	size_t i, j;
	json_array_foreach(json_object_get(figure, "series"), i, series)
	{
		const json_t *rows = json_object_get(series, "rows");
		/* An empty block would not count as one. */
		if (json_array_size(rows) == 0) fputs("NaN NaN NaN NaN NaN \"\"\n", stream);
		json_array_foreach(rows, j, row)
		{
			for (size_t k = 0; k < sizeof kind->columns / sizeof *kind->columns && kind->columns[k]; k++) {
				write_number(stream, schema_double(json_array_get(row, position(names, kind->columns[k]))));
				fputc(' ', stream);
			}
			write_words(stream, json_array_get(json_object_get(series, "marks"), j));
			fputc('\n', stream);
		}
		fputs("\n\n", stream);
	}
}

static void write_script(FILE *stream, const json_t *figure, const struct kind *kind)
{
	fputs("set encoding utf8\n", stream);
	write_axis(stream, "x", json_object_get(figure, "x"));
	write_axis(stream, "y", json_object_get(figure, "y"));
	write_texts(stream, "category", json_object_get(figure, "categories"));
	write_series(stream, figure);
	fprintf(stream, "pdf = 0\n%s%s\nunset output\nreset\npdf = 1\n%s%s\n", plot_style, kind->script, plot_style,
			kind->script);
}

/* ------------------------------------------------------------------ gnuplot */

/* A folder of its own for one drawing: gnuplot runs inside and meets no path but these. */
static const char *const scraps[] = {"data", "script", "messages", "figure.svg", "figure.pdf", "marks"};
enum { DATA, SCRIPT, MESSAGES, SVG, PDF, MARKS, SCRAPS };

static bool scraps_write(const char *const paths[SCRAPS], const json_t *figure, const struct kind *kind)
{
	FILE *data = fopen(paths[DATA], "w"), *script = fopen(paths[SCRIPT], "w");
	if (data) write_data(data, figure, kind);
	if (script) write_script(script, figure, kind);
	bool good = data && script && !ferror(data) && !ferror(script);
	good = (!data || fclose(data) == 0) && good;
	return (!script || fclose(script) == 0) && good;
}

static bool run_gnuplot(const char *folder, const char *messages, char error[REPORT_ERROR])
{
	/* -d: whatever the user has set for plots of their own does not matter here. */
	char *arguments[] = {"gnuplot", "-d", "script", NULL};
	posix_spawn_file_actions_t actions;
	posix_spawn_file_actions_init(&actions);
	posix_spawn_file_actions_addchdir_np(&actions, folder);
	posix_spawn_file_actions_addopen(&actions, 0, "/dev/null", O_RDONLY, 0);
	posix_spawn_file_actions_addopen(&actions, 1, "messages", O_WRONLY | O_CREAT | O_TRUNC, 0666);
	posix_spawn_file_actions_adddup2(&actions, 1, 2);
	pid_t child;
	int failed = posix_spawnp(&child, "gnuplot", &actions, NULL, arguments, environ), status = 0;
	posix_spawn_file_actions_destroy(&actions);
	if (failed && failed != ENOENT) {
		snprintf(error, REPORT_ERROR, "gnuplot cannot be started: %s", strerror(failed));
		return false;
	}
	while (!failed && waitpid(child, &status, 0) < 0 && errno == EINTR) continue;
	if (failed ||
		(WIFEXITED(status) && WEXITSTATUS(status) == 127)) { /* as POSIX has it where the parent cannot know */
		snprintf(error, REPORT_ERROR, "gnuplot is not installed");
		return false;
	}
	if (WIFEXITED(status) && WEXITSTATUS(status) == 0) return true;
	char said[REPORT_ERROR / 2] = "";
	FILE *file = fopen(messages, "r");
	/* The last line that is not empty names the fault; those before show where. */
	for (char line[sizeof said]; file && fgets(line, sizeof line, file);)
		if (line[strspn(line, " \t^\n")]) strcpy(said, line + strspn(line, " \t"));
	if (file) fclose(file);
	said[strcspn(said, "\n")] = '\0';
	snprintf(error, REPORT_ERROR, "gnuplot failed: %s", *said ? said : "without a message");
	return false;
}

static bool move(const char *from, const char *folder, const char *stem, const char *ending, char error[REPORT_ERROR])
{
	char *path;
	if (asprintf(&path, "%s/%s.%s", folder, stem, ending) < 0) return false;
	bool moved = rename(from, path) == 0;
	if (!moved) snprintf(error, REPORT_ERROR, "%s: cannot be written: %s", path, strerror(errno));
	free(path);
	return moved;
}

static size_t points(const json_t *figure)
{
	const json_t *series;
	size_t i, count = 0;
	json_array_foreach(json_object_get(figure, "series"), i, series)
	{
		count += json_array_size(json_object_get(series, "rows"));
	}
	return count;
}

bool figure_draw(const json_t *figure, const json_t *pages, const char *folder, const char *stem,
				 char error[REPORT_ERROR])
{
	const struct kind *kind = kind_of(text_at(figure, "kind"));
	if (!kind) {
		snprintf(error, REPORT_ERROR, "there is no plot script for figures of kind '%s'", text_at(figure, "kind"));
		return false;
	}
	if (points(figure) == 0) {
		snprintf(error, REPORT_ERROR, "there are no points");
		return false;
	}
	char *place = NULL, *paths[SCRAPS] = {NULL};
	snprintf(error, REPORT_ERROR, "%s: a figure cannot be drawn there: no folder for it", folder);
	bool drawn = asprintf(&place, "%s/.drawing-XXXXXX", folder) > 0 && mkdtemp(place);
	for (int i = 0; drawn && i < SCRAPS; i++) drawn = asprintf(&paths[i], "%s/%s", place, scraps[i]) > 0;
	if (drawn && !scraps_write((const char *const *)paths, figure, kind)) {
		snprintf(error, REPORT_ERROR, "%s: a figure's data cannot be written: %s", folder, strerror(errno));
		drawn = false;
	}
	drawn = drawn && run_gnuplot(place, paths[MESSAGES], error);
	if (drawn && marks_any(figure)) drawn = marks_add(figure, pages, paths[MARKS], paths[SVG], error);
	drawn = drawn && move(paths[SVG], folder, stem, "svg", error) && move(paths[PDF], folder, stem, "pdf", error);
	for (int i = 0; i < SCRAPS; i++) {
		if (paths[i]) unlink(paths[i]);
		free(paths[i]);
	}
	if (place) rmdir(place);
	free(place);
	return drawn;
}
