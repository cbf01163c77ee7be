#include "command/campaign_table.h"

#include <gsl/gsl_statistics_double.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "command/run_measures.h"

/* What runs come to, of which points tell how many did: their verdicts, and two more that not every campaign finds out.
 */
enum { VERDICTS = 4, SURVIVED = VERDICTS, NEVER_PARTED, ENDINGS };
static const char *const endings[ENDINGS] = {"done", "collapsed", "halted", "diverged", "survived", "never parted"};

static bool finds_out(const struct campaign_file *file, int ending)
{
	return ending < VERDICTS || (ending == SURVIVED && file->measures & RUN_FAILURE) ||
		   (ending == NEVER_PARTED && file->against);
}

static bool came_to(const json_t *run, int ending)
{
	const char *verdict = json_string_value(json_object_get(run, "verdict"));
	if (ending == SURVIVED) return json_is_true(json_object_get(json_object_get(run, "failure"), "survived"));
	if (ending == NEVER_PARTED) return json_is_false(json_object_get(run, "horizon_differs"));
	return verdict && strcmp(verdict, endings[ending]) == 0;
}

/* Members that are no measure: what they say stands in the grid's columns, or is the same for all runs. */
static bool is_measure(const char *name)
{
	static const char *const others[] = {"point", "machine", "seed", "dimensions", "bits"};
	for (size_t o = 0; o < sizeof others / sizeof *others; o++)
		if (strcmp(name, others[o]) == 0) return false;
	return true;
}

/* Enters the numbers of an object, and of the objects in it, into `flat` under dotted names; those of "made" under
 * their own. */
static void flatten(json_t *flat, const char *prefix, json_t *object)
{
	const char *name;
	json_t *value;
	json_object_foreach(object, name, value)
	{
		char path[200];
		bool made = strcmp(name, "made") == 0;
		snprintf(path, sizeof path, "%s%s%s", prefix, *prefix ? "." : "", name);
		if (!is_measure(path)) continue;
		if (json_is_object(value))
			flatten(flat, made ? "" : path, value);
		else if (json_is_number(value) || json_is_null(value))
			json_object_set(flat, path, value);
	}
}

/* The numbers of each run, or null; and in `names` all names there are, in the order in which they first appear. */
static json_t *flatten_all(const json_t *results, json_t *names)
{
	json_t *all = json_array(), *result;
	size_t r;
	json_array_foreach(results, r, result)
	{
		json_t *flat = json_is_object(result) ? json_object() : json_null();
		if (json_is_object(result)) flatten(flat, "", result);
		json_array_append_new(all, flat);
		json_object_update_missing(names, flat);
	}
	return all;
}

static void heading(json_t *columns, const char *name, const char *what)
{
	char text[240];
	snprintf(text, sizeof text, "%s%s", name, what);
	json_array_append_new(columns, json_string(text));
}

static void add_keys(json_t *columns, const struct campaign_file *file)
{
	for (size_t axis = 0; axis < file->axis_count; axis++) heading(columns, file->axes[axis].key, "");
}

static void add_values(json_t *row, const struct campaign_file *file, size_t point)
{
	for (size_t axis = 0; axis < file->axis_count; axis++) {
		const char *setting = file->axes[axis].settings[campaign_file_choice(file, point, axis)];
		json_array_append_new(row, json_string(campaign_setting_value(setting)));
	}
}

json_t *campaign_table_runs(const struct campaign_file *file, const json_t *results)
{
	static const char *const words[] = {"seed", "verdict", "digest"};
	bool judged = file->measures & RUN_FAILURE;
	json_t *names = json_object(), *all = flatten_all(results, names), *result, *value;
	json_t *columns = json_array(), *rows = json_array();
	const char *name;
	size_t r;
	add_keys(columns, file);
	for (int w = 0; w < 3; w++) heading(columns, words[w], "");
	if (judged) heading(columns, "failure", "");
	json_object_foreach(names, name, value) heading(columns, name, "");
	json_array_foreach(results, r, result)
	{
		if (!json_is_object(result)) continue;
		json_t *row = json_array(), *flat = json_array_get(all, r);
		add_values(row, file, r / file->seed_count);
		for (int w = 0; w < 3; w++) json_array_append(row, json_object_get(result, words[w]));
		if (judged) json_array_append(row, json_object_get(json_object_get(result, "failure"), "what"));
		json_object_foreach(names, name, value)
		{
			json_t *number = json_object_get(flat, name);
			json_array_append(row, number ? number : json_null());
		}
		json_array_append_new(rows, row);
	}
	json_decref(names);
	json_decref(all);
	return json_pack("{s:o, s:o}", "columns", columns, "rows", rows);
}

/* Mean, deviation and count of one number over the runs of a point. */
static void add_spread(json_t *row, const json_t *all, size_t first, size_t count, const char *name, double *values)
{
	size_t there = 0;
	for (size_t r = first; r < first + count; r++) {
		const json_t *number = json_object_get(json_array_get(all, r), name);
		if (json_is_number(number)) values[there++] = json_number_value(number);
	}
	json_array_append_new(row, there > 0 ? json_real(gsl_stats_mean(values, 1, there)) : json_null());
	json_array_append_new(row, there > 1 ? json_real(gsl_stats_sd(values, 1, there)) : json_null());
	json_array_append_new(row, json_integer((json_int_t)there));
}

/* How many runs of a point there are, and how many came to each ending. */
static void add_endings(json_t *row, const struct campaign_file *file, const json_t *results, size_t point)
{
	json_int_t ended[ENDINGS] = {0}, runs = 0;
	for (size_t r = point * file->seed_count; r < (point + 1) * file->seed_count; r++) {
		const json_t *run = json_array_get(results, r);
		runs += json_is_object(run);
		for (int e = 0; e < ENDINGS; e++) ended[e] += came_to(run, e);
	}
	json_array_append_new(row, json_integer(runs));
	for (int e = 0; e < ENDINGS; e++)
		if (finds_out(file, e)) json_array_append_new(row, json_integer(ended[e]));
}

json_t *campaign_table_points(const struct campaign_file *file, const json_t *results)
{
	json_t *names = json_object(), *all = flatten_all(results, names), *value;
	json_t *columns = json_array(), *rows = json_array();
	double *values = calloc(file->seed_count, sizeof *values);
	const char *name;
	add_keys(columns, file);
	heading(columns, "runs", "");
	for (int e = 0; e < ENDINGS; e++)
		if (finds_out(file, e)) heading(columns, endings[e], "");
	json_object_foreach(names, name, value)
	{
		heading(columns, name, "");
		heading(columns, name, " deviation");
		heading(columns, name, " count");
	}
	for (size_t point = 0; values && point < file->points; point++) {
		json_t *row = json_array();
		add_values(row, file, point);
		add_endings(row, file, results, point);
		json_object_foreach(names, name, value)
			add_spread(row, all, point * file->seed_count, file->seed_count, name, values);
		json_array_append_new(rows, row);
	}
	free(values);
	json_decref(names);
	json_decref(all);
	return json_pack("{s:o, s:o}", "columns", columns, "rows", rows);
}

static const struct telling {
	const char *name, *heading;
} tellings[] = {
	{"events", "events"},
	{"impact.exact.fraction_below", "below contact, exact"},
	{"impact.exact.deviation_ulp", "spread at impact / ulp"},
	{"conservation.energy_drift_per_million", "energy drift per 10^6 collisions"},
	{"conservation.momentum_drift_per_million", "momentum drift per 10^6 collisions"},
	{"three_body.contacts", "contacts"},
	{"three_body.events", "of them three-body"},
	{"states.executed.count", "inconsistent when executed"},
	{"states.others.count", "other pairs inconsistent"},
	{"states.repeats", "events repeated"},
	{"failure.event", "first event that fails"},
	{"horizon", "horizon / events per particle"},
	{"collisions_per_second", "collisions/s"},
};
enum { TELLINGS = sizeof tellings / sizeof *tellings };

/* Where a column is; SIZE_MAX where there is none of that name. */
static size_t column_of(const json_t *table, const char *name)
{
	const json_t *columns = json_object_get(table, "columns");
	for (size_t c = 0; c < json_array_size(columns); c++)
		if (strcmp(json_string_value(json_array_get(columns, c)), name) == 0) return c;
	return SIZE_MAX;
}

static json_t *spread_text(const json_t *row, size_t column)
{
	const json_t *mean = json_array_get(row, column), *deviation = json_array_get(row, column + 1);
	char text[80] = "";
	if (json_is_number(mean) && json_is_number(deviation))
		snprintf(text, sizeof text, "%.5g ± %.2g", json_number_value(mean), json_number_value(deviation));
	else if (json_is_number(mean))
		snprintf(text, sizeof text, "%.5g", json_number_value(mean));
	return json_string(text);
}

json_t *campaign_table_telling(const struct campaign_file *file, const json_t *points)
{
	json_t *columns = json_array(), *rows = json_array(), *from;
	size_t r, fixed = file->axis_count + 1, column[TELLINGS];
	for (int e = 0; e < ENDINGS; e++) fixed += finds_out(file, e);
	for (size_t c = 0; c < fixed; c++)
		json_array_append(columns, json_array_get(json_object_get(points, "columns"), c));
	for (int t = 0; t < TELLINGS; t++) {
		column[t] = column_of(points, tellings[t].name);
		if (column[t] != SIZE_MAX) heading(columns, tellings[t].heading, "");
	}
	json_array_foreach(json_object_get(points, "rows"), r, from)
	{
		json_t *row = json_array();
		for (size_t c = 0; c < fixed; c++) json_array_append(row, json_array_get(from, c));
		for (int t = 0; t < TELLINGS; t++)
			if (column[t] != SIZE_MAX) json_array_append_new(row, spread_text(from, column[t]));
		json_array_append_new(rows, row);
	}
	return json_pack("{s:o, s:o}", "columns", columns, "rows", rows);
}

struct result *campaign_table_result(const struct campaign_file *file, const json_t *telling, size_t finished)
{
	struct result *result = result_new(file->name, file->title);
	const json_t *columns = json_object_get(telling, "columns"), *row, *cell;
	size_t count = json_array_size(columns), all = file->points * file->seed_count, r, c;
	const char **headings = calloc(count + 1, sizeof *headings);
	if (!result || !headings) {
		free(headings);
		result_free(result);
		return NULL;
	}
	result_paragraph(result, "A campaign: %zu points of a grid, each run with %zu seeds. %s", file->points,
					 file->seed_count, file->about);
	for (c = 0; c < count; c++) headings[c] = json_string_value(json_array_get(columns, c));
	struct result_table table =
		result_table(result, "Points of the grid",
					 "Mean over the runs of a point, and the standard deviation of one run.", headings);
	json_array_foreach(json_object_get(telling, "rows"), r, row)
	{
		table_row(table);
		json_array_foreach(row, c, cell)
		{
			if (json_is_integer(cell))
				table_count(table, (uint64_t)json_integer_value(cell));
			else
				table_text(table, "%s", json_string_value(cell));
		}
	}
	free(headings);
	if (finished < all) result_incomplete(result, "stopped after %zu of %zu runs", finished, all);
	return result;
}
