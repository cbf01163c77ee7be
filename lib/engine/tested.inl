/* What a listener is told: the pairs that a search after an event asks about. The sieve does not come into it, since it
 * leaves out pairs that part, whatever state they are in; but shadows do: those of which they say surely that they are
 * where their state has them, and not near a step, are counted and not worked out. */

/* Tells of one pair, if it counts and the listener wants to know. */
static void tell_test(struct touchstone_engine *engine, uint32_t i, uint32_t entry, uint32_t state)
{
	struct touchstone_listener *listener = engine->listener;
	uint32_t j = entry_particle(entry), nearest = 0;
	const struct potential *potential = potential_between(engine, i, j);
	if (!potential || !potential->step_count) return;
	struct balls balls;
	relative_state(engine, i, entry, balls.r, balls.v);
	num square = dot(balls.r, balls.r);
	double farthest = to_double(potential->step[0].distance) * listener->reach, excess = INFINITY;
	if (state == 0 && to_double(square) > farthest * farthest) return;
	listener->tests++;
	for (uint32_t s = 0; s < potential->step_count; s++) {
		num limit = mul(potential->step[s].distance, potential->step[s].distance);
		double beyond = to_double(divide(sub(square, limit), limit));
		if (fabs(beyond) < fabs(excess)) excess = beyond, nearest = s;
	}
	uint32_t within = state_at(potential, square), first = engine->itinerary[i].id, second = engine->itinerary[j].id;
	if (fabs(excess) > listener->margin && within == state) return;
	for (int axis = 0; first > second && axis < engine->dimensions; axis++) balls.r[axis] = negated(balls.r[axis]);
	struct touchstone_test test = {
		.first = first < second ? first : second,
		.second = first < second ? second : first,
		.state = (int)state,
		.within = (int)within,
		.step = (int)nearest,
		.excess = excess,
	};
	engine->tested_offset = balls.r;
	engine->touching_distance = potential->step[nearest].distance;
	listener->tested(listener->context, engine, &test);
	engine->tested_offset = NULL;
}

/* The state of particle i and an entry, where partners it has captured are marked. */
static inline uint32_t marked_state(const struct touchstone_engine *engine, uint32_t i, uint32_t entry,
									const struct pair_state *captured)
{
	uint16_t mark = engine->captured[entry_particle(entry)];
	if (!mark) return 0;
	return captured[mark - 1].entry == entry ? captured[mark - 1].state : pairs_get(&engine->pairs, i, entry);
}

/* Up to HELD entries of particle i, each with its state and the distances between which there is nothing to tell. */
struct tests {
	uint32_t count, entry[HELD + 16], state[HELD];
	float inner[HELD + 16], outer[HELD + 16];
};

static inline void add_test(const struct touchstone_engine *engine, uint32_t i, uint32_t entry, uint32_t state,
							struct tests *tests)
{
	const struct touchstone_listener *listener = engine->listener;
	const struct potential *potential = potential_between(engine, i, entry_particle(entry));
	if (!potential || !potential->step_count) return;
	double unit = engine->shadows.per_length, farther = state ? 1 + listener->margin : listener->reach;
	uint32_t k = tests->count++;
	tests->entry[k] = entry;
	tests->state[k] = state;
	tests->inner[k] = 0;
	tests->outer[k] = INFINITY;
	if (state < potential->step_count)
		tests->inner[k] = (float)(to_double(potential->step[state].distance) * farther * unit);
	if (state)
		tests->outer[k] =
			(float)(to_double(potential->step[state - 1].distance) * fmax(0, 1 - listener->margin) * unit);
}

/* Of these, tells what there is to tell. */
static void tell_some(struct touchstone_engine *engine, uint32_t i, struct tests *tests)
{
	struct shadows *shadows = &engine->shadows;
	uint32_t kept[HELD + 16], count = tests->count, at = 0;
	size_t left = count;
	for (uint32_t k = 0; k < count; k++) kept[k] = k;
	if (shadows->shadow) {
		for (uint32_t k = count; k < count + 16; k++) tests->entry[k] = i, tests->inner[k] = tests->outer[k] = 1;
		struct held held = {tests->entry, tests->outer, tests->inner};
		shadows->sieve.images = cells_at_border(&engine->cells, engine->itinerary[i].cell);
		left = shadows->machine->check(&shadows->sieve, shadows->shadow, i, &held, count, kept);
	}
	for (size_t k = 0; k < left; k++) tell_test(engine, i, tests->entry[kept[k]], tests->state[kept[k]]);
	for (uint32_t k = 0; k < count; k++) {
		bool told = at < left && kept[at] == k;
		at += told;
		engine->listener->tests += !told && tests->state[k];
	}
	tests->count = 0;
}

/* Tells of all that the particles of an event may meet next: each pair once. */
static void tell_tests(struct touchstone_engine *engine, const uint32_t *particle, uint32_t *const list[2],
					   const size_t candidates[2], int particles)
{
	struct tests tests = {.count = 0};
	for (int p = 0; p < particles; p++) {
		uint32_t i = particle[p], count;
		const struct pair_state *captured = pairs_of(&engine->pairs, i, &count);
		for (uint32_t k = 0; k < count; k++) engine->captured[entry_particle(captured[k].entry)] = (uint16_t)(k + 1);
		for (size_t k = 0; k < candidates[p]; k++) {
			uint32_t entry = list[p][k];
			if (p == 1 && entry_particle(entry) == particle[0]) continue;
			add_test(engine, i, entry, marked_state(engine, i, entry, captured), &tests);
			if (tests.count == HELD) tell_some(engine, i, &tests);
		}
		tell_some(engine, i, &tests);
		for (uint32_t k = 0; k < count; k++) engine->captured[entry_particle(captured[k].entry)] = 0;
	}
}

/* The offset at hand as exact sums of doubles, filled with zeros; returns how many there are per axis. */
static int tested_terms(const struct touchstone_engine *engine, double terms[3][3 * TOUCHSTONE_MOST_TERMS])
{
	int most = 0, count[3] = {0};
	for (int axis = 0; axis < engine->dimensions; axis++) {
		count[axis] = expand(engine->tested_offset[axis], terms[axis], TOUCHSTONE_MOST_TERMS);
		if (count[axis] > most) most = count[axis];
	}
	for (int axis = 0; axis < 3; axis++)
		for (int term = count[axis]; term < most; term++) terms[axis][term] = 0;
	return most;
}
