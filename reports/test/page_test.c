/* The report: pages that are well formed, lead somewhere, and say what is in the results. With a folder as its argument
 * the program leaves the sample report there, to be looked at. */
#include "folder.h"
#include "page.h"
#include "samples.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>

#include <cmocka.h>

static char error[REPORT_ERROR];
static char *results, *report; /* the sample results, and the report made from them */

static void put(struct result *result, const char *folder)
{
	if (!result_write(result, folder, error)) fail_msg("%s", error);
	result_free(result);
}

static int write_samples(void **state)
{
	(void)state;
	results = folder_new();
	report = report ? report : folder_new();
	put(histogram_result(), results);
	put(trajectory_result(), results);
	put(generic_result(), results);
	if (!report_write(results, report, error)) print_error("%s\n", error);
	return strcmp(error, "") != 0;
}

static char *page(const char *name)
{
	char *text = folder_text(report, name);
	if (!text) fail_msg("%s is not there", name);
	return text;
}

/* Calls back for each entry of the report with this ending. */
static int for_each(const char *ending, void (*look)(const char *name))
{
	DIR *folder = opendir(report);
	int count = 0;
	for (struct dirent *entry; (entry = readdir(folder));) {
		const char *found = strrchr(entry->d_name, '.');
		if (!found || strcmp(found, ending) != 0) continue;
		look(entry->d_name);
		count++;
	}
	closedir(folder);
	return count;
}

/* Links to the live page stand where the page lies beside the report, and only there; parameters are parameters. */
static void live_page_is_linked_where_it_is(void **state)
{
	(void)state;
	char *folder = folder_new(), *stored, *pages;
	assert_true(asprintf(&stored, "%s/results", folder) > 0 && asprintf(&pages, "%s/report", folder) > 0);
	assert_true(aside_folder(stored, error));
	struct result *result = result_new("shown", "Something to see");
	result_live(result, "See & believe", "scene=gas&against=binary32");
	struct result_table table = result_table(result, "Cells", NULL, (const char *const[]){"a", "b", NULL});
	table_text(table, "<halts>"), table_live(table, "scene=gas&method=naive"), table_link(table, "told");
	table_unseen(table, "not live: <it>");
	table_text(table, "touchstone run gas --seed 2"), table_anchor(table, "told");
	put(result, stored);
	for (int there = 0; there < 2; there++) {
		if (there) folder_put(folder, "live.html", "<p>");
		if (!report_write(stored, pages, error)) fail_msg("%s", error);
		char *text = folder_text(pages, "shown.html");
		bool linked = strstr(text, "href=\"../live.html?scene=gas&amp;against=binary32\">See &amp; believe</a>");
		assert_int_equal(linked, there);
		assert_int_equal(strstr(text, "See it happen") != NULL, there);
		linked = strstr(text, "<a class=\"watch\" href=\"../live.html?scene=gas&amp;method=naive\">watch it</a>");
		assert_int_equal(linked, there);
		assert_int_equal(strstr(text, "live.html") != NULL, there);
		linked = strstr(text, "</a> <span class=\"unseen\">not live: &lt;it&gt;</span>");
		assert_int_equal(linked, there);
		assert_non_null(strstr(text, "<a href=\"shown.html#cell-told\">&lt;halts&gt;</a>"));
		assert_non_null(strstr(
			text,
			"<td class=\"command\" id=\"cell-told\"><span>touchstone run gas</span> <span>--seed 2</span> </td>"));
		free(text);
	}
	result = result_new("shown", "Something to see");
	result_live(result, "Not parameters", "scene=gas\" onclick=\"");
	assert_false(result_write(result, stored, error));
	assert_non_null(strstr(error, "no parameters of the live page"));
	result_free(result);
	free(stored);
	free(pages);
	folder_remove(folder);
}

static void check_markup(const char *name)
{
	char *command;
	assert_true(asprintf(&command, "xmllint --nonet --noout '%s/%s'", report, name) > 0);
	if (system(command) != 0) fail_msg("%s is not well formed", name);
	free(command);
}

static void markup_is_well_formed(void **state)
{
	(void)state;
	if (system("command -v xmllint >/dev/null") != 0) {
		print_message("skipped: xmllint is not installed\n");
		skip();
	}
	assert_int_equal(for_each(".html", check_markup), 4);
	assert_int_equal(for_each(".svg", check_markup), 5);
}

/* Every href and src leads to a file of the report, and to a place in it where it names one. */
static void check_links(const char *name)
{
	char *text = page(name);
	const char *const attributes[] = {" href=\"", " src=\""};
	for (size_t i = 0; i < 2; i++)
		for (char *at = text; (at = strstr(at, attributes[i]));) {
			at += strlen(attributes[i]);
			char target[200], id[220];
			snprintf(target, sizeof target, "%.*s", (int)strcspn(at, "\""), at);
			char *place = strchr(target, '#');
			if (place) *place++ = '\0';
			char *there = page(target);
			snprintf(id, sizeof id, " id=\"%s\"", place ? place : "");
			if (place && !strstr(there, id)) fail_msg("%s leads to %s#%s, which is not there", name, target, place);
			free(there);
		}
	free(text);
}

static void links_lead_somewhere(void **state)
{
	(void)state;
	assert_int_equal(for_each(".html", check_links), 4);
}

static void check_inert(const char *name)
{
	char *text = page(name);
	assert_null(strstr(text, "<script"));
	assert_null(strstr(text, "{{/"));
	assert_null(strstr(text, "http"));
	free(text);
}

static void text_stays_text(void **state)
{
	(void)state;
	for_each(".html", check_inert);
	char *text = page("costs.html");
	static const char escaped[] =
		"<h1>a &lt; b &amp; &quot;c&quot; &#39;d&#39; {{title}} `id` @x ^{y} \\ &lt;script&gt;</h1>";
	assert_non_null(strstr(text, escaped));
	free(text);
	/* gnuplot's own marks are printed too, and nothing is run. */
	text = page("costs-orders.svg");
	assert_non_null(strstr(text, "{{title}} `id` @x ^{y} \\ &lt;script"));
	free(text);
}

static void check_drawing(const char *name)
{
	char *text = page(name);
	bool svg = strstr(name, ".svg");
	assert_true(strlen(text) > (svg ? 2000 : 0));
	assert_true(svg ? strstr(text, "<path") != NULL : strncmp(text, "%PDF-", 5) == 0);
	free(text);
}

static void figures_are_drawn(void **state)
{
	(void)state;
	assert_int_equal(for_each(".svg", check_drawing), 5);
	assert_int_equal(for_each(".pdf", check_drawing), 5);
}

static void pages_say_what_was_found(void **state)
{
	(void)state;
	const struct {
		const char *page, *part;
	} expected[] = {
		{"index.html", ">1 agree<"},
		{"index.html", ">2 differ<"},
		{"index.html", ">1 not comparable<"},
		{"index.html", "href=\"fig3.html#claim-2\""},
		{"index.html", "Incomplete: Stopped after 312 000 of 1 000 000 plates."},
		{"fig3.html", "0.49772 to 0.49874 (95 %, Clopper-Pearson)"},
		{"fig3.html", "from 1\u202f200\u202f000 observations"},
		{"fig3.html", "1.42\u202f×\u202f10⁻¹⁷ contact distances"},
		{"fig3.html", "touchstone reproduce fig3 --quick --seed 7"},
		{"fig3.html", "<td class=\"hex\">0x1."},
		{"fig3.html", "<td class=\"number\">∞</td>"},
		{"fig7.html", "This result is incomplete."},
		{"fig7.html", "62\u202fmin 5\u202fs"},
	};
	for (size_t i = 0; i < sizeof expected / sizeof *expected; i++) {
		char *text = page(expected[i].page);
		if (!strstr(text, expected[i].part)) fail_msg("%s does not say '%s'", expected[i].page, expected[i].part);
		free(text);
	}
}

static void numbers_in_csv_have_all_their_digits(void **state)
{
	(void)state;
	char *text = page("fig3-separation.csv");
	static const char head[] = "panel_row,panel_column,series,left,right,height,steps\n"
							   "density 0.1,restitution 1,as measured,";
	assert_memory_equal(text, head, strlen(head));
	char *end;
	assert_true(strtod(text + strlen(head), &end) == -9.5 * 0x1p-53);
	assert_true(strtod(end + 1, NULL) == -8.5 * 0x1p-53);
	free(text);
	text = page("costs-table-1.csv");
	static const char quoted[] = "\"a < b & \"\"c\"\" 'd' {{title}} `id` @x ^{y} \\ <script>\",\n"
								 "row,\"a < b & \"\"c\"\" 'd' {{title}} `id` @x ^{y} \\ <script>\"\n";
	assert_string_equal(strchr(text, '\n') + 1, quoted);
	free(text);
}

static void nothing_else_is_left(void **state)
{
	(void)state;
	assert_int_equal(folder_count(report, ".part") + folder_count(report, ".drawing"), 0);
	assert_int_equal(folder_count(report, ".csv"), 7);
	assert_int_equal(folder_count(report, ""), 4 + 3 + 5 * 3 + 2 + 1);
}

static void expect_refused(const char *file, const char *text, const char *part)
{
	char *in = folder_new(), *out;
	assert_true(asprintf(&out, "%s/out", in) > 0);
	put(trajectory_result(), in);
	folder_put(in, file, text);
	assert_false(report_write(in, out, error));
	if (!strstr(error, part) || !strstr(error, file)) fail_msg("expected '%s', got '%s'", part, error);
	assert_int_equal(folder_count(in, "out"), 0);
	free(out);
	folder_remove(in);
}

static void damaged_results_stop_it_before_it_begins(void **state)
{
	(void)state;
	expect_refused("a.json", "{\"schema\":\n", "a.json:");
	expect_refused("zz.json", "{\"schema\": \"touchstone-result-2\"}", "which this version does not know");
	char *text = folder_text(results, "fig7.json");
	expect_refused("copy.json", text, "holds the result 'fig7'; its name must be fig7.json");
	free(text);
}

static void empty_and_missing_folders_are_told(void **state)
{
	(void)state;
	char *in = folder_new();
	assert_false(report_write(in, report, error));
	assert_non_null(strstr(error, "holds no results"));
	assert_false(report_write("/nowhere/at/all", report, error));
	assert_non_null(strstr(error, "/nowhere/at/all: cannot be read"));
	assert_false(report_write(results, "/dev/null/report", error));
	assert_non_null(strstr(error, "/dev/null/report"));
	folder_remove(in);
}

static void figures_of_unknown_kind_are_named(void **state)
{
	(void)state;
	char *in = folder_new(), *out = folder_new();
	struct result *result = result_new("r", "R");
	result_figure(result,
				  &(struct figure_frame){.name = "f", .kind = "pie", .title = "Pie", .caption = "", .alternative = ""});
	put(result, in);
	assert_true(report_write(in, out, error));
	assert_string_equal(error, "r-f is not drawn: there is no plot script for figures of kind 'pie'");
	char *text = folder_text(out, "r.html");
	assert_non_null(strstr(text, "Not drawn: there is no plot script"));
	assert_null(strstr(text, "<img"));
	free(text);
	folder_remove(in), folder_remove(out);
}

/* However few and plain the series: each kind of figure takes one alone, of any style, on any axes. */
static void every_kind_takes_every_style(void **state)
{
	(void)state;
	static const char *const kinds[] = {"impact-histogram", "trajectory", "scaling", "curves", "bars",
										"frontier",         "discs",      "map"};
	static const char *const columns[] = {"left",  "right", "height", "time",  "remaining", "bits",
										  "error", "x",     "y",      "low",   "high",      "category",
										  "value", "best",  "radius", "speed", "touched",   NULL};
	static const char *const categories[] = {"one", "two", NULL};
	static const double rows[][17] = {{1, 2, 0.5, 0, 8, 8, 0.1, 1, 2, 1, 3, 0, 2, 1, 0.5, -1, 1},
									  {2, 4, 0.25, 1, 1, 24, 0.01, 2, 4, 3, 6, 1, 4, 0, 0.5, 1, 0}};
	char *in = folder_new(), *out = folder_new();
	struct result *result = result_new("r", "R");
	for (unsigned i = 0; i < 32; i++) {
		char name[20];
		snprintf(name, sizeof name, "f%u", i);
		const unsigned bases[] = {0, 10, 2};
		struct figure_axis axis = {.label = "axis", .logarithmic = bases[i % 3]};
		struct result_figure figure = result_figure(result, &(struct figure_frame){.name = name,
																				   .kind = kinds[i % 8],
																				   .title = name,
																				   .caption = "",
																				   .alternative = "",
																				   .x = axis,
																				   .y = axis,
																				   .columns = columns,
																				   .categories = categories});
		struct figure_series series = figure_series(figure, "alone", (enum series_style)(i / 8));
		series_row(series, rows[0]), series_row(series, rows[1]);
	}
	put(result, in);
	assert_true(report_write(in, out, error));
	assert_string_equal(error, "");
	assert_int_equal(folder_count(out, ".svg"), 32);
	folder_remove(in), folder_remove(out);
}

static void without_gnuplot_there_are_pages_still(void **state)
{
	(void)state;
	char *out = folder_new(), *path = strdup(getenv("PATH"));
	setenv("PATH", out, 1);
	bool written = report_write(results, out, error);
	setenv("PATH", path, 1);
	free(path);
	assert_true(written);
	assert_non_null(strstr(error, "gnuplot is not installed"));
	assert_int_equal(folder_count(out, ".svg") + folder_count(out, ".drawing"), 0);
	assert_int_equal(folder_count(out, ".html"), 4);
	char *text = folder_text(out, "fig3.html");
	assert_non_null(strstr(text, "Not drawn: gnuplot is not installed"));
	assert_null(strstr(text, ".svg"));
	free(text);
	folder_remove(out);
}

int main(int argc, char **argv)
{
	report = argc > 1 ? strdup(argv[1]) : NULL;
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(live_page_is_linked_where_it_is),
		cmocka_unit_test(markup_is_well_formed),
		cmocka_unit_test(links_lead_somewhere),
		cmocka_unit_test(text_stays_text),
		cmocka_unit_test(figures_are_drawn),
		cmocka_unit_test(pages_say_what_was_found),
		cmocka_unit_test(numbers_in_csv_have_all_their_digits),
		cmocka_unit_test(nothing_else_is_left),
		cmocka_unit_test(damaged_results_stop_it_before_it_begins),
		cmocka_unit_test(empty_and_missing_folders_are_told),
		cmocka_unit_test(figures_of_unknown_kind_are_named),
		cmocka_unit_test(every_kind_takes_every_style),
		cmocka_unit_test(without_gnuplot_there_are_pages_still),
	};
	int failed = cmocka_run_group_tests(tests, write_samples, NULL);
	folder_remove(results);
	if (argc > 1)
		free(report);
	else
		folder_remove(report);
	return failed;
}
