/* Hand-made families: every question has the property that names its family, to the last bit. */
#include "family_inputs.h"
#include <float.h>
#include <gmp.h>
#include <limits.h>

enum { COUNT = 20000 };

static numbers question[COUNT];
static struct oracle *oracle;

/* b^2 - ac of balls, speed^2 - 2 acceleration h of a plane, and what it is small against: a contact^2, speed^2. */
static struct exact {
	mpq_t discriminant, scale, one, other;
} exact;

/* sum += factor x y z w */
static void add_product(mpq_t sum, double factor, double x, double y, double z, double w)
{
	const double numbers[] = {x, y, z, w};
	mpq_set_d(exact.one, factor);
	for (int i = 0; i < 4; i++) {
		mpq_set_d(exact.other, numbers[i]);
		mpq_mul(exact.one, exact.one, exact.other);
	}
	mpq_add(sum, sum, exact.one);
}

static void find_discriminant(enum touchstone_shape shape, const double *n)
{
	mpq_set_ui(exact.discriminant, 0, 1);
	mpq_set_ui(exact.scale, 0, 1);
	if (shape == TOUCHSTONE_BALL_PLANE) {
		add_product(exact.discriminant, 1, n[1], n[1], 1, 1);
		add_product(exact.scale, 1, n[1], n[1], 1, 1);
		add_product(exact.discriminant, -2, n[2], n[0], 1, 1);
		add_product(exact.discriminant, 2, n[2], n[3], 1, 1);
		return;
	}
	for (int i = 0; i < 3; i++) {
		for (int k = 0; k < 3; k++) {
			add_product(exact.discriminant, 1, n[i], n[3 + i], n[k], n[3 + k]);
			add_product(exact.discriminant, -1, n[i], n[i], n[3 + k], n[3 + k]);
		}
		add_product(exact.discriminant, 1, n[3 + i], n[3 + i], n[6], n[6]);
		add_product(exact.scale, 1, n[3 + i], n[3 + i], n[6], n[6]);
	}
}

/* ---- one question */

struct look {
	const struct family *family;
	enum touchstone_shape shape;
	const double *n;
	size_t index;
	struct oracle_query query;
	struct oracle_time time;
	double gap, size; /* at the start; what it is small against */
};

static void is(const struct look *look, bool holds, const char *what)
{
	check(holds, look->family, look->shape, look->n, what);
}

static size_t touching, hits[2], glancing; /* counted as families are looked at */
static bool zero_seen[TOUCHSTONE_MOST_NUMBERS][2];
static int widest;

static void near_contact(const struct look *look)
{
	is(look, look->gap >= 0 && look->gap <= 0x1p-17 * look->size, "near contact");
	touching += look->gap == 0;
}

static void just_overlapping(const struct look *look)
{
	is(look, look->gap < 0 && look->gap >= -0x1p-17 * look->size, "just overlapping");
}

static void grazing(const struct look *look)
{
	find_discriminant(look->shape, look->n);
	int side = mpq_sgn(exact.discriminant);
	mpq_set_d(exact.one, 0x1p25);
	mpq_mul(exact.discriminant, exact.discriminant, exact.one);
	mpq_abs(exact.discriminant, exact.discriminant);
	is(look, mpq_cmp(exact.discriminant, exact.scale) < 0, "near the tangent");
	hits[look->index % 2] += side > 0;
	glancing += side == 0;
	bool turns_back = look->shape != TOUCHSTONE_BALL_LEAVE && (look->shape == TOUCHSTONE_BALL_BALL || look->n[2] > 0);
	if (turns_back) is(look, (look->time.event == ORACLE_NEVER) == (side <= 0), "missing just where it should");
}

static void double_root(const struct look *look)
{
	find_discriminant(look->shape, look->n);
	is(look, mpq_sgn(exact.discriminant) == 0, "a double root");
	bool touches = look->shape == TOUCHSTONE_BALL_BALL || (look->shape == TOUCHSTONE_BALL_PLANE && look->n[2] > 0);
	is(look, look->time.event == (touches ? ORACLE_NEVER : ORACLE_LATER), "answered as the rule has it");
}

static void never(const struct look *look)
{
	is(look, look->time.event == ORACLE_NEVER, "without event");
}

static void at_rest(const struct look *look)
{
	if (is_of_balls(look->shape))
		is(look, look->n[3] == 0 && look->n[4] == 0 && look->n[5] == 0, "at rest");
	else
		is(look, look->n[1] == 0, "at rest");
	if (look->shape == TOUCHSTONE_BALL_PLANE && look->n[2] < 0)
		is(look, look->time.event != ORACLE_NEVER, "pulled in");
	else
		never(look);
}

static double square(const double *vector)
{
	return vector[0] * vector[0] + vector[1] * vector[1] + vector[2] * vector[2];
}

static double product(const struct look *look)
{
	return look->n[0] * look->n[3] + look->n[1] * look->n[4] + look->n[2] * look->n[5];
}

static void scale_ratios(const struct look *look)
{
	int least = INT_MAX, most = INT_MIN;
	for (size_t i = 0; i < shape_numbers(look->shape); i++) {
		if (look->n[i] == 0) continue;
		least = ilogb(look->n[i]) < least ? ilogb(look->n[i]) : least;
		most = ilogb(look->n[i]) > most ? ilogb(look->n[i]) : most;
	}
	widest = most - least > widest ? most - least : widest;
	if (is_of_balls(look->shape)) {
		double b = product(look);
		is(look, b * b <= DBL_MAX && square(look->n) * square(look->n + 3) <= DBL_MAX, "without overflow");
	}
}

static void overflow(const struct look *look)
{
	double b = is_of_balls(look->shape) ? product(look) : look->n[1];
	bool squares = is_of_balls(look->shape) && (isinf(square(look->n)) || isinf(square(look->n + 3)));
	is(look, squares || !isfinite(b * b), "overflowing");
}

static void underflow(const struct look *look)
{
	double b = is_of_balls(look->shape) ? product(look) : look->n[1];
	bool squares = is_of_balls(look->shape) && (square(look->n) == 0 || square(look->n + 3) == 0);
	is(look, squares || b * b == 0, "underflowing");
	is(look, look->n[1] != 0 || look->n[0] != 0, "other than zero");
}

static void subnormal(const struct look *look)
{
	bool found = false;
	for (size_t i = 0; i < shape_numbers(look->shape); i++) found |= fpclassify(look->n[i]) == FP_SUBNORMAL;
	is(look, found, "subnormal");
}

static void zeros(const struct look *look)
{
	bool found = false;
	for (size_t i = 0; i < shape_numbers(look->shape); i++) {
		if (look->n[i] != 0) continue;
		zero_seen[i][signbit(look->n[i]) != 0] = found = true;
	}
	is(look, found, "with a zero");
}

static void huge_times(const struct look *look)
{
	is(look, look->time.event == ORACLE_LATER, "an event");
	is(look, oracle_compare_double(oracle, &look->time, 0x1p25) > 0, "huge");
}

/* ---- whole families */

static void look_at(const char *name, enum touchstone_shape shape, void (*property)(const struct look *))
{
	const struct family *family = family_named(name);
	assert_non_null(family);
	assert_int_equal(family->origin, FAMILY_HAND_MADE);
	if (!has_shape(family, shape)) return;
	fill(family, shape, family_seed, 0, COUNT, question);
	for (size_t i = 0; i < COUNT; i++) {
		struct look look = {.family = family, .shape = shape, .n = question[i], .index = i};
		look.query = query_of(shape, question[i]);
		look.time = oracle_solve(oracle, &look.query);
		look.gap = oracle_gap(oracle, &look.query, 0);
		look.size = is_of_balls(shape) ? fabs(question[i][6]) : shape == TOUCHSTONE_BALL_PLANE ? question[i][3] : 1;
		property(&look);
	}
}

static void look_at_all_shapes(const char *name, void (*property)(const struct look *))
{
	for (int s = 0; s < TOUCHSTONE_SHAPES; s++) look_at(name, (enum touchstone_shape)s, property);
}

static void states_are_as_named(void **state)
{
	(void)state;
	look_at_all_shapes("near-contact", near_contact);
	assert_true(touching > COUNT / 20);
	look_at_all_shapes("just-overlapping", just_overlapping);
	look_at_all_shapes("receding", never);
	look_at_all_shapes("at-rest", at_rest);
}

static void tangents_are_tangents(void **state)
{
	(void)state;
	look_at_all_shapes("double-root", double_root);
	for (int s = 0; s < TOUCHSTONE_SHAPES; s++) {
		hits[0] = hits[1] = glancing = 0;
		look_at("grazing", (enum touchstone_shape)s, grazing);
		if (!has_shape(family_named("grazing"), (enum touchstone_shape)s)) continue;
		print_message("%s: %zu of %d hit where they should, %zu where they should not, %zu touch\n",
					  shape_name((enum touchstone_shape)s), hits[0], COUNT / 2, hits[1], glancing);
		assert_true(hits[0] > COUNT / 2 * 0.85 && hits[1] < COUNT / 2 * 0.15);
	}
}

static void sizes_are_as_named(void **state)
{
	(void)state;
	for (int s = 0; s < TOUCHSTONE_SHAPES; s++) {
		widest = 0;
		look_at("scale-ratios", (enum touchstone_shape)s, scale_ratios);
		assert_true(widest > 400);
	}
	look_at_all_shapes("overflow", overflow);
	look_at_all_shapes("underflow", underflow);
	look_at_all_shapes("subnormal", subnormal);
	look_at_all_shapes("huge-times", huge_times);
}

static void zeros_are_in_each_place(void **state)
{
	(void)state;
	for (int s = 0; s < TOUCHSTONE_SHAPES; s++) {
		memset(zero_seen, 0, sizeof zero_seen);
		look_at("zeros", (enum touchstone_shape)s, zeros);
		for (size_t i = 0; i < shape_numbers((enum touchstone_shape)s); i++)
			assert_true(zero_seen[i][0] && zero_seen[i][1]);
	}
}

static void ties_tie(void **state)
{
	(void)state;
	const struct family *family = family_named("ties");
	assert_true(family->paired);
	for (int s = 0; s < TOUCHSTONE_SHAPES; s++) {
		enum touchstone_shape shape = (enum touchstone_shape)s;
		fill(family, shape, family_seed, 0, COUNT, question);
		size_t later = 0, different = 0;
		for (size_t i = 0; i < COUNT; i += 2) {
			struct oracle_query one = query_of(shape, question[i]), other = query_of(shape, question[i + 1]);
			struct oracle_time first = oracle_solve(oracle, &one), second = oracle_solve(oracle, &other);
			check(first.event == second.event && oracle_compare(oracle, &first, &second) == 0, family, shape,
				  question[i], "a tie");
			later += first.event == ORACLE_LATER;
			different += memcmp(question[i], question[i + 1], sizeof question[i]) != 0;
		}
		print_message("%s: %zu of %d ties later than at once, %zu of different numbers\n", shape_name(shape), later,
					  COUNT / 2, different);
		assert_true(later > COUNT / 2 * 0.6 && different > COUNT / 2 * 0.9);
	}
}

/* ---- quadratics, known by (b^2 - 4 a c) / (a c): no unit of length or time, no sign and no factor changes it */

static double known[COUNT];
static size_t known_count;

static bool invariant(enum touchstone_shape shape, const double *n, double *value)
{
	find_discriminant(shape, n);
	mpq_set_ui(exact.scale, 0, 1);
	if (shape == TOUCHSTONE_BALL_PLANE) {
		add_product(exact.scale, 0.5, n[2], n[0], 1, 1);
	} else {
		for (int i = 0; i < 3; i++)
			for (int k = 0; k < 3; k++) add_product(exact.scale, 1, n[i], n[i], n[3 + k], n[3 + k]);
		for (int k = 0; k < 3; k++) add_product(exact.scale, -1, n[6], n[6], n[3 + k], n[3 + k]);
	}
	if (mpq_sgn(exact.scale) == 0) return false;
	mpq_div(exact.discriminant, exact.discriminant, exact.scale);
	mpq_set_d(exact.one, shape == TOUCHSTONE_BALL_PLANE ? 1 : 4); /* of balls b is half the published one */
	mpq_mul(exact.discriminant, exact.discriminant, exact.one);
	*value = mpq_get_d(exact.discriminant);
	return true;
}

static bool is_known(double value)
{
	for (size_t i = 0; i < known_count; i++)
		if (known[i] == value) return true;
	return false;
}

/* Those asked of planes are the published coefficients themselves; those asked of balls are among them. */
static void quadratics_are_the_published_ones(void **state)
{
	(void)state;
	const struct family *family = family_named("quadratics");
	fill(family, TOUCHSTONE_BALL_PLANE, family_seed, 0, COUNT, question);
	double value = 0;
	for (size_t i = 0; i < COUNT; i++)
		if (invariant(TOUCHSTONE_BALL_PLANE, question[i], &value) && !is_known(value)) known[known_count++] = value;
	static const double published[][3] = {{1, 0x1p27, 0x1.8p-1},
										  {0x1p-550, 0x1p-552, 0x1p-550},
										  {-158114166017, 316227766017, -158113600000},
										  {-312499999999, 707106781186, -4e11},
										  {8944394323791464, -2. * 5527939700884757, 3416454622906707}, /* F_78 */
										  {1, 2, 0x1.fffffffffffffp-1}};
	for (size_t p = 0; p < sizeof published / sizeof *published; p++) {
		const double *q = published[p];
		assert_true(invariant(TOUCHSTONE_BALL_PLANE, (double[4]){q[2], q[1], 2 * q[0], 0}, &value));
		assert_true(is_known(value));
	}
	print_message("%zu quadratics\n", known_count);
	assert_true(known_count >= 50 && known_count < 60);
	for (int s = 0; s < 2; s++) {
		size_t later = 0;
		fill(family, (enum touchstone_shape)s, family_seed, 0, COUNT, question);
		for (size_t i = 0; i < COUNT; i++) {
			bool found = invariant((enum touchstone_shape)s, question[i], &value) && is_known(value);
			check(found, family, (enum touchstone_shape)s, question[i], "published");
			struct oracle_query query = query_of((enum touchstone_shape)s, question[i]);
			later += oracle_solve(oracle, &query).event == ORACLE_LATER;
		}
		assert_true(later > COUNT / 3);
	}
}

static int make_oracle(void **state)
{
	(void)state;
	mpq_inits(exact.discriminant, exact.scale, exact.one, exact.other, NULL);
	oracle = oracle_create();
	return oracle ? 0 : -1;
}

static int drop_oracle(void **state)
{
	(void)state;
	oracle_destroy(oracle);
	mpq_clears(exact.discriminant, exact.scale, exact.one, exact.other, NULL);
	return 0;
}

int main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(states_are_as_named),
		cmocka_unit_test(tangents_are_tangents),
		cmocka_unit_test(sizes_are_as_named),
		cmocka_unit_test(zeros_are_in_each_place),
		cmocka_unit_test(ties_tie),
		cmocka_unit_test(quadratics_are_the_published_ones),
	};
	seed_families();
	int failed = cmocka_run_group_tests(tests, make_oracle, drop_oracle);
	mpfr_free_cache();
	return failed;
}
