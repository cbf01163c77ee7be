/* How `run` writes particles for viewers: where they are at the end, or on the way as well, in one file. */
#ifndef VERIFY_FRAMES_H
#define VERIFY_FRAMES_H

#include "aside.h"
#include "command/simulation.h"

struct frames {
	struct simulation *simulation; /* must last as long */
	struct aside file;
	struct touchstone_particle *particles;
	uint32_t *captured; /* partners of each; NULL where there are no steps */
};

/* Begins a file. False with a message, and nothing to end, when it cannot be written. */
bool frames_begin(struct frames *frames, struct simulation *simulation, const char *path, char error[STORE_ERROR]);

/* From here on adds a frame now, and whenever the simulation pauses. */
void frames_follow(struct frames *frames);

/* Adds the last one and puts the file in its place; false with a message. */
bool frames_end(struct frames *frames, char error[STORE_ERROR]);

/* Leaves no file behind. */
void frames_drop(struct frames *frames);

#endif
