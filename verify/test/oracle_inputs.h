/* Random and hard inputs for the oracle's tests. */
#ifndef VERIFY_TEST_ORACLE_INPUTS_H
#define VERIFY_TEST_ORACLE_INPUTS_H

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "oracle/oracle.h"
#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

static uint64_t random_state;

/* Prints the seed; another may be given as TOUCHSTONE_SEED. */
static inline void seed_inputs(void)
{
	const char *wanted = getenv("TOUCHSTONE_SEED");
	random_state = wanted ? strtoull(wanted, NULL, 0) : 20140501;
	print_message("seed %" PRIu64 "\n", random_state);
}

/* splitmix64 */
static inline uint64_t random_bits64(void)
{
	uint64_t z = random_state += 0x9e3779b97f4a7c15u;
	z = (z ^ z >> 30) * 0xbf58476d1ce4e5b9u;
	z = (z ^ z >> 27) * 0x94d049bb133111ebu;
	return z ^ z >> 31;
}

static inline int below(int limit)
{
	return (int)(random_bits64() % (uint64_t)limit);
}

static inline double uniform(double least, double most)
{
	return least + (most - least) * ldexp((double)(random_bits64() >> 11), -53);
}

static inline double steps_away(double x, int steps)
{
	for (; steps > 0; steps--) x = nextafter(x, INFINITY);
	for (; steps < 0; steps++) x = nextafter(x, -INFINITY);
	return x;
}

static inline double ordinary(void)
{
	return uniform(-3, 3);
}

/* x over a power of two below 2^most. (A function, so that the draws come in one order with every compiler.) */
static inline double reduced(double x, int most)
{
	return ldexp(x, -below(most));
}

static inline double any_exponent(void)
{
	double x;
	uint64_t pattern = random_bits64();
	memcpy(&x, &pattern, sizeof x);
	return isfinite(x) ? x : 0;
}

static inline double small_integer(void)
{
	int x = below(9) - 4;
	return x == 0 && below(2) ? -0.0 : x;
}

static inline double subnormal(void)
{
	return ldexp(small_integer(), -1074);
}

static inline bool is_of_balls(const struct oracle_query *query)
{
	return query->shape == ORACLE_BALL_BALL || query->shape == ORACLE_BALL_LEAVE;
}

/* Any shape, all its numbers drawn alike. */
static inline void fill(struct oracle_query *query, double (*draw)(void))
{
	for (int i = 0; i < 7; i++) query->number[i] = draw();
	query->shape = (enum oracle_shape)below(4);
}

static inline void ordinary_numbers(struct oracle_query *query)
{
	fill(query, ordinary);
}

static inline void any_numbers(struct oracle_query *query)
{
	fill(query, any_exponent);
}

static inline void small_integers(struct oracle_query *query)
{
	fill(query, small_integer);
}

static inline void subnormals(struct oracle_query *query)
{
	fill(query, subnormal);
}

/* Ordinary numbers, lengths and speeds each on a scale of their own, down to where significands are cut off. */
static inline void scaled_balls(struct oracle_query *query)
{
	int length = below(2080) - 1060, speed = below(2080) - 1060;
	fill(query, below(4) ? ordinary : small_integer);
	query->shape = below(2) ? ORACLE_BALL_BALL : ORACLE_BALL_LEAVE;
	for (int i = 0; i < 7; i++) query->number[i] = ldexp(query->number[i], i < 3 || i == 6 ? length : speed);
}

static inline void approaching_balls(struct oracle_query *query)
{
	fill(query, ordinary);
	query->shape = below(4) ? ORACLE_BALL_BALL : ORACLE_BALL_LEAVE;
	query->ball.contact = 1;
	for (int axis = 0; axis < 3; axis++) query->ball.v[axis] = -query->ball.r[axis] + ordinary() / 4;
}

/* Within a few ulp of touching, or a little farther, at any angle. */
static inline void balls_near_contact(struct oracle_query *query)
{
	approaching_balls(query);
	double *r = query->ball.r, distance = sqrt(r[0] * r[0] + r[1] * r[1] + r[2] * r[2]);
	double wanted = below(2) ? steps_away(1, below(7) - 3) : 1 + reduced(ordinary(), 50);
	for (int axis = 0; axis < 3; axis++) r[axis] *= wanted / distance;
}

/* Passing at the contact distance to a few ulp: along an axis, where one step decides, or at any angle. */
static inline void grazing_balls(struct oracle_query *query)
{
	double contact = uniform(0.5, 2), flight = uniform(-1, 8), angle = below(2) ? 0 : uniform(0, 7);
	double along[2] = {cos(angle), sin(angle)};
	*query = (struct oracle_query){.shape = below(4) ? ORACLE_BALL_BALL : ORACLE_BALL_LEAVE,
								   .ball = {.v = {along[0], along[1], 0}, .contact = contact}};
	query->ball.r[0] = -along[1] * contact - along[0] * flight;
	query->ball.r[1] = steps_away(along[0] * contact - along[1] * flight, below(7) - 3);
}

/* speed^2 = 2 acceleration h to a few ulp, and sometimes exactly. */
static inline void double_roots(struct oracle_query *query)
{
	double speed = below(2) ? ordinary() : small_integer();
	double acceleration = below(2) ? ordinary() : reduced(below(2) ? -16 : 16, 9);
	double height = acceleration == 0 ? 1 : steps_away(speed * speed / (2 * acceleration), below(5) - 2);
	*query = (struct oracle_query){.shape = ORACLE_BALL_PLANE, .plane = {height, speed, acceleration, 0}};
}

static inline void ball_over_plate(struct oracle_query *query)
{
	double height = below(3) ? uniform(0, 1) : reduced(ordinary(), 60);
	double speed = uniform(-1, 1);
	if (below(2)) speed = reduced(speed, 40);
	*query = (struct oracle_query){.shape = ORACLE_BALL_PLANE, .plane = {0.5 + height, speed, below(8) ? -1 : 1, 0.5}};
}

static void (*const families[])(struct oracle_query *) = {
	ordinary_numbers,   any_numbers,   small_integers, subnormals,      scaled_balls,
	balls_near_contact, grazing_balls, double_roots,   ball_over_plate, approaching_balls,
};
enum { FAMILIES = sizeof families / sizeof *families };

static const mpfr_rnd_t directions[] = {MPFR_RNDN, MPFR_RNDU, MPFR_RNDD, MPFR_RNDZ};

/* ---- checks that name their input */

static inline void check(bool holds, const struct oracle_query *query, const char *what)
{
	if (holds) return;
	const double *n = query->number;
	fail_msg("%s: shape %d, %a %a %a %a %a %a %a", what, (int)query->shape, n[0], n[1], n[2], n[3], n[4], n[5], n[6]);
}

/* Zeros of different sign differ. */
static inline bool same_double(double x, double y)
{
	return memcmp(&x, &y, sizeof x) == 0;
}

/* The oracle as it is, and one that always uses the integers. */
struct both {
	struct oracle *quick, *exact;
};

static inline int make_oracles(void **state)
{
	static struct both both;
	both = (struct both){oracle_create(), oracle_create()};
	if (both.exact) oracle_force_exact(both.exact, true);
	*state = &both;
	return both.quick && both.exact ? 0 : -1;
}

static inline int drop_oracles(void **state)
{
	struct both *both = *state;
	oracle_destroy(both->quick);
	oracle_destroy(both->exact);
	return 0;
}

/* Of the times of two questions, by both oracles and either way round. */
static inline void check_order(struct both *both, struct oracle_query first, struct oracle_query second, int expected)
{
	struct oracle *oracles[] = {both->quick, both->exact};
	for (int i = 0; i < 2; i++) {
		struct oracle_time one = oracle_solve(oracles[i], &first), other = oracle_solve(oracles[i], &second);
		check(oracle_compare(oracles[i], &one, &other) == expected, &first, "order");
		check(oracle_compare(oracles[i], &other, &one) == -expected, &second, "order reversed");
	}
}

#endif
