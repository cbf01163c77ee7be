/* The checks of a suite: which scene, finder or figure, and whether there is such a thing. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "audit/suite_source.h"
#include "command/cases.h"
#include "command/command.h"
#include "command/simulation.h"
#include "family/family.h"
#include "store/query_file.h"

/* The settings of a scene: those of `set`, then the keys that have words of their own. */
static bool take_settings(const struct suite_place *place, const struct check_words *words, struct suite_check *check)
{
	const struct {
		const char *key, *value;
	} own[] = {{"events", words->events}, {"method", words->method}, {"arithmetic", words->arithmetic}};
	check->settings = calloc(words->set_count + 4, sizeof *check->settings);
	bool good = check->settings;
	for (unsigned s = 0; good && s < words->set_count; s++)
		good = (check->settings[check->setting_count++] = strdup(words->set[s]));
	for (int k = 0; good && k < 3; k++)
		if (own[k].value)
			good = asprintf(&check->settings[check->setting_count++], "%s=%s", own[k].key, own[k].value) > 0;
	return good || suite_refuse(place, "", "out of memory");
}

struct scene_file *suite_scene(const struct suite_check *check, const char *arithmetic, char error[STORE_ERROR])
{
	char setting[TEXT_SHOWN + 12], **settings = calloc(check->setting_count + 1, sizeof *settings);
	struct scene_file *file = NULL;
	snprintf(error, STORE_ERROR, "out of memory");
	snprintf(setting, sizeof setting, "arithmetic=%.*s", TEXT_SHOWN, arithmetic ? arithmetic : "");
	if (settings) {
		memcpy(settings, check->settings, check->setting_count * sizeof *settings);
		settings[check->setting_count] = setting;
		file = scene_file_open(check->scene, check->setting_count + (arithmetic != NULL), (const char *const *)settings,
							   error);
	}
	free(settings);
	if (!file || simulation_names(file, error)) return file;
	scene_file_close(file);
	return NULL;
}

static bool understand_scene(const struct suite_place *place, const struct check_words *words, const char *cases,
							 struct suite_check *check)
{
	char error[STORE_ERROR], shown[TEXT_SHOWN];
	if (!(check->scene = cases_find(cases, words->scene)))
		return suite_refuse(place, "scene", "'%s' is no file, nor a case in %.80s; accepted: a scene",
							text_shown(shown, words->scene), cases);
	if (!take_settings(place, words, check)) return false;
	struct scene_file *file = suite_scene(check, NULL, error);
	if (!file) return suite_refuse(place, "scene", "%s", error);
	bool limited = file->limits.events < UINT64_MAX || file->limits.time < INFINITY;
	scene_file_close(file);
	return limited ||
		   suite_refuse(place, "events", "missing, and the scene sets no limit; accepted: how many to execute");
}

static bool understand_grade(const struct suite_place *place, const struct check_words *words,
							 struct suite_check *check)
{
	char why[160], shown[TEXT_SHOWN];
	check->method = words->grade;
	check->arithmetic = words->arithmetic ? words->arithmetic : "binary64";
	if (!words->family)
		return suite_refuse(place, "family", "missing; accepted: one that `touchstone list families` has");
	if (!(check->family = family_named(words->family)))
		return suite_refuse(place, "family", "'%s'; accepted: one that `touchstone list families` has",
							text_shown(shown, words->family));
	if (words->shape && !shape_named(words->shape, &check->shape))
		return suite_refuse(place, "shape", "'%s'; accepted: ball-ball, ball-leave, ball-plane, half-space",
							text_shown(shown, words->shape));
	if (!(check->family->shapes & 1u << check->shape))
		return suite_refuse(place, "shape", "family %s has no questions of %s; accepted: a shape that it has",
							check->family->name, shape_name(check->shape));
	if (!touchstone_find(check->arithmetic, check->method, check->shape, NULL, 0, false, NULL, why))
		return suite_refuse(place, "grade", "%s", why);
	check->cases = 100000;
	return suite_count(place, "cases", words->cases, 100, 100000000, &check->cases);
}

static bool understand_figure(const struct suite_place *place, const struct check_words *words,
							  struct suite_check *check)
{
	char shown[TEXT_SHOWN];
	check->figure = words->figure;
	check->full = words->size && strcmp(words->size, "full") == 0;
	if (words->size && !check->full && strcmp(words->size, "quick") != 0)
		return suite_refuse(place, "size", "'%s'; accepted: quick, full", text_shown(shown, words->size));
	for (const struct figure_entry *figure = figures; figure->name; figure++)
		if (strcmp(figure->name, words->figure) == 0) return true;
	return suite_refuse(place, "figure", "'%s'; accepted: one that `touchstone list figures` has",
						text_shown(shown, words->figure));
}

/* Keys that mean nothing for this kind of check would be overlooked by whoever wrote them. */
static bool refuse_strangers(const struct suite_place *place, const struct check_words *words, enum check_kind kind)
{
	const struct {
		const char *key;
		const void *word;
		unsigned kinds; /* bit 1 << kind for those that it belongs to */
	} keys[] = {{"events", words->events, 1},         {"set", words->set, 1},       {"method", words->method, 1},
				{"arithmetic", words->arithmetic, 3}, {"family", words->family, 2}, {"shape", words->shape, 2},
				{"cases", words->cases, 2},           {"size", words->size, 4}};
	static const char *const kinds[CHECK_KINDS] = {"scene", "grade", "figure"};
	for (size_t k = 0; k < sizeof keys / sizeof *keys; k++)
		if (keys[k].word && !(keys[k].kinds & 1u << kind))
			return suite_refuse(place, keys[k].key, "means nothing beside `%s`; accepted: nothing", kinds[kind]);
	return true;
}

static bool define(const struct suite_place *place, const struct check_words *words, struct suite_check *check)
{
	size_t size;
	FILE *stream = open_memstream(&check->definition, &size);
	if (!stream) return suite_refuse(place, "", "out of memory");
	if (check->kind == CHECK_SCENE) fprintf(stream, "scene %s", words->scene);
	for (size_t s = 0; s < check->setting_count; s++) fprintf(stream, " %s", check->settings[s]);
	if (check->kind == CHECK_GRADE)
		fprintf(stream, "grade %s in %s, %s, %s, %llu cases", check->method, check->arithmetic, check->family->name,
				shape_name(check->shape), (unsigned long long)check->cases);
	if (check->kind == CHECK_FIGURE) fprintf(stream, "figure %s%s", check->figure, check->full ? " at full size" : "");
	fprintf(stream, ", %llu seeds", (unsigned long long)check->seeds);
	return fclose(stream) == 0 || suite_refuse(place, "", "out of memory");
}

/* Names become addresses of pages. */
static bool is_name(const char *name)
{
	return *name && strlen(name) <= 60 && !name[strspn(name, "abcdefghijklmnopqrstuvwxyz0123456789-_")];
}

bool suite_check_understand(const struct suite_place *place, const struct check_words *words, const char *cases,
							struct suite_check *check)
{
	char shown[TEXT_SHOWN];
	if (!words->name || !is_name(words->name))
		return suite_refuse(place, "name", "'%s'; accepted: letters a to z, digits, '-' and '_', up to 60",
							text_shown(shown, words->name ? words->name : ""));
	if ((words->scene != NULL) + (words->grade != NULL) + (words->figure != NULL) != 1)
		return suite_refuse(place, "", "accepted: one of scene, grade and figure");
	*check = (struct suite_check){.name = words->name, .weight = 1, .seeds = 1, .own_seed = words->seed != NULL};
	check->kind = words->scene ? CHECK_SCENE : words->grade ? CHECK_GRADE : CHECK_FIGURE;
	if (!refuse_strangers(place, words, check->kind) ||
		!suite_number(place, "weight", words->weight, 0, 1e9, &check->weight) ||
		!suite_count(place, "seeds", words->seeds, 1, check->kind == CHECK_FIGURE ? 1 : SAMPLE_MOST, &check->seeds) ||
		!suite_count(place, "seed", words->seed, 0, 1000000000000, &check->seed))
		return false;
	if (check->kind == CHECK_SCENE   ? !understand_scene(place, words, cases, check)
		: check->kind == CHECK_GRADE ? !understand_grade(place, words, check)
									 : !understand_figure(place, words, check))
		return false;
	return define(place, words, check) && suite_measures_understand(place, words, check);
}
