/* Entries of a cell and its neighbours, listed by every machine as by going through them one by one. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <stdlib.h>

#include "engine/cells.h"
#include "scene/random.h"

static const uint64_t seed = 1967;

enum { GRIDS = 300, MOST = 27 * 64 };

/* A grid with particles in it, of which some have left again. */
static void fill(struct cells *cells, struct random_state *random)
{
	int dimensions = 1 + (int)random_below(random, 3), count[3] = {1, 1, 1};
	bool periodic[3] = {false, false, false};
	for (int axis = 0; axis < dimensions; axis++) {
		count[axis] = 1 + (int)random_below(random, 6);
		periodic[axis] = random_below(random, 2);
	}
	static const uint32_t capacities[] = {4, 8, 12, 16, 32, 64};
	uint32_t capacity = capacities[random_below(random, 6)],
			 room = (uint32_t)(count[0] * count[1] * count[2]) * capacity;
	assert_true(cells_create(cells, dimensions, periodic, count, capacity));
	for (uint32_t p = 0; p < room / 2; p++) {
		uint16_t cell[3] = {0, 0, 0};
		for (int axis = 0; axis < dimensions; axis++)
			cell[axis] = (uint16_t)(1 + random_below(random, (uint64_t)count[axis]));
		bool entered = cells_insert(cells, cell, p);
		if (!entered || random_below(random, 3) == 0) cells_remove(cells, cell, p);
	}
}

static size_t one_by_one(const struct cells *cells, const uint32_t *centre, uint32_t self, uint32_t *list)
{
	size_t found = 0;
	for (int row = 0; row < cells->rows; row++)
		for (size_t i = 0; i < 3 * cells->capacity; i++) {
			uint32_t entry = centre[cells->row[row] + (ptrdiff_t)i];
			if (entry != entry_none && entry != self) list[found++] = entry;
		}
	return found;
}

static void every_machine_lists_the_same(void **state)
{
	(void)state;
	struct random_state random = random_seed(seed);
	static uint32_t expected[MOST], list[MOST + 32];
	size_t listed = 0, machines = 0, gapless = 0;
	for (int k = 0; k < GRIDS; k++) {
		struct cells cells;
		uint16_t cell[3] = {0, 0, 0};
		fill(&cells, &random);
		for (int axis = 0; axis < cells.dimensions; axis++)
			cell[axis] = (uint16_t)(1 + random_below(&random, (uint64_t)cells.count[axis]));
		const uint32_t *centre = cells.entry + cells_index(&cells, cell);
		uint32_t self = random_below(&random, 2) ? *centre : 0;
		size_t count = one_by_one(&cells, centre, self, expected);
		for (machines = 0; (cells.list_rows = cells_machine(cells.gapless, machines)); machines++) {
			for (size_t i = 0; i < MOST + 32; i++) list[i] = 12345;
			assert_int_equal(cells_around(&cells, cell, self, list), count);
			assert_memory_equal(list, expected, count * sizeof *list);
			for (size_t i = 0; i < 16; i++) assert_int_equal(list[count + i], 0);
		}
		listed += count;
		gapless += cells.gapless;
		cells_destroy(&cells);
	}
	print_message("seed %d: %zu entries listed by %zu machines\n", (int)seed, listed, machines);
	assert_true(machines > 0 && listed > 10 * GRIDS && gapless > 0 && gapless < GRIDS);
}

int main(void)
{
	const struct CMUnitTest tests[] = {cmocka_unit_test(every_machine_lists_the_same)};
	return cmocka_run_group_tests(tests, NULL, NULL);
}
