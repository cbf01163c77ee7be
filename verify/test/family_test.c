/* Families of questions: a seed means the same questions however they are asked for, all numbers are finite, and what
 * is harvested looks like what it was harvested from. */
#include "family_inputs.h"
#include "scene/random.h"

enum { COUNT = 10000, SAMPLE = 20000 };

static numbers whole[SAMPLE], pieces[SAMPLE];

static uint64_t digest_of(const void *questions, size_t count, uint64_t hash)
{
	const unsigned char *byte = questions;
	for (size_t i = 0; i < count * sizeof(numbers); i++) hash = (hash ^ byte[i]) * UINT64_C(0x100000001b3);
	return hash;
}

/* Calls for every family and shape that there is. */
static void each(void (*look)(const struct family *family, enum touchstone_shape shape))
{
	const struct family *family;
	for (size_t f = 0; (family = family_at(f)); f++)
		for (int s = 0; s < TOUCHSTONE_SHAPES; s++)
			if (has_shape(family, (enum touchstone_shape)s)) look(family, (enum touchstone_shape)s);
}

/* Any pieces, in any order. */
static void ask_in_pieces(const struct family *family, enum touchstone_shape shape)
{
	struct {
		size_t first, count;
	} cut[64];
	size_t cuts = 0, position = 0;
	struct random_state random = random_seed(family_seed + (uint64_t)shape);
	while (position < COUNT) {
		size_t length = 1 + random_below(&random, 2 * 4096); /* up to two blocks of a harvest */
		if (cuts == 63 || length > COUNT - position) length = COUNT - position;
		cut[cuts].first = position;
		cut[cuts++].count = length;
		position += length;
	}
	while (cuts-- > 0) fill(family, shape, family_seed, cut[cuts].first, cut[cuts].count, pieces + cut[cuts].first);
}

static void look_at_pieces(const struct family *family, enum touchstone_shape shape)
{
	fill(family, shape, family_seed, 0, COUNT, whole);
	memset(pieces, 0xff, sizeof pieces);
	ask_in_pieces(family, shape);
	if (memcmp(whole, pieces, COUNT * sizeof *whole) != 0)
		fail_msg("%s %s depends on how it is asked", family->name, shape_name(shape));
	fill(family, shape, family_seed + 1, 0, COUNT, pieces);
	if (digest_of(whole, COUNT, 0) == digest_of(pieces, COUNT, 0))
		fail_msg("%s %s does not depend on the seed", family->name, shape_name(shape));
}

static void a_seed_means_the_same_questions(void **state)
{
	(void)state;
	each(look_at_pieces);
}

static void look_for_numbers(const struct family *family, enum touchstone_shape shape)
{
	fill(family, shape, family_seed, 1000000, COUNT, whole);
	for (size_t i = 0; i < COUNT; i++)
		for (size_t n = 0; n < TOUCHSTONE_MOST_NUMBERS; n++) {
			bool used = n < shape_numbers(shape);
			check(used ? isfinite(whole[i][n]) : whole[i][n] == 0, family, shape, whole[i], "made of finite numbers");
		}
}

static void numbers_are_finite(void **state)
{
	(void)state;
	each(look_for_numbers);
}

static uint64_t all_digest;

static void add_to_digest(const struct family *family, enum touchstone_shape shape)
{
	fill(family, shape, 1, 4000, 200, whole);
	all_digest = digest_of(whole, 200, all_digest);
}

/* Of 200 questions of each family and shape, from seed 1: a change is a change of what a seed means, on this machine or
 * for all, and must be meant. */
static void a_seed_means_the_same_on_every_machine(void **state)
{
	(void)state;
	all_digest = UINT64_C(0xcbf29ce484222325);
	each(add_to_digest);
	assert_int_equal(all_digest, UINT64_C(0x88f753534ad407e));
}

static void families_have_names(void **state)
{
	(void)state;
	const struct family *family;
	size_t made[2] = {0};
	for (size_t f = 0; (family = family_at(f)); f++) {
		assert_ptr_equal(family_named(family->name), family);
		assert_true(strlen(family->about) > 10 && family->shapes != 0 && family->shapes < 1 << TOUCHSTONE_SHAPES);
		made[family->origin]++;
	}
	assert_true(made[FAMILY_HAND_MADE] >= 14 && made[FAMILY_HARVESTED] == 5);
	assert_null(family_named("nothing of the kind"));
	char error[160] = "";
	assert_false(family_fill(family_named("grazing"), TOUCHSTONE_HALF_SPACE, 1, 0, 1, whole, error));
	assert_non_null(strstr(error, "'grazing' has no questions of this shape"));
	assert_null(strchr(error, '\n'));
}

/* Half of all last bits are set where nothing asks for short numbers. */
static void significands_are_full(void **state)
{
	(void)state;
	static const char *const full[] = {"near-contact", "scale-ratios", "overflow", "underflow", "any-doubles", "dense"};
	for (size_t f = 0; f < sizeof full / sizeof *full; f++) {
		size_t odd = 0, of = 0;
		fill(family_named(full[f]), TOUCHSTONE_BALL_BALL, family_seed, 0, COUNT, whole);
		for (size_t i = 0; i < COUNT; i++)
			for (int n = 3; n < 6; n++) {
				uint64_t pattern;
				memcpy(&pattern, &whole[i][n], sizeof pattern);
				odd += pattern & 1;
				of += whole[i][n] != 0;
			}
		/* Differences of a gas's velocities lose a bit or two. */
		if (!(odd > of * 0.2 && odd < of * 0.52)) fail_msg("%s: %zu last bits set of %zu", full[f], odd, of);
	}
}

/* ---- what is harvested */

struct tally {
	size_t count[3];          /* per event */
	size_t touching, overlap; /* within 1e-12 of contact; of these, below it */
	double speed, wait;       /* mean squared speed of balls, median wait */
};

static int by_value(const void *one, const void *other)
{
	double x = *(const double *)one, y = *(const double *)other;
	return (x > y) - (x < y);
}

static struct tally tally_of(struct oracle *oracle, const char *name, enum touchstone_shape shape)
{
	static double waits[SAMPLE];
	struct tally tally = {0};
	fill(family_named(name), shape, family_seed, 0, SAMPLE, whole);
	for (size_t i = 0; i < SAMPLE; i++) {
		struct oracle_query query = query_of(shape, whole[i]);
		struct oracle_time time = oracle_solve(oracle, &query);
		if (time.event == ORACLE_LATER) waits[tally.count[ORACLE_LATER]] = oracle_round(oracle, &time, MPFR_RNDN);
		tally.count[time.event]++;
		double gap = oracle_gap(oracle, &query, 0);
		tally.touching += fabs(gap) < 1e-12;
		tally.overlap += fabs(gap) < 1e-12 && gap < 0;
		for (int axis = 3; axis < 6; axis++) tally.speed += pow(whole[i][axis], 2) / SAMPLE;
	}
	qsort(waits, tally.count[ORACLE_LATER], sizeof *waits, by_value);
	tally.wait = waits[tally.count[ORACLE_LATER] / 2];
	print_message("%s %s: %zu never, %zu now, %zu later, median %.3f; %zu touching, %zu overlapping, v^2 %.3f\n", name,
				  shape_name(shape), tally.count[ORACLE_NEVER], tally.count[ORACLE_NOW], tally.count[ORACLE_LATER],
				  tally.wait, tally.touching, tally.overlap, tally.speed);
	return tally;
}

/* Every second event pair has just touched; a dense gas is asked about nearer things than a dilute one, and a cooling
 * gas about slower ones. */
static void gases_are_what_they_are_called(void **state)
{
	struct oracle *oracle = *state;
	struct tally dense = tally_of(oracle, "dense", TOUCHSTONE_BALL_BALL);
	struct tally dilute = tally_of(oracle, "dilute", TOUCHSTONE_BALL_BALL);
	struct tally inelastic = tally_of(oracle, "inelastic", TOUCHSTONE_BALL_BALL);
	const struct tally *const tallies[] = {&dense, &dilute, &inelastic};
	for (int t = 0; t < 3; t++) {
		assert_true(tallies[t]->count[ORACLE_LATER] > SAMPLE / 50);
		assert_true(tallies[t]->count[ORACLE_NEVER] > SAMPLE / 2);
		assert_true(tallies[t]->touching > SAMPLE / 200);
		assert_true(tallies[t]->overlap > tallies[t]->touching / 8); /* about half, by the 2014 paper's figure 3 */
		assert_true(tallies[t]->overlap < tallies[t]->touching);
	}
	assert_true(dense.wait < dilute.wait / 2);
	assert_true(dense.speed > 5 && dense.speed < 9); /* 6 between particles with kT = m = 1; who collides is faster */
	assert_true(inelastic.speed < dense.speed / 2);
	struct tally walls = tally_of(oracle, "dilute", TOUCHSTONE_BALL_PLANE);
	struct tally faces = tally_of(oracle, "dense", TOUCHSTONE_HALF_SPACE);
	assert_int_equal(walls.count[ORACLE_LATER] + walls.count[ORACLE_NOW], SAMPLE / 2); /* one of two walls is ahead */
	assert_int_equal(faces.count[ORACLE_LATER] + faces.count[ORACLE_NOW], SAMPLE / 2);
	assert_true(walls.touching > SAMPLE / 100);
}

/* Pairs inside their shell leave it, pairs outside may come in, and many are on it, on either side. */
static void wells_are_left_and_entered(void **state)
{
	struct tally leave = tally_of(*state, "wells", TOUCHSTONE_BALL_LEAVE);
	struct tally enter = tally_of(*state, "wells", TOUCHSTONE_BALL_BALL);
	assert_true(leave.count[ORACLE_NEVER] == 0);
	assert_true(enter.count[ORACLE_LATER] > SAMPLE / 20 && enter.count[ORACLE_NEVER] > SAMPLE / 2);
	const struct tally *const tallies[] = {&leave, &enter};
	for (int t = 0; t < 2; t++) {
		assert_true(tallies[t]->touching > SAMPLE / 1000);
		assert_true(tallies[t]->overlap > tallies[t]->touching / 8);
		assert_true(tallies[t]->overlap < tallies[t]->touching - tallies[t]->touching / 8);
	}
}

static void a_ball_comes_to_rest(void **state)
{
	struct tally tally = tally_of(*state, "bouncing-ball", TOUCHSTONE_BALL_PLANE);
	assert_int_equal(tally.count[ORACLE_NEVER], 0);
	assert_true(tally.touching > SAMPLE / 2 && tally.overlap > SAMPLE / 50);
	double slowest = INFINITY, highest = 0;
	for (size_t i = 0; i < SAMPLE; i++) {
		if (whole[i][1] != 0) slowest = fmin(slowest, fabs(whole[i][1]));
		highest = fmax(highest, whole[i][0]);
	}
	assert_true(slowest < 1e-15 && highest == 1);
}

static int make_oracle(void **state)
{
	*state = oracle_create();
	return *state ? 0 : -1;
}

static int drop_oracle(void **state)
{
	oracle_destroy(*state);
	return 0;
}

int main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(a_seed_means_the_same_questions),
		cmocka_unit_test(numbers_are_finite),
		cmocka_unit_test(a_seed_means_the_same_on_every_machine),
		cmocka_unit_test(families_have_names),
		cmocka_unit_test(significands_are_full),
		cmocka_unit_test(gases_are_what_they_are_called),
		cmocka_unit_test(wells_are_left_and_entered),
		cmocka_unit_test(a_ball_comes_to_rest),
	};
	seed_families();
	int failed = cmocka_run_group_tests(tests, make_oracle, drop_oracle);
	mpfr_free_cache();
	return failed;
}
