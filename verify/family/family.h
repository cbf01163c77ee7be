/* Families of input to finders: named, seeded, each with its reason. The same family, shape and seed give the same
 * questions on every machine. */
#ifndef VERIFY_FAMILY_H
#define VERIFY_FAMILY_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "touchstone.h"

enum family_origin {
	FAMILY_HAND_MADE, /* built to be hard */
	FAMILY_HARVESTED, /* taken from a run of the engine */
};

struct family {
	const char *name;  /* as on the command line */
	const char *about; /* one line */
	enum family_origin origin;
	unsigned shapes; /* bit 1 << enum touchstone_shape for each shape it has questions of */
	bool paired;     /* questions 2k and 2k + 1 have events at exactly the same time */
};

/* The families, NULL after the last; and the one of a name, or NULL. */
const struct family *family_at(size_t number);
const struct family *family_named(const char *name);

/* Fills questions number first .. first + count - 1 of a family. False with one line in `error` when the family has
 * none of that shape, or memory ran out. */
bool family_fill(const struct family *family, enum touchstone_shape shape, uint64_t seed, uint64_t first, size_t count,
				 double (*numbers)[TOUCHSTONE_MOST_NUMBERS], char error[160]);

#endif
