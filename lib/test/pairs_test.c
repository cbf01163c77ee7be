/* The store of pair states, held against a plain table of all pairs. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <stdlib.h>
#include <string.h>

#include "engine/cells.h"
#include "engine/pairs.h"
#include "scene/random.h"

enum { SEED = 20160301, PARTICLES = 40 };

/* State of particle i and image (x, y, z) of j, as i sees it; -1, 0, 1 stand at 0, 1, 2. */
typedef uint8_t table[PARTICLES][PARTICLES][3][3][3];

static uint32_t entry_of(uint32_t particle, const int image[3])
{
	uint32_t entry = particle;
	for (int axis = 0; axis < 3; axis++) entry = entry_shifted(entry, axis, image[axis]);
	return entry;
}

static uint8_t *cell(table state, uint32_t i, uint32_t j, const int image[3])
{
	return &state[i][j][image[0] + 1][image[1] + 1][image[2] + 1];
}

static void assert_same(const struct pairs *pairs, table state)
{
	uint64_t stored = 0;
	for (uint32_t i = 0; i < PARTICLES; i++) {
		uint32_t count, expected = 0;
		for (uint32_t j = 0; j < PARTICLES; j++)
			for (int x = -1; x <= 1; x++)
				for (int y = -1; y <= 1; y++)
					for (int z = -1; z <= 1; z++) {
						const int image[3] = {x, y, z};
						uint8_t wanted = *cell(state, i, j, image);
						expected += wanted > 0;
						assert_int_equal(pairs_get(pairs, i, entry_of(j, image)), wanted);
					}
		const struct pair_state *captured = pairs_of(pairs, i, &count);
		assert_int_equal(count, expected);
		for (uint32_t k = 0; k < count; k++)
			assert_int_equal(pairs_get(pairs, i, captured[k].entry), captured[k].state);
		stored += count;
	}
	assert_int_equal(2 * pairs->count, stored);
}

static void set(struct pairs *pairs, table state, struct random_state *random, int images)
{
	uint32_t i = (uint32_t)random_below(random, PARTICLES), j = (uint32_t)random_below(random, PARTICLES);
	uint8_t wanted = (uint8_t)(random_below(random, 3) ? random_below(random, 4) : 0);
	int image[3], back[3];
	for (int axis = 0; axis < 3; axis++) {
		image[axis] = (int)random_below(random, 3) - 1;
		if (axis >= images) image[axis] = 0;
		back[axis] = -image[axis];
	}
	if (i == j) return;
	*cell(state, i, j, image) = *cell(state, j, i, back) = wanted;
	assert_true(pairs_set(pairs, i, entry_of(j, image), wanted));
}

/* A particle moves to another image: those of its partners that would then be two boxes off are let go before. */
static void shift(struct pairs *pairs, table state, struct random_state *random)
{
	uint32_t i = (uint32_t)random_below(random, PARTICLES);
	int axis = (int)random_below(random, 3), by = random_below(random, 2) ? 1 : -1;
	static table moved;
	memcpy(moved, state, sizeof moved);
	for (uint32_t j = 0; j < PARTICLES; j++)
		for (int x = -1; x <= 1; x++)
			for (int y = -1; y <= 1; y++)
				for (int z = -1; z <= 1; z++) {
					const int image[3] = {x, y, z}, back[3] = {-x, -y, -z};
					int from[3] = {x, y, z}, to[3];
					from[axis] -= by;
					for (int a = 0; a < 3; a++) to[a] = -image[a];
					if (j == i) continue;
					bool beyond = from[axis] < -1 || from[axis] > 1;
					*cell(moved, i, j, image) = beyond ? 0 : *cell(state, i, j, from);
					*cell(moved, j, i, to) = *cell(moved, i, j, image);
					if (image[axis] != by || !*cell(state, i, j, image)) continue;
					assert_true(pairs_set(pairs, i, entry_of(j, image), 0));
					*cell(state, i, j, image) = *cell(state, j, i, back) = 0;
				}
	pairs_shift(pairs, i, axis, by);
	memcpy(state, moved, sizeof moved);
}

static void the_store_is_a_table(void **state)
{
	(void)state;
	static table all;
	struct random_state random = random_seed(SEED);
	print_message("seed %d\n", SEED);
	for (int images = 0; images <= 3; images++) {
		struct pairs pairs;
		memset(all, 0, sizeof all);
		assert_true(pairs_create(&pairs, PARTICLES));
		for (int step = 0; step < 3000; step++) {
			set(&pairs, all, &random, images);
			if (step % 7 == 0) shift(&pairs, all, &random);
			if (step % 100 == 0) assert_same(&pairs, all);
		}
		assert_same(&pairs, all);
		pairs_destroy(&pairs);
	}
}

/* What is let go is used again: memory follows the most that was held at once, not the number of changes. */
static void memory_is_used_again(void **state)
{
	(void)state;
	struct pairs pairs;
	struct random_state random = random_seed(SEED);
	assert_true(pairs_create(&pairs, 1000));
	size_t most = 0;
	for (int round = 0; round < 50; round++) {
		for (int k = 0; k < 20000; k++) {
			uint32_t i = (uint32_t)random_below(&random, 1000), j = (uint32_t)random_below(&random, 1000);
			if (i != j) assert_true(pairs_set(&pairs, i, j, 1 + (uint32_t)random_below(&random, 5)));
		}
		if (round == 0) most = pairs_memory(&pairs);
		for (uint32_t i = 0; i < 1000; i++)
			for (uint32_t count; pairs_of(&pairs, i, &count), count;)
				assert_true(pairs_set(&pairs, i, pairs_of(&pairs, i, &count)[0].entry, 0));
		assert_int_equal(pairs.count, 0);
	}
	print_message("%zu bytes for 20 000 pairs, %zu after 10^6 changes\n", most, pairs_memory(&pairs));
	assert_true(most < 100 * 20000);
	assert_true(pairs_memory(&pairs) < 3 * most / 2);
	pairs_destroy(&pairs);
}

int main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(the_store_is_a_table),
		cmocka_unit_test(memory_is_used_again),
	};
	return cmocka_run_group_tests(tests, NULL, NULL);
}
