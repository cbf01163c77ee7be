/* Coverage-guided fuzzing says what it lacks, and ends with the status that says so. */
#include "own_folder.h"
#include "program.h"

static const char few[] = "sh sed dirname basename nproc make";

/* Runs verify/fuzz/coverage where there are but a few programs. What it says is in `said`, for the caller to free.
 */
static int run(const char *arguments, char **said)
{
	char command[1000];
	snprintf(command, sizeof command,
			 "mkdir -p %s/bin && for program in %s; do ln -sf \"$(command -v $program)\" %s/bin; done; "
			 "PATH=%s/bin verify/fuzz/coverage %s 2>%s/said >&2",
			 folder, few, folder, folder, arguments, folder);
	int status = system(command);
	*said = folder_text(folder, "said");
	assert_true(WIFEXITED(status));
	return WEXITSTATUS(status);
}

static void a_missing_fuzzer_is_skipped(void **state)
{
	(void)state;
	static const struct {
		const char *arguments, *words;
	} missing[] = {
		{"afl 10", "fuzz: skipped, for afl-clang-fast -fsanitize=fuzzer does not work here"},
		{"libfuzzer", "fuzz: skipped, for clang -fsanitize=fuzzer does not work here"},
		{"", "fuzz: skipped, for clang -fsanitize=fuzzer does not work here"},
	};
	for (size_t m = 0; m < sizeof missing / sizeof *missing; m++) {
		char *said;
		int status = run(missing[m].arguments, &said);
		if (status != 77 || !strstr(said, missing[m].words)) fail_msg("status %d: %s", status, said);
		free(said);
	}
}

static void wrong_words_are_refused(void **state)
{
	(void)state;
	static const char *const wrong[] = {"honggfuzz 10", "afl ten", "afl 0", "afl ''"};
	for (size_t w = 0; w < sizeof wrong / sizeof *wrong; w++) {
		char *said;
		int status = run(wrong[w], &said);
		if (status != 2 || !strstr(said, "; accepted: ")) fail_msg("status %d: %s", status, said);
		free(said);
	}
}

int main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(a_missing_fuzzer_is_skipped),
		cmocka_unit_test(wrong_words_are_refused),
	};
	return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
