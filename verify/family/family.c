#include "family/family.h"

#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "family/make.h"
#include "store/query_file.h"

enum {
	MEET = 1 << TOUCHSTONE_BALL_BALL,
	LEAVE = 1 << TOUCHSTONE_BALL_LEAVE,
	BALLS = MEET | LEAVE,
	PLANE = 1 << TOUCHSTONE_BALL_PLANE,
	CROSS = 1 << TOUCHSTONE_HALF_SPACE,
	ALL = BALLS | PLANE | CROSS,
};

/* A family and how it is made: one question at a time, or a block at a time. */
static const struct source {
	struct family family; /* the first, so that a family is known to be its source */
	family_make *make;
	family_harvest *harvest;
} sources[] = {
	{{"dense", "a dense gas of hard spheres between walls: what the search asks after each event", FAMILY_HARVESTED,
	  MEET | PLANE | CROSS, false},
	 NULL,
	 harvest_dense},
	{{"dilute", "a dilute gas of hard spheres between walls, asked likewise", FAMILY_HARVESTED, MEET | PLANE | CROSS,
	  false},
	 NULL,
	 harvest_dilute},
	{{"inelastic", "a cooling gas of restitution 0.5, asked likewise", FAMILY_HARVESTED, MEET | PLANE | CROSS, false},
	 NULL,
	 harvest_inelastic},
	{{"wells", "hard spheres asked when they meet or part at 1.5 diameters, as square wells would", FAMILY_HARVESTED,
	  BALLS, false},
	 NULL,
	 harvest_wells},
	{{"bouncing-ball", "a ball that comes to rest on a plate, asked after each bounce", FAMILY_HARVESTED, PLANE, false},
	 NULL,
	 harvest_bouncing_ball},
	{{"near-contact", "0 to 2^32 ulp from contact, mostly approaching", FAMILY_HAND_MADE, ALL, false},
	 make_near_contact,
	 NULL},
	{{"just-overlapping", "1 to 2^32 ulp inside contact, mostly approaching", FAMILY_HAND_MADE, ALL, false},
	 make_just_overlapping,
	 NULL},
	{{"grazing", "1 to 2^24 ulp off a glancing touch: hits (even questions) and misses (odd)", FAMILY_HAND_MADE,
	  BALLS | PLANE, false},
	 make_grazing,
	 NULL},
	{{"double-root", "glancing touches whose discriminant is exactly zero", FAMILY_HAND_MADE, BALLS | PLANE, false},
	 make_double_root,
	 NULL},
	{{"receding", "on the way apart, some hardly: no event", FAMILY_HAND_MADE, MEET | PLANE | CROSS, false},
	 make_receding,
	 NULL},
	{{"at-rest", "no velocity, with zeros of either sign", FAMILY_HAND_MADE, ALL, false}, make_at_rest, NULL},
	{{"scale-ratios", "positions, velocities and diameters each anywhere from 2^-240 to 2^240", FAMILY_HAND_MADE, ALL,
	  false},
	 make_scale_ratios,
	 NULL},
	{{"overflow", "squares of lengths or speeds, or of their product, overflow", FAMILY_HAND_MADE, BALLS | PLANE,
	  false},
	 make_overflow,
	 NULL},
	{{"underflow", "squares of lengths or speeds, or of their product, underflow to zero", FAMILY_HAND_MADE,
	  BALLS | PLANE, false},
	 make_underflow,
	 NULL},
	{{"subnormal", "lengths or speeds below the smallest normal number", FAMILY_HAND_MADE, ALL, false},
	 make_subnormal,
	 NULL},
	{{"zeros", "zero and negative zero in each place", FAMILY_HAND_MADE, ALL, false}, make_zeros, NULL},
	{{"huge-times", "an event later than 2^25, up to 2^1000", FAMILY_HAND_MADE, ALL, false}, make_huge_times, NULL},
	{{"any-doubles", "random significands over all exponents", FAMILY_HAND_MADE, ALL, false}, make_patterns, NULL},
	{{"quadratics", "coefficients on which published solvers fail", FAMILY_HAND_MADE, BALLS | PLANE, false},
	 make_quadratics,
	 NULL},
	{{"ties", "two by two at exactly the same time: moved, turned, or other pairs", FAMILY_HAND_MADE, ALL, true},
	 make_ties,
	 NULL},
};
enum { SOURCES = sizeof sources / sizeof *sources };

const struct family *family_at(size_t number)
{
	return number < SOURCES ? &sources[number].family : NULL;
}

const struct family *family_named(const char *name)
{
	for (size_t s = 0; s < SOURCES; s++)
		if (strcmp(sources[s].family.name, name) == 0) return &sources[s].family;
	return NULL;
}

/* What seeds the questions of a family, by FNV-1a over all that names them: another family in the table changes
 * nothing. */
static uint64_t key_of(const struct family *family, enum touchstone_shape shape, uint64_t seed)
{
	uint64_t hash = UINT64_C(0xcbf29ce484222325) ^ random_seed(seed).word[0];
	for (const char *letter = family->name; *letter; letter++)
		hash = (hash ^ (unsigned char)*letter) * UINT64_C(0x100000001b3);
	return (hash ^ (uint64_t)shape) * UINT64_C(0x100000001b3);
}

/* Of question or block `index`. The factor is none that random_seed() counts by: states do not overlap. */
static uint64_t seed_of(uint64_t key, uint64_t index)
{
	return key ^ index * UINT64_C(0xd1342543de82ef95);
}

static void fill_one_by_one(const struct source *source, enum touchstone_shape shape, uint64_t key, uint64_t first,
							size_t count, double (*numbers)[TOUCHSTONE_MOST_NUMBERS])
{
	for (size_t i = 0; i < count; i++) {
		uint64_t index = first + i;
		struct random_state random = random_seed(seed_of(key, source->family.paired ? index / 2 : index));
		memset(numbers[i], 0, sizeof numbers[i]);
		source->make(shape, &random, index, numbers[i]);
		for (size_t n = shape_numbers(shape); n < TOUCHSTONE_MOST_NUMBERS; n++) numbers[i][n] = 0;
	}
}

/* The last block of which only a part was asked for: the next call often wants the rest. */
static struct {
	pthread_mutex_t lock;
	const struct source *source; /* NULL: none */
	enum touchstone_shape shape;
	uint64_t seed;
	double numbers[FAMILY_BLOCK][TOUCHSTONE_MOST_NUMBERS];
} last = {.lock = PTHREAD_MUTEX_INITIALIZER};

static bool fill_part(const struct source *source, enum touchstone_shape shape, uint64_t seed, size_t first,
					  size_t count, double (*numbers)[TOUCHSTONE_MOST_NUMBERS], char error[160])
{
	pthread_mutex_lock(&last.lock);
	bool known = last.source == source && last.shape == shape && last.seed == seed;
	if (!known) {
		known = source->harvest(shape, seed, last.numbers, error);
		last.source = known ? source : NULL;
		last.shape = shape;
		last.seed = seed;
	}
	if (known) memcpy(numbers, last.numbers[first], count * sizeof *numbers);
	pthread_mutex_unlock(&last.lock);
	return known;
}

static bool fill_blocks(const struct source *source, enum touchstone_shape shape, uint64_t key, uint64_t first,
						size_t count, double (*numbers)[TOUCHSTONE_MOST_NUMBERS], char error[160])
{
	for (size_t filled = 0, part; filled < count; filled += part) {
		uint64_t index = first + filled, seed = seed_of(key, index / FAMILY_BLOCK);
		size_t offset = index % FAMILY_BLOCK;
		part = FAMILY_BLOCK - offset;
		if (part > count - filled) part = count - filled;
		bool good = part == FAMILY_BLOCK ? source->harvest(shape, seed, numbers + filled, error)
										 : fill_part(source, shape, seed, offset, part, numbers + filled, error);
		if (!good) return false;
	}
	return true;
}

bool family_fill(const struct family *family, enum touchstone_shape shape, uint64_t seed, uint64_t first, size_t count,
				 double (*numbers)[TOUCHSTONE_MOST_NUMBERS], char error[160])
{
	const struct source *source = (const struct source *)family;
	if (!(family->shapes >> shape & 1)) {
		snprintf(error, 160,
				 "family '%s' has no questions of this shape; accepted: those that `touchstone list "
				 "families` names",
				 family->name);
		return false;
	}
	uint64_t key = key_of(family, shape, seed);
	if (!source->make) return fill_blocks(source, shape, key, first, count, numbers, error);
	fill_one_by_one(source, shape, key, first, count, numbers);
	return true;
}
