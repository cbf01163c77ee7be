/* Long gases are kept while they are under way: a run of the paper's size takes many minutes. */
#include "figure/step_gas.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "campaign/piece_store.h"
#include "store/checkpoint.h"
#include "store/checksum.h"

/* Of the gas, and of the program: what another revision has begun is begun again. */
static uint64_t identity_of(const struct step_gas_run *run)
{
	char key[STEP_GAS_KEY];
	step_gas_key(run->gas, run->seed, key);
	const char *revision = piece_store_revision();
	return checksum(checksum(0, key, strlen(key)), revision, strlen(revision));
}

/* What is counted, as plain numbers: of all, and of each particle. */
enum { COUNTS = INCONSISTENCIES + 1, SUMS = 4, EACH = 3 };

static bool put_all(struct checkpoint *checkpoint, const struct step_gas_run *run)
{
	const struct inconsistency *inconsistency = &run->outcome->inconsistency;
	const struct conservation *begin = &run->begin;
	size_t particles = run->gas->particles;
	uint64_t counts[COUNTS] = {inconsistency->events}, *last = malloc(EACH * particles * sizeof *last);
	double sums[SUMS] = {begin->energy[0], begin->energy[1], begin->energy_scale, run->outcome->seconds};
	memcpy(counts + 1, inconsistency->count, sizeof inconsistency->count);
	for (size_t p = 0; last && p < particles; p++) {
		last[EACH * p] = inconsistency->last[p].event;
		last[EACH * p + 1] = inconsistency->last[p].partner;
		last[EACH * p + 2] = inconsistency->last[p].misread;
	}
	bool all = last && checkpoint_put(checkpoint, "counts", TOUCHSTONE_COUNTS, COUNTS, counts) &&
			   checkpoint_put(checkpoint, "sums", TOUCHSTONE_DOUBLES, SUMS, sums) &&
			   checkpoint_put(checkpoint, "last", TOUCHSTONE_COUNTS, EACH * particles, last);
	free(last);
	return all;
}

static bool get_all(const struct checkpoint *checkpoint, struct step_gas_run *run)
{
	struct inconsistency *inconsistency = &run->outcome->inconsistency;
	size_t particles = run->gas->particles;
	uint64_t counts[COUNTS], *last = malloc(EACH * particles * sizeof *last);
	double sums[SUMS];
	bool all = last && checkpoint_get(checkpoint, "counts", TOUCHSTONE_COUNTS, COUNTS, counts) &&
			   checkpoint_get(checkpoint, "sums", TOUCHSTONE_DOUBLES, SUMS, sums) &&
			   checkpoint_get(checkpoint, "last", TOUCHSTONE_COUNTS, EACH * particles, last);
	if (all) {
		inconsistency->events = counts[0];
		memcpy(inconsistency->count, counts + 1, sizeof inconsistency->count);
		run->begin.energy[0] = sums[0], run->begin.energy[1] = sums[1];
		run->begin.energy_scale = sums[2], run->outcome->seconds = sums[3];
	}
	for (size_t p = 0; all && p < particles; p++)
		inconsistency->last[p] =
			(struct inconsistency_last){last[EACH * p], (uint32_t)last[EACH * p + 1], (uint32_t)last[EACH * p + 2]};
	free(last);
	return all;
}

bool step_gas_keep(const struct step_gas_run *run)
{
	struct checkpoint checkpoint = {
		.seed = run->seed, .identity = identity_of(run), .state_version = TOUCHSTONE_STATE_VERSION};
	char error[STORE_ERROR];
	snprintf(checkpoint.program, CHECKPOINT_NAME, "touchstone, revision %.40s", piece_store_revision());
	snprintf(checkpoint.scene, CHECKPOINT_NAME, "%s", step_gas_name(run->gas));
	snprintf(checkpoint.arithmetic, CHECKPOINT_NAME, "%s", run->gas->arithmetic);
	snprintf(checkpoint.method, CHECKPOINT_NAME, "%s", run->gas->method);
	bool kept = touchstone_save(run->engine, &checkpoint.state) && put_all(&checkpoint, run);
#pragma omp critical(step_gas_checkpoint) /* HDF5 is for one thread at a time */
	kept = kept && checkpoint_write(run->kept, &checkpoint, error);
	checkpoint_free(&checkpoint);
	return kept;
}

bool step_gas_go_on(struct step_gas_run *run)
{
	struct checkpoint checkpoint;
	struct touchstone_engine *engine = NULL;
	char error[STORE_ERROR];
	bool goes_on;
#pragma omp critical(step_gas_checkpoint)
	goes_on = checkpoint_read(run->kept, &checkpoint, error);
	if (!goes_on) return false;
	if (checkpoint.identity == identity_of(run))
		engine = touchstone_restore(&run->scene, run->gas->arithmetic, run->gas->method, &checkpoint.state, error);
	goes_on = engine && get_all(&checkpoint, run);
	checkpoint_free(&checkpoint);
	touchstone_destroy(goes_on ? run->engine : engine);
	if (goes_on) run->engine = engine;
	return goes_on;
}
