/* Tangent vectors: against differences of two runs, a periodic orbit whose exponent is known exactly, and a published
 * billiard. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "measure/lyapunov.h"
#include "test/step_scenes.h"

static bool brief; /* under sanitizers, where everything takes ten times longer */
static char error[160];

static struct touchstone_engine *engine_of(const struct touchstone_scene *scene)
{
	struct touchstone_engine *engine = touchstone_create(scene, "binary64", "stable", error);
	if (!engine) fail_msg("%s", error);
	return engine;
}

static struct lyapunov *tangent_of(const struct touchstone_scene *scene, uint64_t seed)
{
	struct lyapunov *lyapunov = lyapunov_begin(scene, seed, error);
	if (!lyapunov) fail_msg("%s", error);
	return lyapunov;
}

/* ---- against differences */

/* A run to a time, with the sequence of its events as one number. */
struct course {
	struct touchstone_engine *engine;
	uint64_t sequence;
};

static void see(void *context, struct touchstone_engine *engine, const struct touchstone_event *event)
{
	(void)engine;
	struct course *course = context;
	uint64_t word = (uint64_t)event->kind << 48 | (uint64_t)event->first << 24 | event->second;
	course->sequence = (course->sequence ^ word) * UINT64_C(0x9e3779b97f4a7c15);
}

/* From the start of the scene, moved by `step` times the vector, to `time`. */
static struct course run_moved(const struct touchstone_scene *scene, const struct lyapunov *start, double step,
							   double time)
{
	struct touchstone_scene moved = *scene;
	struct touchstone_particle *particles = malloc(scene->particle_count * sizeof *particles);
	for (uint32_t p = 0; p < scene->particle_count; p++) {
		double position[3], velocity[3];
		lyapunov_part(start, p, scene->clock, position, velocity);
		particles[p] = scene->particles[p];
		for (int axis = 0; axis < 3; axis++) {
			particles[p].position[axis] += step * position[axis];
			particles[p].velocity[axis] += step * velocity[axis];
		}
	}
	moved.particles = particles;
	struct course course = {.engine = engine_of(&moved)};
	free(particles);
	touchstone_run(course.engine, &(struct touchstone_limits){UINT64_MAX, time, NULL},
				   &(struct touchstone_observer){see, &course});
	return course;
}

/* Time between the last of so many events and the next one. */
static double between_events(const struct touchstone_scene *scene, uint64_t events)
{
	struct touchstone_engine *engine = engine_of(scene);
	struct touchstone_status before, after;
	touchstone_run(engine, &(struct touchstone_limits){events, INFINITY, NULL}, NULL);
	touchstone_status(engine, &before);
	touchstone_run(engine, &(struct touchstone_limits){1, INFINITY, NULL}, NULL);
	touchstone_status(engine, &after);
	touchstone_destroy(engine);
	return (before.time + after.time) / 2;
}

/* How far the vector is from (there - here) / (2 step), over its length. */
static double deviation(const struct touchstone_scene *scene, const struct lyapunov *lyapunov, double time,
						struct touchstone_engine *const ends[2], double step)
{
	double squares = 0, wrong = 0;
	for (uint32_t p = 0; p < scene->particle_count; p++) {
		double tangent[2][3], end[2][2][3];
		lyapunov_part(lyapunov, p, time, tangent[0], tangent[1]);
		for (int e = 0; e < 2; e++) touchstone_state(ends[e], p, end[e][0], end[e][1]);
		for (int part = 0; part < 2; part++)
			for (int axis = 0; axis < scene->dimensions; axis++) {
				double difference = end[1][part][axis] - end[0][part][axis];
				if (part == 0 && scene->periodic[axis]) difference = remainder(difference, scene->box[axis]);
				squares += tangent[part][axis] * tangent[part][axis];
				wrong += pow(difference / (2 * step) - tangent[part][axis], 2);
			}
	}
	return sqrt(wrong / squares);
}

/* The deviation for a scene moved by `step` either way. -1 when the three do not take the same course, which proves
 * nothing. */
static double compare(const struct touchstone_scene *scene, uint64_t seed, double time, double step)
{
	double found = -1;
	struct lyapunov *start = tangent_of(scene, seed), *carried = tangent_of(scene, seed);
	struct touchstone_engine *engine = engine_of(scene);
	struct course middle = run_moved(scene, start, 0, time), here = run_moved(scene, start, -step, time),
				  there = run_moved(scene, start, step, time);
	touchstone_run(engine, &(struct touchstone_limits){UINT64_MAX, time, NULL},
				   &(struct touchstone_observer){lyapunov_see, carried});
	if (here.sequence == middle.sequence && there.sequence == middle.sequence)
		found = deviation(scene, carried, time, (struct touchstone_engine *[]){here.engine, there.engine}, step);
	lyapunov_free(start);
	lyapunov_free(carried);
	touchstone_destroy(engine);
	touchstone_destroy(middle.engine);
	touchstone_destroy(here.engine);
	touchstone_destroy(there.engine);
	return found;
}

/* Takes the scene to a moment at which nothing touches: on the lattice some particles stand at a wall, and a difference
 * would push them into it. */
static void begin_in_flight(struct touchstone_scene *scene)
{
	double time = between_events(scene, 40);
	struct touchstone_particle *particles = malloc(scene->particle_count * sizeof *particles);
	struct touchstone_engine *engine = engine_of(scene);
	touchstone_run(engine, &(struct touchstone_limits){UINT64_MAX, time, NULL}, NULL);
	for (uint32_t p = 0; p < scene->particle_count; p++) {
		touchstone_state(engine, p, particles[p].position, particles[p].velocity);
		particles[p].species = scene->particles[p].species;
	}
	touchstone_destroy(engine);
	free((void *)scene->particles);
	scene->particles = particles;
}

/* A random gas: steps, walls, gravity, masses, inelastic collisions. What is found is the better of two steps, since a
 * grazing collision bends the larger one and rounding spoils the smaller. */
static double compare_gas(struct random_state *random, uint64_t seed)
{
	struct drawn drawn;
	struct scene_recipe recipe = draw_gas(&drawn, random);
	recipe.restitution.coefficient = random_below(random, 2) ? 1 : 0.5 + 0.5 * random_uniform(random);
	struct touchstone_scene scene;
	struct scene_error wrong;
	if (!scene_build(&recipe, seed, &scene, &wrong)) fail_msg("%s %s", wrong.key, wrong.text);
	begin_in_flight(&scene);
	double time = between_events(&scene, 1 + random_below(random, 60));
	double coarse = compare(&scene, seed, time, 1e-7), fine = compare(&scene, seed, time, 1e-9);
	scene_free(&scene);
	return coarse >= 0 && coarse < fine ? coarse : fine;
}

static void is_the_limit_of_differences(void **state)
{
	(void)state;
	struct random_state random = random_seed(SEED);
	int draws = brief ? 20 : 200, compared = 0;
	double worst = 0;
	for (int draw = 0; draw < draws; draw++) {
		double found = compare_gas(&random, SEED + (uint64_t)draw);
		compared += found >= 0;
		worst = fmax(worst, found);
		if (found > 1e-4) fail_msg("draw %d: the vector is off by %g of its length", draw, found);
	}
	print_message("%d of %d gases took one course; off by %.2g of its length at most\n", compared, draws, worst);
	assert_true(compared > draws / 2);
}

/* ---- exponents that are known */

/* Two discs or balls of any masses, head on through a periodic box: seen from one of them, the other goes to and fro
 * between two images of a scatterer of radius s, l = L - 2 s apart. One passage maps a small offset and angle by
 * (1, l; 2/s, 1 + 2 l/s), of determinant 1, whose larger eigenvalue is exp(arcosh(1 + l/s)). */
static void a_periodic_orbit_is_as_unstable_as_it_must_be(void **state)
{
	(void)state;
	struct random_state random = random_seed(SEED + 1);
	for (int draw = 0; draw < 20; draw++) {
		double box = 3 + 5 * random_uniform(&random), size = 0.4 + random_uniform(&random);
		double mass[2] = {0.2 + random_uniform(&random), 0.2 + random_uniform(&random)}, speed = 1.5;
		const struct touchstone_species species[2] = {{size, mass[0]}, {size, mass[1]}};
		const struct touchstone_particle particles[2] = {
			{{-box / 4, 0, 0}, {speed * mass[1] / (mass[0] + mass[1]), 0, 0}, 0},
			{{box / 4, 0, 0}, {-speed * mass[0] / (mass[0] + mass[1]), 0, 0}, 1}};
		const struct touchstone_scene scene = {.dimensions = 2 + draw % 2,
											   .particle_count = 2,
											   .particles = particles,
											   .species_count = 2,
											   .species = species,
											   .periodic = {true, true, true},
											   .box = {box, box, box},
											   .restitution = {TOUCHSTONE_CONSTANT, 1}};
		struct touchstone_engine *engine = engine_of(&scene);
		struct lyapunov *lyapunov = tangent_of(&scene, SEED + (uint64_t)draw);
		double flight = box - 2 * size, passage = flight / speed, growth[2];
		for (int turn = 0; turn < 2; turn++) { /* in the middle of a flight, after 20 and 40 collisions */
			double time = (20 + 20 * turn) * passage + (box / 2 - size) / speed - passage / 2;
			touchstone_run(engine, &(struct touchstone_limits){UINT64_MAX, time, NULL},
						   &(struct touchstone_observer){lyapunov_see, lyapunov});
			struct touchstone_status status;
			touchstone_status(engine, &status);
			assert_int_equal(status.collisions, 20 + 20 * turn);
			growth[turn] = lyapunov_growth(lyapunov, time);
		}
		double found = (growth[1] - growth[0]) / 20, exact = acosh(1 + flight / size);
		if (fabs(found - exact) > 1e-9) fail_msg("draw %d: %.12g per collision, not %.12g", draw, found, exact);
		lyapunov_free(lyapunov);
		touchstone_destroy(engine);
	}
}

/* Two discs in a periodic square are Sinai's billiard with a scatterer whose radius R is their diameter. Dahlqvist 1996
 * (chao-dyn/9601007, "The Lyapunov exponent in the Sinai billiard in the small scatterer limit"): per collision
 * -2 ln R + 1 - 4 ln 2 + 27 zeta(3) / (2 pi^2) + O(R ln^2 R), for sides of length 1. */
static void two_discs_are_sinais_billiard(void **state)
{
	(void)state;
	static const double zeta3 = 1.2020569031595943, pi = 3.14159265358979323846;
	static const double radii[] = {1e-2, 3e-3, 1e-3};
	uint64_t collisions = brief ? 500 : 5000;
	for (size_t k = 0; k < sizeof radii / sizeof *radii; k++) {
		double radius = radii[k];
		const struct touchstone_species disc = {radius, 1};
		const struct touchstone_particle particles[2] = {{{-0.2, 0.1, 0}, {0.43, 0.61, 0}, 0},
														 {{0.3, -0.17, 0}, {-0.43, -0.61, 0}, 0}};
		const struct touchstone_scene scene = {.dimensions = 2,
											   .particle_count = 2,
											   .particles = particles,
											   .species_count = 1,
											   .species = &disc,
											   .periodic = {true, true},
											   .box = {1, 1},
											   .restitution = {TOUCHSTONE_CONSTANT, 1}};
		struct touchstone_engine *engine = engine_of(&scene);
		struct lyapunov *lyapunov = tangent_of(&scene, SEED);
		double growth[2];
		for (int part = 0; part < 2; part++) {
			touchstone_run(engine, &(struct touchstone_limits){part ? collisions : 10, INFINITY, NULL},
						   &(struct touchstone_observer){lyapunov_see, lyapunov});
			struct touchstone_status status;
			touchstone_status(engine, &status);
			growth[part] = lyapunov_growth(lyapunov, status.time);
		}
		double found = (growth[1] - growth[0]) / (double)collisions;
		double limit = -2 * log(radius) + 1 - 4 * log(2) + 27 * zeta3 / (2 * pi * pi);
		print_message("R = %g: %.4f per collision, %.4f in the limit\n", radius, found, limit);
		/* a collision stretches by a factor whose logarithm varies by about 1.5 */
		assert_true(fabs(found - limit) < radius * pow(log(radius), 2) + 5 * 1.5 / sqrt((double)collisions));
		lyapunov_free(lyapunov);
		touchstone_destroy(engine);
	}
}

static void laws_it_cannot_differentiate_are_refused(void **state)
{
	(void)state;
	const struct scene_recipe recipe = gas(3, 32, 0.3);
	struct touchstone_scene scene;
	struct scene_error wrong;
	assert_true(scene_build(&recipe, SEED, &scene, &wrong));
	scene.restitution.law = TOUCHSTONE_VISCOELASTIC;
	assert_null(lyapunov_begin(&scene, SEED, error));
	assert_non_null(strstr(error, "constant coefficient"));
	scene_free(&scene);
	lyapunov_free(NULL);
}

int main(void)
{
	brief = getenv("TOUCHSTONE_BRIEF");
	print_message("seed %d\n", SEED);
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(is_the_limit_of_differences),
		cmocka_unit_test(a_periodic_orbit_is_as_unstable_as_it_must_be),
		cmocka_unit_test(two_discs_are_sinais_billiard),
		cmocka_unit_test(laws_it_cannot_differentiate_are_refused),
	};
	return cmocka_run_group_tests(tests, NULL, NULL);
}
