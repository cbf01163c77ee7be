/* How far apart particles are at impact, against the same sums in thousands of bits. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <gsl/gsl_statistics_double.h>
#include <mpfr.h>
#include <stdio.h>
#include <stdlib.h>

#include "measure/impact.h"
#include "scene/random.h"

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

int main(void)
{
	brief = getenv("TOUCHSTONE_BRIEF");
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(separations_are_exact),
	};
	return cmocka_run_group_tests(tests, NULL, NULL);
}
