/* The 2016 paper's gases (section 5): square wells and square shoulders of width 3, as deep or high as kT. A gas here
 * is the scene of cases/square-well.yaml or cases/square-shoulder.yaml, so that `run` can show it again. */
#ifndef VERIFY_STEP_GAS_H
#define VERIFY_STEP_GAS_H

#include "figure/figure.h"
#include "measure/conservation.h"
#include "measure/course.h"
#include "measure/inconsistency.h"
#include "measure/misreading.h"
#include "touchstone.h"

struct step_gas {
	bool shoulder; /* otherwise a well */
	size_t particles;
	enum touchstone_form form;
	const char *arithmetic, *method;
	double equilibrate; /* collisions per particle */
	uint64_t events;    /* wanted */
	bool watched;       /* by a watcher of misreadings; otherwise inconsistencies are counted */
};

/* What came of one. */
struct step_gas_outcome {
	struct inconsistency inconsistency;
	struct misreading misreading;
	struct touchstone_status end;
	double seconds;      /* of one core, with the observers */
	double energy_drift; /* relative, see measure/conservation.h */
	bool begun, stopped;
	char error[320];
};

/* One that is under way; what it is made from and what it fills are the caller's. */
struct step_gas_run {
	const struct step_gas *gas;
	uint64_t seed;
	const char
		*kept; /* path of the checkpoint in which it is kept when it is stopped, and every so often; NULL: none */
	const struct watch *watch;
	struct step_gas_outcome *outcome;
	struct touchstone_scene scene;
	struct touchstone_engine *engine;
	struct conservation begin; /* where counting began */
	uint64_t since;            /* events since the checkpoint */
};

/* "square-well" or "square-shoulder". */
const char *step_gas_name(const struct step_gas *gas);

/* Events that the gas takes in all. */
uint64_t step_gas_events(const struct step_gas *gas);

/* Runs it; `outcome` is filled, with one line in its error when that could not be. A gas that was kept goes on. */
void step_gas_run(const struct step_gas *gas, uint64_t seed, const char *kept, const struct watch *watch,
				  struct step_gas_outcome *outcome);

/* All that determines its numbers, on one line. */
enum { STEP_GAS_KEY = 320 };
void step_gas_key(const struct step_gas *gas, uint64_t seed, char key[STEP_GAS_KEY]);

/* Writes the checkpoint of a gas that has begun to count inconsistencies; takes one at its start to where it was kept:
 * another engine, and what has been counted. False when that cannot be, or what is kept is of something else. */
bool step_gas_keep(const struct step_gas_run *run);
bool step_gas_go_on(struct step_gas_run *run);

/* The command that shows the same. */
void step_gas_command(const struct step_gas *gas, uint64_t seed, char command[320]);

/* The parts of the page, in states_paper.c, states_precision.c and states_rivals.c: the gases each wants (written to
 * `gases` where that is not NULL; returns how many), and what it makes of their outcomes. */
enum { MOST_STEP_GASES = 96 };
size_t states_paper_gases(bool full, struct step_gas *gases);
void states_paper_tell(struct result *result, const struct step_gas *gases, const struct step_gas_outcome *outcomes);
size_t states_precision_gases(bool full, struct step_gas *gases);
void states_precision_tell(struct result *result, const struct step_gas *gases,
						   const struct step_gas_outcome *outcomes);
size_t states_rivals_gases(bool full, struct step_gas *gases);
void states_rivals_tell(struct result *result, const struct step_gas *gases, const struct step_gas_outcome *outcomes,
						uint64_t seed);

#endif
