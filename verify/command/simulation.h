/* One run of a scene, from its file to where it ends, with progress shown and Ctrl-C heeded on the way. */
#ifndef VERIFY_SIMULATION_H
#define VERIFY_SIMULATION_H

#include "command/progress.h"
#include "measure/horizon.h"
#include "store/scene_file.h"

/* Who looks at the engine in a pause; it must not be run. */
struct simulation_pause {
	void (*look)(void *context); /* NULL: nobody */
	void *context;
};
enum { PAUSE_CHECKPOINT, PAUSE_FRAME, PAUSES };

struct simulation {
	struct touchstone_scene scene;
	struct touchstone_engine *engine;
	uint64_t every; /* events: whenever so many more have been executed in all, there is a pause; 0: never */
	struct simulation_pause pause[PAUSES];
};

/* Makes the scene of `file` with another seed, and the engine it asks for. False with a message, and nothing to close,
 * when that cannot be. */
bool simulation_open(struct simulation *simulation, const struct scene_file *file, uint64_t seed,
					 char error[STORE_ERROR]);

/* The same in two steps: the scene, to be freed by simulation_close, and then the engine, in a state that was saved
 * or, without one, at the start. */
bool simulation_prepare(struct simulation *simulation, const struct scene_file *file, uint64_t seed,
						char error[STORE_ERROR]);
bool simulation_start(struct simulation *simulation, const struct scene_file *file,
					  const struct touchstone_snapshot *state, char error[STORE_ERROR]);
void simulation_close(struct simulation *simulation);

/* Begins once more from the state that the engine is in, a moment later, rounded to doubles, so that an engine in any
 * arithmetic can be given the same start. Its clock runs on, its counts begin anew. False with a message. */
bool simulation_begin_anew(struct simulation *simulation, const struct scene_file *file, char error[STORE_ERROR]);

/* Whether the arithmetic and the method that `file` names exist; false with a message that says where they were named.
 */
bool simulation_names(const struct scene_file *file, char error[STORE_ERROR]);

/* The progress of several runs, on one line for all. */
struct simulation_progress {
	struct progress line;
	double done;   /* events */
	unsigned runs; /* how many are to be made */
	/* Told in place of the line what is done of how many events; or NULL. */
	void (*tell)(void *context, double done, double total);
	void *context;
};

/* Runs until a limit is reached or the verdict is no longer DONE: true; or until an end is asked for: false. `besides`
 * are the events that this run executes for the same progress in other calls, as far as that is known. Several threads
 * may call it for one progress, which may be NULL. */
bool simulation_advance(struct simulation *simulation, const struct touchstone_limits *limits,
						const struct touchstone_observer *observer, struct simulation_progress *progress,
						uint64_t besides);

/* The horizon of a simulation that has only begun, against a finer arithmetic; progress as above. The engine stays
 * where it is. False with a message. */
bool simulation_horizon(const struct simulation *simulation, const struct scene_file *file, const char *against,
						const struct touchstone_limits *limits, struct simulation_progress *progress, uint64_t besides,
						struct horizon *horizon, char error[STORE_ERROR]);

#endif
