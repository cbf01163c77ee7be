/* What one arithmetic exports: everything in it is static but this table. The public functions of touchstone.h find
 * the table by name (lib/arithmetic.c) and call through it. */
#ifndef TOUCHSTONE_UNIT_H
#define TOUCHSTONE_UNIT_H

#include "touchstone.h"

struct unit {
	const char *name;
	bool (*choose)(int bits); /* sets this thread's working precision; false when the unit does not offer it */
	int (*bits)(void);        /* the working precision */
	struct touchstone_engine *(*create)(const struct touchstone_scene *, const char *method,
										const struct touchstone_snapshot *, /* or NULL: from the start */
										char error[160]);
	void (*destroy)(struct touchstone_engine *);
	enum touchstone_verdict (*run)(struct touchstone_engine *, const struct touchstone_limits *,
								   const struct touchstone_observer *);
	void (*status)(const struct touchstone_engine *, struct touchstone_status *);
	void (*recount)(struct touchstone_engine *);
	void (*elastic)(struct touchstone_engine *, bool);
	bool (*rescale)(struct touchstone_engine *, int exponent);
	void (*state)(const struct touchstone_engine *, uint32_t particle, double position[3], double velocity[3]);
	double (*temperature)(const struct touchstone_engine *, uint32_t particle);
	void (*observe_tests)(struct touchstone_engine *, struct touchstone_listener *);
	int (*separation)(const struct touchstone_engine *, double terms[3][3 * TOUCHSTONE_MOST_TERMS],
					  double contact[TOUCHSTONE_MOST_TERMS]);
	size_t (*overlaps)(const struct touchstone_engine *, uint32_t particle, struct touchstone_overlap *, size_t room);
	int (*pair_state)(const struct touchstone_engine *, uint32_t first, uint32_t second);
	size_t (*captured)(const struct touchstone_engine *, uint32_t particle, struct touchstone_captured *, size_t room);
	int (*side)(const struct touchstone_engine *, uint32_t particle, size_t wall);
	void (*flux)(const struct touchstone_engine *, size_t wall, struct touchstone_flux flux[2]);
	bool (*save)(const struct touchstone_engine *, struct touchstone_snapshot *);
	void (*explain)(const struct touchstone_engine *, void (*line)(void *, const char *), void *);
	bool (*drop)(const char *method, const struct touchstone_drop *, size_t, struct touchstone_landing *,
				 touchstone_bounce *, void *, char error[160]);
	bool (*find)(const char *method, enum touchstone_shape, const double (*numbers)[TOUCHSTONE_MOST_NUMBERS],
				 size_t count, bool chained, double *times, char error[160]);
	bool (*find_terms)(const char *method, enum touchstone_shape, const double (*numbers)[TOUCHSTONE_MOST_NUMBERS],
					   size_t count, double (*times)[TOUCHSTONE_MOST_TERMS], char error[160]);
	bool (*find_steps)(const char *method, enum touchstone_shape, const double numbers[TOUCHSTONE_MOST_NUMBERS],
					   struct touchstone_steps *, char error[160]);
	bool (*claim)(const char *method, enum touchstone_shape, struct touchstone_claim *, char error[160]);
	size_t (*exact_count)(enum touchstone_shape, const double (*numbers)[TOUCHSTONE_MOST_NUMBERS], size_t count);
};

extern const struct unit unit_short, unit_binary32, unit_binary64, unit_extended, unit_twin, unit_binary128, unit_mpfr2,
	unit_mpfr4, unit_mpfr16;

#endif
