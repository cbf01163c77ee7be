/* touchstone merge: puts the stores of shards together. */
#include "command/command.h"

#include <argp.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "campaign/piece_store.h"
#include "store/text.h"

struct wish {
	char **paths; /* OUT, then IN... */
	size_t count;
};

static error_t parse(int key, char *argument, struct argp_state *state)
{
	struct wish *wish = state->input;
	if (key == ARGP_KEY_ARG) {
		wish->paths[wish->count++] = argument;
		return 0;
	}
	if (key == ARGP_KEY_END && wish->count < 2)
		refuse_usage("merge: %s; accepted: OUT IN..., such as results/x.pieces results/x-*-of-4.pieces",
					 wish->count ? "nothing to merge" : "no stores");
	return ARGP_ERR_UNKNOWN;
}

static void tell_notes(const struct piece_store *store)
{
	for (size_t n = 0; n < piece_store_note_count(store); n++) refuse("%s", piece_store_note(store, n));
}

/* What all stores have, before any of it is written. */
struct gathered {
	json_t *lines;      /* by key */
	json_t *from;       /* path by key */
	json_t *contradict; /* keys of which two stores tell different numbers */
};

static void gather_one(struct gathered *all, const char *path, const char *key, json_t *line)
{
	json_t *before = json_object_get(all->lines, key);
	if (!before) {
		json_object_set(all->lines, key, line);
		json_object_set_new(all->from, key, json_string(path));
	} else if (!piece_store_same(json_object_get(before, "result"), json_object_get(line, "result"))) {
		char shown[TEXT_SHOWN];
		json_object_set_new(all->contradict, key, json_true());
		const char *revisions[2] = {json_string_value(json_object_get(before, "revision")),
									json_string_value(json_object_get(line, "revision"))};
		refuse("%.200s (revision %.40s) and %.200s (%.40s) contradict each other: %s",
			   json_string_value(json_object_get(all->from, key)), revisions[0] ? revisions[0] : "unknown", path,
			   revisions[1] ? revisions[1] : "unknown", strlen(key) < sizeof shown ? key : text_shown(shown, key));
	}
}

static void gather(struct gathered *all, const char *path, const struct piece_store *store)
{
	const char *key;
	json_t *line;
	tell_notes(store);
	json_object_foreach(piece_store_lines(store), key, line) gather_one(all, path, key, line);
}

/* Adds to a store what it does not have. Of pieces that contradict each other it keeps its own, if it has one. */
static bool add_missing(struct piece_store *store, const struct gathered *all, size_t *added, char *error)
{
	const char *key;
	json_t *line;
	json_object_foreach(all->lines, key, line)
	{
		if (piece_store_find(store, key) || json_object_get(all->contradict, key)) continue;
		if (!piece_store_take(store, line, error)) return false;
		++*added;
	}
	return true;
}

static int merge(const struct wish *wish, struct gathered *all)
{
	char error[512], *name = NULL;
	bool good = true;
	for (size_t i = 1; good && i < wish->count; i++) {
		struct piece_store *store = piece_store_read(wish->paths[i], name, error);
		good = store;
		if (!good) break;
		if (!name && piece_store_campaign(store)) name = strdup(piece_store_campaign(store));
		gather(all, wish->paths[i], store);
		piece_store_close(store, NULL);
	}
	if (good && !name)
		snprintf(error, sizeof error, "none of these stores has a first line yet; accepted: one that has");
	struct piece_store *store = good && name ? piece_store_open(wish->paths[0], name, error) : NULL;
	free(name);
	if (!store) return refuse("%s", error);
	gather(all, wish->paths[0], store);
	size_t added = 0;
	good = add_missing(store, all, &added, error);
	size_t there = json_object_size(piece_store_lines(store)), left_out = json_object_size(all->contradict);
	good = piece_store_close(store, good ? error : NULL) && good;
	if (!good) return refuse("%s", error);
	printf("%s: %zu pieces, %zu of them new", wish->paths[0], there, added);
	if (left_out) printf("; %zu contradicted and not taken over", left_out);
	printf("\n");
	return left_out ? STATUS_FINDING : STATUS_WELL;
}

int command_merge(int argc, char **argv)
{
	static const struct argp argp = {
		.parser = parse,
		.args_doc = "OUT IN...",
		.doc =
			"Puts the stores of a campaign's shards together: OUT, which may be there already, gets every finished "
			"piece "
			"of the others that it does not have. The order does not matter, and merging twice changes nothing. Two "
			"different results of one piece are a finding: OUT keeps its own or, if it has none, gets neither, so that "
			"the piece is made again.\v"
			"Exit status: 0 all well; 1 two results contradict each other; 2 a file is no store, or one of another "
			"campaign, and nothing was merged.\n\n"
			"Example: touchstone merge build/results/restitution-density.pieces "
			"build/results/restitution-density-*-of-4.pieces",
	};
	struct wish wish = {.paths = calloc((size_t)argc, sizeof(char *))};
	struct gathered all = {json_object(), json_object(), json_object()};
	if (!wish.paths || !all.lines || !all.from || !all.contradict) return refuse("out of memory");
	argp_parse(&argp, argc, argv, 0, NULL, &wish);
	int status = merge(&wish, &all);
	json_decref(all.lines);
	json_decref(all.from);
	json_decref(all.contradict);
	free(wish.paths);
	return status;
}
