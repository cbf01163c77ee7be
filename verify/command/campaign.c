/* touchstone campaign: runs over a grid of parameters and seeds, each made once. */
#include "command/command.h"

#include <argp.h>
#include <omp.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "campaign/courier.h"
#include "command/campaign_table.h"
#include "command/campaigning.h"
#include "command/cases.h"
#include "command/interrupt.h"
#include "command/output.h"
#include "command/progress.h"
#include "csv.h"

enum { RESULTS = 256, THREADS, SHARD, JSON, CASES };

static const struct argp_option options[] = {
	{"results", RESULTS, "DIR", 0, "Where runs and tables are kept (build/results)", 1},
	{"threads", THREADS, "K", 0,
	 "Runs side by side (as many as there are cores; on ranks, 1 on the first); the numbers do not depend on it", 1},
	{"shard", SHARD, "I/N", 0,
	 "Make only the I-th of N equal parts, into a store of its own; `touchstone merge` puts them together", 1},
	{"json", JSON, "FILE", 0, "Write all runs as JSON, too; - for standard output", 2},
	{"cases", CASES, "DIR", 0, "Folder in which scenes and, below it, campaigns are found by name", 3},
	{0}};

struct wish {
	const char *file, *results, *folder, *json, *command;
	int threads; /* 0: chosen */
	size_t shard, shards;
};

static void choose_shard(struct wish *wish, const char *argument)
{
	unsigned shard, shards;
	char end;
	if (sscanf(argument, "%u/%u%c", &shard, &shards, &end) != 2 || shard < 1 || shard > shards)
		refuse_option("shard", argument, "I/N with I from 1 to N, such as 2/8");
	wish->shard = shard, wish->shards = shards;
}

static error_t parse(int key, char *argument, struct argp_state *state)
{
	struct wish *wish = state->input;
	switch (key) {
	case RESULTS:
		wish->results = argument;
		return 0;
	case THREADS:
		wish->threads = (int)option_count("threads", argument, 1, 1024);
		return 0;
	case SHARD:
		choose_shard(wish, argument);
		return 0;
	case JSON:
		wish->json = argument;
		return 0;
	case CASES:
		wish->folder = argument;
		return 0;
	case ARGP_KEY_ARG:
		if (wish->file) refuse_usage("campaign: '%.60s' is a second campaign; accepted: one", argument);
		wish->file = argument;
		return 0;
	case ARGP_KEY_NO_ARGS:
		refuse_usage("campaign: no campaign; accepted: a campaign file, such as those in cases/campaigns");
	default:
		return ARGP_ERR_UNKNOWN;
	}
}

static void show(void *context, double part)
{
	progress_show(context, 100 * part, 100);
}

static bool write_csv(const struct wish *wish, const struct campaign_file *file, const char *what, const json_t *table,
					  char error[REPORT_ERROR])
{
	struct aside stream;
	if (!aside_open(&stream, error, "%s/%s-%s.csv", wish->results, file->name, what)) return false;
	csv_table(stream.stream, table);
	return aside_keep(&stream, error);
}

/* The table of a few numbers, in columns. */
static void print(const json_t *table)
{
	const json_t *columns = json_object_get(table, "columns"), *rows = json_object_get(table, "rows"), *row, *cell;
	json_t *lines = json_pack("[O]", columns);
	json_array_extend(lines, (json_t *)rows);
	size_t width[64] = {0}, r, c;
	char text[80];
	for (int drawn = 0; drawn < 2; drawn++) json_array_foreach(lines, r, row)
		{
			json_array_foreach(row, c, cell)
			{
				if (json_is_integer(cell))
					snprintf(text, sizeof text, "%lld", (long long)json_integer_value(cell));
				else
					snprintf(text, sizeof text, "%.79s", json_string_value(cell));
				size_t seen = 0; /* characters, which have one byte that continues none */
				for (const char *byte = text; *byte; byte++) seen += (*byte & 0xc0) != 0x80;
				if (seen > width[c % 64]) width[c % 64] = seen;
				if (drawn && c + 1 < json_array_size(row))
					printf("%s%*s", text, (int)(width[c % 64] - seen) + 2, "");
				else if (drawn)
					printf("%s\n", text);
			}
		}
	json_decref(lines);
}

/* Tables and page of all runs that are there, and the exit status. */
static int tell(const struct wish *wish, const struct campaign_file *file, const json_t *results, double seconds)
{
	char error[REPORT_ERROR];
	size_t finished = campaign_finished(results), all = json_array_size(results), r;
	json_t *runs = campaign_table_runs(file, results), *points = campaign_table_points(file, results);
	json_t *telling = campaign_table_telling(file, points);
	struct result *result = campaign_table_result(file, telling, finished);
	if (result) result_made_by(result, wish->command, seconds, NULL);
	bool written = result && write_csv(wish, file, "runs", runs, error) &&
				   write_csv(wish, file, "points", points, error) && result_write(result, wish->results, error);
	if (!result) snprintf(error, sizeof error, "out of memory");
	result_free(result);
	if (written && wish->json) {
		json_t *json = json_pack("{s:s, s:s, s:s, s:b, s:O, s:O}", "campaign", file->name, "title", file->title,
								 "scene", file->scene, "complete", finished == all, "runs", results, "points", points);
		written = output_json(wish->json, json, error);
		json_decref(json);
	}
	if (written && !(wish->json && strcmp(wish->json, "-") == 0)) print(telling);
	bool broken = false;
	const json_t *run;
	json_array_foreach(results, r, run)
	{
		const char *verdict = json_string_value(json_object_get(run, "verdict"));
		broken |= verdict && (strcmp(verdict, "halted") == 0 || strcmp(verdict, "diverged") == 0);
		broken |= json_is_false(json_object_get(json_object_get(run, "failure"), "survived"));
	}
	json_decref(telling);
	json_decref(points);
	json_decref(runs);
	if (!written) return refuse("%s", error);
	fprintf(stderr,
			"%s: %zu of %zu runs in %s/%s-runs.csv, points of the grid in %s-points.csv, page: touchstone report\n",
			file->name, finished, all, wish->results, file->name, file->name);
	return interrupted() ? STATUS_INTERRUPTED : broken ? STATUS_FINDING : STATUS_WELL;
}

/* One of several ranks. Only the first of them has anything to say or to write. */
struct place {
	const struct ranks *ranks; /* NULL: alone */
	int rank, count;
};

/* An end that was asked for does not wait for ranks that are no longer there. */
static void leave(const struct place *place)
{
	if (place->ranks && !interrupted()) place->ranks->end();
}

static int make(const struct wish *wish, struct campaigning *pieces, const struct place *place)
{
	char error[CAMPAIGN_ERROR], part[40];
	const struct campaign_file *file = pieces->file;
	snprintf(part, sizeof part, "%zu-of-%zu", wish->shard, wish->shards);
	struct progress progress = progress_begin(file->name, "%");
	const struct campaign campaign = {file->name,       pieces->count,    campaigning_key,
									  campaigning_cost, campaigning_make, pieces};
	const struct campaign_setup setup = {.folder = wish->results,
										 .part = wish->shards ? part : NULL,
										 .threads = wish->threads,
										 .stop = interrupt_flag(),
										 .ranks = place->ranks,
										 .rank_count = place->count,
										 .progress = show,
										 .context = &progress};
	if (place->rank > 0) {
		courier_make(&campaign, place->ranks, interrupt_flag());
		leave(place);
		return interrupted() ? STATUS_INTERRUPTED : STATUS_WELL;
	}
	double began = progress_clock();
	json_t *results = campaign_run(&campaign, &setup, error);
	progress_end(&progress);
	leave(place);
	if (!results) return refuse("%s", error);
	int status = interrupted() ? STATUS_INTERRUPTED : STATUS_WELL;
	if (wish->shards)
		fprintf(stderr, "%s: shard %zu of %zu: %zu of %zu runs in %s/%s-%s.pieces\n", file->name, wish->shard,
				wish->shards, campaign_finished(results), pieces->count, wish->results, file->name, part);
	else
		status = tell(wish, file, results, progress_clock() - began);
	json_decref(results);
	return status;
}

static int open_and_make(const struct wish *wish, const struct campaign_file *file, const struct place *place)
{
	char error[STORE_ERROR];
	struct campaigning pieces;
	if (!campaigning_open(&pieces, file, error)) return refuse("%s", error);
	char *store = campaign_store_path(wish->results, file->name, NULL);
	bool good = store && (wish->shards == 0 || campaigning_choose(&pieces, wish->shard, wish->shards, store, error));
	if (!store) snprintf(error, sizeof error, "out of memory");
	int status = good ? make(wish, &pieces, place) : refuse("%s", error);
	free(store);
	campaigning_close(&pieces);
	return status;
}

/* A file, or a campaign by its name. */
static char *find_campaign(const char *cases, const char *name)
{
	char *folder, *path = NULL;
	if (asprintf(&folder, "%s/campaigns", cases) < 0) return NULL;
	path = cases_find(folder, name);
	free(folder);
	return path;
}

/* Takes its place among the ranks, if there are any. Not STATUS_WELL when it cannot. */
static int take_place(struct place *place, struct wish *wish)
{
	char error[512];
	if (ranks_launched()) {
		place->ranks = ranks_load(error);
		if (!place->ranks) {
			if (ranks_number() == 0) refuse("campaign: %s", error);
			return STATUS_SKIPPED;
		}
		place->ranks->begin(&place->rank, &place->count);
	}
	if (wish->threads == 0) wish->threads = place->count > 1 ? 1 : omp_get_num_procs();
	interrupt_watch();
	return STATUS_WELL;
}

static int campaign(struct wish *wish)
{
	char error[STORE_ERROR];
	if (wish->json && !output_possible(wish->json, error)) return refuse("%s", error);
	if (wish->json && wish->shards)
		return refuse("--json: a shard has a part of the runs only; accepted: without --shard");
	const char *cases = cases_folder(wish->folder);
	char *path = find_campaign(cases, wish->file);
	if (!path) return refuse("%s: no such file, nor in %s/campaigns; accepted: a campaign file", wish->file, cases);
	struct place place = {.count = 1};
	struct campaign_file *file = campaign_file_open(path, cases, error);
	int status = file ? take_place(&place, wish) : refuse("%s", error);
	if (status == STATUS_WELL) status = open_and_make(wish, file, &place);
	campaign_file_close(file);
	free(path);
	return status;
}

int command_campaign(int argc, char **argv)
{
	static const struct argp argp = {
		.options = options,
		.parser = parse,
		.args_doc = "FILE",
		.doc =
			"Makes the runs of a campaign: a scene over a grid of its keys, each point with several seeds. Every run "
			"that "
			"is finished is kept at once in DIR/NAME.pieces, and never made again: a campaign that was stopped or "
			"killed "
			"goes on where it was when it is called again. The numbers do not depend on threads or shards. At the end "
			"there are tables, DIR/NAME-runs.csv and DIR/NAME-points.csv, and a page for `touchstone report`. FILE is "
			"YAML, explained in cases/campaigns/restitution-density.yaml, or the name of one there.\v"
			"For a batch scheduler: `touchstone campaign FILE --shard 3/8` makes one part of eight, `touchstone merge "
			"DIR/NAME.pieces DIR/NAME-*-of-8.pieces` puts them together, and then `touchstone campaign FILE` makes "
			"what "
			"is still missing and writes the tables. With Open MPI: `mpirun -n K touchstone campaign FILE` makes a run "
			"on "
			"each rank at a time; a rank that dies ends the job, and calling it again makes what is missing.\n\n"
			"Exit status: 0 all runs done or collapsed; 1 one has halted or diverged, or a failure was measured; 2 bad "
			"input, or a run that could "
			"not begin; 130 interrupted, what was finished by then is kept.\n\n"
			"Example: touchstone campaign restitution-density --threads 2",
	};
	struct wish wish = {.results = "build/results"};
	char *command = command_line(argc, argv);
	wish.command = command ? command : "";
	argp_parse(&argp, argc, argv, 0, NULL, &wish);
	int status = campaign(&wish);
	free(command);
	return status;
}
