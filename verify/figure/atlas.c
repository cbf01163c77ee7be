#include "figure/atlas.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "command/cases.h"
#include "figure/figure_campaign.h"
#include "store/scene_identity.h"

static const int ladder[ATLAS_RUNGS] = {4,  5,  6,  7,  8,  9,  10, 11, 12, 13, 14, 15, 16, 17, 18,
										19, 20, 21, 22, 23, 24, 25, 28, 32, 40, 46, 53, 64, 113};
/* FAST is the finest whose arithmetic is no library's: 25 bits. */
enum { FINEST = ATLAS_RUNGS - 1, FAST = 21 };

int atlas_bits(int rung)
{
	return ladder[rung];
}

const char *atlas_arithmetic(int rung, char name[16])
{
	int bits = ladder[rung];
	if (bits == 53) return "binary64";
	if (bits == 113) return "binary128";
	snprintf(name, 16, "%s:%d", bits <= 25 ? "short" : "mpfr", bits);
	return name;
}

bool atlas_goes_well(enum failure_kind kind)
{
	return kind == FAILURE_NONE || kind == FAILURE_REST;
}

int atlas_shown(const struct atlas_cell *cell)
{
	bool below = atlas_goes_well(cell->failure.kind) && cell->rung > 0;
	return below ? cell->rung - 1 : ATLAS_BINARY64;
}

const struct failure *atlas_failure_shown(const struct atlas_cell *cell)
{
	return atlas_shown(cell) == ATLAS_BINARY64 ? &cell->failure : &cell->below;
}

/* ------------------------------------------------------------------ one cell */

/* What the measurement of one cell is about. */
struct trial {
	const struct atlas *atlas;
	int scene, method;
	struct watch watch;
};

static bool survives(const struct trial *trial, int rung, struct failure *failure, char error[160])
{
	const struct atlas *atlas = trial->atlas;
	char name[16];
	return failure_find(&atlas->scene[trial->scene], 0, atlas_arithmetic(rung, name), atlas->method[trial->method],
						&atlas->limits, &trial->watch, failure, error) &&
		   !failure->stopped && atlas_goes_well(failure->kind);
}

/* The rung to be tried next, between one that fails and one that survives. What survives in binary64 mostly does so in
 * 25 bits or fewer, of which each is tried before any that take longer. */
static int between(int low, int high)
{
	if (low < FAST && high > FAST) high = FAST + 1;
	return (low + high) / 2;
}

/* In binary64, then by bisection where it begins to survive. Refused with the reason in `error`. */
static void fill(const struct trial *trial, struct atlas_cell *cell, char error[160])
{
	*error = '\0';
	bool lives = survives(trial, ATLAS_BINARY64, &cell->failure, error);
	struct failure failure = cell->failure;
	int low = lives ? -1 : ATLAS_BINARY64, high = lives ? ATLAS_BINARY64 : ATLAS_RUNGS; /* fails at low, not at high */
	cell->refused = *error;
	if (cell->refused || failure.stopped) return;
	if (!lives) {
		cell->below = failure;
		if (survives(trial, FINEST, &failure, error))
			high = FINEST;
		else
			low = FINEST, cell->below = failure;
	}
	while (high - low > 1 && !failure.stopped) {
		int middle = between(low, high);
		if (survives(trial, middle, &failure, error))
			high = middle;
		else
			low = middle, cell->below = failure;
	}
	cell->rung = high;
	cell->done = true;
}

/* ------------------------------------------------------------------ pieces: one cell each */

static void piece_key(void *context, size_t piece, char key[CAMPAIGN_KEY])
{
	const struct atlas *atlas = context;
	int scene = (int)piece / atlas->methods, method = (int)piece % atlas->methods;
	snprintf(key, CAMPAIGN_KEY, "scene=%s identity=%016" PRIx64 " method=%s events=%" PRIu64, atlas->scene_name[scene],
			 scene_identity(&atlas->scene[scene]), atlas->method[method], atlas->limits.events);
}

static json_t *failure_json(const struct failure *failure)
{
	return json_pack("{s:i, s:I, s:o, s:s}", "kind", (int)failure->kind, "event", (json_int_t)failure->event, "time",
					 campaign_number(failure->time), "text", failure->text);
}

static struct failure failure_of_json(const json_t *json)
{
	struct failure failure = {
		.kind = (enum failure_kind)json_integer_value(json_object_get(json, "kind")),
		.event = (uint64_t)json_integer_value(json_object_get(json, "event")),
		.time = campaign_value(json, "time"),
	};
	const char *text = json_string_value(json_object_get(json, "text"));
	snprintf(failure.text, sizeof failure.text, "%s", text ? text : "");
	return failure;
}

static struct atlas_cell cell_of_json(const json_t *json)
{
	if (!json_is_object(json)) return (struct atlas_cell){0};
	const json_t *rung = json_object_get(json, "rung");
	return (struct atlas_cell){
		.failure = failure_of_json(json_object_get(json, "binary64")),
		.rung = (int)json_integer_value(rung),
		.below = failure_of_json(json_object_get(json, "below")),
		.done = rung,
		.refused = !rung,
	};
}

static json_t *make_piece(void *context, size_t piece, const struct campaign_watch *watch, char error[CAMPAIGN_ERROR])
{
	const struct atlas *atlas = context;
	const struct trial trial = {
		.atlas = atlas,
		.scene = (int)piece / atlas->methods,
		.method = (int)piece % atlas->methods,
		.watch = {.stop = watch->stop},
	};
	struct atlas_cell cell = {0};
	char why[160];
	if (!watch->stop || !*watch->stop) fill(&trial, &cell, why);
	if (watch->stop && *watch->stop) return NULL;
	json_t *json = cell.refused ? json_pack("{s:s}", "refused", why)
								: json_pack("{s:o, s:i, s:o}", "binary64", failure_json(&cell.failure), "rung",
											cell.rung, "below", failure_json(&cell.below));
	if (!json) snprintf(error, CAMPAIGN_ERROR, "not enough memory");
	return json;
}

bool atlas_measure(struct atlas *atlas, char error[512])
{
	const struct figure_setup *setup = atlas->setup;
	const size_t pieces = (size_t)atlas->scenes * (size_t)atlas->methods;
	const struct campaign campaign = {"atlas", pieces, piece_key, NULL, make_piece, atlas};
	json_t *results = figure_campaign_run(&campaign, setup, error);
	for (size_t p = 0; results && p < pieces; p++)
		atlas->cell[p % (size_t)atlas->methods][p / (size_t)atlas->methods] = cell_of_json(json_array_get(results, p));
	json_decref(results);
	return results;
}

/* ------------------------------------------------------------------ scenes and methods */

static bool open_scene(struct atlas *atlas, const char *short_name, char error[512])
{
	int s = atlas->scenes;
	char name[40];
	snprintf(name, sizeof name, "stress/%s", short_name);
	char *path = cases_find(cases_folder(NULL), name);
	atlas->scene_name[s] = short_name;
	atlas->file[s] = path ? scene_file_open(path, 0, NULL, error) : NULL;
	if (!path) snprintf(error, 512, "there is no case %s in %s", name, cases_folder(NULL));
	free(path);
	if (!atlas->file[s] || !scene_file_build(atlas->file[s], &atlas->scene[s], error)) {
		scene_file_close(atlas->file[s]);
		return false;
	}
	atlas->scenes++;
	return true;
}

struct atlas *atlas_open(const struct figure_setup *setup, const char *const scenes[], uint64_t events, char error[512])
{
	struct atlas *atlas = calloc(1, sizeof *atlas);
	if (!atlas) {
		snprintf(error, 512, "not enough memory");
		return NULL;
	}
	atlas->setup = setup;
	atlas->limits = (struct touchstone_limits){events, INFINITY, NULL};
	const char *method;
	for (size_t m = 0; m < ATLAS_METHODS && (method = touchstone_method_name(m)); m++)
		atlas->method[atlas->methods++] = method;
	for (int s = 0; scenes[s] && s < ATLAS_SCENES; s++)
		if (!open_scene(atlas, scenes[s], error)) {
			atlas_close(atlas);
			return NULL;
		}
	return atlas;
}

void atlas_close(struct atlas *atlas)
{
	for (int s = 0; atlas && s < atlas->scenes; s++) {
		scene_free(&atlas->scene[s]);
		scene_file_close(atlas->file[s]);
	}
	free(atlas);
}
