/* Balls that bounce on a plate until they rest: what is measured of them against what each does, and where they rest
 * against theory and the engine. */
#include <math.h>
#include <setjmp.h>
#include <signal.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <gsl/gsl_sort.h>
#include <mpfr.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/time.h>

#include "measure/collapse.h"
#include "measure/interval.h"
#include "scene/random.h"
#include "scene/scene.h"

enum { SEED = 20140902, BITS = 5000 };

static bool brief; /* under sanitizers, where everything takes ten times longer */

/* cmocka compares in single precision. */
static void assert_close(double found, double expected, double tolerance)
{
	if (!(fabs(found - expected) <= tolerance)) fail_msg("%.17g, not %.17g within %g", found, expected, tolerance);
}

static void set_sum(mpfr_t sum, const double terms[TOUCHSTONE_MOST_TERMS])
{
	mpfr_set_zero(sum, 1);
	for (int term = TOUCHSTONE_MOST_TERMS - 1; term >= 0; term--) mpfr_add_d(sum, sum, terms[term], MPFR_RNDN);
}

/* ------------------------------------------------------------------ the measure */

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
		set_sum(height, landing.start);
		set_sum(factor, landing.plate);
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
		set_sum(factor, landing.time);
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

/* ------------------------------------------------------------------ the time of rest */

static const double gravity = -1, restitution = 0.5; /* the paper's ball, which rests at t = 3 */

enum { ENGINE_ORDER = 3 }; /* the engine forms the contact position first, and a flight as r + (v t + g/2 t^2) */

/* From a thread that cmocka does not know. */
static void fail_in_thread(const char *why)
{
	fprintf(stderr, "%s\n", why);
	exit(EXIT_FAILURE);
}

/* Rest time of a ball over a plate by the engine itself, or NaN if it does not come to rest. */
static double engine_rests(double plate, enum touchstone_form form)
{
	struct touchstone_particle ball = {.position = {plate + 1}};
	struct touchstone_wall wall = {{plate}, {1}, {TOUCHSTONE_CONSTANT, restitution}};
	static const struct scene_species unit_ball = {1, {1, 1}};
	struct scene_recipe recipe = {.dimensions = 1,
								  .form = form,
								  .box = {8},
								  .boundary = {SCENE_OPEN},
								  .acceleration = {gravity},
								  .particle_count = 1,
								  .particles = &ball,
								  .positions = SCENE_GIVEN,
								  .velocities = SCENE_AS_GIVEN,
								  .species_count = 1,
								  .species = &unit_ball,
								  .restitution = {TOUCHSTONE_CONSTANT, 1},
								  .boundary_restitution = {TOUCHSTONE_CONSTANT, 1},
								  .wall_count = 1,
								  .walls = &wall};
	struct touchstone_scene scene;
	struct scene_error complaint;
	char error[160] = "";
	if (!scene_build(&recipe, SEED, &scene, &complaint)) fail_in_thread(complaint.text);
	struct touchstone_engine *engine = touchstone_create(&scene, "binary64", "stable", error);
	if (!engine) fail_in_thread(error);
	touchstone_run(engine, &(struct touchstone_limits){.events = 100000, .time = INFINITY}, NULL);
	struct touchstone_status status;
	touchstone_status(engine, &status);
	touchstone_destroy(engine);
	scene_free(&scene);
	return status.verdict == TOUCHSTONE_COLLAPSED ? status.time : NAN;
}

/* The engine calls a ball at rest after 260 events without progress of time, each of which may still be two units in
 * the last place of t long; the drop after 16 that do not move its time at all. */
static void engine_and_drop_rest_together(void **state)
{
	(void)state;
	const double lag = 260 * 2 * 0x1p-51;
	int plates = brief ? 300 : 10000, lost = 0;
	double apart = 0, off = 0;
#pragma omp parallel for schedule(static) reduction(max : apart, off) reduction(+ : lost)
	for (int i = 0; i < plates; i++) {
		struct random_state random = random_seed(SEED + (uint64_t)i);
		struct touchstone_drop drop = {{random_uniform(&random)}, gravity, restitution, ENGINE_ORDER, 10000};
		struct touchstone_landing landing;
		char error[160];
		lost += !touchstone_drop("binary64", "stable", &drop, 1, &landing, NULL, NULL, error) ||
				landing.verdict != TOUCHSTONE_COLLAPSED;
		double exact = landing.time[0] - collapse_error(&drop, &landing);
		for (int form = TOUCHSTONE_RELATIVE; form <= TOUCHSTONE_ABSOLUTE; form++) {
			double time = engine_rests(drop.plate[0], form);
			lost += isnan(time);
			apart = fmax(apart, fabs(time - landing.time[0]));
			off = fmax(off, fabs(time - exact));
		}
	}
	print_message("%d plates from seed %d: rest times differ by at most %.2g, and from the exact ones by %.2g\n",
				  plates, SEED, apart, off);
	assert_int_equal(lost, 0);
	assert_true(apart < lag);
	assert_true(off < lag);
}

static struct collapse drop_balls(const char *arithmetic, int bits, unsigned order, uint64_t plates)
{
	struct collapse collapse;
	char error[160];
	struct collapse_setup setup = {.arithmetic = arithmetic,
								   .method = "stable",
								   .order = order,
								   .gravity = gravity,
								   .restitution = restitution,
								   .plates = plates,
								   .seed = SEED,
								   .bits = bits,
								   .most = 4000};
	if (!collapse_measure(&setup, &collapse, error)) fail_in_thread(error);
	return collapse;
}

/* Below 1e-7 as the engine evaluates it, and of the size of the square root of the roundoff in any order. */
static void every_ball_rests_on_time(void **state)
{
	(void)state;
	struct collapse collapse[TOUCHSTONE_DROP_ORDERS];
	uint64_t plates = brief ? 1000 : 20000;
#pragma omp parallel for schedule(dynamic, 1)
	for (unsigned order = 0; order < TOUCHSTONE_DROP_ORDERS; order++)
		collapse[order] = drop_balls("binary64", 53, order, plates);
	for (unsigned order = 0; order < TOUCHSTONE_DROP_ORDERS; order++) {
		print_message("%s: rest time off by at most %.2g, on the plate at %a\n", touchstone_drop_order(order),
					  collapse[order].largest_error, collapse[order].worst_plate);
		assert_int_equal(collapse[order].plates, plates);
		assert_int_equal(collapse[order].rested, plates);
		assert_true(collapse[order].largest_error < (order == ENGINE_ORDER ? 1e-7 : 32 * sqrt(0x1p-53)));
	}
}

/* Where the gap is (r - plate) - s/2, as algorithm 2 of the 2014 paper has it, the last bounces are as small as the
 * square root of the roundoff, and the error of the rest time with them. */
static void rest_time_errs_by_half_the_bits(void **state)
{
	(void)state;
	static const struct {
		const char *arithmetic;
		int bits;
	} rung[] = {{"short:8", 8},   {"short:16", 16},   {"binary32", 24},  {"mpfr:36", 36},   {"binary64", 53},
				{"extended", 64}, {"binary128", 113}, {"mpfr:200", 200}, {"mpfr:350", 350}, {"mpfr:512", 512}};
	enum { RUNGS = sizeof rung / sizeof *rung };
	double bits[RUNGS], error[RUNGS];
#pragma omp parallel for schedule(dynamic, 1)
	for (int i = RUNGS - 1; i >= 0; i--) {
		bits[i] = rung[i].bits;
		error[i] = log2(drop_balls(rung[i].arithmetic, rung[i].bits, 0, brief ? 20 : 200).largest_error);
	}
	struct line_fit fit = fit_line(bits, error, RUNGS);
	print_message("rest time errs by 2^(%.4f P %+.2f), P = 8 .. 512\n", fit.slope, fit.intercept);
	assert_true(fabs(fit.slope + 0.5) < 0.02);
}

int main(void)
{
	brief = getenv("TOUCHSTONE_BRIEF");
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(error_is_that_of_the_formula),
		cmocka_unit_test(collapse_is_that_of_every_ball),
		cmocka_unit_test(collapse_stops),
		cmocka_unit_test(engine_and_drop_rest_together),
		cmocka_unit_test(every_ball_rests_on_time),
		cmocka_unit_test(rest_time_errs_by_half_the_bits),
	};
	return cmocka_run_group_tests(tests, NULL, NULL);
}
