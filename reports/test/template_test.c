/* Templates: whatever the values, what is printed is text and no markup. */
#include "template.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include <cmocka.h>

static char *rendered(const struct template *templates, json_t *context)
{
	char *text = NULL;
	size_t size = 0;
	FILE *stream = open_memstream(&text, &size);
	template_write(stream, templates, "page", context);
	fclose(stream);
	json_decref(context);
	return text;
}

static void expect(const char *page, const char *context, const char *expected)
{
	struct template templates[] = {{"page", page}, {"part", "({{a}})\n"}, {NULL, NULL}};
	json_error_t fault;
	json_t *values = json_loads(context, 0, &fault);
	assert_non_null(values);
	char *text = rendered(templates, values);
	assert_string_equal(text, expected);
	free(text);
}

/* The text that a browser shows for escaped text. */
static void unescape(char *text)
{
	static const char *const entities[][2] = {
		{"&amp;", "&"}, {"&lt;", "<"}, {"&gt;", ">"}, {"&quot;", "\""}, {"&#39;", "'"}};
	char *out = text;
	while (*text) {
		size_t i = 0;
		while (i < 5 && strncmp(text, entities[i][0], strlen(entities[i][0])) != 0) i++;
		*out++ = i < 5 ? *entities[i][1] : *text;
		text += i < 5 ? strlen(entities[i][0]) : 1;
	}
	*out = '\0';
}

static void any_text_is_shown_as_it_is(void **state)
{
	(void)state;
	unsigned seed = (unsigned)time(NULL);
	print_message("seed %u\n", seed);
	static const char alphabet[] = "<>&\"'{}#/^ax;";
	for (int trial = 0; trial < 20000; trial++) {
		char value[24] = "";
		size_t length = (size_t)rand_r(&seed) % (sizeof value - 1);
		for (size_t i = 0; i < length; i++) value[i] = alphabet[(size_t)rand_r(&seed) % (sizeof alphabet - 1)];
		const struct template templates[] = {{"page", "{{a}}"}, {NULL, NULL}};
		char *text = rendered(templates, json_pack("{s: s}", "a", value));
		assert_null(strpbrk(text, "<>\"'"));
		unescape(text);
		assert_string_equal(text, value);
		free(text);
	}
}

static void sections_follow_their_values(void **state)
{
	(void)state;
	expect("{{#a}}yes{{/a}}{{^a}}no{{/a}}", "{\"a\": \"x\"}", "yes");
	expect("{{#a}}yes{{/a}}{{^a}}no{{/a}}", "{\"a\": \"\"}", "no");
	expect("{{#a}}yes{{/a}}{{^a}}no{{/a}}", "{\"a\": []}", "no");
	expect("{{#a}}yes{{/a}}{{^a}}no{{/a}}", "{\"a\": false}", "no");
	expect("{{#a}}yes{{/a}}{{^a}}no{{/a}}", "{}", "no");
	expect("{{#a}}[{{.}}]{{/a}}", "{\"a\": [\"<\", 2, 0.5]}", "[&lt;][2][0.5]");
	expect("{{#a}}{{b}}{{c}} {{/a}}", "{\"c\": 9, \"a\": [{\"b\": 1}, {\"b\": 2, \"c\": 3}]}", "19 23 ");
	expect("{{#a}}{{#a}}{{b}}{{/a}}!{{/a}}", "{\"a\": {\"a\": {\"b\": 1}}}", "1!");
	expect("a\n{{#a}}\nb\n{{/a}}\nc", "{\"a\": true}", "a\nb\nc");
	expect("{{>part}}|{{b}}", "{\"a\": 1}", "(1)\n|");
}

static void unfinished_tags_are_text(void **state)
{
	(void)state;
	expect("a {{b", "{\"b\": 1}", "a {{b");
	expect("{{#a}}b", "{\"a\": true}", "b");
}

static void control_characters_vanish(void **state)
{
	(void)state;
	expect("{{a}}", "{\"a\": \"x\\u0001y\\tz\"}", "x y\tz");
}

int main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(any_text_is_shown_as_it_is),
		cmocka_unit_test(sections_follow_their_values),
		cmocka_unit_test(unfinished_tags_are_text),
		cmocka_unit_test(control_characters_vanish),
	};
	return cmocka_run_group_tests(tests, NULL, NULL);
}
