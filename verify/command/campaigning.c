#include "command/campaigning.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "campaign/piece_store.h"
#include "command/outcome.h"
#include "measure/course.h"

static size_t point_of(const struct campaigning *all, size_t piece)
{
	return all->chosen[piece] / all->file->seed_count;
}

static uint64_t seed_of(const struct campaigning *all, size_t piece)
{
	return all->file->seeds[all->chosen[piece] % all->file->seed_count];
}

static const char **room_for_settings(const struct campaign_file *file)
{
	return calloc(file->setting_count + file->axis_count + 1, sizeof(char *));
}

/* ------------------------------------------------------------------ which pieces */

/* The text of the scene file, and the particles that it has from elsewhere. */
static bool digest_scene(struct campaigning *all, char error[STORE_ERROR])
{
	char *bytes = NULL;
	size_t length = 0;
	FILE *text = fopen(all->file->scene, "r"), *stream = open_memstream(&bytes, &length);
	const char **settings = room_for_settings(all->file);
	struct scene_file *scene = text && stream && settings ? campaign_file_scene(all->file, 0, settings, error) : NULL;
	bool good = scene;
	if (!text || !stream || !settings) snprintf(error, STORE_ERROR, "%.200s: cannot be read", all->file->scene);
	for (int c; good && (c = getc(text)) != EOF;) putc(c, stream);
	const struct touchstone_particle *particles = good ? scene->recipe.particles : NULL;
	for (size_t p = 0; particles && p < scene->recipe.particle_count; p++) {
		fwrite(&particles[p].species, sizeof particles[p].species, 1, stream);
		fwrite(particles[p].position, sizeof particles[p].position, 1, stream);
		fwrite(particles[p].velocity, sizeof particles[p].velocity, 1, stream);
	}
	if (text) fclose(text);
	if (stream && fclose(stream) == 0)
		snprintf(all->scene_digest, sizeof all->scene_digest, "%016" PRIx64, piece_store_checksum(bytes, length));
	scene_file_close(scene);
	free(settings);
	free(bytes);
	return good;
}

/* The events a run takes, so far as that is known. Those of wider arithmetics cost more; by how much is a guess, and
 * only the order hangs on it. */
static double cost_of(const struct scene_file *scene)
{
	static const char *const dear[] = {"mpfr", "binary128", "twin", "short"};
	double particles = (double)scene->recipe.particle_count;
	double events = scene->limits.events < UINT64_MAX ? (double)scene->limits.events : 100 * particles;
	double cost = 1 + events + scene->equilibrate * particles / 2;
	for (size_t d = 0; d < sizeof dear / sizeof *dear; d++)
		if (strncmp(scene->arithmetic, dear[d], strlen(dear[d])) == 0) cost *= 5;
	return cost;
}

static bool find_costs(struct campaigning *all, char error[STORE_ERROR])
{
	const char **settings = room_for_settings(all->file);
	all->costs = calloc(all->file->points, sizeof *all->costs);
	bool good = settings && all->costs;
	if (!good) snprintf(error, STORE_ERROR, "out of memory");
	for (size_t point = 0; good && point < all->file->points; point++) {
		struct scene_file *scene = campaign_file_scene(all->file, point, settings, error);
		good = scene;
		if (good) all->costs[point] = cost_of(scene);
		scene_file_close(scene);
	}
	free(settings);
	return good;
}

/* Whether each key has its room: grids of potentials may not. */
static bool check_keys(struct campaigning *all, char error[STORE_ERROR])
{
	char key[CAMPAIGN_KEY];
	for (size_t piece = 0; piece < all->count; piece += all->file->seed_count) {
		campaigning_key(all, piece, key);
		if (strlen(key) + 20 < CAMPAIGN_KEY) continue; /* 20: for the longest seed */
		snprintf(error, STORE_ERROR, "%s: the keys and values of a point are longer than %d characters",
				 all->file->name, CAMPAIGN_KEY);
		return false;
	}
	return true;
}

bool campaigning_open(struct campaigning *all, const struct campaign_file *file, char error[STORE_ERROR])
{
	*all = (struct campaigning){.file = file, .count = file->points * file->seed_count};
	all->chosen = calloc(all->count, sizeof *all->chosen);
	for (size_t piece = 0; all->chosen && piece < all->count; piece++) all->chosen[piece] = piece;
	if (!all->chosen) snprintf(error, STORE_ERROR, "out of memory");
	if (all->chosen && digest_scene(all, error) && find_costs(all, error) && check_keys(all, error)) return true;
	campaigning_close(all);
	return false;
}

void campaigning_close(struct campaigning *all)
{
	free(all->chosen);
	free(all->costs);
}

bool campaigning_choose(struct campaigning *all, size_t shard, size_t shards, const char *path, char error[STORE_ERROR])
{
	struct piece_store *store = NULL;
	FILE *there = fopen(path, "r");
	if (there) {
		fclose(there);
		store = piece_store_read(path, all->file->name, error);
		if (!store) return false;
	}
	size_t count = 0;
	for (size_t piece = shard - 1; piece < all->count; piece += shards) {
		char key[CAMPAIGN_KEY];
		campaigning_key(all, piece, key);
		if (store && piece_store_find(store, key)) continue;
		all->chosen[count++] = all->chosen[piece]; /* never beyond `piece` */
	}
	all->count = count;
	piece_store_close(store, NULL);
	return true;
}

/* ------------------------------------------------------------------ one piece */

void campaigning_key(void *context, size_t piece, char key[CAMPAIGN_KEY])
{
	const struct campaigning *all = context;
	const struct campaign_file *file = all->file;
	const char *slash = strrchr(file->scene, '/');
	FILE *stream = fmemopen(key, CAMPAIGN_KEY, "w");
	if (!stream) abort(); /* there is no memory for a few words */
	fprintf(stream, "scene=%s#%s", slash ? slash + 1 : file->scene, all->scene_digest);
	for (size_t s = 0; s < file->setting_count; s++) fprintf(stream, " %s", file->settings[s]);
	for (size_t axis = 0; axis < file->axis_count; axis++)
		fprintf(stream, " %s", file->axes[axis].settings[campaign_file_choice(file, point_of(all, piece), axis)]);
	for (const struct run_measure_entry *entry = run_measures; entry->name; entry++)
		if (file->measures & entry->measure) fprintf(stream, " measure=%s", entry->name);
	if (file->against) fprintf(stream, " against=%s", file->against);
	fprintf(stream, " seed=%" PRIu64, seed_of(all, piece));
	putc('\0', stream);
	fclose(stream);
	key[CAMPAIGN_KEY - 1] = '\0';
}

double campaigning_cost(void *context, size_t piece)
{
	const struct campaigning *all = context;
	return all->costs[point_of(all, piece)];
}

static void tell(void *context, double done, double total)
{
	const struct campaign_watch *watch = context;
	watch->progress(watch, total > 0 && total < INFINITY ? done / total : 0);
}

/* What the key does not determine moves to "made". */
static json_t *part_made(json_t *told)
{
	static const char *const names[] = {"file",
										"wall_seconds",
										"events_per_second",
										"collisions_per_second",
										"bytes_per_particle",
										"state_bytes_per_particle",
										"peak_memory_bytes",
										"machine"};
	json_t *made = json_object();
	for (size_t n = 0; n < sizeof names / sizeof *names; n++) {
		json_object_set(made, names[n], json_object_get(told, names[n]));
		json_object_del(told, names[n]);
	}
	json_object_set_new(told, "made", made);
	return told;
}

static json_t *point_json(const struct campaign_file *file, size_t point)
{
	json_t *json = json_object();
	for (size_t axis = 0; axis < file->axis_count; axis++) {
		const char *setting = file->axes[axis].settings[campaign_file_choice(file, point, axis)];
		json_object_set_new(json, file->axes[axis].key, json_string(campaign_setting_value(setting)));
	}
	return json;
}

json_t *campaigning_make(void *context, size_t piece, const struct campaign_watch *watch, char error[CAMPAIGN_ERROR])
{
	const struct campaigning *all = context;
	const struct campaign_file *file = all->file;
	const char **settings = room_for_settings(file);
	struct scene_file *scene = settings ? campaign_file_scene(file, point_of(all, piece), settings, error) : NULL;
	if (!settings) snprintf(error, CAMPAIGN_ERROR, "out of memory");
	json_t *told = NULL;
	if (scene) {
		const struct run_plan plan = {
			.path = file->scene,
			.file = scene,
			.limits = scene->limits,
			.settings = settings,
			.setting_count = file->setting_count + file->axis_count,
			.measures = file->measures,
			.against = file->against,
		};
		struct simulation_progress progress = {.runs = 1, .tell = tell, .context = (void *)watch};
		struct outcome outcome;
		outcome_find(&outcome, &plan, seed_of(all, piece), &progress);
		if (outcome.failed)
			snprintf(error, CAMPAIGN_ERROR, "seed %" PRIu64 ": %.400s", outcome.seed, outcome.error);
		else if (!outcome.interrupted) {
			told = json_pack("{s:o}", "point", point_json(file, point_of(all, piece)));
			json_t *rest = part_made(outcome_json(&plan, &outcome, 1, NULL));
			json_object_update(told, rest);
			json_decref(rest);
		}
		outcome_free(&outcome);
	}
	scene_file_close(scene);
	free(settings);
	return told;
}
