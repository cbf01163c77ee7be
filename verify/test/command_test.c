/* The command line, as a user meets it: what it says, where it says it, and its exit status. */
#include <sys/stat.h>

#include "family/family.h"
#include "own_folder.h"
#include "program.h"
#include "result.h"
#include "touchstone.h"

#define GAS "run hard-spheres --set particles=64 --set equilibrate=2"

static void every_command_helps(void **state)
{
	(void)state;
	static const char *const commands[] = {"",        "list ",  "run ",      "reproduce ", "grade ", "chart ",
										   "replay ", "audit ", "campaign ", "merge ",     "report "};
	for (size_t c = 0; c < sizeof commands / sizeof *commands; c++) {
		struct said help = program_run("%s--help", commands[c]), version = program_run("%s--version", commands[c]);
		char usage[64];
		snprintf(usage, sizeof usage, "Usage: touchstone %s[OPTION...]", commands[c]);
		if (help.status != 0 || !strstr(help.out, usage) || !strstr(help.out, "Example: touchstone "))
			fail_msg("%shelp: status %d: %s", commands[c], help.status, help.out);
		assert_string_equal(help.err, "");
		if (version.status != 0 || strncmp(version.out, "touchstone ", 11) != 0)
			fail_msg("%sversion: status %d: %s", commands[c], version.status, version.out);
		said_free(&help);
		said_free(&version);
	}
	struct said said = program_run("%s", "");
	assert_int_equal(said.status, 2);
	assert_non_null(strstr(said.err, "Usage: touchstone [OPTION...] COMMAND"));
	said_free(&said);
}

static void listings_are_complete(void **state)
{
	(void)state;
	struct said all = program_run("list"), methods = program_run("list methods"), cases = program_run("list cases");
	struct said arithmetics = program_run("list arithmetics"), figures = program_run("list figures");
	struct said families = program_run("list families");
	const char *const parts[] = {methods.out, cases.out, arithmetics.out, families.out, figures.out};
	for (int p = 0; p < 5; p++) {
		assert_non_null(strstr(all.out, parts[p]));
		char *rest, *copy = strdup(parts[p]);
		for (char *line = strtok_r(copy, "\n", &rest); line; line = strtok_r(NULL, "\n", &rest)) {
			char name[64], about[200] = "";
			if (sscanf(line, " %63s %199[^\n]", name, about) != 2 || strlen(about) < 5)
				fail_msg("listed bare: %s", line);
		}
		free(copy);
	}
	const char *name;
	for (size_t n = 0; (name = touchstone_finder_name(n)); n++) assert_non_null(strstr(methods.out, name));
	for (size_t n = 0; (name = touchstone_method_name(n)); n++) assert_non_null(strstr(methods.out, name));
	for (size_t n = 0; (name = touchstone_arithmetic_name(n)); n++) assert_non_null(strstr(arithmetics.out, name));
	const struct family *family;
	for (size_t n = 0; (family = family_at(n)); n++) assert_non_null(strstr(families.out, family->name));
	assert_non_null(strstr(families.out, "harvested; ball-ball ball-plane half-space\n"));
	assert_int_equal(program_lines(cases.out), folder_count("cases", ".yaml") + folder_count("cases/stress", ".yaml"));
	assert_non_null(strstr(cases.out, "  stress/corner"));
	assert_non_null(strstr(cases.out, "bouncing-ball"));
	struct said *const said[] = {&all, &methods, &cases, &arithmetics, &families, &figures};
	for (int s = 0; s < 6; s++) {
		assert_int_equal(said[s]->status, 0);
		said_free(said[s]);
	}

	folder_put(folder, "good.yaml", "title: Nothing to see\ndimensions: 1\nparticles: 2\ndensity: 0.1\n");
	folder_put(folder, "spoilt.yaml", "particels: 2\n");
	struct said mixed = program_run("list cases --cases %s", folder);
	assert_int_equal(mixed.status, 2);
	assert_non_null(strstr(mixed.out, "Nothing to see"));
	assert_non_null(strstr(mixed.err, "spoilt.yaml:1: "));
	said_free(&mixed);
	program_refused(program_run("list shapes"), "cases, methods, arithmetics, families, figures");
	program_refused(program_run("list cases --cases %s/none", folder), "none: cannot be read");
}

static void reports_are_made_from_results(void **state)
{
	(void)state;
	char *results, error[REPORT_ERROR];
	assert_true(asprintf(&results, "%s/results", folder) > 0);
	program_refused(program_run("report --results %s --output %s/report", results, folder), "cannot be read");
	struct result *result = result_new("nothing", "Nothing at all");
	result_paragraph(result, "Said for the sake of a page.");
	result_made_by(result, "touchstone", 0, NULL);
	if (!result_write(result, results, error)) fail_msg("%s", error);
	result_free(result);
	struct said said = program_run("report --results %s --output %s/report", results, folder);
	if (said.status != 0) fail_msg("status %d: %s", said.status, said.err);
	assert_non_null(strstr(said.out, "/report/index.html\n"));
	said.out[strlen(said.out) - 1] = '\0';
	assert_int_equal(access(said.out, R_OK), 0);
	said_free(&said);
	program_refused(program_run("report index.html"), "is too much");
	free(results);
}

static void bad_usage_is_one_line(void **state)
{
	(void)state;
	static const struct {
		const char *arguments, *words;
	} wrong[] = {
		{"assay", "no command 'assay'; accepted: list, run, reproduce, grade, chart, fuzz, replay, audit, campaign"},
		{"run", "no scene"},
		{"run cradle column", "second scene"},
		{"run nowhere.yaml", "nowhere.yaml: no such file"},
		{"run cases", "cases: no such file"},
		{"run hard-spheres --set densty=1", "--set densty=1: unknown key 'densty'; accepted: "},
		{"run hard-spheres --set density", "--set density"},
		{"run hard-spheres --set density=2", "close packing"},
		{"run hard-spheres --set restitution=1.5", "0 to 1"},
		{"run hard-spheres --set particles=0", "particles: '0'"},
		{"run hard-spheres --set start.temperature=nan", "'nan'"},
		{"run hard-spheres --events -1", "events: '-1'"},
		{"run hard-spheres --events 1e6x", "events: '1e6x'"},
		{"run hard-spheres --time -1", "time: '-1'"},
		{"run hard-spheres --seed 1.5", "seed: '1.5'"},
		{"run hard-spheres --seed 18446744073709551615", "seed: 18446744073709551615; accepted:"},
		{"run hard-spheres --runs 0", "--runs: '0'; accepted: a whole number, 1 to"},
		{"run hard-spheres --threads many", "--threads: 'many'"},
		{"run hard-spheres --measure impact,colour", "--measure: 'colour'; accepted: impact, conservation"},
		{"run hard-spheres --method fast", "method: no method 'fast'; known are stable, naive, guarded"},
		{"run hard-spheres --arithmetic decimal", "arithmetic: no arithmetic 'decimal'; known are"},
		{"run hard-spheres --arithmetic mpfr:0", "mpfr:P from 2 to 1024"},
		{"run hard-spheres --arithmetic mpfr:99999", "mpfr:P from 2 to 1024"},
		{"run hard-spheres --arithmetic mpfr:-53", "mpfr:P from 2 to 1024"},
		{"run hard-spheres --arithmetic mpfr:99999999999999999999", "mpfr:P from 2 to 1024"},
		{"run hard-spheres --arithmetic short:99", "short:P takes P from 4 to 25"},
		{"run hard-spheres --arithmetic binary64:24", "the others no number"},
		{"reproduce fig99", "no figure 'fig99'; accepted: "},
	};
	for (size_t w = 0; w < sizeof wrong / sizeof *wrong; w++)
		program_refused(program_run("%s", wrong[w].arguments), wrong[w].words);
	static const char *const unknown[] = {"--frob",       "list --frob",   "run --frob",   "reproduce --frob",
										  "grade --frob", "replay --frob", "audit --frob", "report --frob"};
	for (int u = 0; u < 7; u++) {
		struct said said = program_run("%s", unknown[u]);
		if (said.status != 2 || !strstr(said.err, "unrecognized option '--frob'"))
			fail_msg("%s: status %d: %s", unknown[u], said.status, said.err);
		assert_string_equal(said.out, "");
		said_free(&said);
	}
}

static void bad_scenes_have_a_line(void **state)
{
	(void)state;
	folder_put(folder, "bad.yaml", "dimensions: 3\nparticles: 64\ndensity: 0.5\nmethod: magic\n");
	program_refused(program_run("run %s/bad.yaml", folder), "/bad.yaml:4: method: no method 'magic'");
	folder_put(folder, "bad.yaml",
			   "dimensions: 1\nboundaries: [open]\nbodies:\n  - position: [0]\n  - position: [0.5]\n");
	program_refused(program_run("run %s/bad.yaml", folder), "overlap");
}

static void unwritable_output_leaves_nothing(void **state)
{
	(void)state;
	char *pipe; /* stands for all that is no file, and would be lost if it were replaced by one */
	assert_true(asprintf(&pipe, "%s/pipe", folder) > 0);
	assert_int_equal(mkfifo(pipe, 0600), 0);
	int before = folder_count(folder, "");
	program_refused(program_run(GAS " --events 10 --json %s", folder), folder);
	program_refused(program_run(GAS " --events 10 --json %s/none/run.json", folder), "cannot be written");
	program_refused(program_run(GAS " --events 10 --xyz %s/none/end.xyz", folder), "cannot be written");
	program_refused(program_run(GAS " --events 10 --json %s", pipe), "/pipe: not a file");
	program_refused(program_run(GAS " --events 10 --xyz %s", pipe), "/pipe: not a file");
	program_refused(program_run_to("/dev/full", GAS " --events 10 --json -"), "standard output: cannot be written");
	program_refused(program_run_to("/dev/full", "list"), "standard output: cannot be written");
	program_refused(program_run_to("/dev/full", "run --help"), "standard output: cannot be written");
	if (!getenv("TOUCHSTONE_MEMCHECK")) /* there valgrind's own file takes the place of what is closed */
		program_refused(program_run_to("", "list"), "standard output: cannot be written");
	assert_int_equal(folder_count(folder, ""), before);
	struct stat there;
	assert_true(stat(pipe, &there) == 0 && S_ISFIFO(there.st_mode));
	free(pipe);
}

int main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(every_command_helps),           cmocka_unit_test(listings_are_complete),
		cmocka_unit_test(reports_are_made_from_results), cmocka_unit_test(bad_usage_is_one_line),
		cmocka_unit_test(bad_scenes_have_a_line),        cmocka_unit_test(unwritable_output_leaves_nothing),
	};
	return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
