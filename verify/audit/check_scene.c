/* Checks of scenes: all seeds run, and again in every arithmetic in which the digest is to be the same. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "audit/check.h"
#include "command/command.h"
#include "command/outcome.h"

static bool measures(const struct suite_check *check, enum audit_quantity from, enum audit_quantity to)
{
	bool found = false;
	for (size_t m = 0; m < check->measure_count; m++)
		found |= check->measures[m].quantity >= &audit_quantities[from] &&
				 check->measures[m].quantity <= &audit_quantities[to];
	return found;
}

static bool whole(const struct outcome *outcomes, size_t count, char error[STORE_ERROR])
{
	for (size_t o = 0; o < count; o++) {
		if (outcomes[o].failed) memcpy(error, outcomes[o].error, STORE_ERROR);
		if (outcomes[o].failed || outcomes[o].interrupted) return false;
	}
	return true;
}

/* Runs the check's scene with all seeds. Timings are taken one run at a time. */
static bool run(const struct suite_check *check, const char *arithmetic, uint64_t seed, double share, int threads,
				struct outcome *outcomes, size_t count, char error[STORE_ERROR])
{
	struct scene_file *file = suite_scene(check, arithmetic, error);
	if (!file) return false;
	*error = '\0';
	struct run_plan plan = {
		.path = check->scene,
		.file = file,
		.limits = file->limits,
	};
	if (!arithmetic && measures(check, SCENE_BELOW_CONTACT, SCENE_DEEPEST)) plan.measures |= RUN_IMPACT;
	if (!arithmetic && measures(check, SCENE_ENERGY_DRIFT, SCENE_MOMENTUM_DRIFT)) plan.measures |= RUN_CONSERVATION;
	if (share < 1) {
		file->equilibrate *= share;
		plan.limits.time *= share;
		if (plan.limits.events < UINT64_MAX) plan.limits.events = (uint64_t)ceil(share * (double)plan.limits.events);
	}
	bool timed = measures(check, SCENE_EVENT_TIME, SCENE_COLLISION_SPEED);
	struct simulation_progress progress = {.line = progress_begin(check->name, "events"), .runs = (unsigned)count};
#pragma omp parallel for schedule(dynamic, 1) num_threads(timed ? 1 : threads)
	for (size_t run = 0; run < count; run++) outcome_find(&outcomes[run], &plan, seed + run, &progress);
	progress_end(&progress.line);
	scene_file_close(file);
	return whole(outcomes, count, error);
}

static void free_all(struct outcome *outcomes, size_t count)
{
	for (size_t o = 0; outcomes && o < count; o++) outcome_free(&outcomes[o]);
	free(outcomes);
}

/* ---- what they found */

/* One digest for all: that of a single run, or the runs' digests hashed in turn (FNV-1a over their bytes). */
static void write_digest(char word[MEASURE_WORDS], const struct outcome *outcomes, size_t count)
{
	uint64_t digest = count == 1 ? outcomes->status.digest : 0xcbf29ce484222325;
	for (size_t o = 0; o < count && count > 1; o++)
		for (int byte = 0; byte < 8; byte++)
			digest = (digest ^ (outcomes[o].status.digest >> 8 * byte & 0xff)) * 0x100000001b3;
	snprintf(word, MEASURE_WORDS, "%016llx", (unsigned long long)digest);
}

/* All verdicts there were: "done", "done, halted". */
static struct measurement verdicts(const struct outcome *outcomes, size_t count)
{
	char word[MEASURE_WORDS] = "";
	for (size_t o = 0; o < count; o++) {
		const char *verdict = outcome_verdict(&outcomes[o]);
		size_t length = strlen(word);
		if (!strstr(word, verdict)) snprintf(word + length, sizeof word - length, "%s%s", length ? ", " : "", verdict);
	}
	return measurement_word(word);
}

static struct measurement below_contact(const struct outcome *outcomes, size_t count)
{
	uint64_t below = 0, contacts = 0;
	for (size_t o = 0; o < count; o++) {
		below += outcomes[o].impact->exact.below;
		contacts += outcomes[o].impact->count;
	}
	return measurement_proportion(below, contacts);
}

/* Of a single run; NaN where there is no such thing. */
static double value_of(const struct outcome *outcome, enum audit_quantity quantity)
{
	const struct touchstone_status *status = &outcome->status;
	const struct conservation *begin = &outcome->conserved[0], *end = &outcome->conserved[1];
	switch (quantity) {
	case SCENE_SEPARATION_SPREAD:
		return impact_deviation(&outcome->impact->exact, outcome->impact->count);
	case SCENE_DEEPEST:
		return outcome->impact->count ? fmax(0, -outcome->impact->exact.least) : NAN;
	case SCENE_ENERGY_DRIFT:
		return fabs(conservation_energy_drift(begin, end));
	case SCENE_MOMENTUM_DRIFT:
		return conservation_momentum_drift(begin, end);
	case SCENE_EVENT_TIME:
		return status->events ? 1e9 * outcome->wall_seconds / (double)status->events : NAN;
	case SCENE_COLLISION_SPEED:
		return (double)status->collisions / outcome->wall_seconds;
	default:
		return (double)status->memory / (double)outcome->particles;
	}
}

static struct measurement measure(const struct quantity_entry *entry, const struct outcome *outcomes, size_t count)
{
	enum audit_quantity quantity = (enum audit_quantity)(entry - audit_quantities);
	struct sample sample = {0};
	char word[MEASURE_WORDS];
	switch (quantity) {
	case SCENE_DIGEST:
		write_digest(word, outcomes, count);
		return measurement_word(word);
	case SCENE_VERDICT:
		return verdicts(outcomes, count);
	case SCENE_BELOW_CONTACT:
		return below_contact(outcomes, count);
	default:
		for (size_t o = 0; o < count; o++) sample_add(&sample, value_of(&outcomes[o], quantity));
		return measurement_sample(entry->nature, &sample);
	}
}

bool check_scene(const struct suite_check *check, uint64_t seed, double share, int threads, struct check_value *values,
				 char error[STORE_ERROR])
{
	size_t count = share < 1 ? 1 : (size_t)check->seeds;
	struct outcome *outcomes = calloc(count, sizeof *outcomes);
	if (!outcomes) snprintf(error, STORE_ERROR, "out of memory");
	bool good = outcomes && run(check, NULL, seed, share, threads, outcomes, count, error);
	for (size_t m = 0; good && m < check->measure_count; m++)
		values[m].measured = measure(check->measures[m].quantity, outcomes, count);
	free_all(outcomes, count);
	for (size_t m = 0; good && m < check->measure_count; m++) {
		if (!check->measures[m].same_in) continue;
		outcomes = calloc(count, sizeof *outcomes);
		good = outcomes && run(check, check->measures[m].same_in, seed, share, threads, outcomes, count, error);
		if (good) write_digest(values[m].other, outcomes, count);
		free_all(outcomes, count);
	}
	return good;
}
