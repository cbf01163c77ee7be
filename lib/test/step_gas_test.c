/* Gases of particles with steps are what statistical mechanics says: how often pairs climb, how many are captured, the
 * second virial coefficient from pairs and from impulses, and captures as many as releases.
 *
 * Every tolerance is held against the statistical error of the measurement, which is estimated from the run itself. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <stdio.h>
#include <stdlib.h>

#include "scene/scene.h"

enum { SEED = 20160301, PARTS = 24, MOST_STATES = 4 };

static const double pi = 3.14159265358979323846;

static bool brief; /* under sanitizers, where everything takes ten times longer */

/* What a run is made of, summed over its time. */
struct sums {
	double time, temperature, virial;
	double pairs[MOST_STATES + 1]; /* in each state, times time */
	double captures, releases, inner_bounces, outer_bounces;
};

struct gas {
	struct touchstone_scene scene;
	struct touchstone_engine *engine;
	double pairs[MOST_STATES + 1], energy; /* now */
	double last;                           /* event */
	double total_energy;
	struct sums sums;
};

/* Drawn together counts as negative: at wells, where pairs turn back within a step, and where they leave one. */
static void see(void *context, struct touchstone_engine *engine, const struct touchstone_event *event)
{
	(void)engine;
	struct gas *gas = context;
	struct sums *sums = &gas->sums;
	double wait = event->time - gas->last, count = (double)gas->scene.particle_count;
	gas->last = event->time;
	sums->time += wait;
	sums->temperature += wait * 2 * (gas->total_energy - gas->energy) / (3 * count);
	for (int s = 0; s <= MOST_STATES; s++) sums->pairs[s] += wait * gas->pairs[s];
	bool inside = event->kind == TOUCHSTONE_BOUNCE && event->approach < 0;
	bool together = inside || (event->kind == TOUCHSTONE_CAPTURE && event->energy < 0) ||
					(event->kind == TOUCHSTONE_RELEASE && event->energy > 0);
	sums->virial += (together ? -1 : 1) * event->impulse * event->distance;
	sums->captures += event->kind == TOUCHSTONE_CAPTURE;
	sums->releases += event->kind == TOUCHSTONE_RELEASE;
	sums->inner_bounces += inside;
	sums->outer_bounces += event->kind == TOUCHSTONE_BOUNCE && !inside;
	gas->pairs[event->before]--;
	gas->pairs[event->after]++;
	gas->energy += event->energy;
}

/* Makes a gas of unit diameter and mass, lets it forget its start, and counts who is captured. */
static struct gas begin(size_t count, double density, double temperature, const struct touchstone_potential *potential)
{
	static const struct scene_species ball[] = {{1, {1, 1}}};
	const struct scene_recipe recipe = {.dimensions = 3,
										.particle_count = count,
										.density = density,
										.boundary_restitution = {TOUCHSTONE_CONSTANT, 1},
										.species_count = 1,
										.species = ball,
										.restitution = {TOUCHSTONE_CONSTANT, 1},
										.potential_count = 1,
										.potentials = potential,
										.velocities = SCENE_MAXWELL,
										.temperature = temperature};
	struct gas gas = {0};
	struct scene_error complaint;
	char error[160] = "";
	if (!scene_build(&recipe, SEED, &gas.scene, &complaint)) fail_msg("%s %s", complaint.key, complaint.text);
	gas.engine = touchstone_create(&gas.scene, "binary64", "stable", error);
	if (!gas.engine) fail_msg("%s", error);
	touchstone_run(gas.engine, &(struct touchstone_limits){50 * count, INFINITY, NULL}, NULL);
	struct touchstone_status status;
	touchstone_status(gas.engine, &status);
	gas.last = status.time;
	gas.energy = gas.total_energy = status.potential_energy;
	gas.pairs[0] = (double)count * (double)(count - 1) / 2 - (double)status.captured;
	for (uint32_t p = 0; p < count; p++) {
		struct touchstone_captured list[128];
		double position[3], velocity[3];
		size_t captured = touchstone_captured(gas.engine, p, list, 128);
		assert_true(captured <= 128);
		for (size_t k = 0; k < captured; k++) gas.pairs[list[k].state] += 0.5;
		touchstone_state(gas.engine, p, position, velocity);
		for (int axis = 0; axis < 3; axis++) gas.total_energy += velocity[axis] * velocity[axis] / 2;
	}
	return gas;
}

/* Runs on and adds up; in so many parts, which are taken to be independent. */
static void measure(struct gas *gas, uint64_t events, struct sums part[PARTS])
{
	struct touchstone_observer observer = {see, gas};
	for (int p = 0; p < PARTS; p++) {
		gas->sums = (struct sums){0};
		touchstone_run(gas->engine, &(struct touchstone_limits){events / PARTS, INFINITY, NULL}, &observer);
		part[p] = gas->sums;
	}
	struct touchstone_status status; /* what was added up on the way is what the engine knows */
	touchstone_status(gas->engine, &status);
	double captured = 0;
	for (int s = 1; s <= MOST_STATES; s++) captured += gas->pairs[s];
	assert_true(captured == (double)status.captured);
	assert_true(fabs(gas->energy - status.potential_energy) < 1e-6);
	touchstone_destroy(gas->engine);
	scene_free(&gas->scene);
}

struct estimate {
	double mean, error;
};

static struct estimate estimate_of(const double part[PARTS])
{
	double sum = 0, squares = 0;
	for (int p = 0; p < PARTS; p++) sum += part[p];
	for (int p = 0; p < PARTS; p++) squares += pow(part[p] - sum / PARTS, 2);
	return (struct estimate){sum / PARTS, sqrt(squares / (PARTS - 1) / PARTS)};
}

/* Ratios of what was measured to what is expected, part by part, are 1. */
static void assert_one(const double ratio[PARTS], double tolerance, const char *what)
{
	struct estimate estimate = estimate_of(ratio);
	if (brief) tolerance *= 20; /* a run too short for bound pairs to be forgotten */
	print_message("  %s: %.4f +- %.4f of what is expected\n", what, estimate.mean, estimate.error);
	assert_true(3 * estimate.error < tolerance);
	assert_true(fabs(estimate.mean - 1) < tolerance);
}

/* At any density the normal speed at a step is that of an ideal gas: of all that come to climb it, exp(-energy/kT) do;
 * and in equilibrium as many pairs come in as go out. */
static void as_many_climb_as_boltzmann_says(void **state)
{
	(void)state;
	for (int sign = -1; sign <= 1; sign += 2) {
		const struct touchstone_step step = {1.5, sign};
		const struct touchstone_potential potential = {{0, 0}, 1, {TOUCHSTONE_CONSTANT, 1}, 1, &step};
		struct sums part[PARTS];
		double climbing[PARTS], balance[PARTS];
		struct gas gas = begin(500, 0.3, 1, &potential);
		measure(&gas, brief ? 48000 : 1000000, part);
		for (int p = 0; p < PARTS; p++) {
			double pass = sign < 0 ? part[p].releases : part[p].captures;
			double stay = sign < 0 ? part[p].inner_bounces : part[p].outer_bounces;
			climbing[p] = pass / (pass + stay) / exp(-part[p].time / part[p].temperature);
			balance[p] = part[p].captures / part[p].releases;
			assert_true((sign < 0 ? part[p].outer_bounces : part[p].inner_bounces) == 0);
		}
		print_message("%s\n", sign < 0 ? "well" : "shoulder");
		assert_one(climbing, 0.02, "fraction that climbs");
		assert_one(balance, 0.005, "captures to releases");
	}
}

/* Volume of the shell between two distances. */
static double shell(double inner, double outer)
{
	return 4 * pi / 3 * (pow(outer, 3) - pow(inner, 3));
}

/* At low density pairs are in each state by its volume and exp(-energy/kT), and p V / N kT = 1 + B n, with B by
 * integration; the rest is of the order of n times the volume of a step, 1 or 2 % here. It is warm, so that few pairs
 * stay together until a third comes by. */
static void dilute_pairs_know_only_each_other(void **state)
{
	(void)state;
	static const struct touchstone_step steps[][3] = {{{2, -1}}, {{2, 1}}, {{1.3, 0.5}, {1.6, -1.25}, {2, -0.75}}};
	static const size_t step_count[] = {1, 1, 3};
	static const char *const names[] = {"well", "shoulder", "three steps"};
	for (int s = 0; s < 3; s++) {
		const struct touchstone_potential potential = {{0, 0}, 1, {TOUCHSTONE_CONSTANT, 1}, step_count[s], steps[s]};
		const double density = 1e-3, count = brief ? 1000 : 8000, volume = count / density;
		const double all = count * (count - 1) / 2;
		struct sums part[PARTS];
		double occupied[PARTS], from_pairs[PARTS], from_impulses[PARTS], rate[PARTS];
		struct gas gas = begin((size_t)count, density, 2, &potential);
		measure(&gas, brief ? 48000 : steps[s][0].energy > 0 && step_count[s] == 1 ? 160000 : 480000, part);
		print_message("%s\n", names[s]);
		for (int p = 0; p < PARTS; p++) {
			double kt = part[p].temperature / part[p].time, inner = 1, exact = 2 * pi / 3, found = exact;
			for (size_t k = 0; k < step_count[s]; k++) {
				double between = shell(inner, steps[s][k].distance);
				double factor = part[p].pairs[step_count[s] - k] / part[p].time / (all * between / volume);
				exact -= (exp(-steps[s][k].energy / kt) - 1) * between / 2;
				found -= (factor - 1) * between / 2;
				inner = steps[s][k].distance;
			}
			double held = 0, expected = 0;
			inner = 1;
			for (size_t k = 0; k < step_count[s]; k++) {
				held += part[p].pairs[step_count[s] - k] / part[p].time;
				expected += all / volume * shell(inner, steps[s][k].distance) * exp(-steps[s][k].energy / kt);
				inner = steps[s][k].distance;
			}
			occupied[p] = held / expected;
			from_pairs[p] = found / exact;
			from_impulses[p] = part[p].virial / (3 * count * kt * part[p].time) / (exact * density);
			double come = part[p].captures + part[p].outer_bounces;
			rate[p] = come / part[p].time / (count / 2 * 4 * density * 4 * sqrt(pi * kt));
		}
		assert_one(occupied, 0.04, "captured pairs");
		assert_one(from_pairs, 0.2, "second virial coefficient, from pairs");
		assert_one(from_impulses, 0.2, "second virial coefficient, from impulses");
		if (step_count[s] == 1) assert_one(rate, 0.03, "rate at which pairs come to the step");
	}
}

int main(void)
{
	brief = getenv("TOUCHSTONE_BRIEF");
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(as_many_climb_as_boltzmann_says),
		cmocka_unit_test(dilute_pairs_know_only_each_other),
	};
	return cmocka_run_group_tests(tests, NULL, NULL);
}
