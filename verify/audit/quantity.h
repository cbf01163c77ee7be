/* What a check can measure: the names that a suite's `measure:` knows. */
#ifndef VERIFY_AUDIT_QUANTITY_H
#define VERIFY_AUDIT_QUANTITY_H

#include <stddef.h>

#include "audit/measurement.h"

enum check_kind { CHECK_SCENE, CHECK_GRADE, CHECK_FIGURE };
enum { CHECK_KINDS = 3 };

enum audit_quantity {
	/* of a scene's runs */
	SCENE_DIGEST,
	SCENE_VERDICT,
	SCENE_BELOW_CONTACT,
	SCENE_SEPARATION_SPREAD,
	SCENE_DEEPEST,
	SCENE_ENERGY_DRIFT,
	SCENE_MOMENTUM_DRIFT,
	SCENE_EVENT_TIME,
	SCENE_COLLISION_SPEED,
	SCENE_MEMORY,
	/* of a finder's answers */
	GRADE_MISSED,
	GRADE_PHANTOM,
	GRADE_NEGATIVE,
	GRADE_NAN,
	GRADE_MISORDERED,
	GRADE_BROKEN,
	GRADE_MEDIAN_ULP,
	GRADE_LARGEST_ULP,
	GRADE_CALL_TIME,
	/* of a figure's claims */
	FIGURE_DIFFERS,
	FIGURE_VERDICT,
	FIGURE_PROPORTION,
	FIGURE_VALUE,
	QUANTITIES_OF_AUDITS,
};

struct quantity_entry {
	const char *name;
	enum check_kind kind;
	enum measure_nature nature;
	enum measure_worse worse; /* where a suite does not say */
	const char *unit, *about;
};
extern const struct quantity_entry audit_quantities[QUANTITIES_OF_AUDITS];

/* The quantity of that name, or NULL; of that kind all names, parted by commas. Returns `names`. */
const struct quantity_entry *audit_quantity_named(enum check_kind kind, const char *name);
enum { QUANTITY_NAMES = 240 };
const char *audit_quantity_names(enum check_kind kind, char names[QUANTITY_NAMES]);

#endif
