#include "page.h"

#include "csv.h"
#include "embed.h"
#include "figure.h"
#include "result.h"
#include "template.h"
#include "view.h"

#include <dirent.h>
#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

EMBED(template_head, "templates/head.html");
EMBED(template_cell, "templates/cell.html");
EMBED(template_index, "templates/index.html");
EMBED(template_result, "templates/result.html");
EMBED(template_style, "templates/style.css");

static const struct template templates[] = {{"head", template_head},   {"cell", template_cell},
											{"index", template_index}, {"result", template_result},
											{"style", template_style}, {NULL, NULL}};

static const char *text_at(const json_t *object, const char *key)
{
	return json_string_value(json_object_get(object, key));
}

/* ------------------------------------------------------------------ reading */

struct shelf {
	struct result **results;
	size_t count;
};

static void shelf_free(struct shelf *shelf)
{
	for (size_t i = 0; i < shelf->count; i++) result_free(shelf->results[i]);
	free(shelf->results);
}

static int is_result(const struct dirent *entry)
{
	const char *ending = strrchr(entry->d_name, '.');
	return *entry->d_name != '.' && ending && strcmp(ending, ".json") == 0;
}

static struct result *read_one(const char *folder, const char *file, char error[REPORT_ERROR])
{
	char *path;
	if (asprintf(&path, "%s/%s", folder, file) < 0) return NULL;
	struct result *result = result_read(path, error);
	free(path);
	/* Names are addresses in the report, so two files must not claim the same one. */
	const char *name = result ? text_at(result_document(result), "name") : "";
	if (result && (strncmp(file, name, strlen(name)) != 0 || strcmp(file + strlen(name), ".json") != 0)) {
		snprintf(error, REPORT_ERROR, "%s/%s: holds the result '%s'; its name must be %s.json", folder, file, name,
				 name);
		result_free(result);
		return NULL;
	}
	return result;
}

static bool shelf_read(struct shelf *shelf, const char *folder, char error[REPORT_ERROR])
{
	struct dirent **entries;
	int count = scandir(folder, &entries, is_result, versionsort);
	if (count < 0) {
		snprintf(error, REPORT_ERROR, "%s: cannot be read: %s", folder, strerror(errno));
		return false;
	}
	*shelf = (struct shelf){.results = calloc((size_t)count + 1, sizeof(struct result *))};
	bool good = shelf->results;
	if (count == 0) snprintf(error, REPORT_ERROR, "%s: holds no results (*.json)", folder);
	for (int i = 0; i < count; i++) {
		if (good) shelf->results[i] = read_one(folder, entries[i]->d_name, error);
		good = good && shelf->results[i];
		shelf->count += good;
		free(entries[i]);
	}
	free(entries);
	if (good && count > 0) return true;
	shelf_free(shelf);
	return false;
}

/* ------------------------------------------------------------------ writing */

static bool write_page(const char *folder, const char *page, const char *template, const json_t *view,
					   char error[REPORT_ERROR])
{
	struct aside file;
	if (!aside_open(&file, error, "%s/%s", folder, page)) return false;
	template_write(file.stream, templates, template, view);
	return aside_keep(&file, error);
}

static bool write_csv(const char *folder, const char *name, void (*write)(FILE *, const json_t *),
					  const json_t *numbers, char error[REPORT_ERROR])
{
	struct aside file;
	if (!aside_open(&file, error, "%s/%s", folder, name)) return false;
	write(file.stream, numbers);
	return aside_keep(&file, error);
}

/* Draws the figures of one result and notes in their views what became of it; the last trouble is in `trouble`. */
static bool write_figures(const json_t *document, const json_t *pages, json_t *view, const char *folder,
						  char trouble[REPORT_ERROR], char error[REPORT_ERROR])
{
	const json_t *figure;
	size_t i;
	json_array_foreach(json_object_get(document, "figures"), i, figure)
	{
		json_t *shown = json_array_get(json_object_get(view, "figures"), i);
		char problem[REPORT_ERROR] = "";
		bool drawn = figure_draw(figure, pages, folder, text_at(shown, "stem"), problem);
		json_object_set_new(shown, "drawn", json_boolean(drawn));
		if (!drawn) {
			json_object_set_new(shown, "problem", json_string(problem));
			snprintf(trouble, REPORT_ERROR, "%.200s is not drawn: %.250s", text_at(shown, "stem"), problem);
		}
		if (!write_csv(folder, text_at(shown, "csv"), csv_figure, figure, error)) return false;
	}
	return true;
}

static bool write_tables(const json_t *document, const json_t *view, const char *folder, char error[REPORT_ERROR])
{
	const json_t *table;
	size_t i;
	json_array_foreach(json_object_get(document, "tables"), i, table)
	{
		const json_t *shown = json_array_get(json_object_get(view, "tables"), i);
		if (!write_csv(folder, text_at(shown, "csv"), csv_table, table, error)) return false;
	}
	return true;
}

/* The names of all pages of results. */
static json_t *pages_of(const struct shelf *shelf)
{
	json_t *pages = json_array();
	for (size_t i = 0; i < shelf->count; i++)
		json_array_append_new(pages, json_sprintf("%s.html", text_at(result_document(shelf->results[i]), "name")));
	return pages;
}

/* In cells of tables the live page's parameters become addresses, or vanish where it is not. */
static void link_cells(const json_t *view, bool there)
{
	const json_t *table, *row;
	json_t *cell;
	size_t t, r, c;
	json_array_foreach(json_object_get(view, "tables"), t, table)
		json_array_foreach(json_object_get(table, "rows"), r, row)
			json_array_foreach(json_object_get(row, "cells"), c, cell)
	{
		const char *query = text_at(cell, "watch");
		json_t *address = there && query ? json_sprintf("../live.html?%s", query) : NULL;
		if (address)
			json_object_set_new(cell, "watch", address);
		else
			json_object_del(cell, "watch");
		if (!there) json_object_del(cell, "unseen");
	}
}

/* Links to the live page, where it lies beside the report: what each result says of it, as addresses. */
static void link_live(const struct shelf *shelf, const json_t *views, const char *folder)
{
	char *path = NULL;
	bool there = asprintf(&path, "%s/../live.html", folder) >= 0 && access(path, R_OK) == 0;
	for (size_t i = 0; i < json_array_size(views); i++) link_cells(json_array_get(views, i), there);
	for (size_t i = 0; there && i < shelf->count; i++) {
		json_t *links = json_array();
		const json_t *live;
		size_t k;
		json_array_foreach(json_object_get(result_document(shelf->results[i]), "live"), k, live) json_array_append_new(
			links, json_pack("{s: o, s: s}", "address", json_sprintf("../live.html?%s", text_at(live, "query")),
							 "title", text_at(live, "title")));
		json_object_set_new(json_array_get(views, i), "has_live", json_boolean(json_array_size(links) > 0));
		json_object_set_new(json_array_get(views, i), "live", links);
	}
	free(path);
}

/* The way from page to page. */
static void link_views(const json_t *views)
{
	const char *const directions[] = {"previous", "next"};
	for (size_t i = 0; i < json_array_size(views); i++)
		for (size_t d = 0; d < 2; d++) {
			const json_t *other = json_array_get(views, i + 2 * d - 1);
			if (other)
				json_object_set_new(
					json_array_get(views, i), directions[d],
					json_pack("{s: s, s: s}", "page", text_at(other, "page"), "title", text_at(other, "title")));
		}
}

bool report_write(const char *results_folder, const char *report_folder, char error[REPORT_ERROR])
{
	struct shelf shelf;
	char trouble[REPORT_ERROR] = "";
	if (!shelf_read(&shelf, results_folder, error)) return false;
	json_t *views = json_array(), *pages = pages_of(&shelf);
	bool good = aside_folder(report_folder, error) && write_page(report_folder, "style.css", "style", NULL, error);
	for (size_t i = 0; good && i < shelf.count; i++) {
		const json_t *document = result_document(shelf.results[i]);
		json_t *view = view_result(document);
		json_array_append_new(views, view);
		good = write_figures(document, pages, view, report_folder, trouble, error) &&
			   write_tables(document, view, report_folder, error) &&
			   result_write(shelf.results[i], report_folder, error);
	}
	link_views(views);
	link_live(&shelf, views, report_folder);
	for (size_t i = 0; good && i < json_array_size(views); i++) {
		const json_t *view = json_array_get(views, i);
		good = write_page(report_folder, text_at(view, "page"), "result", view, error);
	}
	json_t *index = view_index(views);
	good = good && write_page(report_folder, "index.html", "index", index, error);
	if (good) strcpy(error, trouble);
	json_decref(index);
	json_decref(views);
	json_decref(pages);
	shelf_free(&shelf);
	return good;
}
