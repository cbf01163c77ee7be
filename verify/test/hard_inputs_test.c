/* cases/hard-inputs.txt: every answer is the oracle's, every line has a source, and all that there is to be hard about
 * is in it. */
#include "family_inputs.h"

static struct query_file file;

static void check_line(bool holds, const struct query *query, const char *what)
{
	if (!holds) fail_msg("hard-inputs.txt:%ld: %s: %s", query->line, what, query->comment ? query->comment : "");
}

/* The part of a comment after a word such as "source: ", up to the next semicolon, into `found`. */
static bool part_of(const char *comment, const char *word, char found[200])
{
	const char *start = comment ? strstr(comment, word) : NULL;
	if (!start) return false;
	start += strlen(word);
	snprintf(found, 200, "%.*s", (int)strcspn(start, ";"), start);
	return *found != '\0';
}

static void answers_are_exact(void **state)
{
	(void)state;
	struct oracle *oracles[] = {oracle_create(), oracle_create()};
	assert_true(oracles[0] && oracles[1]);
	oracle_force_exact(oracles[1], true);
	for (size_t i = 0; i < file.count; i++)
		for (int way = 0; way < 2; way++) {
			const struct query *query = &file.query[i];
			char answer[200], wanted[200];
			struct oracle_query asked = query_of(query->shape, query->number);
			check_line(oracle_accepts(&asked), query, "not finite");
			struct oracle_time time = oracle_solve(oracles[way], &asked);
			if (time.event == ORACLE_LATER)
				snprintf(wanted, sizeof wanted, "%a", oracle_round(oracles[way], &time, MPFR_RNDN));
			else
				snprintf(wanted, sizeof wanted, "%s", time.event == ORACLE_NOW ? "now" : "never");
			bool stated = query->comment && strncmp(query->comment, "exact ", 6) == 0;
			check_line(stated && part_of(query->comment, "exact ", answer), query, "no exact answer");
			if (strcmp(answer, wanted) != 0)
				fail_msg("hard-inputs.txt:%ld: '%s' is stated, exact is '%s'", query->line, answer, wanted);
		}
	oracle_destroy(oracles[0]);
	oracle_destroy(oracles[1]);
}

/* What is said to be drawn from a family is, to the last bit. */
static void sources_are_true(void **state)
{
	(void)state;
	size_t drawn = 0;
	for (size_t i = 0; i < file.count; i++) {
		const struct query *query = &file.query[i];
		char source[200], name[64];
		uint64_t seed, number;
		check_line(part_of(query->comment, "; source: ", source), query, "no source");
		if (strncmp(source, "family ", 7) != 0) continue;
		int read = sscanf(source, "family %63[^,], seed %" SCNu64 ", number %" SCNu64, name, &seed, &number);
		check_line(read == 3 && family_named(name), query, "no such family");
		numbers again;
		fill(family_named(name), query->shape, seed, number, 1, &again);
		check_line(memcmp(again, query->number, sizeof again) == 0, query, "not what the family has there");
		check_line(strstr(query->comment, "; breaks: "), query, "breaks nothing");
		drawn++;
	}
	assert_true(drawn >= 40);
}

/* What is said to break a method in binary64 does, in the way that is said. */
static void methods_are_broken(void **state)
{
	(void)state;
	struct oracle *oracle = oracle_create();
	assert_non_null(oracle);
	size_t broken = 0, wrong = 0;
	for (size_t i = 0; i < file.count; i++) {
		const struct query *query = &file.query[i];
		char words[200], method[64], error[160];
		int behind = 0;
		if (!part_of(query->comment, "; breaks: ", words)) continue;
		check_line(sscanf(words, "%63[^,], %n", method, &behind) == 1 && behind, query, "no method and no fault");
		const char *fault = words + behind;
		numbers asked;
		double got, stated;
		memcpy(asked, query->number, sizeof asked);
		if (!touchstone_find("binary64", method, query->shape, (const numbers *)&asked, 1, true, &got, error))
			fail_msg("hard-inputs.txt:%ld: %s", query->line, error);
		struct oracle_query exact = query_of(query->shape, query->number);
		struct oracle_time time = oracle_solve(oracle, &exact);
		bool never = time.event == ORACLE_NEVER, holds;
		if (strcmp(fault, "missed") == 0)
			holds = !never && got == INFINITY;
		else if (strcmp(fault, "phantom") == 0)
			holds = never && got < INFINITY;
		else if (strcmp(fault, "negative") == 0)
			holds = got < 0;
		else if (strcmp(fault, "not a number") == 0)
			holds = isnan(got);
		else
			holds = sscanf(fault, "%lf ulp", &stated) == 1 && oracle_error(oracle, &time, got) > 0.9 * stated;
		if (!holds) print_message("hard-inputs.txt:%ld: %s is not '%s': %a\n", query->line, method, fault, got);
		wrong += !holds;
		broken++;
	}
	oracle_destroy(oracle);
	assert_int_equal(wrong, 0);
	assert_true(broken >= 40);
}

static size_t lines_with(const char *words, int shape)
{
	size_t lines = 0;
	for (size_t i = 0; i < file.count; i++)
		lines += strstr(file.query[i].comment, words) && (shape < 0 || (int)file.query[i].shape == shape);
	return lines;
}

static void nothing_is_left_out(void **state)
{
	(void)state;
	for (int s = 0; s < TOUCHSTONE_SHAPES; s++) assert_true(lines_with("exact", s) >= 10);
	for (int number = 1; number <= 13; number++) {
		char words[40];
		snprintf(words, sizeof words, "; source: quadratic %d", number);
		if (lines_with(words, -1) == 0) fail_msg("quadratic %d is not asked", number);
	}
	static const char *const methods[] = {"stable",           "naive",   "guarded", "numerical-recipes", "kahan",
										  "textbook-epsilon", "sterbenz"};
	for (size_t m = 0; m < sizeof methods / sizeof *methods; m++) {
		char words[60];
		snprintf(words, sizeof words, "; breaks: %s, ", methods[m]);
		if (lines_with(words, -1) == 0) fail_msg("nothing breaks %s", methods[m]);
	}
	assert_true(lines_with("exact now", -1) > 5 && lines_with("exact never", -1) > 5 &&
				lines_with("exact inf", -1) > 1);
}

static int open_file(void **state)
{
	(void)state;
	char error[400];
	bool read = query_file_read(TOUCHSTONE_CASES "/hard-inputs.txt", &file, error);
	if (!read) print_error("%s\n", error);
	return read ? 0 : -1;
}

static int close_file(void **state)
{
	(void)state;
	query_file_free(&file);
	return 0;
}

int main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(answers_are_exact),
		cmocka_unit_test(sources_are_true),
		cmocka_unit_test(methods_are_broken),
		cmocka_unit_test(nothing_is_left_out),
	};
	int failed = cmocka_run_group_tests(tests, open_file, close_file);
	mpfr_free_cache();
	return failed;
}
