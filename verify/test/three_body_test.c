/* Three-body events against a search over all pairs, in exact arithmetic. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <mpfr.h>
#include <stdio.h>
#include <stdlib.h>

#include "measure/three_body.h"
#include "scene/random.h"
#include "scene/scene.h"

enum { SEED = 20140902, MOST = 64 };

static bool brief; /* under sanitizers, where everything takes ten times longer */

/* Whether two bodies overlap: of three squares of differences of doubles, with all their bits. */
static bool overlap(const struct touchstone_scene *scene, const double one[3], const double other[3], double contact)
{
	double apart[3], squares = 0;
	for (int axis = 0; axis < scene->dimensions; axis++) {
		double box = scene->box[axis];
		apart[axis] = one[axis] - other[axis];
		if (scene->periodic[axis]) apart[axis] -= box * rint(apart[axis] / box);
		squares += apart[axis] * apart[axis];
	}
	if (squares > 1.01 * contact * contact) return false;
	mpfr_t sum, part;
	mpfr_inits2(1000, sum, part, (mpfr_ptr)0);
	mpfr_set_d(sum, -contact, MPFR_RNDN);
	mpfr_mul_d(sum, sum, contact, MPFR_RNDN);
	for (int axis = 0; axis < scene->dimensions; axis++) {
		double box = scene->box[axis], image = scene->periodic[axis] ? rint((one[axis] - other[axis]) / box) : 0;
		mpfr_set_d(part, one[axis], MPFR_RNDN);
		mpfr_sub_d(part, part, other[axis], MPFR_RNDN);
		mpfr_sub_d(part, part, image * box, MPFR_RNDN);
		mpfr_sqr(part, part, MPFR_RNDN);
		mpfr_add(sum, sum, part, MPFR_RNDN);
	}
	bool overlaps = mpfr_sgn(sum) < 0;
	mpfr_clears(sum, part, (mpfr_ptr)0);
	return overlaps;
}

/* What is seen of a run, by the measure and by force. */
struct witness {
	const struct touchstone_scene *scene;
	struct three_body seen;
	uint64_t overlapping, events;
};

/* All that a particle overlaps, by force; held against what the engine finds in its cells. */
static uint64_t overlapped(const struct witness *witness, const struct touchstone_engine *engine, uint32_t particle)
{
	const struct touchstone_scene *scene = witness->scene;
	const struct touchstone_particle *particles = scene->particles;
	double here[3], there[3], velocity[3];
	uint64_t found = 0, told = 0;
	touchstone_state(engine, particle, here, velocity);
	for (uint32_t k = 0; k < scene->particle_count; k++) {
		double contact = scene->species[particles[particle].species].diameter / 2 +
						 scene->species[particles[k].species].diameter / 2;
		touchstone_state(engine, k, there, velocity);
		if (k != particle && overlap(scene, here, there, contact)) found |= UINT64_C(1) << k;
	}
	struct touchstone_overlap list[MOST];
	size_t count = touchstone_overlaps(engine, particle, list, MOST);
	assert_true(count <= MOST);
	for (size_t k = 0; k < count; k++) {
		told |= UINT64_C(1) << list[k].partner;
		assert_true(list[k].depth > 0 && list[k].depth < 0.5);
	}
	assert_int_equal(told, found);
	return found;
}

static void see(void *context, struct touchstone_engine *engine, const struct touchstone_event *event)
{
	struct witness *witness = context;
	three_body_see(&witness->seen, engine, event);
	if (event->kind != TOUCHSTONE_CONTACT) return;
	uint32_t i = event->first, j = event->second;
	uint64_t of_first = overlapped(witness, engine, i), of_second = overlapped(witness, engine, j);
	uint64_t pair = UINT64_C(1) << i | UINT64_C(1) << j;
	bool both = of_first >> j & 1;
	assert_int_equal(both, of_second >> i & 1);
	witness->overlapping += both;
	witness->events += both && ((of_first | of_second) & ~pair);
}

static void run_gas(const char *arithmetic, int dimensions, double density, double restitution, bool walls,
					uint64_t seed)
{
	const bool mixed = seed % 2;
	const struct scene_species sizes[] = {{mixed ? 0.5 : 1, {1, 1}}, {0.5, {0.75, 0.5}}};
	struct scene_recipe recipe = {
		.dimensions = dimensions,
		.particle_count = MOST,
		.density = density,
		.boundary = {walls ? SCENE_WALLS : SCENE_PERIODIC},
		.boundary_restitution = {TOUCHSTONE_CONSTANT, 1},
		.species_count = 1 + mixed,
		.species = sizes,
		.restitution = {TOUCHSTONE_CONSTANT, restitution},
		.positions = SCENE_LATTICE,
		.velocities = SCENE_MAXWELL,
		.temperature = 1,
		.form = TOUCHSTONE_ABSOLUTE,
	};
	struct touchstone_scene scene;
	struct scene_error complaint;
	char error[160];
	if (!scene_build(&recipe, seed, &scene, &complaint)) fail_msg("%s %s", complaint.key, complaint.text);
	double side = ldexp(ceil(scene.box[0] * 4), -2); /* so that the coarsest arithmetic counts in the same box */
	for (int axis = 0; axis < dimensions; axis++) scene.box[axis] = side;
	struct touchstone_engine *engine = touchstone_create(&scene, arithmetic, "stable", error);
	if (!engine) fail_msg("%s", error);
	struct witness witness = {.scene = &scene};
	assert_true(three_body_begin(&witness.seen, MOST));
	struct touchstone_limits limits = {.events = brief ? 200 : 1500, .time = INFINITY};
	touchstone_run(engine, &limits, &(struct touchstone_observer){see, &witness});
	const struct three_body *seen = &witness.seen;
	print_message("%s, %d dimensions, density %g, restitution %g, seed %d: %d contacts, %d overlap, %d of three, %d "
				  "encounters\n",
				  arithmetic, dimensions, density, restitution, (int)seed, (int)seen->contacts, (int)seen->overlapping,
				  (int)seen->events, (int)seen->encounters);
	assert_int_equal(seen->overlapping, witness.overlapping);
	assert_int_equal(seen->events, witness.events);
	assert_true(seen->encounters <= seen->events && (seen->encounters > 0) == (seen->events > 0));
	assert_true(seen->overlapping > seen->contacts / 8);
	three_body_end(&witness.seen);
	touchstone_destroy(engine);
	scene_free(&scene);
}

static void cells_see_what_all_pairs_see(void **state)
{
	(void)state;
	for (uint64_t seed = SEED; seed < SEED + 2; seed++) {
		run_gas("short:9", 3, 0.5, 1, false, seed);
		run_gas("short:12", 2, 0.6, 0.8, false, seed);
		run_gas("binary32", 3, 0.7, 0.9, true, seed);
		run_gas("binary64", 3, 0.7, 1, false, seed);
	}
}

/* Among three there is no fourth: whatever they do is one encounter. */
static void three_meet_once(void **state)
{
	(void)state;
	struct random_state random = random_seed(SEED);
	uint64_t events = 0;
	for (int trial = 0; trial < 40; trial++) {
		static const struct touchstone_species ball = {1, 1};
		struct touchstone_wall walls[2] = {{{-2}, {1}, {TOUCHSTONE_CONSTANT, 1}},
										   {{2}, {-1}, {TOUCHSTONE_CONSTANT, 1}}};
		struct touchstone_particle particles[3] = {{.position = {-1.25}}, {.position = {0}}, {.position = {1.25}}};
		for (int p = 0; p < 3; p++) particles[p].velocity[0] = random_normal(&random);
		struct touchstone_scene scene = {.dimensions = 1,
										 .particle_count = 3,
										 .particles = particles,
										 .species_count = 1,
										 .species = &ball,
										 .wall_count = 2,
										 .walls = walls,
										 .box = {4},
										 .restitution = {TOUCHSTONE_CONSTANT, 1}};
		char error[160];
		struct touchstone_engine *engine = touchstone_create(&scene, "short:5", "stable", error);
		if (!engine) fail_msg("%s", error);
		struct three_body seen;
		assert_true(three_body_begin(&seen, 3));
		struct touchstone_limits limits = {.events = 300, .time = INFINITY};
		touchstone_run(engine, &limits, &(struct touchstone_observer){three_body_see, &seen});
		assert_int_equal(seen.encounters, seen.events > 0);
		events += seen.events;
		three_body_end(&seen);
		touchstone_destroy(engine);
	}
	print_message("%d events of three balls on a line, seed %d\n", (int)events, SEED);
	assert_true(events > 40);
}

static void rates_are_counts_per_contact(void **state)
{
	(void)state;
	struct three_body one = {.contacts = 1000, .overlapping = 500, .events = 7, .encounters = 4}, sum = one;
	three_body_merge(&sum, &one);
	struct interval interval, expected = interval_of_rate(14, 2000);
	assert_true(three_body_rate(&sum, &interval) == 0.007);
	assert_memory_equal(&interval, &expected, sizeof interval);
	assert_true(three_body_encounter_rate(&sum, &interval) == 0.004);
	assert_true(interval.low < 0.004 && interval.high > 0.004);
	assert_int_equal(sum.overlapping, 1000);
}

int main(void)
{
	brief = getenv("TOUCHSTONE_BRIEF");
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(cells_see_what_all_pairs_see),
		cmocka_unit_test(three_meet_once),
		cmocka_unit_test(rates_are_counts_per_contact),
	};
	return cmocka_run_group_tests(tests, NULL, NULL);
}
