/* Questions as text: what is written is read back to the last bit, whatever is wrong has its line, and damage of any
 * kind does no harm. */
#include <locale.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "scene/random.h"
#include "store/query_file.h"
#include "test/folder.h"

static const uint64_t seed = 7;

static char *folder, *path;

static void put(const char *text, size_t length)
{
	FILE *stream = fopen(path, "w");
	assert_non_null(stream);
	assert_int_equal(fwrite(text, 1, length, stream), length);
	assert_int_equal(fclose(stream), 0);
}

/* Any double at all; of NaN text keeps no more than the sign. */
static double any_double(struct random_state *random)
{
	double x;
	uint64_t pattern = random_bits(random);
	if (random_below(random, 8) == 0) pattern &= UINT64_C(0x800fffffffffffff) >> random_below(random, 40);
	if (random_below(random, 16) == 0) pattern |= UINT64_C(0x7ff) << 52;
	if (random_below(random, 16) == 0) pattern &= UINT64_C(0xfff) << 52;
	memcpy(&x, &pattern, sizeof x);
	return isnan(x) ? copysign(NAN, x) : x;
}

static struct query any_query(struct random_state *random)
{
	static const char *const comments[] = {NULL, "", "exact 0x1p+0; source: none", "# and # again"};
	struct query query = {.shape = (enum touchstone_shape)random_below(random, TOUCHSTONE_SHAPES)};
	for (size_t i = 0; i < shape_numbers(query.shape); i++) query.number[i] = any_double(random);
	query.comment = comments[random_below(random, 4)];
	return query;
}

static void check_same(const struct query *one, const struct query *other, bool with_comment)
{
	assert_int_equal(one->shape, other->shape);
	assert_memory_equal(one->number, other->number, sizeof one->number);
	if (!with_comment) return;
	assert_true(!one->comment == !other->comment);
	if (one->comment) assert_string_equal(one->comment, other->comment);
}

static void round_trips(void)
{
	enum { QUERIES = 200 };
	struct random_state random = random_seed(seed);
	for (int trial = 0; trial < 50; trial++) {
		struct query query[QUERIES], parsed;
		char *text, error[400];
		size_t length;
		FILE *stream = open_memstream(&text, &length);
		for (int i = 0; i < QUERIES; i++) {
			query[i] = any_query(&random);
			for (uint64_t n = random_below(&random, 3); n > 0; n--) fputs(" \t# nothing asked here\r\n\n", stream);
			long start = ftell(stream);
			query_write(stream, &query[i]);
			fflush(stream);
			if (!query_parse(text + start, &parsed, error)) fail_msg("%s: %s", text + start, error);
			check_same(&parsed, &query[i], false);
			fputs(i == QUERIES - 1 ? "" : trial % 2 ? "\r\n" : "\n", stream);
		}
		fclose(stream);
		put(text, length);
		struct query_file file;
		if (!query_file_read(path, &file, error)) fail_msg("%s", error);
		assert_int_equal(file.count, QUERIES);
		for (int i = 0; i < QUERIES; i++) check_same(&file.query[i], &query[i], true);
		query_file_free(&file);
		free(text);
	}
}

static void written_and_read_is_the_same(void **state)
{
	(void)state;
	round_trips();
}

/* In a country of decimal commas, where the machine knows one. */
static void countries_do_not_matter(void **state)
{
	(void)state;
	static const char *const commas[] = {"de_DE.UTF-8", "fr_FR.UTF-8", "es_ES.UTF-8", "de_DE", "pt_BR.UTF-8"};
	bool known = false;
	for (size_t i = 0; i < sizeof commas / sizeof *commas && !known; i++) known = setlocale(LC_ALL, commas[i]);
	if (!known) {
		print_message("no locale with decimal commas is installed\n");
		skip();
	}
	round_trips();
	struct query query;
	char error[400];
	assert_true(query_parse("half-space 1.5 -2.5e-1", &query, error));
	assert_true(query.number[0] == 1.5 && query.number[1] == -0.25);
	assert_false(query_parse("half-space 1,5 -1", &query, error));
	setlocale(LC_ALL, "C");
}

static void files_are_read_as_people_write_them(void **state)
{
	(void)state;
	static const char text[] = "# first\r\n"
							   "\n"
							   "  ball-ball 3 0 -0 -1. .5 +1e-3 0x1.8p-1 # exact 0x1p+1 ; source: me \t\r\n"
							   "half-space\t1e-400 -INF#\n"
							   "ball-plane 1 -nan infinity NaN";
	put(text, sizeof text - 1);
	struct query_file file;
	char error[400];
	if (!query_file_read(path, &file, error)) fail_msg("%s", error);
	assert_int_equal(file.count, 3);
	const struct query *query = file.query;
	assert_true(query[0].line == 3 && query[1].line == 4 && query[2].line == 5);
	assert_string_equal(query[0].comment, "exact 0x1p+1 ; source: me");
	assert_string_equal(query[1].comment, "");
	assert_null(query[2].comment);
	assert_true(query[0].number[2] == 0 && signbit(query[0].number[2]) && query[0].number[6] == 0.75);
	assert_true(query[1].number[0] == 0 && query[1].number[1] == -INFINITY);
	assert_true(isnan(query[2].number[1]) && query[2].number[2] == INFINITY && isnan(query[2].number[3]));
	query_file_free(&file);
}

static void assert_refused(const char *text, size_t length, const char *place, const char *words)
{
	struct query_file file;
	char error[400] = "", wanted[200];
	put(text, length);
	if (query_file_read(path, &file, error)) fail_msg("accepted: %s", text);
	snprintf(wanted, sizeof wanted, "%s:%s: ", path, place);
	if (strncmp(error, wanted, strlen(wanted)) != 0 || !strstr(error, words) || !strstr(error, "; accepted: "))
		fail_msg("'%s' does not say '%s' and '%s'", error, wanted, words);
	assert_null(strchr(error, '\n'));
	assert_null(file.query);
}

static void bad_files_are_refused(void **state)
{
	(void)state;
	static const struct {
		const char *text, *place, *words;
	} bad[] = {
		{"", "1", "without a question"},
		{"# only\n# this\n", "3", "without a question"},
		{"half-space 1 -1\nball 1 2\n", "2", "'ball' is no shape; accepted: ball-ball, ball-leave"},
		{"Half-space 1 -1\n", "1", "'Half-space' is no shape"},
		{"half-space\n", "1", "0 numbers; accepted: 2, half-space distance speed"},
		{"half-space # 1 1\n", "1", "0 numbers"},
		{"\n\nball-ball 1 2 3 4 5 6\n", "3", "6 numbers; accepted: 7, ball-ball rx ry rz vx vy vz contact"},
		{"ball-plane 1 2 3 4 5\n", "1", "'5' is too much; accepted: 4 numbers"},
		{"half-space 1 -1 junk\n", "1", "'junk' is too much"},
		{"half-space 1 -1;\n", "1", "'-1;' is no number"},
		{"half-space 0x 1\n", "1", "'0x' is no number; accepted: decimal"},
		{"half-space 0x1.8q0 1\n", "1", "'0x1.8q0' is no number"},
		{"half-space 0x1p 1\n", "1", "'0x1p' is no number"},
		{"half-space 0x1.8.0p3 1\n", "1", "'0x1.8.0p3' is no number"},
		{"half-space 1,5 1\n", "1", "'1,5' is no number"},
		{"half-space --1 1\n", "1", "'--1' is no number"},
		{"half-space nan(1) 1\n", "1", "'nan(1)' is no number"},
		{"half-space infinite 1\n", "1", "'infinite' is no number"},
		{"half-space 1e999 1\n", "1", "'1e999' is too large; accepted: up to 0x1.fffffffffffffp+1023"},
		{"half-space 1 -0x1p1024\n", "1", "'-0x1p1024' is too large"},
		{"half-space 1 \x1b[31m\n", "1", "'?[31m' is no number"},
	};
	for (size_t i = 0; i < sizeof bad / sizeof *bad; i++)
		assert_refused(bad[i].text, strlen(bad[i].text), bad[i].place, bad[i].words);
	assert_refused("half-space 1 -1\nhalf-\0space 1 -1\n", 34, "2", "a character of value 0");
	enum { LONG = 100000 };
	char *text = malloc(LONG);
	memset(text, '#', LONG);
	memcpy(text, "half-space 1 -1\n", 16);
	assert_refused(text, LONG, "2", "a line without end; accepted: up to 4095 characters");
	memset(text, '1', LONG);
	struct query query;
	char error[400];
	text[LONG - 1] = '\0';
	assert_false(query_parse(text, &query, error));
	assert_non_null(strstr(error, "without end"));
	free(text);
	assert_false(query_parse(" # nothing", &query, error));
	assert_non_null(strstr(error, "no question; accepted: "));
}

static void missing_files_are_said(void **state)
{
	(void)state;
	struct query_file file;
	char error[400];
	assert_false(query_file_read("/no/such\nfile", &file, error));
	assert_string_equal(error, "/no/such?file: cannot be read: No such file or directory");
	assert_false(query_file_read(folder, &file, error));
	assert_non_null(strstr(error, ":1: cannot be read: Is a directory"));
	assert_false(query_file_read("/dev/zero", &file, error));
	assert_non_null(strstr(error, "/dev/zero:1: a character of value 0"));
}

/* Damaged anywhere, a file is refused on one line or makes sense all the same. */
static void damaged_files_do_no_harm(void **state)
{
	(void)state;
	static const char sound[] = "ball-ball 0x1.8p+0 -0x1p-3 0 -1 0 1e-5 1 # exact never; source: x\r\n"
								"ball-plane 1 -2.5 -1 0.5\n# between\nhalf-space inf -nan\n";
	static const char spice[] = "\0\n\r\t #0123456789abcdefxp.+-,ein";
	struct random_state random = random_seed(seed);
	int refused = 0;
	enum { TRIALS = 5000 };
	for (int trial = 0; trial < TRIALS; trial++) {
		char text[2 * sizeof sound];
		size_t length = sizeof sound - 1;
		memcpy(text, sound, sizeof sound);
		for (uint64_t n = 1 + random_below(&random, 4); n > 0; n--) {
			size_t at = random_below(&random, length);
			char letter = (char)random_below(&random, 256);
			if (random_below(&random, 2)) letter = spice[random_below(&random, sizeof spice)];
			uint64_t how = random_below(&random, 3);
			if (how == 1) memmove(text + at + 1, text + at, length++ - at);
			if (how == 2) memmove(text + at, text + at + 1, --length - at);
			if (how < 2) text[at] = letter;
		}
		put(text, length);
		struct query_file file;
		char error[400] = "";
		if (query_file_read(path, &file, error)) {
			for (size_t i = 0; i < file.count; i++) assert_true(file.query[i].line >= 1 && file.query[i].line < 16);
			query_file_free(&file);
			continue;
		}
		refused++;
		assert_true(strncmp(error, path, strlen(path)) == 0);
		assert_null(strchr(error, '\n'));
	}
	print_message("%d of %d refused\n", refused, TRIALS);
	assert_true(refused > TRIALS / 4 && refused < TRIALS);
}

static void shapes_have_names(void **state)
{
	(void)state;
	enum touchstone_shape shape;
	for (int s = 0; s < TOUCHSTONE_SHAPES; s++) {
		assert_true(shape_named(shape_name((enum touchstone_shape)s), &shape) && (int)shape == s);
		assert_in_range(shape_numbers(shape), 2, TOUCHSTONE_MOST_NUMBERS);
	}
	assert_false(shape_named("ball", &shape));
}

static int make_folder(void **state)
{
	(void)state;
	folder = folder_new();
	return asprintf(&path, "%s/queries.txt", folder) > 0 ? 0 : -1;
}

static int remove_folder(void **state)
{
	(void)state;
	free(path);
	folder_remove(folder);
	return 0;
}

int main(void)
{
	printf("seed %llu\n", (unsigned long long)seed);
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(written_and_read_is_the_same),
		cmocka_unit_test(damaged_files_do_no_harm),
		cmocka_unit_test(countries_do_not_matter),
		cmocka_unit_test(files_are_read_as_people_write_them),
		cmocka_unit_test(bad_files_are_refused),
		cmocka_unit_test(missing_files_are_said),
		cmocka_unit_test(shapes_have_names),
	};
	return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
