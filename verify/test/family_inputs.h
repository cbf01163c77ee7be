/* Questions of families, for the tests that look at what they are. */
#ifndef VERIFY_TEST_FAMILY_INPUTS_H
#define VERIFY_TEST_FAMILY_INPUTS_H

#include <inttypes.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "family/family.h"
#include "oracle/oracle.h"
#include "store/query_file.h"

typedef double numbers[TOUCHSTONE_MOST_NUMBERS];

static uint64_t family_seed;

/* Prints the seed; another may be given as TOUCHSTONE_SEED. */
static inline void seed_families(void)
{
	const char *wanted = getenv("TOUCHSTONE_SEED");
	family_seed = wanted ? strtoull(wanted, NULL, 0) : 20140503;
	print_message("seed %" PRIu64 "\n", family_seed);
}

static inline bool has_shape(const struct family *family, enum touchstone_shape shape)
{
	return family->shapes >> shape & 1;
}

static inline void fill(const struct family *family, enum touchstone_shape shape, uint64_t seed, uint64_t first,
						size_t count, numbers *filled)
{
	char error[160];
	if (!family_fill(family, shape, seed, first, count, filled, error)) fail_msg("%s: %s", family->name, error);
}

static inline struct oracle_query query_of(enum touchstone_shape shape, const double *number)
{
	struct oracle_query query = {.shape = (enum oracle_shape)shape};
	memcpy(query.number, number, sizeof query.number);
	return query;
}

static inline bool is_of_balls(enum touchstone_shape shape)
{
	return shape == TOUCHSTONE_BALL_BALL || shape == TOUCHSTONE_BALL_LEAVE;
}

/* Fails, and names the question. */
static inline void check(bool holds, const struct family *family, enum touchstone_shape shape, const double *n,
						 const char *what)
{
	if (holds) return;
	fail_msg("%s is not %s: %s %a %a %a %a %a %a %a", family->name, what, shape_name(shape), n[0], n[1], n[2], n[3],
			 n[4], n[5], n[6]);
}

#endif
