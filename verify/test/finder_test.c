/* The finders against the exact oracle: `rounded` to the last bit in every arithmetic, every method by what its file
 * claims, and the inputs on which, by their files, methods fail. */
#include "oracle_inputs.h"

#include "test/long_double.h"
#include "touchstone.h"

enum {
	BATCH = 2048,
	ROUNDED_CASES = 10000000, /* of `rounded` in binary64 */
	CASES = 40000,            /* of each method, and of `rounded` in each other arithmetic */
};

static int shortened(int cases)
{
	return getenv("TOUCHSTONE_BRIEF") ? cases / 100 : cases;
}

/* ---- arithmetics as MPFR sees them */

struct arithmetic {
	const char *name;
	int bits;
	int largest_exponent; /* of a range like IEEE 754's; 0 for one without end */
};

static const struct arithmetic arithmetics[] = {
	{"binary64", 53, 1024}, {"binary32", 24, 128}, {"short:4", 4, 1024},   {"short:11", 11, 1024},
	{"short:25", 25, 1024}, {"extended", 64, 0},   {"binary128", 113, 0},  {"mpfr:3", 3, 0},
	{"mpfr:53", 53, 0},     {"mpfr:200", 200, 0},  {"mpfr:1024", 1024, 0}, {"twin", 53, 1024}, /* as a double sees it */
};
enum { ARITHMETICS = sizeof arithmetics / sizeof *arithmetics };

/* A number of so many bits, rounded by `ternary`, as the range of the arithmetic has it, and then as a double. */
static double in_range(mpfr_t number, int ternary, const struct arithmetic *arithmetic)
{
	int largest = arithmetic->largest_exponent;
	if (largest && mpfr_regular_p(number)) {
		mpfr_exp_t least = mpfr_get_emin(), most = mpfr_get_emax();
		mpfr_set_emax(largest);
		mpfr_set_emin(4 - largest - arithmetic->bits);
		ternary = mpfr_check_range(number, ternary, MPFR_RNDN);
		mpfr_subnormalize(number, ternary, MPFR_RNDN);
		mpfr_set_emin(least);
		mpfr_set_emax(most);
	}
	return mpfr_get_d(number, MPFR_RNDN);
}

/* Rounds the numbers of a query into an arithmetic; false when one is then no longer finite. */
static bool take_in(struct oracle_query *query, const struct arithmetic *arithmetic)
{
	bool finite = true;
	mpfr_t number;
	if (arithmetic->bits >= 53) return true;
	mpfr_init2(number, arithmetic->bits);
	for (int i = 0; i < 7; i++) {
		int ternary = mpfr_set_d(number, query->number[i], MPFR_RNDN);
		query->number[i] = in_range(number, ternary, arithmetic);
		finite &= isfinite(query->number[i]) != 0;
	}
	mpfr_clear(number);
	return finite;
}

/* The time correctly rounded into an arithmetic, and then to a double. */
static double nearest(struct oracle *oracle, const struct oracle_time *time, const struct arithmetic *arithmetic)
{
	if (arithmetic->bits == 53) return oracle_round(oracle, time, MPFR_RNDN);
	mpfr_t number;
	mpfr_init2(number, arithmetic->bits);
	int ternary = oracle_round_mpfr(oracle, number, time, MPFR_RNDN);
	double result = in_range(number, ternary, arithmetic);
	mpfr_clear(number);
	return result;
}

/* ---- questions, collected by shape so that they can be asked together */

struct questions {
	int count;
	double number[BATCH][TOUCHSTONE_MOST_NUMBERS];
	double time[BATCH];
};

static struct questions pile[TOUCHSTONE_SHAPES];

static struct oracle_query query_of(enum touchstone_shape shape, int k)
{
	struct oracle_query query = {.shape = (enum oracle_shape)shape};
	memcpy(query.number, pile[shape].number[k], sizeof query.number);
	return query;
}

static void ask(const char *arithmetic, const char *method, enum touchstone_shape shape, bool chained)
{
	char error[160];
	struct questions *asked = &pile[shape];
	const double(*number)[TOUCHSTONE_MOST_NUMBERS] = (const double(*)[TOUCHSTONE_MOST_NUMBERS])asked->number;
	if (!touchstone_find(arithmetic, method, shape, number, (size_t)asked->count, chained, asked->time, error))
		fail_msg("%s", error);
}

/* Draws a query that the arithmetic can hold onto the pile of its shape, and says which. */
static enum touchstone_shape draw(void (*family)(struct oracle_query *), const struct arithmetic *arithmetic)
{
	struct oracle_query query;
	do family(&query);
	while (!take_in(&query, arithmetic));
	struct questions *asked = &pile[query.shape];
	memcpy(asked->number[asked->count++], query.number, sizeof query.number);
	return (enum touchstone_shape)query.shape;
}

static void clear_piles(void)
{
	for (int shape = 0; shape < TOUCHSTONE_SHAPES; shape++) pile[shape].count = 0;
}

static void fail_answer(const char *what, const char *arithmetic, const char *method, const struct oracle_query *query,
						double got, double expected)
{
	const double *n = query->number;
	fail_msg("%s: %s in %s: shape %d, %a %a %a %a %a %a %a: got %a, expected %a", what, method, arithmetic,
			 (int)query->shape, n[0], n[1], n[2], n[3], n[4], n[5], n[6], got, expected);
}

/* ---- rounded */

static void check_rounded(struct oracle *oracle, enum touchstone_shape shape, const struct arithmetic *arithmetic)
{
	ask(arithmetic->name, "rounded", shape, below(4) == 0);
	for (int k = 0; k < pile[shape].count; k++) {
		struct oracle_query query = query_of(shape, k);
		struct oracle_time time = oracle_solve(oracle, &query);
		double expected = nearest(oracle, &time, arithmetic);
		if (!same_double(pile[shape].time[k], expected))
			fail_answer("not correctly rounded", arithmetic->name, "rounded", &query, pile[shape].time[k], expected);
	}
	pile[shape].count = 0;
}

/* One in so many is drawn from any family, the others from those that take the fast path. */
static void round_many(struct oracle *oracle, int cases, int any, const struct arithmetic *arithmetic)
{
	static void (*const common[])(struct oracle_query *) = {ordinary_numbers, approaching_balls, ball_over_plate};
	clear_piles();
	for (int i = 0; i < cases; i++) {
		enum touchstone_shape shape = draw(i % any ? common[i % 3] : families[i / any % FAMILIES], arithmetic);
		if (pile[shape].count == BATCH) check_rounded(oracle, shape, arithmetic);
	}
	for (int shape = 0; shape < TOUCHSTONE_SHAPES; shape++)
		check_rounded(oracle, (enum touchstone_shape)shape, arithmetic);
}

static void test_rounded_is_correctly_rounded(void **state)
{
	struct both *both = *state;
	round_many(both->quick, shortened(ROUNDED_CASES), 32, &arithmetics[0]);
}

static void test_rounded_is_correctly_rounded_in_every_arithmetic(void **state)
{
	struct both *both = *state;
	for (int a = 0; a < ARITHMETICS; a++) round_many(both->quick, shortened(CASES), 1, &arithmetics[a]);
}

/* ---- claims */

static bool within(const struct oracle_query *query, const struct touchstone_claim *claim)
{
	static const int count[] = {7, 7, 4, 2};
	for (int i = 0; i < count[query->shape]; i++) {
		double size = fabs(query->number[i]);
		if (size != 0 && (size < claim->least || size > claim->most)) return false;
	}
	return true;
}

/* Holds one answer to the claim; returns its error in the claim's units, or 0. */
static double hold(struct oracle *oracle, const struct arithmetic *arithmetic, const char *method,
				   const struct touchstone_claim *claim, const struct oracle_query *query, double got)
{
	if (!within(query, claim)) return 0;
	if (claim->never_nan && isnan(got)) fail_answer("not a number", arithmetic->name, method, query, got, 0);
	if (claim->never_negative && got < 0) fail_answer("negative", arithmetic->name, method, query, got, 0);
	if (claim->most_ulp == INFINITY && !claim->never_misses && !claim->never_phantom) return 0;
	if (claim->discriminant_bits && oracle_graze(oracle, query) <= ldexp(1, -claim->discriminant_bits)) return 0;
	struct oracle_time time = oracle_solve(oracle, query);
	double expected = nearest(oracle, &time, arithmetic);
	if (claim->never_misses && expected < INFINITY && got == INFINITY)
		fail_answer("missed", arithmetic->name, method, query, got, expected);
	if (claim->never_phantom && time.event == ORACLE_NEVER && got < INFINITY)
		fail_answer("phantom", arithmetic->name, method, query, got, expected);
	if (!(got < INFINITY && expected < INFINITY)) return 0;
	double error = oracle_error(oracle, &time, got);
	if (arithmetic->bits < 53) error = ldexp(error, arithmetic->bits - 53);
	bool normal = expected >= ldexp(1, 2 - arithmetic->largest_exponent) || !arithmetic->largest_exponent;
	if (normal && error > claim->most_ulp * (1 + 1e-9))
		fail_answer("error above the claim", arithmetic->name, method, query, got, expected);
	return normal && got > 0 ? error : 0;
}

/* Holds all answers on the piles to what the method claims; returns whether it claims anything. */
static bool hold_all(struct oracle *oracle, const struct arithmetic *arithmetic, const char *method, double *worst)
{
	bool claims = false;
	for (int shape = 0; shape < TOUCHSTONE_SHAPES; shape++) {
		char error[160];
		struct touchstone_claim claim;
		if (!touchstone_finder_claim(arithmetic->name, method, (enum touchstone_shape)shape, &claim, error)) continue;
		claims = true;
		ask(arithmetic->name, method, (enum touchstone_shape)shape, false);
		for (int k = 0; k < pile[shape].count; k++) {
			struct oracle_query query = query_of((enum touchstone_shape)shape, k);
			double got = hold(oracle, arithmetic, method, &claim, &query, pile[shape].time[k]);
			*worst = fmax(*worst, got);
		}
	}
	return claims;
}

static void test_methods_keep_their_claims(void **state)
{
	struct both *both = *state;
	enum { MOST_METHODS = 32 };
	for (int a = 0; a < ARITHMETICS; a++) {
		if (!arithmetic_is_whole(arithmetics[a].name)) continue;
		double worst[MOST_METHODS] = {0};
		int claims = 0;
		for (int done = 0; done < shortened(CASES); done += BATCH) {
			const char *method;
			clear_piles();
			for (int i = 0; i < BATCH; i++) draw(families[i % FAMILIES], &arithmetics[a]);
			for (int m = 0; (method = touchstone_finder_name((size_t)m)); m++)
				claims += hold_all(both->quick, &arithmetics[a], method, &worst[m]);
		}
		assert_true(claims >= 4);
		print_message("%s:", arithmetics[a].name);
		for (int m = 0; touchstone_finder_name((size_t)m); m++)
			if (worst[m] > 0) print_message(" %s %.3g ulp", touchstone_finder_name((size_t)m), worst[m]);
		print_message("\n");
	}
}

/* ---- witnesses */

enum fault { MISSED, INVENTED, BELOW_ZERO, NO_NUMBER, INACCURATE };

struct witness {
	const char *method;
	enum fault fault;
	const struct oracle_query *query;
	double ulp; /* of the inaccurate */
};

static const struct oracle_query inside = {
	ORACLE_BALL_BALL, .number = {-0x1.20ead74f39b9bp+2, 0x1.7369d85fc87fap+0, 0, 1, 0, 0, 0x1.7369d85fc87fcp+0}};
static const struct oracle_query outside = {
	ORACLE_BALL_BALL, .number = {-0x1.fe8adeff2cb38p+1, 0x1.29e3db2c33b4cp-1, 0, 1, 0, 0, 0x1.29e3db2c33b49p-1}};
static const struct oracle_query overlap = {ORACLE_BALL_BALL, .number = {0x1.fffffffffffffp-1, 0, 0, -1, 0, 0, 1}};
static const struct oracle_query receding = {ORACLE_BALL_BALL, .number = {0x1.fffffffffffffp-1, 0, 0, 1, 0, 0, 1}};
static const struct oracle_query slow = {ORACLE_BALL_BALL, .number = {2, 0, 0, -0x1p-27, 0, 0, 1}};
static const struct oracle_query huge = {ORACLE_BALL_BALL, .number = {0x1p400, 0, 0, -0x1p200, 0, 0, 1}};
static const struct oracle_query sunk = {ORACLE_BALL_PLANE, .number = {0x1.fffffffffffffp-2, 0, -1, 0x1p-1}};
static const struct oracle_query half_way = {ORACLE_HALF_SPACE, .number = {0x1p-1074, -2}};
static const struct oracle_query leaving = {
	ORACLE_BALL_LEAVE, .number = {0x1.159e575eae8fap-1, 0x1.ae7400a7b25cp-2, 0x1.747dac982341ap-1,
								  -0x1.d398d3b7a19d6p-1, -0x1.36a038c8f3de2p-1, -0x1.bd78942184b8dp+0, 1}};

static const struct witness witnesses[] = {
	{"stable", MISSED, &inside, 0},
	{"stable", INVENTED, &outside, 0},
	{"naive", BELOW_ZERO, &overlap, 0},
	{"naive", NO_NUMBER, &sunk, 0},
	{"guarded", MISSED, &overlap, 0},
	{"guarded", MISSED, &slow, 0},
	{"compensated", INACCURATE, &leaving, 3.13},
	{"rounded", INACCURATE, &half_way, 0.5},
	{"numerical-recipes", BELOW_ZERO, &overlap, 0},
	{"numerical-recipes", INVENTED, &outside, 0},
	{"numerical-recipes", NO_NUMBER, &huge, 0},
	{"kahan", BELOW_ZERO, &overlap, 0},
	{"kahan", MISSED, &inside, 0},
	{"kahan", NO_NUMBER, &huge, 0},
	{"sterbenz", BELOW_ZERO, &overlap, 0},
	{"sterbenz", MISSED, &inside, 0},
	{"textbook-epsilon", INVENTED, &receding, 0},
	{"textbook-epsilon", MISSED, &slow, 0},
};

/* Each method file names inputs on which the method fails, or is as far off as it was ever seen. */
static void test_witnesses(void **state)
{
	struct both *both = *state;
	for (size_t w = 0; w < sizeof witnesses / sizeof *witnesses; w++) {
		const struct witness *witness = &witnesses[w];
		const struct oracle_query *query = witness->query;
		char error[160];
		double got;
		if (!touchstone_find("binary64", witness->method, (enum touchstone_shape)query->shape, &query->number, 1, false,
							 &got, error))
			fail_msg("%s", error);
		struct oracle_time time = oracle_solve(both->quick, query);
		double ulp = oracle_error(both->quick, &time, got), expected = oracle_round(both->quick, &time, MPFR_RNDN);
		bool event = time.event != ORACLE_NEVER;
		const bool holds[] = {
			[MISSED] = event && got == INFINITY,
			[INVENTED] = !event && got < INFINITY,
			[BELOW_ZERO] = got < 0,
			[NO_NUMBER] = isnan(got) != 0,
			[INACCURATE] = event && fabs(ulp - witness->ulp) < 0.01,
		};
		if (!holds[witness->fault]) fail_answer("no witness", "binary64", witness->method, query, got, expected);
	}
}

int main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test_setup_teardown(test_rounded_is_correctly_rounded, make_oracles, drop_oracles),
		cmocka_unit_test_setup_teardown(test_rounded_is_correctly_rounded_in_every_arithmetic, make_oracles,
										drop_oracles),
		cmocka_unit_test_setup_teardown(test_methods_keep_their_claims, make_oracles, drop_oracles),
		cmocka_unit_test_setup_teardown(test_witnesses, make_oracles, drop_oracles),
	};
	seed_inputs();
	int failed = cmocka_run_group_tests(tests, NULL, NULL);
	mpfr_free_cache();
	return failed;
}
