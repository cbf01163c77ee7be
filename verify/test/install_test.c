/* An installed tree: what is in it, programs that embed the library, completion, and that nothing is left of it after.
 */
#include "program.h"

#define TREE "/opt/touchstone"

static char *folder;   /* the DESTDIR */
static char *words[2]; /* what the last command of the shell said, and nothing */

/* Runs a command of the shell; what it wrote, which lasts until the next call. Fails unless it succeeds. */
__attribute__((format(printf, 1, 2))) static const char *shell(const char *format, ...)
{
	char *command, *whole;
	va_list list;
	va_start(list, format);
	bool enough = vasprintf(&command, format, list) >= 0;
	va_end(list);
	if (!enough || asprintf(&whole, "(%s) >%s/said 2>&1 </dev/null", command, folder) < 0) abort();
	int status = system(whole);
	free(words[0]);
	words[0] = folder_text(folder, "said");
	if (status != 0) fail_msg("status %d of %s: %s", status, command, words[0]);
	free(command);
	free(whole);
	return words[0];
}

static bool there(const char *program)
{
	char command[100];
	snprintf(command, sizeof command, "command -v %s >/dev/null", program);
	bool found = system(command) == 0;
	if (!found) print_message("skipped: no %s\n", program);
	return found;
}

/* The folder in which this was built, for the make that installs it. */
static const char *build(void)
{
	static char path[200];
	snprintf(path, sizeof path, "%.*s", (int)(strrchr(TOUCHSTONE_PROGRAM, '/') - TOUCHSTONE_PROGRAM),
			 TOUCHSTONE_PROGRAM);
	return path;
}

static void make(const char *goal)
{
	shell("unset MAKEFLAGS MAKELEVEL MFLAGS; make -s %s BUILD=%s DESTDIR=%s PREFIX=" TREE, goal, build(), folder);
}

static void everything_is_installed(void **state)
{
	(void)state;
	static const char *const files[] = {"bin/touchstone",
										"include/touchstone.h",
										"lib/libtouchstone.a",
										"lib/libtouchstone.so",
										"lib/pkgconfig/touchstone.pc",
										"share/touchstone/cases/hard-spheres.yaml",
										"share/touchstone/cases/campaigns/restitution-density.yaml",
										"share/bash-completion/completions/touchstone"};
	for (size_t f = 0; f < sizeof files / sizeof *files; f++) {
		char path[300];
		snprintf(path, sizeof path, "%s" TREE "/%s", folder, files[f]);
		if (access(path, R_OK) != 0) fail_msg("no %s", files[f]);
	}
	if (access(TOUCHSTONE_MPI, F_OK) == 0)
		shell("test -x %s" TREE "/lib/touchstone/touchstone-mpi.so -o -r %s" TREE "/lib/touchstone/touchstone-mpi.so",
			  folder, folder);
	shell("cmp lib/touchstone.h %s" TREE "/include/touchstone.h", folder);
}

/* Both libraries show what touchstone.h declares, and nothing else. */
static void only_public_names_are_seen(void **state)
{
	(void)state;
	static const char *const libraries[] = {"nm -D --defined-only %s" TREE "/lib/libtouchstone.so",
											"nm -g --defined-only %s" TREE "/lib/libtouchstone.a"};
	for (int l = 0; l < 2; l++) {
		char *command, *line, *rest;
		size_t names = 0;
		if (asprintf(&command, libraries[l], folder) < 0) abort();
		char *text = strdup(shell("%s", command));
		free(command);
		for (line = strtok_r(text, "\n", &rest); line; line = strtok_r(NULL, "\n", &rest)) {
			const char *name = strrchr(line, ' ');
			if (!name || !strstr(line, " T ")) continue;
			if (strncmp(name + 1, "touchstone_", 11) != 0)
				fail_msg("%s shows%s", l ? "the archive" : "the shared one", name);
			names++;
		}
		free(text);
		assert_true(names >= 20);
	}
	shell("objdump -p %s" TREE "/lib/libtouchstone.so | grep 'SONAME *libtouchstone.so.[0-9]*$'", folder);
}

/* The program of the README, by what pkg-config says, against the shared and against the static library. Two balls on a
 * ring of length 8 meet at t = 1 and then every 6. */
static void programs_embed_the_library(void **state)
{
	(void)state;
	if (!there("pkg-config")) skip();
	const char *set = "export PKG_CONFIG_PATH=%s" TREE "/lib/pkgconfig PKG_CONFIG_SYSROOT_DIR=%s; "
					  "cc -std=c11 -Wall -Wextra -Wpedantic -Werror %s -o %s/embed verify/test/embed/embed.c "
					  "$(pkg-config --cflags --libs %s touchstone) && LD_LIBRARY_PATH=%s %s/embed";
	char path[300];
	snprintf(path, sizeof path, "%s" TREE "/lib", folder);
	for (int fixed = 0; fixed < 2; fixed++) {
		char *command;
		if (asprintf(&command, set, folder, folder, fixed ? "-static" : "", folder, fixed ? "--static" : "",
					 fixed ? "/nowhere" : path, folder) < 0)
			abort();
		assert_string_equal(shell("%s", command), "100 collisions by t = 595\n");
		free(command);
	}
	char *program = folder_text("verify/test/embed", "embed.c"), *readme = folder_text(".", "README.md");
	if (!strstr(readme, program)) fail_msg("the README shows another program than verify/test/embed/embed.c");
	free(program);
	free(readme);
}

static void the_installed_program_finds_its_cases(void **state)
{
	(void)state;
	shell("cd / && %s" TREE "/bin/touchstone run cradle --events 10 --json - | grep '" TREE
		  "/.*share/touchstone/cases/cradle'",
		  folder);
	shell("cd / && %s" TREE "/bin/touchstone list campaigns | grep restitution-density", folder);
}

static void commands_have_manual_pages(void **state)
{
	(void)state;
	if (!there("help2man")) skip();
	shell("for command in $(%s --help | sed -n '/^ Commands:/,/^$/s/^  \\([a-z]*\\)  .*/\\1/p'); do "
		  "grep -A1 '^.SH NAME' %s" TREE
		  "/share/man/man1/touchstone-$command.1 | grep \"^touchstone-$command .- [A-Z]\" || "
		  "exit 1; done; grep '^touchstone .- numerical' %s" TREE "/share/man/man1/touchstone.1",
		  TOUCHSTONE_PROGRAM, folder, folder);
}

static void assert_completes(const char *typed, const char *expected)
{
	const char *offered =
		shell("bash -c 'source %s" TREE "/share/bash-completion/completions/touchstone && COMP_WORDS=(%s %s) && "
			  "COMP_CWORD=$((${#COMP_WORDS[@]} - 1)) && _touchstone; echo \"${COMPREPLY[*]}\"'",
			  folder, TOUCHSTONE_PROGRAM, typed);
	if (strncmp(offered, expected, strlen(expected)) != 0 || strcmp(offered + strlen(expected), "\n") != 0)
		fail_msg("'%s' is offered '%s', not '%s'", typed, offered, expected);
}

static void completion_offers_what_there_is(void **state)
{
	(void)state;
	if (!there("bash")) skip();
	assert_completes("camp", "campaign");
	assert_completes("run hard-s", "hard-spheres");
	assert_completes("run --arithm", "--arithmetic");
	assert_completes("run --method nai", "naive");
	assert_completes("run --method = nai", "naive");
	assert_completes("run --measure thr", "three-body");
	assert_completes("run hard-spheres --arithmetic bin", "binary32 binary64 binary128");
	assert_completes("campaign rest", "restitution-density");
	assert_completes("reproduce fig7", "fig7");
	assert_completes("grade --family graz", "grazing");
	assert_completes("list camp", "campaigns");
	assert_completes("merge x", "");
}

static void uninstalled_is_gone(void **state)
{
	(void)state;
	make("uninstall");
	assert_string_equal(shell("find %s/opt ! -type d", folder), "");
}

static int set_up(void **state)
{
	(void)state;
	folder = folder_new();
	make("install");
	return 0;
}

static int tear_down(void **state)
{
	(void)state;
	folder_remove(folder);
	free(words[0]);
	return 0;
}

int main(void)
{
#ifdef __SANITIZE_ADDRESS__
	print_message("skipped: what is installed is built without sanitizers\n");
	return 0;
#endif
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(everything_is_installed),    cmocka_unit_test(only_public_names_are_seen),
		cmocka_unit_test(programs_embed_the_library), cmocka_unit_test(the_installed_program_finds_its_cases),
		cmocka_unit_test(commands_have_manual_pages), cmocka_unit_test(completion_offers_what_there_is),
		cmocka_unit_test(uninstalled_is_gone), /* last */
	};
	return cmocka_run_group_tests(tests, set_up, tear_down);
}
