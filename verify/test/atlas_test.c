/* The failure atlas: its cells do not depend on threads nor on a stop on the way, and lead to commands that show them.
 */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "campaign/campaign.h"
#include "figure/atlas.h"
#include "figure/atlas_live.h"
#include "program.h"

enum { EVENTS = 400 };
static const char *const few[] = {"cradle", "corner", NULL};
static char error[512];

/* Stops when so much of it is done. */
struct stopper {
	double after;
	volatile int stop;
	int told;
};

static void count(void *context, double part)
{
	struct stopper *stopper = context;
	stopper->told++;
	if (part >= stopper->after) stopper->stop = 1;
}

static struct atlas *measured(const struct figure_setup *setup)
{
	struct atlas *atlas = atlas_open(setup, few, EVENTS, error);
	if (!atlas || !atlas_measure(atlas, error)) fail_msg("%s", error);
	return atlas;
}

static int done(const struct atlas *atlas)
{
	int count = 0;
	for (int m = 0; m < atlas->methods; m++)
		for (int s = 0; s < atlas->scenes; s++) count += atlas->cell[m][s].done;
	return count;
}

static void assert_same_failure(const struct failure *one, const struct failure *other)
{
	assert_int_equal(one->kind, other->kind);
	assert_int_equal(one->event, other->event);
	assert_memory_equal(&one->time, &other->time, sizeof one->time);
	assert_string_equal(one->text, other->text);
}

static void assert_same(const struct atlas *one, const struct atlas *other)
{
	for (int m = 0; m < one->methods; m++)
		for (int s = 0; s < one->scenes; s++) {
			const struct atlas_cell *a = &one->cell[m][s], *b = &other->cell[m][s];
			assert_true(a->done && b->done);
			assert_int_equal(a->rung, b->rung);
			assert_same_failure(&a->failure, &b->failure);
			assert_same_failure(&a->below, &b->below);
		}
}

static void a_stop_keeps_cells_and_numbers(void **state)
{
	(void)state;
	char *folder = folder_new();
	struct stopper idle = {.after = 2}, stopped = {.after = 0.3}, going_on = {.after = 2};
	struct figure_setup setup = {.threads = 1, .progress = count, .context = &idle};
	struct atlas *whole = measured(&setup);
	int cells = whole->methods * whole->scenes;
	assert_int_equal(done(whole), cells);

	setup = (struct figure_setup){
		.threads = 2, .folder = folder, .stop = &stopped.stop, .progress = count, .context = &stopped};
	struct atlas *part = measured(&setup);
	int kept = done(part);
	assert_true(kept > 0 && kept < cells);
	atlas_close(part);

	setup.stop = &going_on.stop, setup.context = &going_on, setup.threads = 3;
	struct atlas *rest = measured(&setup);
	print_message("%d of %d cells kept by a stop; %d tellings before it, %d for the rest\n", kept, cells, stopped.told,
				  going_on.told);
	assert_same(whole, rest);
	assert_true(going_on.told < idle.told);
	atlas_close(rest);
	atlas_close(whole);
	campaign_forget("atlas", folder);
	folder_remove(folder);
}

static const json_t *table_of(const struct result *result, size_t number)
{
	return json_object_get(json_array_get(json_object_get(result_document(result), "tables"), number), "rows");
}

static const char *command_named(const struct result *result, const char *name)
{
	const json_t *row;
	size_t r;
	json_array_foreach(table_of(result, 1), r, row)
	{
		const json_t *cell = json_array_get(row, 3);
		if (strcmp(json_text(cell, "anchor"), name) == 0) return json_text(cell, "text");
	}
	fail_msg("no command is named %s", name);
	return NULL;
}

/* Each cell leads to a command, and the command shows the failure in the precision in which there is one. */
static void cells_lead_to_commands_that_show_them(void **state)
{
	(void)state;
	const struct figure_setup setup = {.threads = 2};
	struct atlas *atlas = measured(&setup);
	struct result *result = atlas_result(atlas);
	char *folder = folder_new();
	int failing = 0, live = 0;
	if (!result_write(result, folder, error)) fail_msg("%s", error); /* which checks where links lead */
	for (int m = 0; m < atlas->methods; m++)
		for (int s = 0; s < atlas->scenes; s++) {
			const json_t *cell = json_array_get(json_array_get(table_of(result, 0), (size_t)m), (size_t)s + 1);
			const char *command = command_named(result, json_text(cell, "link"));
			const struct failure *failure = atlas_failure_shown(&atlas->cell[m][s]);
			assert_memory_equal(command, "touchstone ", 11);
			json_t *json = program_json(program_run("%s --json -", command + 11), !failure_survived(failure));
			const json_t *told = json_object_get(json, "failure");
			if (strcmp(json_text(told, "what"), failure_word(failure->kind)) != 0)
				fail_msg("%s: %s, and the atlas says %s", command, json_text(told, "what"),
						 failure_word(failure->kind));
			assert_int_equal(json_integer_value(json_object_get(told, "event")), failure->event);
			failing += !atlas_goes_well(failure->kind);
			char query[300] = "", unseen[80];
			bool shown = atlas_live(atlas, m, s, query, unseen);
			assert_int_equal(shown, json_object_get(cell, "live") != NULL);
			assert_int_equal(*unseen != '\0', json_object_get(cell, "unseen") != NULL);
			assert_true(shown || *unseen);
			live += shown;
			json_decref(json);
		}
	print_message("%d of %d commands show a failure, %d cells are on the live page\n", failing, done(atlas), live);
	assert_true(failing > atlas->methods && live == 2 * (atlas->methods - 1)); /* all but rounded */
	folder_remove(folder);
	result_free(result);
	atlas_close(atlas);
}

int main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(a_stop_keeps_cells_and_numbers),
		cmocka_unit_test(cells_lead_to_commands_that_show_them),
	};
	return cmocka_run_group_tests(tests, NULL, NULL);
}
