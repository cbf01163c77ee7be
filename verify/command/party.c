#include "command/party.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "command/command.h"
#include "store/query_file.h"

bool words_room(struct words *words, int arguments)
{
	words->word = calloc((size_t)arguments + 1, sizeof *words->word);
	return words->word;
}

void words_add(struct words *words, char *word)
{
	for (size_t w = 0; w < words->count; w++)
		if (strcmp(words->word[w], word) == 0) return;
	words->word[words->count++] = word;
}

bool guests_room(struct guests *guests, int arguments)
{
	return words_room(&guests->methods, arguments) && words_room(&guests->arithmetics, arguments) &&
		   words_room(&guests->plugins, arguments);
}

void guests_free(struct guests *guests)
{
	free(guests->methods.word);
	free(guests->arithmetics.word);
	free(guests->plugins.word);
}

void guests_add_shape(struct guests *guests, const char *name)
{
	if (!shape_named(name, &guests->shape))
		refuse_option("shape", name, "ball-ball, ball-leave, ball-plane, half-space");
	guests->shapes |= 1u << guests->shape;
}

void guests_complete(struct guests *guests, const char *command)
{
	static char usual[] = "binary64";
	if (guests->methods.count + guests->plugins.count == 0)
		refuse_usage("%s: no method; accepted: one that `touchstone list methods` has, all, or --plugin FILE.so",
					 command);
	if (guests->arithmetics.count == 0) words_add(&guests->arithmetics, usual);
	if (guests->shapes == 0) guests->shapes = (1u << TOUCHSTONE_SHAPES) - 1;
}

/* Adds a method in an arithmetic if it has a finder for one of the shapes; if not, `error` says why. */
static bool add_method(struct party *party, const struct guests *guests, const char *method, const char *arithmetic,
					   char error[160])
{
	struct finder finder = {.method = method, .arithmetic = arithmetic};
	for (int shape = 0; shape < TOUCHSTONE_SHAPES; shape++) {
		if (!(guests->shapes & 1u << shape) || !finder_answers(&finder, (enum touchstone_shape)shape, error)) continue;
		party->finders[party->count++] = finder;
		return true;
	}
	return false;
}

static int add_methods(struct party *party, const char *command, const struct guests *guests, const char *arithmetic)
{
	char error[160];
	for (size_t m = 0; m < guests->methods.count; m++) {
		const char *method = guests->methods.word[m];
		bool all = strcmp(method, "all") == 0, any = false;
		for (size_t n = 0; all && touchstone_finder_name(n); n++)
			any |= add_method(party, guests, touchstone_finder_name(n), arithmetic, error);
		if (!all) any = add_method(party, guests, method, arithmetic, error);
		if (!any) return refuse("%s: %s", command, error);
	}
	return STATUS_WELL;
}

static int add_plugins(struct party *party, const struct guests *guests, const struct plugin_patience *patience)
{
	for (size_t p = 0; p < guests->plugins.count; p++) {
		char error[PLUGIN_ERROR];
		bool broken;
		struct plugin *plugin = plugin_open(guests->plugins.word[p], guests->shape, patience, &broken, error);
		if (!plugin) {
			refuse("--plugin: %s", error);
			return broken ? STATUS_FINDING : STATUS_REFUSED;
		}
		party->finders[party->count++] =
			(struct finder){.method = plugin_name(plugin), .arithmetic = "binary64", .plugin = plugin};
	}
	return STATUS_WELL;
}

static size_t method_count(void)
{
	size_t count = 0;
	while (touchstone_finder_name(count)) count++;
	return count;
}

int party_gather(struct party *party, const char *command, const struct guests *guests,
				 const struct plugin_patience *patience)
{
	size_t names = guests->methods.count + method_count(), ways = guests->arithmetics.count + 1;
	party->finders = calloc(names * ways + guests->plugins.count, sizeof *party->finders);
	if (!party->finders) return refuse("out of memory");
	int status = STATUS_WELL;
	for (size_t a = 0; status == STATUS_WELL && a < guests->arithmetics.count; a++)
		status = add_methods(party, command, guests, guests->arithmetics.word[a]);
	return status == STATUS_WELL ? add_plugins(party, guests, patience) : status;
}

void party_dismiss(struct party *party)
{
	for (size_t f = 0; f < party->count; f++) plugin_close(party->finders[f].plugin);
	free(party->finders);
}
