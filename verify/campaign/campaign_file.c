#include "campaign/campaign_file.h"

#include <cyaml/cyaml.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "campaign/yaml_flow.h"
#include "command/cases.h"
#include "command/run_measures.h"
#include "command/simulation.h"
#include "store/yaml_schema.h"

/* `set`, `grid` and `seeds` are read from the document itself: their keys are those of a scene. */
struct campaign_words {
	char *title, *about, *scene, *events, *time, *against, **measures;
	unsigned measures_count;
};

static const cyaml_schema_value_t measure = {CYAML_VALUE_STRING(CYAML_FLAG_POINTER, char, 0, CYAML_UNLIMITED)};

enum { WORD = CYAML_FLAG_POINTER | CYAML_FLAG_OPTIONAL };
static const cyaml_schema_field_t fields[] = {
	CYAML_FIELD_STRING_PTR("title", WORD, struct campaign_words, title, 0, CYAML_UNLIMITED),
	CYAML_FIELD_STRING_PTR("about", WORD, struct campaign_words, about, 0, CYAML_UNLIMITED),
	CYAML_FIELD_STRING_PTR("scene", WORD, struct campaign_words, scene, 0, CYAML_UNLIMITED),
	CYAML_FIELD_IGNORE("set", CYAML_FLAG_OPTIONAL),
	CYAML_FIELD_IGNORE("grid", CYAML_FLAG_OPTIONAL),
	CYAML_FIELD_IGNORE("seeds", CYAML_FLAG_OPTIONAL),
	CYAML_FIELD_STRING_PTR("events", WORD, struct campaign_words, events, 0, CYAML_UNLIMITED),
	CYAML_FIELD_STRING_PTR("time", WORD, struct campaign_words, time, 0, CYAML_UNLIMITED),
	CYAML_FIELD_STRING_PTR("against", WORD, struct campaign_words, against, 0, CYAML_UNLIMITED),
	CYAML_FIELD_SEQUENCE("measures", WORD, struct campaign_words, measures, &measure, 0, 100),
	CYAML_FIELD_END};
static const cyaml_schema_value_t schema = {CYAML_VALUE_MAPPING(CYAML_FLAG_POINTER, struct campaign_words, fields)};

struct campaign_source {
	struct yaml_text text;
	struct campaign_words *words;
};

__attribute__((format(printf, 4, 5))) static bool refuse(const struct campaign_file *file, char *error, const char *key,
														 const char *format, ...)
{
	size_t line;
	va_list arguments;
	yaml_text_locate(&file->source->text, key, &line);
	va_start(arguments, format);
	yaml_text_blame(&file->source->text, line, key, error, format, arguments);
	va_end(arguments);
	return false;
}

/* The value of one of the file's own keys; NULL where it is not given. */
static yaml_node_t *member(const struct campaign_file *file, const char *key)
{
	const struct yaml_text *text = &file->source->text;
	const yaml_node_t *root = yaml_document_get_root_node((yaml_document_t *)&text->document);
	for (yaml_node_pair_t *pair = root->data.mapping.pairs.start; pair < root->data.mapping.pairs.top; pair++)
		if (strcmp(yaml_text_word(yaml_text_node(text, pair->key)), key) == 0) return yaml_text_node(text, pair->value);
	return NULL;
}

/* KEY=VALUE of a node; NULL, with a message about `place`, when it cannot be one. */
static char *setting(const struct campaign_file *file, const char *place, const char *key, const yaml_node_t *value,
					 char *error)
{
	char *flow = yaml_flow(&file->source->text, value), *whole = NULL;
	if (!flow)
		refuse(file, error, place, "more than can be said on one line; accepted: a value, a list, a mapping");
	else if (asprintf(&whole, "%s=%s", key, flow) < 0)
		whole = NULL;
	free(flow);
	return whole;
}

static bool add_setting(struct campaign_file *file, char *whole)
{
	if (whole) file->settings[file->setting_count++] = whole;
	return whole;
}

/* A key of the scene, written out; `seed` belongs to `seeds`. */
static bool check_key(const struct campaign_file *file, const char *place, const yaml_node_t *key, char *error)
{
	if (key->type != YAML_SCALAR_NODE) return refuse(file, error, place, "a key that is no word; accepted: words");
	return strcmp(yaml_text_word(key), "seed") != 0 || refuse(file, error, place, "has a seed; accepted: in `seeds`");
}

/* What all points have in common. */
static bool read_settings(struct campaign_file *file, char *error)
{
	const struct yaml_text *text = &file->source->text;
	const struct campaign_words *words = file->source->words;
	const yaml_node_t *set = member(file, "set");
	if (set && set->type != YAML_MAPPING_NODE)
		return refuse(file, error, "set", "not a mapping; accepted: keys of the scene, such as {particles: 500}");
	size_t count = set ? (size_t)(set->data.mapping.pairs.top - set->data.mapping.pairs.start) : 0;
	file->settings = calloc(count + 2, sizeof *file->settings);
	if (!file->settings) return refuse(file, error, "set", "out of memory");
	for (size_t s = 0; s < count; s++) {
		const yaml_node_pair_t *pair = &set->data.mapping.pairs.start[s];
		const yaml_node_t *key = yaml_text_node(text, pair->key);
		if (!check_key(file, "set", key, error) ||
			!add_setting(file, setting(file, "set", yaml_text_word(key), yaml_text_node(text, pair->value), error)))
			return false;
	}
	const char *const limits[2][2] = {{"events", words->events}, {"time", words->time}};
	for (int l = 0; l < 2; l++) {
		char *whole;
		if (limits[l][1] &&
			!add_setting(file, asprintf(&whole, "%s=%s", limits[l][0], limits[l][1]) < 0 ? NULL : whole))
			return refuse(file, error, limits[l][0], "out of memory");
	}
	return true;
}

static bool read_axis(struct campaign_file *file, struct campaign_axis *axis, const yaml_node_pair_t *pair, char *error)
{
	const struct yaml_text *text = &file->source->text;
	const yaml_node_t *key = yaml_text_node(text, pair->key), *values = yaml_text_node(text, pair->value);
	if (!check_key(file, "grid", key, error)) return false;
	char place[YAML_PATH];
	snprintf(place, sizeof place, "grid.%.100s", yaml_text_word(key));
	size_t count = 0;
	if (values->type == YAML_SEQUENCE_NODE)
		count = (size_t)(values->data.sequence.items.top - values->data.sequence.items.start);
	if (count == 0) return refuse(file, error, place, "no list of values; accepted: a list, such as [0.1, 0.5]");
	axis->key = strdup(yaml_text_word(key));
	axis->settings = calloc(count, sizeof *axis->settings);
	if (!axis->key || !axis->settings) return refuse(file, error, place, "out of memory");
	for (; axis->count < count; axis->count++) {
		const yaml_node_t *value = yaml_text_node(text, values->data.sequence.items.start[axis->count]);
		char *whole = setting(file, place, axis->key, value, error);
		if (!whole) return false;
		axis->settings[axis->count] = whole;
		for (size_t before = 0; before < axis->count; before++)
			if (strcmp(axis->settings[before], whole) == 0) {
				char shown[TEXT_SHOWN];
				axis->count++; /* so that it is freed */
				return refuse(file, error, place, "'%s' is there twice; accepted: once",
							  text_shown(shown, campaign_setting_value(whole)));
			}
	}
	if (file->points > CAMPAIGN_MOST_PIECES / count)
		return refuse(file, error, place, "makes a grid of more than %d points", CAMPAIGN_MOST_PIECES);
	file->points *= count;
	return true;
}

static bool read_grid(struct campaign_file *file, char *error)
{
	const yaml_node_t *grid = member(file, "grid");
	if (grid && grid->type != YAML_MAPPING_NODE)
		return refuse(file, error, "grid", "not a mapping; accepted: keys of the scene with lists of values");
	size_t count = grid ? (size_t)(grid->data.mapping.pairs.top - grid->data.mapping.pairs.start) : 0;
	file->axes = calloc(count + 1, sizeof *file->axes);
	file->points = 1;
	if (!file->axes) return refuse(file, error, "grid", "out of memory");
	while (file->axis_count < count) {
		size_t axis = file->axis_count++;
		if (!read_axis(file, &file->axes[axis], &grid->data.mapping.pairs.start[axis], error)) return false;
	}
	return true;
}

/* Adds the seeds of one word: a number, or FIRST..LAST. */
static bool add_seeds(struct campaign_file *file, const char *word, char *error)
{
	char shown[TEXT_SHOWN], first_word[40];
	const char *dots = strstr(word, "..");
	uint64_t first, last;
	snprintf(first_word, sizeof first_word, "%.*s", dots ? (int)(dots - word) : 39, word);
	bool fits = text_count(first_word, &first) && text_count(dots ? dots + 2 : word, &last) && first <= last;
	if (!fits || last > INT64_MAX)
		return refuse(file, error, "seeds", "'%s'; accepted: whole numbers below 2^63, such as 1..20 or [1, 5, 9]",
					  text_shown(shown, word));
	if (last - first >= CAMPAIGN_MOST_PIECES / file->points - file->seed_count)
		return refuse(file, error, "seeds", "makes more than %d runs on a grid of %zu", CAMPAIGN_MOST_PIECES,
					  file->points);
	for (size_t s = 0; s < file->seed_count; s++)
		if (first <= file->seeds[s] && file->seeds[s] <= last)
			return refuse(file, error, "seeds", "%llu is there twice; accepted: once",
						  (unsigned long long)file->seeds[s]);
	size_t count = file->seed_count + (size_t)(last - first) + 1;
	uint64_t *longer = realloc(file->seeds, count * sizeof *longer);
	if (!longer) return refuse(file, error, "seeds", "out of memory");
	file->seeds = longer;
	while (file->seed_count < count) file->seeds[file->seed_count++] = first++;
	return true;
}

static bool read_seeds(struct campaign_file *file, char *error)
{
	const yaml_node_t *seeds = member(file, "seeds");
	if (!seeds) return add_seeds(file, "1", error);
	if (seeds->type == YAML_SCALAR_NODE) return add_seeds(file, yaml_text_word(seeds), error);
	if (seeds->type == YAML_MAPPING_NODE)
		return refuse(file, error, "seeds", "a mapping; accepted: 1..20 or [1, 5, 9]");
	const yaml_node_item_t *item = seeds->data.sequence.items.start;
	for (; item < seeds->data.sequence.items.top; item++) {
		const yaml_node_t *node = yaml_text_node(&file->source->text, *item);
		if (!add_seeds(file, node->type == YAML_SCALAR_NODE ? yaml_text_word(node) : "a list", error)) return false;
	}
	return file->seed_count > 0 || refuse(file, error, "seeds", "none; accepted: 1..20 or [1, 5, 9]");
}

static bool read_measures(struct campaign_file *file, char *error)
{
	const struct campaign_words *words = file->source->words;
	for (unsigned m = 0; m < words->measures_count; m++) {
		char place[40], shown[TEXT_SHOWN], names[RUN_MEASURE_NAMES];
		unsigned measure = run_measure_named(words->measures[m]);
		snprintf(place, sizeof place, "measures[%u]", m);
		if (!measure)
			return refuse(file, error, place, "'%s' is unknown; accepted: %s", text_shown(shown, words->measures[m]),
						  run_measure_names(names));
		file->measures |= measure;
	}
	file->against = words->against;
	return true;
}

static bool find_scene(struct campaign_file *file, const char *path, const char *cases, char *error)
{
	const char *name = file->source->words->scene, *slash = strrchr(path, '/');
	char *beside = NULL;
	if (!name) return refuse(file, error, "scene", "not given; accepted: a scene file, or a case by its name");
	if (*name != '/' && slash && asprintf(&beside, "%.*s/%s", (int)(slash - path), path, name) < 0) beside = NULL;
	if (beside) file->scene = cases_find(cases, beside);
	free(beside);
	if (!file->scene) file->scene = cases_find(cases, name);
	char shown[TEXT_SHOWN];
	return file->scene || refuse(file, error, "scene",
								 "'%s': no such file, nor a case in %.100s; accepted: a scene file, "
								 "or a name that `touchstone list cases` has",
								 text_shown(shown, name), cases);
}

/* Passes on what is wrong with a scene, and says which key of the campaign it comes from. */
static bool blame(const struct campaign_file *file, size_t point, const char *wrong, char *error)
{
	char place[YAML_PATH] = "scene", start[STORE_ERROR], shown[TEXT_SHOWN];
	for (size_t axis = 0; axis < file->axis_count; axis++) {
		size_t choice = campaign_file_choice(file, point, axis);
		snprintf(start, sizeof start, "--set %s", file->axes[axis].settings[choice]);
		text_shown(shown, start);
		if (strncmp(wrong, shown, strlen(shown)) != 0) continue;
		snprintf(place, sizeof place, "grid.%.90s[%zu]", file->axes[axis].key, choice);
		wrong += strlen(shown);
	}
	for (size_t s = 0; s < file->setting_count; s++) {
		snprintf(start, sizeof start, "--set %s", file->settings[s]);
		text_shown(shown, start);
		if (strncmp(wrong, shown, strlen(shown)) != 0) continue;
		size_t length = strcspn(file->settings[s], "=");
		bool own = strncmp(file->settings[s], "events=", 7) == 0 || strncmp(file->settings[s], "time=", 5) == 0;
		snprintf(place, sizeof place, "%s%.*s", own ? "" : "set.", (int)(length < 90 ? length : 90), file->settings[s]);
		wrong += strlen(shown);
	}
	return refuse(file, error, place, "%s", *wrong == ':' ? wrong + 2 : wrong);
}

/* Every point of the grid must be a scene that some limit brings to an end. */
static bool check_points(const struct campaign_file *file, char *error)
{
	const char **settings = calloc(file->setting_count + file->axis_count + 1, sizeof *settings);
	char wrong[STORE_ERROR] = "";
	bool good = settings;
	for (size_t point = 0; good && point < file->points; point++) {
		struct scene_file *scene = campaign_file_scene(file, point, settings, wrong);
		good = scene && simulation_names(scene, wrong);
		if (!good) blame(file, point, wrong, error);
		if (good && file->against && !horizon_possible(scene->arithmetic, file->against, wrong))
			good = refuse(file, error, "against", "%s", wrong);
		if (good && scene->limits.events == UINT64_MAX && scene->limits.time == INFINITY)
			good = refuse(file, error, "events", "not given, nor in the scene; accepted: events, time, or both");
		scene_file_close(scene);
	}
	if (!settings) refuse(file, error, "grid", "out of memory");
	free(settings);
	return good;
}

static bool understand(struct campaign_file *file, const char *path, const char *cases, char *error)
{
	struct campaign_source *source = file->source;
	if (!source->words) return refuse(file, error, "", "empty; accepted: scene, grid, seeds, events, measures");
	file->title = source->words->title ? source->words->title : file->name;
	file->about = source->words->about ? source->words->about : "";
	return read_measures(file, error) && find_scene(file, path, cases, error) && read_settings(file, error) &&
		   read_grid(file, error) && read_seeds(file, error) && check_points(file, error);
}

/* The name becomes that of files and pages. */
static bool name_it(struct campaign_file *file, const char *path, char *error)
{
	const char *slash = strrchr(path, '/'), *base = slash ? slash + 1 : path;
	file->name = strndup(base, strcspn(base, "."));
	if (!file->name) return snprintf(error, STORE_ERROR, "out of memory"), false;
	bool fits = *file->name && !file->name[strspn(file->name, "abcdefghijklmnopqrstuvwxyz0123456789-_")];
	char shown[TEXT_SHOWN];
	if (!fits)
		snprintf(error, STORE_ERROR, "%s: a campaign's results go by its name; accepted: a to z, digits, '-', '_'",
				 text_shown(shown, path));
	return fits;
}

struct campaign_file *campaign_file_open(const char *path, const char *cases, char error[STORE_ERROR])
{
	struct campaign_file *file = calloc(1, sizeof *file);
	struct campaign_source *source = file ? calloc(1, sizeof *source) : NULL;
	cyaml_data_t *data = NULL;
	if (!source || !yaml_text_read(&source->text, path, error)) {
		if (!source) snprintf(error, STORE_ERROR, "out of memory");
		free(source);
		free(file);
		return NULL;
	}
	file->source = source;
	bool good = name_it(file, path, error) && yaml_schema_load(&source->text, &schema, &data, error);
	source->words = data;
	if (good && understand(file, path, cases, error)) return file;
	campaign_file_close(file);
	return NULL;
}

static void free_all(char **strings, size_t count)
{
	for (size_t s = 0; s < count; s++) free(strings[s]);
	free(strings);
}

void campaign_file_close(struct campaign_file *file)
{
	if (!file) return;
	for (size_t axis = 0; axis < file->axis_count; axis++) {
		free(file->axes[axis].key);
		free_all(file->axes[axis].settings, file->axes[axis].count);
	}
	free(file->axes);
	free_all(file->settings, file->setting_count);
	free(file->seeds);
	free(file->scene);
	free(file->name);
	if (file->source->words) yaml_schema_free(&schema, file->source->words);
	yaml_text_close(&file->source->text);
	free(file->source);
	free(file);
}

size_t campaign_file_choice(const struct campaign_file *file, size_t point, size_t axis)
{
	for (size_t faster = file->axis_count; --faster > axis;) point /= file->axes[faster].count;
	return point % file->axes[axis].count;
}

const char *campaign_setting_value(const char *setting)
{
	return setting + strcspn(setting, "=") + 1;
}

struct scene_file *campaign_file_scene(const struct campaign_file *file, size_t point, const char **settings,
									   char error[STORE_ERROR])
{
	size_t count = 0;
	for (; count < file->setting_count; count++) settings[count] = file->settings[count];
	for (size_t axis = 0; axis < file->axis_count; axis++)
		settings[count++] = file->axes[axis].settings[campaign_file_choice(file, point, axis)];
	return scene_file_open(file->scene, count, settings, error);
}
