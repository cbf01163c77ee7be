/* Neighbour lists: which particles they take, by every machine, and that an engine with them runs as one without. */
#include "step_scenes.h"

#include "engine/bands.h"
#include "engine/cells.h"

static bool brief; /* under sanitizers, where everything takes ten times longer */

/* ------------------------------------------------------------------ bands */

enum { ANCHORS = 100 };

/* What every machine lists is what one finds by hand, and whoever of two asks finds the same. */
static void bands_are_the_same_from_both_ends(void **state)
{
	(void)state;
	struct random_state random = random_seed(SEED);
	print_message("seed %d\n", SEED);
	uint64_t listed = 0, anew = 0, lists = 0;
	for (int trial = 0; trial < 300; trial++) {
		struct anchor anchor[ANCHORS];
		struct bands bands = {0};
		const float box[3] = {4, 5, 6};
		double limit[6];
		for (int b = 0; b < 3; b++) {
			limit[2 * b] = 3 * random_uniform(&random), limit[2 * b + 1] = limit[2 * b] + random_uniform(&random);
			bands_add(&bands, limit[2 * b], limit[2 * b + 1]);
		}
		for (int i = 0; i < ANCHORS; i++)
			for (int axis = 0; axis < 3; axis++)
				anchor[i].at[axis] = (float)((random_uniform(&random) - 0.5) * box[axis]);
		float from[3] = {anchor[0].at[0] + 0.1f, anchor[0].at[1], anchor[0].at[2]}, nowhere[3] = {NAN, NAN, NAN};
		uint32_t entry[ANCHORS + 16] = {0}, found[ANCHORS + 16], back[32], count = 0;
		for (uint32_t i = 1; i < ANCHORS; i++) {
			entry[count] = i;
			for (int axis = 0; axis < 3; axis++)
				entry[count] = entry_shifted(entry[count], axis, (int)random_below(&random, 3) - 1);
			count++;
		}
		bands_lister *lister;
		for (size_t machine = 0; (lister = bands_machine(machine)); machine++, lists++) {
			size_t all = lister(&bands, anchor, box, nowhere, anchor[0].at, entry, count, found), at = 0, fresh = 0;
			for (uint32_t k = 0; k < count; k++) {
				const float *other = anchor[entry_particle(entry[k])].at;
				uint32_t mirrored[17] = {entry_mirrored(entry[k], 0)};
				double square = 0;
				for (int axis = 0; axis < 3; axis++) {
					double shift = entry_image(entry[k], axis) * (double)box[axis];
					square += pow(anchor[0].at[axis] - (double)other[axis] - shift, 2);
				}
				bool there = at < all && found[at] == entry[k], within = false, doubtful = false;
				at += there;
				for (int b = 0; b < 6; b++) doubtful |= fabs(sqrt(square) - limit[b]) < 1e-5;
				for (int b = 0; b < 6; b += 2) within |= sqrt(square) >= limit[b] && sqrt(square) <= limit[b + 1];
				assert_true(doubtful || there == within);
				assert_int_equal(lister(&bands, anchor, box, nowhere, other, mirrored, 1, back), there);
				listed += there;
			}
			assert_int_equal(at, all);
			fresh = lister(&bands, anchor, box, from, anchor[0].at, entry, count, found);
			assert_true(fresh <= all);
			anew += fresh;
		}
	}
	assert_true(3 * listed > 5 * lists && anew > 0 && anew < listed / 2);
}

/* Too many bands become fewer, none of which is lost. */
static void bands_cover_what_was_added(void **state)
{
	(void)state;
	struct bands bands = {0};
	for (int b = 0; b < 3 * MOST_BANDS; b++) {
		bands_add(&bands, b + 0.25, b + 0.5);
		assert_true(bands.count <= MOST_BANDS);
		for (int a = 0; a <= b; a++) {
			bool covered = false;
			for (int k = 0; k < bands.count; k++)
				covered |= bands.low[k] <= (float)pow(a + 0.25, 2) && bands.high[k] >= (float)pow(a + 0.5, 2);
			assert_true(covered);
		}
	}
}

/* ------------------------------------------------------------------ engines */

static void look_for_lists(void *context, const char *text)
{
	if (strncmp(text, "neighbour lists:", strlen("neighbour lists:")) == 0) *(bool *)context = true;
}

/* A liquid of any kind, without what keeps an engine from having lists. */
static struct scene_recipe draw_liquid(struct drawn *drawn, struct random_state *random)
{
	int dimensions = 1 + (int)random_below(random, 3);
	size_t counts[] = {30, 100, 250};
	struct scene_recipe recipe = gas(dimensions, counts[dimensions - 1], 0.5 + 0.3 * random_uniform(random));
	recipe.form = random_below(random, 2) ? TOUCHSTONE_ABSOLUTE : TOUCHSTONE_RELATIVE;
	if (random_below(random, 3) == 0) recipe.boundary[0] = SCENE_WALLS;
	if (random_below(random, 3) == 0) recipe.species_count = 2, recipe.species = two_sizes, recipe.density *= 0.6;
	draw(drawn, &recipe, random);
	recipe.virtual_wall_count = 0;
	return recipe;
}

static void lists_do_not_matter(void **state)
{
	(void)state;
	static const char *const methods[] = {"stable", "compensated"}, *const arithmetics[] = {"binary64", "binary32"};
	struct random_state random = random_seed(SEED);
	int with_lists = 0, trials = brief ? 8 : 40;
	for (int trial = 0; trial < trials; trial++) {
		struct drawn drawn;
		struct scene_recipe recipe = draw_liquid(&drawn, &random);
		const char *arithmetic = arithmetics[trial % 5 == 4], *method = methods[trial % 3 == 2];
		struct touchstone_status by[2];
		for (int unsieved = 0; unsieved < 2; unsieved++) {
			bool lists = false;
			recipe.search = unsieved ? TOUCHSTONE_UNSIEVED : TOUCHSTONE_CELLS;
			struct run run = begin(&recipe, arithmetic, method);
			touchstone_explain(run.engine, look_for_lists, &lists);
			assert_false(unsieved && lists);
			with_lists += lists;
			by[unsieved] = advance(&run, brief ? 500 : 10000);
			end(&run);
		}
		if (by[0].digest != by[1].digest || by[0].captured != by[1].captured)
			fail_msg(
				"trial %d (%d dimensions, %s, %s): %016llx after %llu events with lists, %016llx after %llu without",
				trial, recipe.dimensions, arithmetic, method, (unsigned long long)by[0].digest,
				(unsigned long long)by[0].events, (unsigned long long)by[1].digest, (unsigned long long)by[1].events);
	}
	print_message("%d of %d engines had lists\n", with_lists, trials);
	assert_true(with_lists > trials / 4);
}

int main(void)
{
	brief = getenv("TOUCHSTONE_BRIEF");
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(bands_are_the_same_from_both_ends),
		cmocka_unit_test(bands_cover_what_was_added),
		cmocka_unit_test(lists_do_not_matter),
	};
	return cmocka_run_group_tests(tests, NULL, NULL);
}
