/* What the README tells others to put into their pipelines: every word of it is accepted, and in its place. */
#include "program.h"
#include "store/yaml_text.h"

static char *readme;

/* The fenced block of a language, which the caller frees. */
static char *block(const char *language)
{
	char fence[20];
	snprintf(fence, sizeof fence, "\n```%s\n", language);
	const char *begin = strstr(readme, fence);
	if (!begin) fail_msg("no block of %s", language);
	begin += strlen(fence);
	return strndup(begin, (size_t)(strstr(begin, "```") - begin));
}

/* Every `touchstone audit ...` and `touchstone report --history ...` is one that the program takes. */
static void commands_are_taken(void **state)
{
	(void)state;
	unsigned count = 0;
	for (const char *at = readme; (at = strstr(at, "build/touchstone ")); at++) {
		const char *words = at + strlen("build/touchstone ");
		size_t length = strcspn(words, "\n&|>#`'");
		if (strncmp(words, "audit ", 6) != 0 && strncmp(words, "report --history", 16) != 0) continue;
		char line[300] = "", *date;
		snprintf(line, sizeof line, "%.*s", (int)length, words);
		if ((date = strstr(line, "$(date"))) { /* what the shell makes of it; systemd wants its $ doubled */
			char *quote = date > line && strchr("\"$", date[-1]) ? date - 1 : date, *close = strchr(date, ')');
			char rest[300];
			snprintf(rest, sizeof rest, "20261122%s", close + 1 + (close[1] == '"'));
			snprintf(quote, sizeof line - (size_t)(quote - line), "%s", rest);
		}
		struct said said = program_run("%s --help", line);
		if (said.status != 0) fail_msg("%s: %s", line, said.err);
		said_free(&said);
		count++;
	}
	assert_true(count >= 6);
}

/* Five fields of time, and a command that a shell can read; cron takes a bare % for a line's end. */
static void the_line_for_cron_is_sound(void **state)
{
	(void)state;
	char *line = block("cron"), command[600], *to = command;
	int begin = 0;
	assert_true(sscanf(line, "%*[0-9*] %*[0-9*] %*[0-9*] %*[0-9*] %*[0-9*] %n", &begin) == 0 && begin > 10);
	for (const char *from = line + begin; *from && *from != '\n'; from++) {
		assert_true(*from != '%' || from[-1] == '\\');
		if (from[0] != '\\' || from[1] != '%') *to++ = *from;
	}
	*to = '\0';
	char *checked;
	assert_true(asprintf(&checked, "sh -n <<'END'\n%s\nEND\n", command) > 0);
	assert_int_equal(system(checked), 0);
	free(checked);
	free(line);
}

/* A unit and its timer; systemd itself is asked where it is installed. */
static void the_units_are_sound(void **state)
{
	(void)state;
	char *units = block("ini"), *timer = strstr(units, "# touchstone-audit.timer"), *folder = folder_new(), *command;
	assert_true(timer && strstr(units, "[Service]") < timer && strstr(timer, "[Timer]"));
	folder_put(folder, "touchstone-audit.timer", timer);
	*timer = '\0';
	folder_put(folder, "touchstone-audit.service", units);
	assert_true(asprintf(&command,
						 "! command -v systemd-analyze >/dev/null || "
						 "systemd-analyze verify %s/touchstone-audit.service %s/touchstone-audit.timer >%s/said 2>&1",
						 folder, folder, folder) > 0);
	int status = system(command);
	char *said = folder_text(folder, "said");
	if (status != 0 || (said && strstr(said, "touchstone-audit"))) fail_msg("%d: %s", status, said ? said : "");
	free(said);
	free(command);
	free(units);
	folder_remove(folder);
}

static void the_pipeline_is_yaml(void **state)
{
	(void)state;
	char *text = block("yaml"), *folder = folder_new(), path[200], error[STORE_ERROR];
	size_t line;
	struct yaml_text yaml;
	folder_put(folder, "pipeline.yaml", text);
	snprintf(path, sizeof path, "%s/pipeline.yaml", folder);
	if (!yaml_text_read(&yaml, path, error)) fail_msg("%s", error);
	assert_true(yaml_text_locate(&yaml, "audit.script[1]", &line));
	assert_true(yaml_text_locate(&yaml, "audit.artifacts.reports.junit", &line));
	yaml_text_close(&yaml);
	free(text);
	folder_remove(folder);
}

static int set_up(void **state)
{
	(void)state;
	readme = folder_text(".", "README.md"); /* tests run in the top folder */
	return readme ? 0 : -1;
}

static int tear_down(void **state)
{
	(void)state;
	free(readme);
	return 0;
}

int main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(commands_are_taken),
		cmocka_unit_test(the_line_for_cron_is_sound),
		cmocka_unit_test(the_units_are_sound),
		cmocka_unit_test(the_pipeline_is_yaml),
	};
	return cmocka_run_group_tests(tests, set_up, tear_down);
}
