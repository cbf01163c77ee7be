#include "figure/atlas_live.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

/* The page shows time / (3 * 2^speed) seconds of it; about five are wanted. */
static int speed_for(double time)
{
	return time > 0 ? (int)fmin(6, fmax(-8, ceil(log2(time / 15)))) : 0;
}

bool atlas_live(const struct atlas *atlas, int method, int scene, char query[300], char unseen[80])
{
	const struct atlas_cell *cell = &atlas->cell[method][scene];
	const char *name = atlas->method[method];
	int rung = atlas_shown(cell);
	char arithmetic[16], until[60] = "";
	*unseen = '\0';
	if (strcmp(name, "rounded") == 0) {
		snprintf(unseen, 80, "not live: it needs GMP");
		return false;
	}
	if (atlas_bits(rung) > 25 && rung != ATLAS_BINARY64) {
		snprintf(unseen, 80, "live in binary64, not %s", atlas_arithmetic(rung, arithmetic));
		rung = ATLAS_BINARY64;
	}
	const struct failure *failure = rung == atlas_shown(cell) ? atlas_failure_shown(cell) : &cell->failure;
	if (failure->event)
		snprintf(until, sizeof until, "&events=%" PRIu64 "&speed=%d", failure->event,
				 speed_for(failure->time - atlas->scene[scene].clock));
	snprintf(query, 300, "scene=stress-%s&seed=%" PRIu64 "&method=%s&arithmetic=%s&against=stable@binary64%s",
			 atlas->scene_name[scene], atlas->file[scene]->seed, name, atlas_arithmetic(rung, arithmetic), until);
	return true;
}
