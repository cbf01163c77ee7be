/* positional: a pair's state is what its separation says each time the pair is tested.
 *
 * Source: Alder and Wainwright 1959, as the 2016 paper tells it (sections 2 and 5): the separation computed when a pair
 * is tested for its next event (step 1) is stored, and says which event is executed then (step 4). What is done with a
 * pair that stands at a step, as every pair does that has just had an event, they do not say.
 * Built here: whenever one of two particles has had an event, the pair's state becomes the number of steps with
 *
 *     r.r < d^2
 *
 * in the working arithmetic, r being the relative position that the finders are asked with; at a step a pair is
 * outside. The finders are those of `stable`, so that the reading is all that differs from it.
 *
 * What goes wrong: rounding leaves half of all pairs on the wrong side of the step they have just passed. They pass it
 * once more, and receive its energy once more; where time cannot advance by so little, for ever. Witness (binary64):
 * square-shoulder with 500 particles in the absolute form, from its lattice: stuck on releases of one pair from event
 * 43 on (verify/test/states_test.c, positional_is_stuck; `reproduce states` has the command). */

static void out_of_memory(struct touchstone_engine *engine);

/* Reads the state of particle i with one entry again. */
static void read_again(struct touchstone_engine *engine, uint32_t i, uint32_t entry)
{
	const struct potential *potential = potential_between(engine, i, entry_particle(entry));
	if (!potential || !potential->step_count) return;
	struct balls balls;
	relative_state(engine, i, entry, balls.r, balls.v);
	skip_least_time(engine, i, entry, &balls);
	uint32_t read = state_at(potential, dot(balls.r, balls.r)), before = pairs_get(&engine->pairs, i, entry);
	if (read != before && !set_state(engine, potential, i, entry, before, read)) out_of_memory(engine);
}

/* The same with all that may be near it, and with all that was thought to be. */
static void read_all_again(struct touchstone_engine *engine, uint32_t i, const uint32_t *candidate, size_t candidates)
{
	uint32_t left, count;
	for (size_t k = 0; k < candidates; k++) read_again(engine, i, candidate[k]);
	for (pairs_of(&engine->pairs, i, &left); left > 0; left--) /* from the last, whose place a forgotten one gets */
		read_again(engine, i, pairs_of(&engine->pairs, i, &count)[left - 1].entry);
}
