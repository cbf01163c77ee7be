/* The atlas of failures: one cell for each method in each stress scene, measured as pieces of a campaign, so that what
 * is finished is kept and no number depends on how many are made side by side. */
#ifndef VERIFY_ATLAS_H
#define VERIFY_ATLAS_H

#include "figure/figure.h"
#include "measure/failure.h"
#include "store/scene_file.h"

/* Precisions, from coarse to fine: every one from 4 to 25 bits, then some; among them binary64. */
enum { ATLAS_SCENES = 16, ATLAS_METHODS = 32, ATLAS_RUNGS = 29, ATLAS_BINARY64 = ATLAS_RUNGS - 3 };

/* One method in one scene. */
struct atlas_cell {
	struct failure failure; /* in binary64 */
	int rung;               /* coarsest at which it survives; ATLAS_RUNGS: none */
	struct failure below;   /* what happens one rung coarser, if there is one */
	bool done, refused;     /* neither: not made, for a stop */
};

struct atlas {
	const struct figure_setup *setup;
	int scenes, methods;
	const char *scene_name[ATLAS_SCENES], *method[ATLAS_METHODS];
	struct scene_file *file[ATLAS_SCENES];
	struct touchstone_scene scene[ATLAS_SCENES];
	struct touchstone_limits limits;
	struct atlas_cell cell[ATLAS_METHODS][ATLAS_SCENES];
};

/* Reads the scenes of these names (in the cases' folder `stress`; ended by NULL) for all methods an engine can run by.
 * NULL with one line in `error`; free it with atlas_close. */
struct atlas *atlas_open(const struct figure_setup *setup, const char *const scenes[], uint64_t events,
						 char error[512]);
void atlas_close(struct atlas *atlas); /* NULL is fine */

/* Fills the cells; those that a stop left out are not done. False with one line in `error`. */
bool atlas_measure(struct atlas *atlas, char error[512]);

/* What was measured as a result, which the caller frees (atlas_figure.c); NULL when out of memory. */
struct result *atlas_result(const struct atlas *atlas);

int atlas_bits(int rung);
const char *atlas_arithmetic(int rung, char name[16]);

/* No stress scene runs out of events of its own accord. */
bool atlas_goes_well(enum failure_kind kind);

/* The precision in which a cell's failure is to be seen: binary64, or the finest below it that fails. */
int atlas_shown(const struct atlas_cell *cell);
const struct failure *atlas_failure_shown(const struct atlas_cell *cell);

#endif
