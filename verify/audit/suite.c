#include "audit/suite.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "audit/suite_source.h"
#include "store/yaml_schema.h"

bool suite_refuse(const struct suite_place *place, const char *key, const char *format, ...)
{
	char path[YAML_PATH];
	size_t line;
	snprintf(path, sizeof path, "%.90s%s%.30s", place->path, *place->path && *key ? "." : "", key);
	yaml_text_locate(&place->source->text, path, &line);
	va_list arguments;
	va_start(arguments, format);
	yaml_text_blame(&place->source->text, line, path, place->error, format, arguments);
	va_end(arguments);
	return false;
}

bool suite_number(const struct suite_place *place, const char *key, const char *word, double least, double most,
				  double *value)
{
	char shown[TEXT_SHOWN];
	double number;
	if (!word) return true;
	if (!text_number(word, &number) || number < least || number > most)
		return suite_refuse(place, key, "'%s'; accepted: a number, %g to %g", text_shown(shown, word), least, most);
	*value = number;
	return true;
}

bool suite_count(const struct suite_place *place, const char *key, const char *word, uint64_t least, uint64_t most,
				 uint64_t *value)
{
	char shown[TEXT_SHOWN];
	uint64_t count;
	if (!word) return true;
	if (!text_count(word, &count) || count < least || count > most)
		return suite_refuse(place, key, "'%s'; accepted: a whole number, %llu to %llu", text_shown(shown, word),
							(unsigned long long)least, (unsigned long long)most);
	*value = count;
	return true;
}

static int by_weight(const void *a, const void *b)
{
	const struct suite_check *one = a, *other = b;
	if (one->weight != other->weight) return one->weight < other->weight ? 1 : -1;
	return strcmp(one->name, other->name);
}

static bool understand(struct suite *suite, const char *cases, char error[STORE_ERROR])
{
	const struct suite_words *words = suite->source->words;
	struct suite_place place = {.source = suite->source, .error = error};
	suite->title = words->title ? words->title : suite->name;
	suite->about = words->about ? words->about : "";
	suite->false_alarms = 1e-3;
	if (!suite_number(&place, "false_alarms", words->false_alarms, 1e-9, 0.1, &suite->false_alarms)) return false;
	if (!words->checks) return suite_refuse(&place, "", "no checks; accepted: checks, a list");
	suite->checks = calloc(words->checks_count, sizeof *suite->checks);
	if (!suite->checks) return suite_refuse(&place, "", "out of memory");
	for (unsigned c = 0; c < words->checks_count; c++) {
		snprintf(place.path, sizeof place.path, "checks[%u]", c);
		suite->check_count++;
		if (!suite_check_understand(&place, &words->checks[c], cases, &suite->checks[c])) return false;
		for (unsigned before = 0; before < c; before++)
			if (strcmp(suite->checks[before].name, suite->checks[c].name) == 0)
				return suite_refuse(&place, "name", "'%s' is another check's; accepted: a name of its own",
									suite->checks[c].name);
	}
	qsort(suite->checks, suite->check_count, sizeof *suite->checks, by_weight);
	return true;
}

static bool read_text(struct suite_source *source, const char *path, char error[STORE_ERROR])
{
	cyaml_data_t *data = NULL;
	if (!yaml_text_read(&source->text, path, error)) return false;
	source->read = true;
	if (!yaml_schema_load(&source->text, &suite_schema, &data, error)) return false;
	source->words = data;
	return data || yaml_text_refuse(&source->text, 1, "", error, "empty; accepted: checks, a list");
}

struct suite *suite_open(const char *path, const char *cases, char error[STORE_ERROR])
{
	struct suite *suite = calloc(1, sizeof *suite);
	if (suite) suite->source = calloc(1, sizeof *suite->source);
	if (suite) suite->name = text_stem(path);
	if (!suite || !suite->source || !suite->name)
		snprintf(error, STORE_ERROR, "out of memory");
	else if (read_text(suite->source, path, error) && understand(suite, cases, error))
		return suite;
	suite_close(suite);
	return NULL;
}

void suite_close(struct suite *suite)
{
	if (!suite) return;
	for (size_t c = 0; c < suite->check_count; c++) {
		struct suite_check *check = &suite->checks[c];
		for (size_t s = 0; s < check->setting_count; s++) free(check->settings[s]);
		free(check->settings);
		free(check->scene);
		free(check->measures);
		free(check->definition);
	}
	free(suite->checks);
	if (suite->source && suite->source->words) yaml_schema_free(&suite_schema, suite->source->words);
	if (suite->source && suite->source->read) yaml_text_close(&suite->source->text);
	free(suite->source);
	free(suite->name);
	free(suite);
}
