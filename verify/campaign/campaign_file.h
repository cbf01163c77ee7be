/* Campaign files: YAML that says which runs of a scene a campaign is made of. The keys are explained at the top of
 * cases/campaigns/restitution-density.yaml.
 *
 * What is wrong with one is said on one line, "FILE:LINE: key: what; accepted: what", as with scenes; also what is
 * wrong with a scene at any point of the grid. */
#ifndef VERIFY_CAMPAIGN_FILE_H
#define VERIFY_CAMPAIGN_FILE_H

#include <stdbool.h>
#include <stdint.h>

#include "store/scene_file.h"

enum { CAMPAIGN_MOST_PIECES = 1000000 };

/* A key of the scene that takes several values. */
struct campaign_axis {
	char *key;
	char **settings; /* KEY=VALUE, one for each */
	size_t count;
};

struct campaign_file {
	char *name;        /* of the file, without folder and ending */
	const char *title; /* the name where none is given */
	const char *about; /* "" where none is given */
	char *scene;       /* path of the scene file */
	char **settings;   /* KEY=VALUE, the same for all points: `set`, `events`, `time` */
	size_t setting_count;
	struct campaign_axis *axes; /* the last one varies fastest */
	size_t axis_count;
	uint64_t *seeds;
	size_t seed_count;
	size_t points;                  /* of the grid */
	unsigned measures;              /* of enum run_measure (command/run_measures.h) */
	const char *against;            /* a finer arithmetic to find horizons with, or NULL */
	struct campaign_source *source; /* where each key was said */
};

/* Reads a campaign file; `cases` is the folder in which a scene is found by its name, unless the file's own folder has
 * one of that path. NULL with a message when something is wrong with it, or with the scene at a point of the grid. */
struct campaign_file *campaign_file_open(const char *path, const char *cases, char error[STORE_ERROR]);
void campaign_file_close(struct campaign_file *file);

/* Which of an axis's values a point has. */
size_t campaign_file_choice(const struct campaign_file *file, size_t point, size_t axis);

/* What follows KEY= in a setting. */
const char *campaign_setting_value(const char *setting);

/* The scene file at a point of the grid; NULL with a message. The caller closes it. `settings`, with room for
 * setting_count + axis_count, receives what it was opened with; the strings belong to `file`. */
struct scene_file *campaign_file_scene(const struct campaign_file *file, size_t point, const char **settings,
									   char error[STORE_ERROR]);

#endif
