#include "figure/atlas_live.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

/* The stress scenes of the live page (.ci/live.mk): those in the plane, or on a line, that have a box. */
static bool has_scene(const char *name)
{
	static const char *const shown[] = {"near-collapse", "cradle", "column", "grazing"};
	for (size_t s = 0; s < sizeof shown / sizeof *shown; s++)
		if (strcmp(shown[s], name) == 0) return true;
	return false;
}

/* The page shows time / (3 * 2^speed) seconds of it; about five are wanted. */
static int speed_for(double time)
{
	return time > 0 ? (int)fmin(6, fmax(-8, ceil(log2(time / 15)))) : 0;
}

bool atlas_live(const struct atlas *atlas, int method, int scene, char query[300])
{
	const struct atlas_cell *cell = &atlas->cell[method][scene];
	const char *name = atlas->method[method];
	if (!has_scene(atlas->scene_name[scene]) || strcmp(name, "rounded") == 0) return false; /* that one needs MPFR */
	int rung = atlas_shown(cell);
	if (atlas_bits(rung) > 25) rung = ATLAS_BINARY64; /* nor is mpfr:28 in the page */
	const struct failure *failure = rung == atlas_shown(cell) ? atlas_failure_shown(cell) : &cell->failure;
	char arithmetic[16], until[60] = "";
	if (failure->event)
		snprintf(until, sizeof until, "&events=%" PRIu64 "&speed=%d", failure->event, speed_for(failure->time));
	snprintf(query, 300, "scene=stress-%s&seed=%" PRIu64 "&method=%s&arithmetic=%s&against=stable@binary64%s",
			 atlas->scene_name[scene], atlas->file[scene]->seed, name, atlas_arithmetic(rung, arithmetic), until);
	return true;
}
