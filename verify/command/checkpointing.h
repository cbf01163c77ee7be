/* How `run` writes checkpoints of what it does, and goes on from one: the state of the engine, and what has been
 * measured since counting began. */
#ifndef VERIFY_CHECKPOINTING_H
#define VERIFY_CHECKPOINTING_H

#include "command/outcome.h"

struct checkpointing {
	const struct run_plan *plan;
	struct outcome *outcome;
	struct simulation *simulation;
	bool measuring; /* equilibration is over */
};

/* Whether the checkpoint that the plan resumes is one of this scene, arithmetic and method, and not beyond the plan's
 * limits; false with a message. */
bool checkpointing_fits(const struct run_plan *plan, const struct simulation *simulation, char error[STORE_ERROR]);

/* What was measured before a checkpoint, of enum run_measure. */
unsigned checkpointing_measures(const struct checkpoint *checkpoint);

/* Takes over what was measured before the checkpoint that the plan resumes; false with a message, such as when it lacks
 * a measure that is wanted. `*measuring` tells whether equilibration is over. */
bool checkpointing_resume(struct checkpointing *checkpointing, bool *measuring, char error[STORE_ERROR]);

/* Has checkpoints written while the simulation advances, if the plan says so. What cannot be written is told in the
 * outcome's error. `checkpointing` must last as long as the simulation. */
void checkpointing_begin(struct checkpointing *checkpointing, bool measuring);

/* Writes the last one, of a run that has ended or was stopped. */
void checkpointing_end(struct simulation *simulation);

#endif
