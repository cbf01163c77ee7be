/* Stepped potentials: single events against their closed forms, and what is refused. */
#include "scene/potential.h"
#include "step_scenes.h"

enum { MOST_EVENTS = 64 };

/* ------------------------------------------------------------------ two particles */

struct seen {
	size_t count;
	struct touchstone_event event[MOST_EVENTS];
};

static void see(void *context, struct touchstone_engine *engine, const struct touchstone_event *event)
{
	struct seen *seen = context;
	if (event->kind < TOUCHSTONE_CROSSING && event->kind != TOUCHSTONE_WALL)
		assert_int_equal(touchstone_pair_state(engine, event->first, event->second), event->before);
	if (seen->count < MOST_EVENTS) seen->event[seen->count++] = *event;
}

/* A pair in open space, of masses 1 and 3, at rest together but for the relative motion; the second at the origin. */
static struct seen watch_pair(const char *arithmetic, const struct touchstone_potential *potential, const double r[3],
							  const double v[3], double velocity[3], double *energy)
{
	const struct touchstone_species species[2] = {{1, 1}, {1, 3}};
	struct touchstone_particle particles[2] = {{.species = 0}, {.species = 1}};
	for (int axis = 0; axis < 3; axis++) {
		particles[0].position[axis] = r[axis];
		particles[0].velocity[axis] = 0.75 * v[axis];
		particles[1].velocity[axis] = -0.25 * v[axis];
	}
	struct touchstone_scene scene = {.dimensions = 3,
									 .particle_count = 2,
									 .particles = particles,
									 .species_count = 2,
									 .species = species,
									 .box = {40, 40, 40},
									 .restitution = {TOUCHSTONE_CONSTANT, 1},
									 .potential_count = 1,
									 .potentials = potential};
	char error[160] = "";
	struct touchstone_engine *engine = touchstone_create(&scene, arithmetic, "stable", error);
	if (!engine) fail_msg("%s", error);
	struct seen seen = {0};
	struct touchstone_observer observer = {see, &seen};
	assert_int_equal(touchstone_run(engine, &(struct touchstone_limits){50, 100, NULL}, &observer), TOUCHSTONE_DONE);
	double position[3], first[3], second[3];
	struct touchstone_status status;
	touchstone_state(engine, 0, position, first);
	touchstone_state(engine, 1, position, second);
	touchstone_status(engine, &status);
	*energy = status.potential_energy;
	for (int axis = 0; axis < 3; axis++) {
		velocity[axis] = first[axis] - second[axis];
		*energy += (first[axis] * first[axis] + 3 * second[axis] * second[axis]) / 2;
	}
	touchstone_destroy(engine);
	return seen;
}

/* Speed along the line of centres after a climb, by energy: reduced mass 3/4. */
static double climbed(double normal, double energy)
{
	return sqrt(normal * normal - 2 * energy / 0.75);
}

static void assert_near(double value, double expected, double roundoff)
{
	if (!(fabs(value - expected) <= 64 * roundoff * fmax(1, fabs(expected))))
		fail_msg("%.17g, expected %.17g", value, expected);
}

/* A pair that comes head-on through steps, and what the paper's figure 1 says happens at each. */
static void events_have_closed_forms(void **state)
{
	(void)state;
	static const char *const arithmetics[] = {"binary64", "mpfr:200", "twin", "extended", "binary128", "mpfr:53"};
	const struct touchstone_step well[] = {{3, -1.5}}, shoulder[] = {{3, 1.5}}, stair[] = {{2, 0.25}, {3, -1}};
	for (int a = 0; a < 6; a++) {
		const double roundoff = 0x1p-53, r[3] = {5, 0, 0};
		double after[3], energy;
		/* (1) capture, (3) core, (2a) release */
		struct touchstone_potential potential = {{1, 0}, 1, {TOUCHSTONE_CONSTANT, 1}, 1, well};
		double v[3] = {-2, 0, 0}, inside = climbed(2, -1.5);
		struct seen seen = watch_pair(arithmetics[a], &potential, r, v, after, &energy);
		assert_int_equal(seen.count, 3);
		assert_int_equal(seen.event[0].kind, TOUCHSTONE_CAPTURE);
		assert_near(seen.event[0].time, 1, roundoff);
		assert_near(seen.event[0].approach, 2, roundoff);
		assert_near(seen.event[0].distance, 3, roundoff);
		assert_near(seen.event[0].impulse, 0.75 * (inside - 2), roundoff);
		assert_true(seen.event[0].before == 0 && seen.event[0].after == 1 && seen.event[0].energy == -1.5);
		assert_int_equal(seen.event[1].kind, TOUCHSTONE_CONTACT);
		assert_near(seen.event[1].time, 1 + 2 / inside, roundoff);
		assert_true(seen.event[1].before == 1 && seen.event[1].after == 1 && seen.event[1].energy == 0);
		assert_int_equal(seen.event[2].kind, TOUCHSTONE_RELEASE);
		assert_near(seen.event[2].time, 1 + 4 / inside, roundoff);
		assert_near(seen.event[2].approach, -inside, roundoff);
		assert_true(seen.event[2].before == 1 && seen.event[2].after == 0 && seen.event[2].energy == 1.5);
		assert_near(after[0], 2, roundoff);
		assert_near(energy, 1.5, roundoff);
		/* an inelastic core, then (2b): too slow to leave, it bounces to and fro */
		potential.restitution.coefficient = 0.5;
		seen = watch_pair(arithmetics[a], &potential, r, v, after, &energy);
		assert_true(seen.count > 10);
		for (size_t k = 1; k < 10; k++)
			assert_int_equal(seen.event[k].kind, k % 2 ? TOUCHSTONE_CONTACT : TOUCHSTONE_BOUNCE);
		assert_near(seen.event[2].time, 1 + 2 / inside + 4 / inside, roundoff);
		assert_true(seen.event[2].before == 1 && seen.event[2].after == 1 && seen.event[2].energy == 0);
		assert_near(seen.event[2].impulse, 0.75 * inside, roundoff);
		/* aslant: only the normal part changes; r = (-, 1, 0) at the step, and the pair passes the core by */
		potential.core = 0.5;
		const double aslant[3] = {5, 1, 0};
		double normal = 2 * sqrt(8.0 / 9), within = climbed(normal, -1.5);
		seen = watch_pair(arithmetics[a], &potential, aslant, v, after, &energy);
		assert_int_equal(seen.count, 2);
		assert_near(seen.event[0].time, (5 - sqrt(8)) / 2, roundoff);
		assert_near(seen.event[0].approach, normal, roundoff);
		assert_near(seen.event[0].impulse, 0.75 * (within - normal), roundoff);
		assert_near(seen.event[1].time - seen.event[0].time, 6 * within / (within * within + 4.0 / 9), roundoff);
		assert_near(energy, 1.5, roundoff);
		/* a shoulder: climbed by the fast, not by the slow */
		potential = (struct touchstone_potential){{0, 1}, 1, {TOUCHSTONE_CONSTANT, 1}, 1, shoulder};
		v[0] = -2.5;
		seen = watch_pair(arithmetics[a], &potential, r, v, after, &energy);
		assert_int_equal(seen.count, 3);
		assert_int_equal(seen.event[0].kind, TOUCHSTONE_CAPTURE);
		assert_near(seen.event[1].time, 2 / 2.5 + 2 / climbed(2.5, 1.5), roundoff);
		assert_near(after[0], 2.5, roundoff);
		v[0] = -1.9;
		seen = watch_pair(arithmetics[a], &potential, r, v, after, &energy);
		assert_int_equal(seen.count, 1);
		assert_int_equal(seen.event[0].kind, TOUCHSTONE_BOUNCE);
		assert_true(seen.event[0].before == 0 && seen.event[0].after == 0);
		assert_near(after[0], 1.9, roundoff);
		/* two steps, and nothing in the middle: in and out again on the other side */
		potential = (struct touchstone_potential){{0, 1}, 0, {TOUCHSTONE_CONSTANT, 1}, 2, stair};
		v[0] = -1;
		seen = watch_pair(arithmetics[a], &potential, r, v, after, &energy);
		assert_int_equal(seen.count, 4);
		double first = climbed(1, -1), second = climbed(first, 1.25);
		assert_true(seen.event[0].after == 1 && seen.event[1].after == 2 && seen.event[2].after == 1);
		assert_true(seen.event[1].energy == 1.25 && seen.event[3].after == 0);
		assert_near(seen.event[3].time, 2 + 2 / first + 4 / second, roundoff);
		assert_near(after[0], -1, roundoff);
	}
}

/* A pair exactly at a step is outside of it, and then what its motion says. */
static void ties_are_outside(void **state)
{
	(void)state;
	const struct touchstone_step well[] = {{3, -1}};
	const struct touchstone_potential potential = {{0, 1}, 1, {TOUCHSTONE_CONSTANT, 1}, 1, well};
	double after[3], energy;
	for (int direction = -1; direction <= 1; direction += 2) {
		const double at[3] = {3, 0, 0}, within[3] = {2.75, 0, 0}, v[3] = {direction, 0, 0};
		struct seen seen = watch_pair("binary64", &potential, at, v, after, &energy);
		assert_int_equal(seen.count, direction < 0 ? 3 : 0);
		seen = watch_pair("binary64", &potential, within, v, after, &energy);
		assert_int_equal(seen.event[0].before, 1);
		assert_int_equal(seen.event[0].kind, direction < 0 ? TOUCHSTONE_CONTACT : TOUCHSTONE_BOUNCE);
	}
}

/* ------------------------------------------------------------------ what is refused */

static void nonsense_is_refused(void **state)
{
	(void)state;
	const struct touchstone_step backwards[] = {{2, -1}, {1.5, 0}}, deep[] = {{0.9, -1}}, endless[] = {{2, INFINITY}},
								 wide[] = {{11, 1}}, sound[] = {{2, -1}};
	const struct touchstone_restitution elastic = {TOUCHSTONE_CONSTANT, 1};
	const struct {
		struct touchstone_potential potential;
		const char *says;
	} bad[] = {
		{{{0, 0}, 1, elastic, 2, backwards}, "steps from the innermost outwards"},
		{{{0, 0}, 1, elastic, 1, deep}, "within the core"},
		{{{0, 0}, 1, elastic, 1, endless}, "accepted: a finite number"},
		{{{0, 0}, 1, elastic, 1, wide}, "its own image"},
		{{{0, 1}, 1, elastic, 1, sound}, "species 0 and 1"},
		{{{0, 0}, 1.5, elastic, 1, sound}, "mean of the diameters"},
		{{{0, 0}, -1, elastic, 1, sound}, "mean of the diameters"},
		{{{0, 0}, 1, {TOUCHSTONE_CONSTANT, 1.5}, 1, sound}, "restitution"},
	};
	for (size_t b = 0; b < sizeof bad / sizeof *bad; b++) {
		struct scene_recipe recipe = gas(3, 100, 0.1);
		struct touchstone_scene scene;
		struct scene_error complaint;
		recipe.potentials = &bad[b].potential;
		recipe.potential_count = 1;
		assert_false(scene_build(&recipe, SEED, &scene, &complaint));
		if (!strstr(complaint.text, bad[b].says)) fail_msg("%s %s", complaint.key, complaint.text);
	}
}

/* Steps by the rule have the volume of their shells: the integral of the potential is kept, whatever their number. */
static void lennard_jones_keeps_its_volume(void **state)
{
	(void)state;
	const struct lennard_jones law = {1.5, 1.1, 0.8, 3};
	struct touchstone_step steps[40];
	for (int dimensions = 1; dimensions <= 3; dimensions++) {
		double integral = 0, volume = 0;
		potential_lennard_jones(&law, dimensions, 1, steps);
		assert_true(steps[0].distance == 3);
		integral = steps[0].energy * (pow(3, dimensions) - pow(0.8, dimensions));
		potential_lennard_jones(&law, dimensions, 40, steps);
		double inner = 0.8;
		for (int s = 0; s < 40; s++) {
			double middle = 1.1 / ((steps[s].distance + inner) / 2), power = pow(middle, 6);
			double shell = pow(steps[s].distance, dimensions) - pow(inner, dimensions);
			volume += steps[s].energy * shell;
			assert_true(steps[s].distance > inner);
			if (s > 4) assert_true(fabs(steps[s].energy - 6 * (power * power - power)) < 0.1);
			inner = steps[s].distance;
		}
		assert_true(fabs(volume - integral) < 1e-12 * fabs(integral) + 1e-11);
	}
}

int main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(events_have_closed_forms),
		cmocka_unit_test(ties_are_outside),
		cmocka_unit_test(nonsense_is_refused),
		cmocka_unit_test(lennard_jones_keeps_its_volume),
	};
	return cmocka_run_group_tests(tests, NULL, NULL);
}
