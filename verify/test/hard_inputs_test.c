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
	static const char *const methods[] = {"stable", "naive",   "guarded", "numerical-recipes",
										  "kahan",  "epsilon", "sterbenz"};
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
		cmocka_unit_test(nothing_is_left_out),
	};
	int failed = cmocka_run_group_tests(tests, open_file, close_file);
	mpfr_free_cache();
	return failed;
}
