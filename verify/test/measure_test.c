/* The measures against slow and plain ways to the same numbers: separations at impact, collapse on a plate, and the
 * course of a run. */
#include <math.h>
#include <setjmp.h>
#include <signal.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <gsl/gsl_sort.h>
#include <gsl/gsl_statistics_double.h>
#include <mpfr.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/time.h>

#include "measure/collapse.h"
#include "measure/conservation.h"
#include "measure/course.h"
#include "measure/impact.h"
#include "scene/random.h"
#include "scene/scene.h"

enum { SEED = 20140902, BITS = 5000 };

static bool brief; /* under sanitizers, where everything takes ten times longer */

/* cmocka compares in single precision. */
static void assert_close(double found, double expected, double tolerance)
{
	if (!(fabs(found - expected) <= tolerance)) fail_msg("%.17g, not %.17g within %g", found, expected, tolerance);
}

/* Sets a number to the sum of so many doubles. */
static void set_sum(mpfr_t sum, const double *terms, int count)
{
	mpfr_set_zero(sum, 1);
	for (int term = count - 1; term >= 0; term--) mpfr_add_d(sum, sum, terms[term], MPFR_RNDN);
}

/* ------------------------------------------------------------------ separation at impact */

/* A separation less the contact distance, found with BITS bits: exact in all that is asked of it. */
struct truth {
	int sign;
	int bar;       /* nearest representable number, counted from contact */
	double excess; /* in ulp above contact */
};

/* Two or three particles, of which two are so close to contact, on either side of it, that rounding decides; some
 * nearly along an axis, where a second component of 2^-P decides. */
struct near {
	struct touchstone_particle particle[3];
	struct touchstone_species species[2];
	struct touchstone_scene scene;
};

/* What an observer keeps of the impacts it sees. */
enum { MOST = 4096 };
struct witness {
	int bits;
	const struct touchstone_scene *scene;
	struct impact seen, merged; /* all at once, and one by one */
	double excess[MOST];
};

/* Places are 2 wide where the largest diameter is 1 and the box a power of two: exact in every arithmetic. */
static void draw_near(struct near *near, struct random_state *random, int bits)
{
	double other = 0.3 + 0.7 * random_uniform(random); /* the sum of two radii is to be a double, too */
	*near = (struct near){.species = {{1, 1}, {bits > 53 ? (float)other : other, 0.7}}};
	struct touchstone_scene *scene = &near->scene;
	*scene = (struct touchstone_scene){.particles = near->particle, .species = near->species};
	scene->dimensions = 1 + (int)random_below(random, 3);
	scene->particle_count = 2 + random_below(random, 2);
	scene->species_count = 1 + random_below(random, 2);
	scene->form = (enum touchstone_form)random_below(random, 2);
	scene->restitution.coefficient = 0.5 + 0.5 * random_uniform(random);
	bool periodic = random_below(random, 2), straight = random_below(random, 4) == 0;
	double size = ldexp(1, 3 + (int)random_below(random, bits < 36 ? (uint64_t)bits - 8 : 28));
	double way[3] = {0}, length = 0, place[3] = {0, 1 + ldexp(8 * random_uniform(random) - 4, -bits), -1.5};
	for (int axis = 0; axis < scene->dimensions; axis++)
		way[axis] = straight && axis ? ldexp(random_normal(random), -bits) : random_normal(random);
	for (int axis = 0; axis < 3; axis++) length += way[axis] * way[axis];
	for (int p = 1; p < 3; p++) near->particle[p].species = (uint32_t)random_below(random, scene->species_count);
	if (near->particle[1].species) place[1] *= 0.5 + 0.5 * near->species[1].diameter;
	for (int axis = 0; axis < scene->dimensions; axis++) {
		double base = straight ? 0 : size * (random_uniform(random) - 0.5);
		scene->box[axis] = size;
		scene->periodic[axis] = periodic;
		for (int p = 0; p < 3; p++) {
			struct touchstone_particle *particle = &near->particle[p];
			double position = base + place[p] * way[axis] / sqrt(length);
			particle->position[axis] = periodic ? position - size * rint(position / size) : position;
			particle->velocity[axis] = 0.25 * random_normal(random) - place[p] * way[axis] / sqrt(length);
		}
	}
}

static struct truth truth_of(double terms[3][3 * TOUCHSTONE_MOST_TERMS], int count, double contact, int bits)
{
	mpfr_t r, sum, reference, step;
	mpfr_inits2(BITS, r, sum, step, (mpfr_ptr)0);
	mpfr_init2(reference, bits);
	mpfr_set_zero(sum, 1);
	for (int axis = 0; axis < 3; axis++) {
		set_sum(r, terms[axis], count);
		mpfr_sqr(r, r, MPFR_RNDN);
		mpfr_add(sum, sum, r, MPFR_RNDN);
	}
	mpfr_sqrt(sum, sum, MPFR_RNDN);
	mpfr_sub_d(sum, sum, contact, MPFR_RNDN);
	struct truth truth = {.sign = mpfr_sgn(sum)};

	mpfr_set_d(reference, contact, MPFR_RNDN);
	mpfr_nextabove(reference);
	mpfr_sub_d(step, reference, contact, MPFR_RNDN);
	mpfr_div(r, sum, step, MPFR_RNDN);
	truth.excess = mpfr_get_d(r, MPFR_RNDN);
	mpfr_set_d(reference, contact, MPFR_RNDN);
	mpfr_nextbelow(reference);
	if (truth.sign < 0) mpfr_d_sub(step, contact, reference, MPFR_RNDN); /* may be half as long */
	mpfr_div(r, sum, step, MPFR_RNDN);
	mpfr_rint(r, r, MPFR_RNDN);
	truth.bar = (int)fmin(fmax(mpfr_get_d(r, MPFR_RNDN), -IMPACT_REACH), IMPACT_REACH);
	mpfr_clears(r, sum, reference, step, (mpfr_ptr)0);
	return truth;
}

/* The terms of a separation are those of the positions that the engine tells: to the last bit where these are whole,
 * and near enough to betray a wrong image or particle where they are rounded to double. */
static void assert_true_positions(const struct witness *witness, const struct touchstone_engine *engine,
								  const struct touchstone_event *event, double terms[3][3 * TOUCHSTONE_MOST_TERMS],
								  int count)
{
	const struct touchstone_scene *scene = witness->scene;
	double one[3], other[3], velocity[3], square = 0;
	touchstone_state(engine, event->first, one, velocity);
	touchstone_state(engine, event->second, other, velocity);
	bool whole = scene->form == TOUCHSTONE_ABSOLUTE && !scene->periodic[0] && witness->bits <= 53;
	mpfr_t r;
	mpfr_init2(r, BITS);
	for (int axis = 0; axis < 3; axis++) {
		set_sum(r, terms[axis], count);
		mpfr_sub_d(r, r, one[axis], MPFR_RNDN);
		mpfr_add_d(r, r, other[axis], MPFR_RNDN);
		double off = mpfr_get_d(r, MPFR_RNDN), box = scene->box[axis], apart = one[axis] - other[axis];
		double image = scene->periodic[axis] ? box * rint(apart / box) : 0;
		assert_close(off, -image, whole ? 0 : 0x1p-50 * box);
		square += apart * apart;
	}
	mpfr_clear(r);
	if (whole && witness->bits == 53) assert_close(event->distance, sqrt(square), 0);
}

static void see(void *context, struct touchstone_engine *engine, const struct touchstone_event *event)
{
	struct witness *witness = context;
	double terms[3][3 * TOUCHSTONE_MOST_TERMS], distance[TOUCHSTONE_MOST_TERMS];
	int count = touchstone_separation(engine, terms, distance), bits = witness->bits;
	double contact = distance[0];
	assert_true_positions(witness, engine, event, terms, count);
	struct truth truth = truth_of(terms, count, contact, bits);

	struct impact one;
	impact_begin(&one, bits);
	impact_see(&one, engine, event);
	if (!one.exact.bar[IMPACT_REACH + truth.bar])
		fail_msg("%d bits, contact %a: %.17g ulp are not in bar %d", bits, contact, truth.excess, truth.bar);
	assert_int_equal(one.exact.below, truth.sign < 0);
	assert_int_equal(one.exact.above, truth.sign > 0);
	assert_close(one.exact.sum, truth.excess, 0x1p-30 + 0x1p-40 * fabs(truth.excess));

	int64_t steps = event->steps, reach = IMPACT_REACH;
	assert_int_equal(one.measured.bar[reach + (steps < -reach ? -reach : steps > reach ? reach : steps)], 1);
	assert_int_equal(one.measured.below, steps < 0);
	assert_int_equal(one.measured.above, steps > 0);
	if (24 <= bits && bits <= 53 && labs(steps) < reach) { /* the distance is so many numbers away */
		mpfr_t walk;
		mpfr_init2(walk, bits);
		mpfr_set_d(walk, contact, MPFR_RNDN);
		for (int64_t step = 0; step < labs(steps); step++) steps < 0 ? mpfr_nextbelow(walk) : mpfr_nextabove(walk);
		assert_close(mpfr_get_d(walk, MPFR_RNDN), event->distance, 0);
		mpfr_clear(walk);
	}

	assert_true(witness->seen.count < MOST);
	witness->excess[witness->seen.count] = truth.excess;
	impact_see(&witness->seen, engine, event);
	impact_merge(&witness->merged, &one);
}

static void assert_gathered(const struct witness *witness)
{
	const struct impact *seen = &witness->seen;
	assert_memory_equal(&witness->merged, seen, sizeof *seen); /* the same sums in the same order */
	double scale = fmax(fabs(seen->exact.least), fabs(seen->exact.most));
	double mean = gsl_stats_mean(witness->excess, 1, seen->count);
	double deviation = gsl_stats_sd_with_fixed_mean(witness->excess, 1, seen->count, mean);
	assert_close(impact_mean(&seen->exact, seen->count), mean, 0x1p-30 * scale);
	assert_close(impact_deviation(&seen->exact, seen->count), deviation, 0x1p-20 * scale);
	uint64_t mode = seen->exact.bar[IMPACT_REACH + impact_mode(&seen->exact)];
	for (int bar = 1; bar < 2 * IMPACT_REACH; bar++) assert_true(seen->exact.bar[bar] <= mode);
}

static void separations_are_exact(void **state)
{
	(void)state;
	static const struct {
		const char *arithmetic;
		int bits;
	} one[] = {{"binary64", 53}, {"binary32", 24}, {"short:11", 11},   {"mpfr:53", 53},
			   {"extended", 64}, {"twin", 106},    {"binary128", 113}, {"mpfr:200", 200}};
	struct witness *witness = malloc(sizeof *witness);
	assert_non_null(witness);
	for (size_t a = 0; a < sizeof one / sizeof *one; a++) {
		struct random_state random = random_seed(SEED + a);
		*witness = (struct witness){.bits = one[a].bits};
		impact_begin(&witness->seen, one[a].bits);
		witness->merged = witness->seen;
		for (int trial = 0; trial < (brief ? 60 : 600); trial++) {
			struct near near;
			draw_near(&near, &random, one[a].bits);
			witness->scene = &near.scene;
			char error[160] = "";
			struct touchstone_engine *engine = touchstone_create(&near.scene, one[a].arithmetic, "stable", error);
			if (!engine) fail_msg("%s", error);
			struct touchstone_limits limits = {.events = 6, .time = 20};
			touchstone_run(engine, &limits, &(struct touchstone_observer){see, witness});
			touchstone_destroy(engine);
		}
		const struct impact *seen = &witness->seen;
		print_message("%s, seed %d: %d impacts, %d below and %d above contact, %d by MPFR\n", one[a].arithmetic,
					  SEED + (int)a, (int)seen->count, (int)seen->exact.below, (int)seen->exact.above,
					  (int)seen->forced);
		assert_gathered(witness);
		assert_true(seen->exact.below > seen->count / 8 && seen->exact.above > seen->count / 8);
		assert_true(one[a].bits > 53 ? seen->forced == seen->count : seen->forced < seen->count / 2);
	}
	free(witness);
}

/* ------------------------------------------------------------------ collapse on a plate */

static void error_is_that_of_the_formula(void **state)
{
	(void)state;
	static const char *const arithmetics[] = {"binary64", "short:9", "mpfr:300", "twin", "binary128"};
	struct random_state random = random_seed(SEED);
	mpfr_t exact, height, factor;
	mpfr_inits2(BITS, exact, height, factor, (mpfr_ptr)0);
	for (int trial = 0; trial < 200; trial++) {
		struct touchstone_drop drop = {.order = (unsigned)trial % TOUCHSTONE_DROP_ORDERS, .most = 5000};
		drop.gravity = -0.1 - 5 * random_uniform(&random);
		drop.restitution = 0.1 + 0.8 * random_uniform(&random);
		for (int term = 0; term < 6; term++) drop.plate[term] = ldexp(random_uniform(&random), -53 * term);
		struct touchstone_landing landing;
		char error[160];
		assert_true(touchstone_drop(arithmetics[trial % 5], "stable", &drop, 1, &landing, NULL, NULL, error));
		set_sum(height, landing.start, TOUCHSTONE_MOST_TERMS);
		set_sum(factor, landing.plate, TOUCHSTONE_MOST_TERMS);
		mpfr_sub(height, height, factor, MPFR_RNDN);
		mpfr_mul_2ui(height, height, 1, MPFR_RNDN);
		mpfr_sub_ui(height, height, 1, MPFR_RNDN);       /* less the diameter */
		mpfr_set_d(factor, drop.restitution, MPFR_RNDN); /* sqrt(2h (1+e)^2 / (1-e)^2 / |g|) */
		mpfr_add_ui(exact, factor, 1, MPFR_RNDN);
		mpfr_ui_sub(factor, 1, factor, MPFR_RNDN);
		mpfr_div(factor, exact, factor, MPFR_RNDN);
		mpfr_sqr(factor, factor, MPFR_RNDN);
		mpfr_div_d(factor, factor, fabs(drop.gravity), MPFR_RNDN);
		mpfr_mul(exact, height, factor, MPFR_RNDN);
		mpfr_sqrt(exact, exact, MPFR_RNDN);
		set_sum(factor, landing.time, TOUCHSTONE_MOST_TERMS);
		mpfr_sub(exact, factor, exact, MPFR_RNDN);
		assert_close(collapse_error(&drop, &landing), mpfr_get_d(exact, MPFR_RNDN), 0);
	}
	mpfr_clears(exact, height, factor, (mpfr_ptr)0);
}

/* The paper's ball. */
static struct collapse_setup paper(bool naive, unsigned order, uint64_t plates, uint64_t seed)
{
	const char *method = naive ? "naive" : "stable";
	return (struct collapse_setup){"binary64", method, order, -1, 0.5, plates, seed, 53, 2000, NULL};
}

/* The paper's ball in plain double, as the words of touchstone_drop_order have it: eq. 12 of 2014 for `naive`,
 * algorithm 2 for `stable`. */
static struct touchstone_landing drop_plainly(double plate, bool naive, unsigned order, uint64_t most)
{
	const double g = -1, e = 0.5, s = 1;
	struct touchstone_landing landing = {.plate = {plate}, .start = {plate + 1}};
	double r = plate + 1, v = 0, time = 0;
	for (int stalled = 0; stalled < 16 && landing.events < most; landing.events++) {
		double gap = order % 2 ? r - (plate + s / 2) : (r - plate) - s / 2;
		double root = sqrt(v * v - 2 * g * gap), t = -(v + root) / g;
		if (!naive && v < 0) t = gap <= 0 ? 0 : 2 * gap / (root - v);
		if (!naive && isnan(root)) t = -v / g;
		if (!(t >= 0)) {
			landing.verdict = TOUCHSTONE_HALTED;
			break;
		}
		r = order < 2   ? (r + v * t) + g / 2 * (t * t)
			: order < 4 ? r + (v * t + g / 2 * (t * t))
						: r + t * (v + g / 2 * t);
		v = -e * (v + g * t);
		stalled = time + t > time ? 0 : stalled + 1;
		time += t;
		if (stalled == 16) landing.verdict = TOUCHSTONE_COLLAPSED;
	}
	landing.time[0] = time;
	landing.gap = order % 2 ? r - (plate + s / 2) : (r - plate) - s / 2;
	return landing;
}

/* What is measured over many plates is what the balls do one by one, and those do what the formulas say. The median is
 * that of the first 4096 that rest. */
static void assert_collapse(const struct collapse_setup *setup, bool naive)
{
	enum { SAMPLE = 4096 };
	double errors[SAMPLE];
	struct collapse found, plain = {.worst_plate = NAN};
	char error[160];
	assert_true(collapse_measure(setup, &found, error));
	struct random_state random = random_seed(setup->seed);
	for (uint64_t i = 0; i < setup->plates; i++) {
		struct touchstone_drop drop = {{random_uniform(&random)}, -1, 0.5, setup->order, setup->most};
		struct touchstone_landing engines, landing = drop_plainly(drop.plate[0], naive, setup->order, setup->most);
		assert_true(touchstone_drop(setup->arithmetic, setup->method, &drop, 1, &engines, NULL, NULL, error));
		assert_int_equal(engines.verdict, landing.verdict);
		assert_int_equal(engines.events, landing.events);
		assert_close(engines.time[0], landing.time[0], 0);
		assert_close(engines.gap, landing.gap, 0);
		plain.deepest = fmin(plain.deepest, landing.gap);
		if (landing.verdict == TOUCHSTONE_HALTED) plain.halted++, plain.events_to_halt += (double)landing.events;
		if (landing.verdict != TOUCHSTONE_COLLAPSED) continue;
		double off = fabs(collapse_error(&drop, &landing));
		if (plain.rested < SAMPLE) errors[plain.rested] = off;
		if (off > plain.largest_error) plain.largest_error = off, plain.worst_plate = drop.plate[0];
		plain.rested++, plain.events_to_rest += (double)landing.events;
	}
	size_t sampled = plain.rested < SAMPLE ? plain.rested : SAMPLE;
	gsl_sort(errors, 1, sampled);
	print_message("%s, %s, seed %d: %d halt, %d rest\n", setup->method, touchstone_drop_order(setup->order),
				  (int)setup->seed, (int)plain.halted, (int)plain.rested);
	assert_int_equal(found.plates, setup->plates);
	assert_int_equal(found.halted, plain.halted);
	assert_int_equal(found.rested, plain.rested);
	assert_close(found.events_to_halt * (double)plain.halted, plain.events_to_halt, 1e-6);
	assert_close(found.events_to_rest * (double)plain.rested, plain.events_to_rest, 1e-6);
	assert_close(found.largest_error, plain.largest_error, 0);
	assert_close(found.worst_plate, plain.worst_plate, 0);
	assert_close(found.median_error, (errors[(sampled - 1) / 2] + errors[sampled / 2]) / 2, 0);
	assert_close(found.deepest, plain.deepest, 0);
	if (naive && setup->order % 2 == 0) assert_in_range(found.halted, found.plates / 8, found.plates * 5 / 8);
}

static void collapse_is_that_of_every_ball(void **state)
{
	(void)state;
	for (unsigned order = 0; order < TOUCHSTONE_DROP_ORDERS; order++)
		for (int naive = 0; naive < 2; naive++) {
			struct collapse_setup setup = paper(naive, order, order || naive ? 700 : 4500, SEED + order);
			assert_collapse(&setup, naive);
		}
}

static volatile int stop;

static void stop_now(int signal)
{
	(void)signal;
	stop = 1;
}

static void collapse_stops(void **state)
{
	(void)state;
	struct collapse_setup setup = paper(false, 0, UINT64_C(1) << 50, SEED);
	setup.stop = &stop;
	struct collapse collapse;
	char error[160] = "";
	signal(SIGALRM, stop_now);
	setitimer(ITIMER_REAL, &(struct itimerval){.it_value = {.tv_usec = 50000}}, NULL);
	assert_true(collapse_measure(&setup, &collapse, error));
	signal(SIGALRM, SIG_DFL);
	assert_in_range(collapse.plates, 1, setup.plates - 1);
}

/* ------------------------------------------------------------------ the course of a run */

static struct touchstone_engine *make_gas(struct touchstone_scene *scene, double restitution)
{
	static const struct scene_species ball = {1, {1, 1}};
	struct scene_recipe recipe = {.dimensions = 3,
								  .particle_count = 256,
								  .density = 0.4,
								  .boundary_restitution = {TOUCHSTONE_CONSTANT, 1},
								  .species_count = 1,
								  .species = &ball,
								  .restitution = {TOUCHSTONE_CONSTANT, restitution},
								  .velocities = SCENE_MAXWELL,
								  .temperature = 1};
	struct scene_error complaint;
	char error[160] = "";
	if (!scene_build(&recipe, SEED, scene, &complaint)) fail_msg("%s %s", complaint.key, complaint.text);
	struct touchstone_engine *engine = touchstone_create(scene, "binary64", "stable", error);
	if (!engine) fail_msg("%s", error);
	return engine;
}

static struct touchstone_status status_of(const struct touchstone_engine *engine)
{
	struct touchstone_status status;
	touchstone_status(engine, &status);
	return status;
}

/* What a watch is told; it may pull the plug after so many slices. */
struct told {
	uint64_t events, slices, stop_after;
	volatile int stop;
};

static void tell(void *context, uint64_t more, const struct touchstone_status *now)
{
	struct told *told = context;
	told->events += more;
	assert_int_equal(now->events, told->events);
	if (++told->slices == told->stop_after) told->stop = 1;
}

static void slices_do_not_matter(void **state)
{
	(void)state;
	struct touchstone_scene scene[2];
	struct touchstone_limits limits = {.events = brief ? 20000 : 300000, .time = INFINITY};
	struct touchstone_engine *whole = make_gas(&scene[0], 0.99), *sliced = make_gas(&scene[1], 0.99);
	touchstone_run(whole, &limits, NULL);
	struct told told = {.stop_after = 3};
	struct watch watch = {&told.stop, tell, &told};
	assert_false(course_run(sliced, &limits, NULL, &watch)); /* stopped on the way */
	assert_int_equal(told.slices, 3);
	uint64_t events = status_of(sliced).events;
	assert_in_range(events, 1, limits.events - 1);
	assert_false(course_run(sliced, &limits, NULL, &watch)); /* and before it began */
	assert_int_equal(status_of(sliced).events, events);
	told.stop = 0;
	limits.events -= events;
	assert_true(course_run(sliced, &limits, NULL, &watch));
	assert_int_equal(told.events, status_of(whole).events);
	assert_int_equal(status_of(sliced).digest, status_of(whole).digest);
	limits.time = status_of(whole).time + 0.5;
	assert_true(course_run(sliced, &limits, NULL, NULL));
	assert_close(status_of(sliced).time, limits.time, 0);
	touchstone_destroy(whole);
	touchstone_destroy(sliced);
	for (int i = 0; i < 2; i++) scene_free(&scene[i]);
}

/* Elastic whatever the scene says, then not any more; what was counted is forgotten. */
static void equilibration_is_elastic(void **state)
{
	(void)state;
	struct touchstone_scene scene;
	struct touchstone_engine *engine = make_gas(&scene, 0.8);
	struct told told = {0};
	struct watch watch = {&told.stop, tell, &told};
	struct conservation before = conservation_of(&scene, engine);
	assert_true(course_equilibrate(engine, 25, &watch));
	assert_int_equal(told.events, 25 * 256 / 2);
	assert_int_equal(course_events(1, 3), 2); /* two share one, and a half is a whole */
	assert_int_equal(status_of(engine).events, 0);
	struct conservation after = conservation_of(&scene, engine);
	assert_true(fabs(conservation_energy_drift(&before, &after)) < 1e-14);
	assert_true(conservation_momentum_drift(&before, &after) < 1e-14);

	struct touchstone_limits limits = {.events = 1000, .time = INFINITY};
	assert_true(course_run(engine, &limits, NULL, NULL));
	struct conservation later = conservation_of(&scene, engine);
	assert_true(conservation_energy_drift(&after, &later) < -0.1);
	assert_int_equal(status_of(engine).events, 1000);

	told = (struct told){.stop = 1};
	assert_false(course_equilibrate(engine, 25, &watch));
	assert_int_equal(told.events, 0);
	touchstone_destroy(engine);
	scene_free(&scene);
}

int main(void)
{
	brief = getenv("TOUCHSTONE_BRIEF");
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(separations_are_exact),          cmocka_unit_test(error_is_that_of_the_formula),
		cmocka_unit_test(collapse_is_that_of_every_ball), cmocka_unit_test(collapse_stops),
		cmocka_unit_test(slices_do_not_matter),           cmocka_unit_test(equilibration_is_elastic),
	};
	return cmocka_run_group_tests(tests, NULL, NULL);
}
