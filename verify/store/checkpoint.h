/* Checkpoints: files from which a run goes on as if it had never stopped.
 *
 * A file begins with 512 bytes of text: what it is, the version of the format, the number of bytes that follow and
 * their checksum, by which it is refused, before anything else looks at it, when it is not whole. The rest is HDF5
 * (which tools find behind the text): attributes that say what it is a checkpoint of, the group `state` with a dataset
 * for each field of the engine's state, and the group `run` with what has been measured on the way. Every dataset has
 * checksums of its own (Fletcher 32). Nothing is compressed: gzip at level 1 with bytes shuffled
 * halves the checkpoint of 10^5 hard spheres in binary64 after 2 10^6 events (10.5 MB), and takes five times as long
 * (h5repack -f SHUF -f GZIP=1 against -f FLET: 0.14 s and 0.03 s of the processor's time). */
#ifndef VERIFY_CHECKPOINT_H
#define VERIFY_CHECKPOINT_H

#include "store/text.h"
#include "touchstone.h"

enum { CHECKPOINT_FORMAT = 1, CHECKPOINT_NAME = 64 };

struct checkpoint {
	/* what it is of */
	char program[CHECKPOINT_NAME], scene[CHECKPOINT_NAME], arithmetic[CHECKPOINT_NAME], method[CHECKPOINT_NAME];
	uint64_t seed;
	uint64_t identity;                /* of the start state, and of what was done to it before counting began */
	uint64_t state_version;           /* TOUCHSTONE_STATE_VERSION */
	struct touchstone_snapshot state; /* of the engine */
	struct touchstone_snapshot run;   /* of those who look on; each field of one row */
};

/* Writes a checkpoint, to the disk, in the place of the one that may be there: at any moment there is a whole file.
 * False with a message when it cannot be written. */
bool checkpoint_write(const char *path, const struct checkpoint *checkpoint, char error[STORE_ERROR]);

/* Reads one; end with checkpoint_free. False with a message when it is missing, none, not whole or of another version.
 */
bool checkpoint_read(const char *path, struct checkpoint *checkpoint, char error[STORE_ERROR]);
void checkpoint_free(struct checkpoint *checkpoint);

/* Adds a field of so many numbers to `run`, copied; takes those of a field of that name, content and size. False when
 * out of memory, or when there is no such field. */
bool checkpoint_put(struct checkpoint *checkpoint, const char *name, enum touchstone_content content, size_t count,
					const void *numbers);
bool checkpoint_get(const struct checkpoint *checkpoint, const char *name, enum touchstone_content content,
					size_t count, void *numbers);

#endif
