/* Points that answer: names, texts and links over a drawing, where its points are. */
#include "folder.h"
#include "page.h"
#include "result.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>

#include <cmocka.h>

static char error[REPORT_ERROR];

static const char *const columns[] = {"x", "y", "low", "high", "best", NULL};

static struct result_figure start(struct result *result, const struct figure_axis *y)
{
	return result_figure(result, &(struct figure_frame){.name = "f",
														.kind = "frontier",
														.title = "Worth <it>",
														.caption = "",
														.alternative = "a & b",
														.x = {"cost", 10, {0, 0}},
														.y = *y,
														.columns = columns});
}

static void add(struct figure_series series, double x, double y, bool best, const char *name, const char *link)
{
	series_row(series, (double[]){x, y, NAN, NAN, best});
	series_mark(series, &(struct series_mark){name, name, link, best});
}

/* Draws the report of a result called `chart` beside one called `other`; its only figure as SVG, and perhaps as CSV. */
static char *drawn(struct result *result, char **csv)
{
	char *in = folder_new(), *out = folder_new();
	struct result *other = result_new("other", "Other");
	assert_true(result_write(result, in, error) && result_write(other, in, error));
	result_free(result), result_free(other);
	if (!report_write(in, out, error) || *error) fail_msg("%s", error);
	char *svg = folder_text(out, "chart-f.svg"), *page = folder_text(out, "chart.html");
	assert_non_null(svg);
	assert_non_null(strstr(page, "<object type=\"image/svg+xml\" data=\"chart-f.svg\""));
	assert_int_equal(folder_count(out, "chart-f.pdf"), 1);
	if (csv) *csv = folder_text(out, "chart-f.csv");
	free(page);
	folder_remove(in), folder_remove(out);
	return svg;
}

/* Where the disc of the point with this text is. */
static void place_of(const char *svg, const char *text, double at[2])
{
	const char *mark = strstr(svg, text);
	if (!mark || sscanf(strstr(mark, "<circle"), "<circle cx=\"%lf\" cy=\"%lf\"", &at[0], &at[1]) != 2)
		fail_msg("no mark '%s'", text);
}

static void points_have_texts_and_links(void **state)
{
	(void)state;
	struct result *result = result_new("chart", "Chart");
	struct result_figure figure = start(result, &(struct figure_axis){"worth", 0, {0, 0}});
	struct figure_series series = figure_series(figure, "one", SERIES_POINTS);
	add(series, 1, 1, true, "a \"b\" <c>", "other.html#x");
	add(series, 10, 0.5, false, "second", "missing.html");
	add(series, 100, 2, true, "third", NULL);
	struct figure_series line = figure_series(figure, "frontier", SERIES_LINE);
	series_row(line, (double[]){1, 1, NAN, NAN, 1}), series_row(line, (double[]){100, 2, NAN, NAN, 1});
	char *csv, *svg = drawn(result, &csv);
	assert_non_null(strstr(svg, "<title>Worth &lt;it&gt;</title>"));
	assert_non_null(strstr(svg, "<desc>a &amp; b</desc>"));
	assert_null(strstr(svg, "Gnuplot"));
	assert_non_null(strstr(svg, "<a class=\"mark\" target=\"_top\" xlink:href=\"other.html#x\"><title>a &quot;b&quot; "
								"&lt;c&gt;</title><circle "));
	assert_non_null(strstr(svg, "<g class=\"mark\"><title>second</title>")); /* no page, no link */
	assert_non_null(strstr(svg, "<g class=\"mark\"><title>third</title>"));
	assert_null(strstr(svg, "missing.html"));
	/* what is beaten lies below what is not */
	assert_true(strstr(svg, "<title>second") < strstr(svg, "<title>third"));
	/* only the best are named in the drawing itself */
	assert_non_null(strstr(svg, ">third</text>"));
	assert_null(strstr(svg, ">second</text>"));
	const char head[] = "panel_row,panel_column,series,name,x,y,low,high,best\n,,one,\"a \"\"b\"\" <c>\",1,1,,,1\n";
	assert_memory_equal(csv, head, strlen(head));
	assert_non_null(strstr(csv, "\n,,frontier,,1,1,"));
	free(csv);
	free(svg);
}

/* Discs lie where gnuplot draws the points: it writes a point's symbol with the same coordinates. */
static void discs_lie_on_the_points(void **state)
{
	(void)state;
	for (unsigned base = 0; base <= 10; base += 10) {
		struct result *result = result_new("chart", "Chart");
		struct result_figure figure = start(result, &(struct figure_axis){"worth", base, {0, 0}});
		const char *const cells[] = {"up", "down"};
		for (int row = 0; row < 2; row++)
			for (int column = 0; column < 2; column++) {
				struct figure_series series = figure_series(figure, "one", SERIES_POINTS);
				char name[40];
				series_panel(series, cells[row], cells[column], NULL);
				for (int k = 0; k < 3; k++) {
					snprintf(name, sizeof name, "p%d%d%d", row, column, k);
					add(series, 3 + 20 * k + row, k == 0 ? 0 : 0.01 * k + 0.2 * column, k == 2, name, NULL);
				}
			}
		char *svg = drawn(result, NULL);
		double first[2], below[2], beside[2];
		int matched = 0;
		place_of(svg, "<title>p000<", first);
		place_of(svg, "<title>p100<", below);
		place_of(svg, "<title>p010<", beside);
		assert_true(below[1] > first[1] + 100 && beside[0] > first[0] + 100);
		for (const char *use = svg; (use = strstr(use, "<use xlink:href='#gpPt")); use++) {
			double drawn_at[2];
			if (sscanf(strstr(use, "translate("), "translate(%lf,%lf)", &drawn_at[0], &drawn_at[1]) != 2) continue;
			for (const char *mark = svg; (mark = strstr(mark, "<circle cx")); mark++) {
				double at[2];
				sscanf(mark, "<circle cx=\"%lf\" cy=\"%lf\"", &at[0], &at[1]);
				matched += fabs(at[0] - drawn_at[0]) < 0.5 && fabs(at[1] - drawn_at[1]) < 0.5;
			}
		}
		assert_int_equal(matched, 12);
		free(svg);
	}
}

/* A share of zero has a lane on a logarithmic axis. */
static void none_has_a_lane(void **state)
{
	(void)state;
	struct result *result = result_new("chart", "Chart");
	struct result_figure figure = start(result, &(struct figure_axis){"share", 10, {0, 0}});
	struct figure_series series = figure_series(figure, "one", SERIES_POINTS);
	add(series, 1, 0.01, false, "some", NULL), add(series, 2, 0, true, "nothing", NULL);
	char *svg = drawn(result, NULL);
	double some[2], nothing[2];
	place_of(svg, "<title>some<", some);
	place_of(svg, "<title>nothing<", nothing);
	assert_true(nothing[1] > some[1]);
	assert_non_null(strstr(svg, ">none<"));
	free(svg);
}

/* On a map the words stand in the cells, and the discs on them, in the order of the axes. */
static void cells_of_a_map_have_words(void **state)
{
	(void)state;
	static const char *const plane[] = {"x", "y", "value", NULL};
	static const char *const words[] = {"alpha", "beta", "gamma", "delta", "epsilon", "none"};
	struct result *result = result_new("chart", "Chart");
	struct result_figure figure = result_figure(result, &(struct figure_frame){.name = "f",
																			   .kind = "map",
																			   .title = "Map",
																			   .caption = "",
																			   .alternative = "",
																			   .x = {"across", 0, {0, 0}},
																			   .y = {"up", 0, {0, 0}},
																			   .columns = plane});
	struct figure_series series = figure_series(figure, "one", SERIES_POINTS);
	for (int cell = 0; cell < 6; cell++) {
		series_row(series, (double[]){0.2 + 0.1 * (cell % 3), 10 + 5 * (cell / 3), cell < 5 ? exp(-2 * cell) : NAN});
		series_mark(series, &(struct series_mark){words[cell], words[cell], NULL, true});
	}
	char *svg = drawn(result, NULL);
	double at[6][2];
	for (int cell = 0; cell < 6; cell++) {
		char text[40];
		snprintf(text, sizeof text, "<title>%s<", words[cell]);
		place_of(svg, text, at[cell]);
		snprintf(text, sizeof text, ">%s<", words[cell]);
		assert_non_null(strstr(svg, text));
	}
	for (int cell = 0; cell < 6; cell++) {
		assert_true(fabs(at[cell][0] - at[cell % 3][0]) < 0.1 && fabs(at[cell][1] - at[cell / 3 * 3][1]) < 0.1);
		assert_true(cell % 3 == 0 || at[cell][0] > at[cell - 1][0] + 100);
		assert_true(cell < 3 || at[cell][1] < at[cell - 3][1] - 100);
	}
	free(svg);
}

static void marks_are_all_or_none(void **state)
{
	(void)state;
	struct result *result = result_new("chart", "Chart");
	struct result_figure figure = start(result, &(struct figure_axis){"worth", 0, {0, 0}});
	struct figure_series series = figure_series(figure, "one", SERIES_POINTS);
	add(series, 1, 1, true, "marked", NULL);
	series_row(series, (double[]){2, 2, NAN, NAN, 1});
	char *folder = folder_new();
	assert_false(result_write(result, folder, error));
	assert_non_null(strstr(error, "marks is not a list as long as its rows"));
	result_free(result);
	folder_remove(folder);
}

int main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(points_have_texts_and_links),
		cmocka_unit_test(discs_lie_on_the_points),
		cmocka_unit_test(none_has_a_lane),
		cmocka_unit_test(cells_of_a_map_have_words),
		cmocka_unit_test(marks_are_all_or_none),
	};
	return cmocka_run_group_tests(tests, NULL, NULL);
}
