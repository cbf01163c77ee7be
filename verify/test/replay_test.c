/* Replaying a question: exact coefficients, and the table as a user sees it. */
#include "measure/exact_steps.h"

#include "oracle_inputs.h"
#include "program.h"

/* Whether a line of the text begins with `start` and has all the words, each behind the one before. */
static bool has_line(const char *text, const char *start, const char *const words[])
{
	for (const char *line = text; line; line = strchr(line, '\n'), line += line != NULL) {
		if (strncmp(line, start, strlen(start)) != 0) continue;
		const char *at = line, *end = line + strcspn(line, "\n");
		while (*words && (at = strstr(at, *words)) && at < end) words++;
		if (!*words) return true;
	}
	return false;
}

static void check_step(const struct exact_steps *steps, enum exact_step step, double value)
{
	int off = below(100) + 2;
	assert_true(exact_step_error(steps->value[step], value) == 0);
	if (value == 0) return;
	double farther = value > 0 ? steps_away(value, off) : steps_away(value, -off);
	double error = exact_step_error(steps->value[step], farther);
	if (error < off || error > 2 * off) fail_msg("%a and %a: %g, not %d ulp", value, farther, error, off);
}

/* Whole numbers make whole coefficients, which doubles compute exactly; powers of two move all exponents. */
static void coefficients_are_exact(void **state)
{
	(void)state;
	for (int round = 0; round < 20000; round++) {
		double number[TOUCHSTONE_MOST_NUMBERS], length = ldexp(1, below(200) - 100), speed = ldexp(1, below(200) - 100);
		for (int i = 0; i < TOUCHSTONE_MOST_NUMBERS; i++) number[i] = below(2001) - 1000;
		const double *r = number, *v = number + 3, s = number[6];
		double a = v[0] * v[0] + v[1] * v[1] + v[2] * v[2], b = r[0] * v[0] + r[1] * v[1] + r[2] * v[2];
		double c = r[0] * r[0] + r[1] * r[1] + r[2] * r[2] - s * s;
		double scaled[TOUCHSTONE_MOST_NUMBERS];
		for (int i = 0; i < TOUCHSTONE_MOST_NUMBERS; i++) scaled[i] = number[i] * (i < 3 || i == 6 ? length : speed);
		struct exact_steps steps;
		exact_steps_init(&steps, below(2) ? TOUCHSTONE_BALL_BALL : TOUCHSTONE_BALL_LEAVE, scaled);
		check_step(&steps, STEP_A, a * speed * speed);
		check_step(&steps, STEP_B, b * length * speed);
		check_step(&steps, STEP_C, c * length * length);
		check_step(&steps, STEP_DISCRIMINANT, (b * b - a * c) * length * length * speed * speed);
		exact_steps_clear(&steps);

		exact_steps_init(&steps, TOUCHSTONE_BALL_PLANE, number);
		check_step(&steps, STEP_A, number[2]);
		check_step(&steps, STEP_B, number[1]);
		check_step(&steps, STEP_C, number[0] - number[3]);
		check_step(&steps, STEP_DISCRIMINANT, number[1] * number[1] - 2 * number[2] * (number[0] - number[3]));
		exact_steps_clear(&steps);
	}
}

static void errors_at_the_edges(void **state)
{
	(void)state;
	mpq_t exact;
	mpq_init(exact);
	assert_true(exact_step_error(exact, 0) == 0);
	assert_true(exact_step_error(exact, 3 * 0x1p-1074) == 3);
	assert_true(exact_step_error(exact, -INFINITY) == INFINITY && isnan(exact_step_error(exact, NAN)));
	mpq_set_ui(exact, 1, 3);
	assert_true(fabs(exact_step_error(exact, 1.0 / 3) - 1.0 / 3) < 1e-12);
	mpq_div_2exp(exact, exact, 1073); /* a third of the second subnormal number */
	assert_true(fabs(exact_step_error(exact, 0x1p-1074) - 1.0 / 3) < 1e-12);
	mpq_set_ui(exact, 1, 1);
	mpq_mul_2exp(exact, exact, 1100); /* beyond all doubles */
	assert_true(fabs(exact_step_error(exact, 0x1p1023) / 0x1p52 - 1) < 1e-12);
	mpq_clear(exact);
}

static void a_question_is_taken_apart(void **state)
{
	(void)state;
	struct said said = program_run("replay ball-ball 3 0 0 -0x1p0 0 0 1");
	if (said.status != 0) fail_msg("status %d: %s", said.status, said.err);
	assert_non_null(
		strstr(said.out, "ball-ball 0x1.8p+1 0x0p+0 0x0p+0 -0x1p+0 0x0p+0 0x0p+0 0x1p+0\n  3 0 0 -1 0 0 1\n"));
	assert_true(has_line(said.out, "  a = v.v ", (const char *const[]){" 1", NULL}));
	assert_true(has_line(said.out, "  b = r.v ", (const char *const[]){" -3", NULL}));
	assert_true(has_line(said.out, "  c = r.r - contact^2 ", (const char *const[]){" 8", NULL}));
	assert_true(has_line(said.out, "  D = b^2 - a c ", (const char *const[]){" 1", NULL}));
	assert_non_null(strstr(said.out, "exactly: later, at t = 2, the double 0x1p+1\n"));
	static const char *const arithmetics[] = {"short:12", "binary32", "binary64", "twin", "binary128", "mpfr:200"};
	for (size_t a = 0; a < sizeof arithmetics / sizeof *arithmetics; a++)
		assert_true(has_line(said.out, "  stable ", (const char *const[]){arithmetics[a], " 0x1p+1 ", " 0", NULL}));
	said_free(&said);
}

static void other_shapes_are_taken_apart(void **state)
{
	(void)state;
	static const struct {
		const char *question, *line, *words[4];
	} cases[] = {
		{"ball-leave 0 0 0 1 0 0 2", "  exactly: later, at t = 2", {NULL}},
		{"ball-plane 2 0 -1 0", "  c = distance - contact", {"2", NULL}},
		{"ball-plane 2 0 -1 0", "  D = b^2 - 2 a c", {"4", NULL}},
		{"ball-plane 2 0 -1 0", "  stable", {"binary64", "0x1p+1", "0", NULL}},
		{"half-space 1 -4", "  stable", {"binary64", "0x1p-2", "0", NULL}},
		{"half-space 1 4", "  exactly: no event", {NULL}},
		{"half-space -1 -4", "  exactly: now", {NULL}},
		{"half-space 1 inf", "  exactly: undefined", {NULL}},
		{"ball-ball nan 0 0 1 0 0 1", "  exactly: undefined", {NULL}},
	};
	for (size_t c = 0; c < sizeof cases / sizeof *cases; c++) {
		struct said said = program_run("replay --method stable --arithmetic binary64 %s", cases[c].question);
		if (said.status != 0 || !has_line(said.out, cases[c].line, cases[c].words))
			fail_msg("%s: status %d: %s%s", cases[c].question, said.status, said.out, said.err);
		assert_null(strstr(said.out, "mpfr"));
		said_free(&said);
	}
}

static void files_are_replayed_line_by_line(void **state)
{
	(void)state;
	char *folder = folder_new();
	folder_put(folder, "two.txt", "# a file\nhalf-space 1 -4 # the first\n\nball-ball 3 0 0 -1 0 0 1\n");
	folder_put(folder, "bad.txt", "half-space 1 -4\nhalf-space one two\n");
	struct said said = program_run("replay %s/two.txt --method stable", folder);
	assert_int_equal(said.status, 0);
	const char *first = strstr(said.out, "half-space 0x1p+0 -0x1p+2 # the first\n");
	assert_true(first == said.out && strstr(first, "\n\nball-ball 0x1.8p+1"));
	said_free(&said);
	program_refused(program_run("replay %s/bad.txt", folder), "bad.txt:2: ");
	program_refused(program_run("replay %s/none.txt", folder), "none.txt");
	folder_remove(folder);
}

static void bad_usage_is_one_line(void **state)
{
	(void)state;
	static const struct {
		const char *arguments, *words;
	} wrong[] = {
		{"", "nothing to replay"},
		{"half-space 1", "1 numbers; accepted: 2"},
		{"half-space 1 2 3", "'3' is too much"},
		{"half-space 1 0x1g", "'0x1g' is no number"},
		{"half-space 1 1e999", "too large"},
		{"no-such-file", "no-such-file"},
		{"half-space 1 2 --method fastest", "fastest"},
		{"half-space 1 2 --arithmetic decimal", "decimal"},
		{"half-space 1 2 --arithmetic mpfr:1", "mpfr:P from 2 to 1024"},
		{"some.txt other.txt", "'other.txt' is too much"},
	};
	for (size_t w = 0; w < sizeof wrong / sizeof *wrong; w++)
		program_refused(program_run("replay %s", wrong[w].arguments), wrong[w].words);
}

int main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(coefficients_are_exact),          cmocka_unit_test(errors_at_the_edges),
		cmocka_unit_test(a_question_is_taken_apart),       cmocka_unit_test(other_shapes_are_taken_apart),
		cmocka_unit_test(files_are_replayed_line_by_line), cmocka_unit_test(bad_usage_is_one_line),
	};
	seed_inputs();
	int failed = cmocka_run_group_tests(tests, NULL, NULL);
	mpfr_free_cache();
	return failed;
}
