/* Results: what is put in comes back, and what is not a result is refused in one clear line. */
#include "folder.h"
#include "result.h"
#include "samples.h"
#include "schema.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <sys/stat.h>
#include <time.h>

#include <cmocka.h>

static char error[REPORT_ERROR];

static struct result *written_and_read(const struct result *result, const char *folder)
{
	char *path;
	if (!result_write(result, folder, error)) fail_msg("%s", error);
	assert_true(
		asprintf(&path, "%s/%s.json", folder, json_string_value(json_object_get(result_document(result), "name"))) > 0);
	struct result *back = result_read(path, error);
	free(path);
	if (!back) fail_msg("%s", error);
	return back;
}

static double random_double(unsigned *seed)
{
	uint64_t bits = 0;
	for (int i = 0; i < 5; i++) bits = bits << 15 ^ (uint64_t)rand_r(seed);
	double value;
	memcpy(&value, &bits, sizeof value);
	return value;
}

static void every_double_comes_back(void **state)
{
	(void)state;
	enum { ROWS = 5000 };
	unsigned seed = (unsigned)time(NULL);
	print_message("seed %u\n", seed);
	static const char *const columns[] = {"x", "y", "low", "high", NULL};
	static double sent[ROWS][4];
	const double special[] = {0.0, -0.0, INFINITY, -INFINITY, NAN, 0x1p-1074, 0x1.fffffffffffffp1023, 0x1p-1022};
	struct result *result = result_new("doubles", "Doubles");
	struct result_figure figure = result_figure(
		result, &(struct figure_frame){
					.name = "f", .kind = "curves", .title = "", .caption = "", .alternative = "", .columns = columns});
	struct figure_series series = figure_series(figure, "s", SERIES_LINE);
	struct result_table table = result_table(result, "t", NULL, columns);
	for (int i = 0; i < ROWS; i++) {
		table_row(table);
		for (int j = 0; j < 4; j++) {
			sent[i][j] = i < 2 ? special[4 * i + j] : random_double(&seed);
			table_number(table, sent[i][j]);
		}
		series_row(series, sent[i]);
	}
	char *folder = folder_new();
	struct result *back = written_and_read(result, folder);
	const json_t *document = result_document(back);
	const json_t *points = json_object_get(
		json_array_get(json_object_get(json_array_get(json_object_get(document, "figures"), 0), "series"), 0), "rows");
	const json_t *cells = json_object_get(json_array_get(json_object_get(document, "tables"), 0), "rows");
	for (size_t i = 0; i < ROWS; i++)
		for (size_t j = 0; j < 4; j++) {
			double values[] = {schema_double(json_array_get(json_array_get(points, i), j)),
							   schema_double(json_array_get(json_array_get(cells, i), j))};
			for (int k = 0; k < 2; k++)
				assert_true(isnan(sent[i][j]) ? isnan(values[k])
											  : memcmp(&values[k], &sent[i][j], sizeof(double)) == 0);
		}
	result_free(back), result_free(result);
	folder_remove(folder);
}

static void documents_come_back(void **state)
{
	(void)state;
	struct result *(*const make[])(void) = {histogram_result, trajectory_result, generic_result};
	char *folder = folder_new();
	for (size_t i = 0; i < 3; i++) {
		struct result *result = make[i](), *back = written_and_read(result, folder);
		assert_true(json_equal(result_document(result), result_document(back)));
		result_free(result), result_free(back);
	}
	assert_int_equal(folder_count(folder, ""), 3);
	folder_remove(folder);
}

static void bytes_that_are_not_utf8_do_no_harm(void **state)
{
	(void)state;
	char *folder = folder_new();
	struct result *result = result_new("bytes", "caf\xe9");
	result_paragraph(result, "%s", "\xff\xfe");
	struct result *back = written_and_read(result, folder);
	const json_t *document = result_document(back);
	assert_string_equal(json_string_value(json_object_get(document, "title")), "caf?");
	assert_string_equal(json_string_value(json_array_get(json_object_get(document, "summary"), 0)), "??");
	result_free(result), result_free(back);
	folder_remove(folder);
}

static void expect_refused(const char *text, const char *part)
{
	char *folder = folder_new(), *path;
	folder_put(folder, "r.json", text);
	assert_true(asprintf(&path, "%s/r.json", folder) > 0);
	*error = '\0';
	struct result *result = result_read(path, error);
	if (result || !strstr(error, part) || !strstr(error, "r.json") || strchr(error, '\n'))
		fail_msg("expected '%s', got '%s'", part, error);
	free(path);
	folder_remove(folder);
}

/* However a file is cut off, it is refused. */
static void truncated_files_are_refused(void **state)
{
	(void)state;
	char *folder = folder_new();
	struct result *result = generic_result();
	assert_true(result_write(result, folder, error));
	char *text = folder_text(folder, "costs.json");
	for (size_t length = strlen(text) - 2; length > 0; length -= length > 100 ? length / 37 : 1) {
		text[length] = '\0';
		expect_refused(text, "r.json");
	}
	expect_refused("", "damaged result");
	assert_null(result_read("/nowhere/r.json", error));
	assert_non_null(strstr(error, "/nowhere/r.json: cannot be read as a result"));
	free(text);
	result_free(result);
	folder_remove(folder);
}

/* Sets one value of a sound result, given as a path of keys and indices, and expects this to be noticed. */
static void expect_noticed(const char *way, const char *value, const char *part)
{
	struct result *result = histogram_result();
	json_t *document = json_deep_copy(result_document(result)), *at = document;
	char keys[100], *rest = keys;
	snprintf(keys, sizeof keys, "%s", way);
	for (char *key; (key = strsep(&rest, "/"));) {
		json_t *set = rest ? NULL : json_loads(value, JSON_DECODE_ANY, NULL);
		if (!rest && json_is_array(at)) assert_int_equal(json_array_set_new(at, (size_t)atoi(key), set), 0);
		if (!rest && json_is_object(at)) assert_int_equal(json_object_set_new(at, key, set), 0);
		at = json_is_array(at) ? json_array_get(at, (size_t)atoi(key)) : json_object_get(at, key);
		assert_non_null(at);
	}
	char *text = json_dumps(document, 0);
	expect_refused(text, part);
	free(text);
	json_decref(document);
	result_free(result);
}

static void unsound_results_are_refused(void **state)
{
	(void)state;
	expect_noticed("schema", "\"touchstone-result-2\"",
				   "has schema 'touchstone-result-2', which this version does not know");
	expect_noticed("schema", "7", "names no schema; accepted is touchstone-result-1");
	expect_noticed("title", "7", "xpected string");
	expect_noticed("name", "\"../fig3\"", "name '../fig3' has more than letters");
	expect_noticed("complete", "\"yes\"", "xpected");
	expect_noticed("seconds", "\"long\"", "seconds is not a number");
	expect_noticed("machine/cores", "\"two\"", "xpected integer");
	expect_noticed("summary/0", "1", "summary[0] is not text");
	expect_noticed("claims", "{}", "claims is not a list");
	expect_noticed("claims/1/verdict", "\"perhaps\"", "claims[1]: verdict is 'perhaps', not agrees, differs");
	expect_noticed("claims/1/measured", "\"much\"", "claims[1]: measured is not a number");
	expect_noticed("claims/0/interval/1", "\"wide\"", "claims[0]: interval is not two numbers");
	expect_noticed("tables/0/rows/3", "[1, 2]", "tables[0]: row 3 has 2 values, where there are 6 columns");
	expect_noticed("tables/0/rows/3/1", "{}", "tables[0]: row 3, column 1");
	expect_noticed("tables/0/rows/3/1", "{\"text\": \"1 missed\", \"level\": 5}", "tables[0]: row 3, column 1");
	expect_noticed("tables/0/rows/3/1", "{\"text\": 1, \"level\": 0}", "tables[0]: row 3, column 1");
	expect_noticed("tables/0/rows/3/1", "{\"text\": \"\", \"anchor\": \"a b\"}", "tables[0]: row 3, column 1");
	expect_noticed("tables/0/rows/3/1", "{\"text\": \"\", \"live\": \"a=\\\"\"}", "tables[0]: row 3, column 1");
	expect_noticed("tables/0/rows/3/1", "{\"text\": \"\", \"unseen\": 1}", "tables[0]: row 3, column 1");
	expect_noticed("tables/0/rows/3/1", "{\"text\": \"\", \"link\": \"x\"}",
				   "tables[0]: row 3, column 1: a link to 'x', and no cell is so named");
	expect_noticed("figures/0/x", "{}", "figures[0]: ");
	expect_noticed("figures/0/columns/2", "\"depth\"", "needs a column 'height'");
	expect_noticed("figures/0/series/0/style", "\"bold\"", "series style is 'bold'");
	expect_noticed("figures/0/series/0/rows/0/0", "\"wide\"", "figures[0]: row 0, column 0");
	expect_refused("[]", "not a result");
	expect_refused("{\"schema\": \"touchstone-result-1\",\n\"name\": }", "r.json:2: damaged result");
	expect_refused("{\"schema\": 1, \"schema\": 2}", "duplicate");
}

static void unsound_results_are_not_written(void **state)
{
	(void)state;
	static const char *const columns[] = {"a", "b", NULL};
	char *folder = folder_new();
	struct result *result = result_new("short", "A row that is too short");
	struct result_table table = result_table(result, "t", NULL, columns);
	table_row(table), table_number(table, 1);
	assert_false(result_write(result, folder, error));
	assert_string_equal(error, "result short: tables[0]: row 0 has 1 values, where there are 2 columns");
	table_text(table, "here"), table_anchor(table, "here"), table_row(table);
	table_text(table, "there"), table_anchor(table, "here"), table_number(table, 2);
	assert_false(result_write(result, folder, error));
	assert_string_equal(error, "result short: tables[0]: row 0, column 1: another cell is named 'here' too");
	result_free(result);

	result = result_new("../escape", "A name that leaves the folder");
	assert_false(result_write(result, folder, error));
	assert_non_null(strstr(error, "name '../escape'"));
	result_free(result);

	result = trajectory_result();
	result_figure(result, &(struct figure_frame){
							  .name = "height", .kind = "none", .title = "", .caption = "", .alternative = ""});
	assert_false(result_write(result, folder, error));
	assert_non_null(strstr(error, "name 'height' is taken by figures[0]"));
	result_free(result);
	assert_int_equal(folder_count(folder, ""), 0);
	folder_remove(folder);
}

static void unwritable_places_are_told(void **state)
{
	(void)state;
	char *folder = folder_new(), *below = NULL, *taken = NULL;
	struct result *result = generic_result();
	folder_put(folder, "file", "");
	assert_true(asprintf(&below, "%s/file/below", folder) > 0 && asprintf(&taken, "%s/costs.json", folder) > 0);
	assert_false(result_write(result, below, error));
	assert_non_null(strstr(error, "Not a directory"));
	assert_int_equal(mkdir(taken, 0777), 0);
	assert_false(result_write(result, folder, error));
	assert_non_null(strstr(error, "costs.json: not a file"));
	assert_int_equal(folder_count(folder, ""), 2);
	assert_null(result_read(taken, error));
	free(below), free(taken);
	result_free(result);
	folder_remove(folder);
}

/* A full disk: what is there already must outlive the attempt. */
static void failed_writing_leaves_the_old_file(void **state)
{
	(void)state;
	char *folder = folder_new();
	folder_put(folder, "a", "old");
	struct aside file;
	assert_true(aside_open(&file, error, "%s/a", folder));
	fputs("new", file.stream);
	file.stream = freopen("/dev/full", "w", file.stream);
	fputs("new", file.stream);
	assert_false(aside_keep(&file, error));
	assert_non_null(strstr(error, "No space left"));
	assert_true(aside_open(&file, error, "%s/a", folder));
	fputs("new", file.stream);
	aside_drop(&file);
	char *text = folder_text(folder, "a");
	assert_string_equal(text, "old");
	assert_int_equal(folder_count(folder, ""), 1);
	free(text);
	folder_remove(folder);
}

int main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(every_double_comes_back),
		cmocka_unit_test(documents_come_back),
		cmocka_unit_test(bytes_that_are_not_utf8_do_no_harm),
		cmocka_unit_test(truncated_files_are_refused),
		cmocka_unit_test(unsound_results_are_refused),
		cmocka_unit_test(unsound_results_are_not_written),
		cmocka_unit_test(unwritable_places_are_told),
		cmocka_unit_test(failed_writing_leaves_the_old_file),
	};
	return cmocka_run_group_tests(tests, NULL, NULL);
}
