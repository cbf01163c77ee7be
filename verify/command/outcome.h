/* What the command `run` finds out about one run, and how it is told.
 *
 * The JSON of `run --json` is one object:
 *
 *	scene, title, file     name of the scene, its title, the path it was read from
 *	settings               list of the KEY=VALUE that overrode it
 *	particles, dimensions, arithmetic, bits, method
 *	seed ... impact        those of the first run, as below
 *	peak_memory_bytes      of the whole program, with all runs
 *	machine                processor, compiler and so on
 *	explained              list of lines, with --explain
 *	runs, together         with --runs R, R > 1: list of all runs, the first included; sums over them, and with
 *	                       --against horizon: {count, mean, deviation, least, open}: of those that never differed
 *
 * and of each run:
 *
 *	seed
 *	events, collisions     physical events after equilibration, and those between two particles
 *	captures, releases     of pairs, at a step of their potential; bounces: turned back there
 *	crossings              of virtual walls, which are no events
 *	captured_pairs         those within a step at the end; potential_energy: of all of them
 *	kicked_energy          what the kicks of convection brought in; thermostat_energy: what thermal walls did
 *	lookups                bookkeeping: cells crossed and searches repeated
 *	time_begun, time       when equilibration ended, and the last event (or the limit that was reached)
 *	verdict, reason        done, collapsed, halted, diverged, interrupted; why, "" when a limit was reached
 *	complete               false when the run was interrupted
 *	digest                 16 hexadecimal digits
 *	wall_seconds           without start and equilibration, with observers and checkpoints; of a resumed run, of all
 *	                       its parts up to the checkpoints they were resumed from, and this one
 *	resumed_from           events executed when the run was resumed; null if it was not
 *	checkpoints            how many were written on the way, and checkpoint_seconds, what that took
 *	events_per_second, collisions_per_second, bytes_per_particle, state_bytes_per_particle (of them for tracked states)
 *	fluxes                 for each virtual wall, what passed it [with its normal, against it]: count, mass, momentum
 *	                       [x, y, z], energy (kinetic)
 *	conservation           when measured: energy [first, last], momentum [[x, y, z] first, [x, y, z] last],
 *	                       energy_scale, momentum_scale (see measure/conservation.h), energy_drift, momentum_drift
 *	                       (relative to the scale), energy_drift_per_million, momentum_drift_per_million (collisions)
 *	three_body             when measured: contacts; overlapping, those after which the two overlap; events, those after
 *	                       which one of them overlaps a third as well, rate, rate_interval (per contact, 95 %);
 *	                       encounters, those that do not just follow another of the same three, encounter_rate and
 *	                       encounter_rate_interval
 *	against                with --against A: A
 *	horizon                events per particle for which both arithmetics take the same course; null when none was run
 *	horizon_events, horizon_time
 *	                       how many events that are, and when the last of them happens
 *	horizon_differs        false when the two had not parted where the run ended (or was interrupted)
 *	parting                when they differ, the events that do, {here: {kind, particles: [first, second] or particle
 *	                       and wall, time}, there: the same in the finer arithmetic}; null for one that has none left
 *	impact                 when measured: contacts; measured and exact, each with below, above, fraction_below,
 *	                       fraction_below_interval (95 %), mean_ulp, deviation_ulp, least_ulp, most_ulp (ulp: the step
 *	                       from the contact distance upwards), and bars, counts per representable number, of
 *	                       which first_bar is how many numbers from contact the first stands
 *	states                 when measured: tests (of pairs near a step); for each kind of inconsistency of
 *	                       measure/inconsistency.h, by its name, count and per_event, [rate, 95 % interval]; repeats,
 *	                       misses and energy as in measure/misreading.h; repeated, missed, stuck: the first of each,
 *	                       null where there was none: event, time, kind, pair, third (null: none), was, read
 *	failure                when measured: what (survives, halts, ...: measure/failure.h), survived (whether nothing is
 *	                       wrong), event (the first that shows it, null for none), time, text
 *	trace                  with --trace: list of events, each with kind, between [particle, particle or wall], time,
 *	                       wait (since the later of their last events), separation, steps (that in representable
 *	                       numbers from contact), stabilising, backwards (measure/trace.h), positions and velocities
 *	                       (left by it, of both particles)
 *
 * Numbers that do not exist, such as the rate of no collisions, are null. */
#ifndef VERIFY_OUTCOME_H
#define VERIFY_OUTCOME_H

#include <jansson.h>

#include "command/run_measures.h"
#include "command/simulation.h"
#include "measure/conservation.h"
#include "measure/failure.h"
#include "measure/impact.h"
#include "measure/inconsistency.h"
#include "measure/misreading.h"
#include "measure/three_body.h"
#include "measure/trace.h"
#include "store/checkpoint.h"

/* What is to be run, once or several times. */
struct run_plan {
	const char *path; /* of the scene file */
	const struct scene_file *file;
	struct touchstone_limits limits; /* after equilibration */
	const char *const *settings;
	size_t setting_count;
	unsigned measures;      /* of enum run_measure */
	bool trace;             /* told event by event? */
	const char *xyz;        /* file for the particles at the end, or NULL */
	const char *against;    /* a finer arithmetic to find the horizon with, or NULL */
	const char *checkpoint; /* file for checkpoints, or NULL */
	uint64_t every;         /* so many events both are written, particles as one more frame; 0: at the end only */
	const char *resume;     /* file of the checkpoint that the run goes on from, and what it holds; or NULL */
	const struct checkpoint *resumed;
};

/* What was found out about the states of pairs. */
struct states_outcome {
	struct inconsistency inconsistency;
	struct misreading misreading;
	struct touchstone_listener listener; /* to tests, for both */
};

/* What became of one run. */
struct outcome {
	uint64_t seed;
	struct touchstone_status status;
	bool interrupted;
	size_t particles;
	double time_begun;   /* simulated time when equilibration ended */
	double wall_seconds; /* without equilibration; of all parts of a run that was resumed */
	double clock_begun;  /* the steady clock, less those wall seconds, when this part of the run began */
	bool resumed;
	uint64_t resumed_from; /* events */
	uint64_t checkpoints;  /* written by this program, and how long that took: */
	double checkpoint_seconds;
	bool conservation; /* measured, at begin and end: */
	struct conservation conserved[2];
	bool compared; /* with a finer arithmetic: */
	struct horizon horizon;
	struct impact *impact; /* NULL when not measured; freed by outcome_free */
	bool three_bodies;     /* measured: */
	struct three_body three_body;
	struct states_outcome *states; /* NULL when not measured; freed by outcome_free */
	struct trace trace;            /* all zeros when not wanted; freed by outcome_free */
	struct failure failure;        /* when watched for */
	size_t virtual_wall_count;
	struct touchstone_flux (*fluxes)[2]; /* through each; freed by outcome_free */
	bool failed;                         /* there was no run */
	char error[STORE_ERROR];             /* why it failed, or could not write its particles; "" otherwise */
};

/* Makes one run of the plan. */
void outcome_find(struct outcome *outcome, const struct run_plan *plan, uint64_t seed,
				  struct simulation_progress *progress);
void outcome_free(struct outcome *outcome);

/* done, collapsed, halted, diverged or interrupted; why is in its status. */
const char *outcome_verdict(const struct outcome *outcome);

/* Tells `count` outcomes of a plan: as a table on standard output; as JSON, with the lines of an explanation (or NULL,
 * which stays the caller's), owned by the caller. */
void outcome_print(const struct run_plan *plan, const struct outcome *outcomes, size_t count);
json_t *outcome_json(const struct run_plan *plan, const struct outcome *outcomes, size_t count, json_t *explained);

/* The same of their horizons alone: lines of the table, members of a run, and those of all runs together. */
void outcome_print_horizon(const struct run_plan *plan, const struct outcome *outcomes, size_t count);
void outcome_set_horizon(json_t *run, const struct run_plan *plan, const struct outcome *outcome);
json_t *outcome_horizons(const struct outcome *outcomes, size_t count);

/* One line of the table for people: what, and the rest as printf has it. */
__attribute__((format(printf, 2, 3))) void outcome_row(const char *what, const char *format, ...);

/* The events of a run one by one, and what goes wrong in it: lines of the table, and members of a run. */
void outcome_print_events(const struct run_plan *plan, const struct outcome *outcomes, size_t count);
void outcome_set_events(json_t *run, const struct run_plan *plan, const struct outcome *outcome);

/* The most memory this program has held so far, in bytes. */
uint64_t outcome_peak_memory(void);

/* All three-body events of several outcomes; false when they were not measured. */
bool outcome_three_body(const struct outcome *outcomes, size_t count, struct three_body *together);

/* All impacts of several outcomes; NULL when they were not measured. The caller frees it. */
struct impact *outcome_impact(const struct outcome *outcomes, size_t count);

#endif
