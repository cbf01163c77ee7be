/* The runs of a campaign file as the pieces of a campaign. */
#ifndef VERIFY_CAMPAIGNING_H
#define VERIFY_CAMPAIGNING_H

#include "campaign/campaign.h"
#include "campaign/campaign_file.h"

/* All pieces or some of them: piece p is run number chosen[p], by point of the grid, then by seed. */
struct campaigning {
	const struct campaign_file *file;
	char scene_digest[17]; /* of the scene file's text and of the particles it lists or names */
	double *costs;         /* of a run at each point of the grid */
	size_t *chosen;
	size_t count;
};

/* Begins with all pieces. False with a message. */
bool campaigning_open(struct campaigning *all, const struct campaign_file *file, char error[STORE_ERROR]);
void campaigning_close(struct campaigning *all);

/* Keeps every `shards`th piece, beginning with number `shard` from 1, and of these what the store at `path`, if there
 * is one, does not have yet. False with a message when that cannot be read. */
bool campaigning_choose(struct campaigning *all, size_t shard, size_t shards, const char *path,
						char error[STORE_ERROR]);

/* As `struct campaign` has them; the context is a struct campaigning. A piece is what `run --json` tells (outcome.h),
 * with `point`, an object of the grid's keys and their values as written, before it, and with what differs from one
 * making to another (seconds, memory, machine, path) in its member "made". */
void campaigning_key(void *context, size_t piece, char key[CAMPAIGN_KEY]);
double campaigning_cost(void *context, size_t piece);
json_t *campaigning_make(void *context, size_t piece, const struct campaign_watch *watch, char error[CAMPAIGN_ERROR]);

#endif
