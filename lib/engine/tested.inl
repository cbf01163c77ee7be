/* What a listener is told: the pairs that a search after an event asks about. For its sake the sieve lets all pass that
 * are near enough, also those that part. And of these, pairs whose shadows say surely that they are where their state
 * has them, and not near a step, are counted and not worked out. */

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

/* ------------------------------------------------------------------ what shadows say */

/* Whether all that particle i has captured is surely so near that it counts by its distance alone, as it will be unless
 * the method misses events. */
static bool keeps_captured(struct touchstone_engine *engine, uint32_t i)
{
	uint32_t kept[LOOKED_OVER + 16], count, some;
	const struct pair_state *captured = pairs_of(&engine->pairs, i, &count);
	struct bounds bounds;
	bool keeps = true;
	for (; count && keeps; captured += some, count -= some) {
		some = count < LOOKED_OVER ? count : LOOKED_OVER;
		for (uint32_t k = 0; k < some + 16; k++) {
			const struct potential *potential =
				potential_between(engine, i, entry_particle(captured[k < some ? k : 0].entry));
			double farthest = to_double(potential->step[0].distance) * engine->listener->reach;
			bounds.entry[k] = captured[k < some ? k : 0].entry;
			bounds.inner[k] = 0;
			bounds.outer[k] = (float)(farthest * engine->shadows.per_length);
		}
		keeps = !out_of_bounds(engine, i, bounds.entry, &bounds, some, kept);
	}
	return keeps;
}

/* Whether the sieve will let everything pass that is to be told of these particles, and has been told to. */
static bool sieve_listens(struct touchstone_engine *engine, const uint32_t *particle, int particles)
{
	if (!engine->shadows.shadow) return false;
	for (int p = 0; p < particles; p++)
		if (!keeps_captured(engine, particle[p])) return false;
	engine->shadows.sieve.heard = (float)(engine->listener->reach * (1 + 0x1p-20));
	return true;
}

/* ------------------------------------------------------------------ the tests after an event */

/* Some of those that particle i is tested against, and how many of them are in a state. */
struct tests {
	uint32_t count, captured, state[LOOKED_OVER];
	struct bounds bounds;
};

static inline void add_test(const struct touchstone_engine *engine, uint32_t i, uint32_t entry, uint32_t state,
							struct tests *tests)
{
	const struct potential *potential = potential_between(engine, i, entry_particle(entry));
	if (!potential || !potential->step_count) return;
	const struct step *step = potential->step + state;
	double margin = engine->listener->margin, unit = engine->shadows.per_length, inner = 0, outer = INFINITY;
	if (state < potential->step_count)
		inner = to_double(step->distance) * (state ? 1 + margin : engine->listener->reach) * unit;
	if (state) outer = margin < 1 ? to_double(step[-1].distance) * (1 - margin) * unit : 0;
	uint32_t k = tests->count++;
	tests->captured += state > 0;
	tests->state[k] = state;
	tests->bounds.entry[k] = entry;
	tests->bounds.inner[k] = (float)inner;
	tests->bounds.outer[k] = (float)outer;
}

/* Tells what there is to tell of them, and counts the others that are in a state. */
static void tell_some(struct touchstone_engine *engine, uint32_t i, struct tests *tests)
{
	uint32_t kept[LOOKED_OVER + 16], count = tests->count;
	size_t left = count;
	engine->listener->tests += tests->captured;
	tests->count = tests->captured = 0;
	if (!count) return;
	for (uint32_t k = count; k < count + 16; k++)
		tests->bounds.entry[k] = i, tests->bounds.inner[k] = tests->bounds.outer[k] = 1;
	if (engine->shadows.shadow)
		left = out_of_bounds(engine, i, tests->bounds.entry, &tests->bounds, count, kept);
	else
		for (uint32_t k = 0; k < count; k++) kept[k] = k;
	for (size_t at = 0; at < left; at++) {
		uint32_t k = kept[at], state = tests->state[k];
		engine->listener->tests -= state > 0; /* it counts itself */
		tell_test(engine, i, tests->bounds.entry[k], state);
	}
}

/* The state of particle i and an entry, while the partners it has captured are marked. */
static inline uint32_t marked_state(const struct touchstone_engine *engine, uint32_t i, uint32_t entry,
									const struct pair_state *captured)
{
	uint16_t mark = engine->captured[entry_particle(entry)];
	if (!mark) return 0;
	return captured[mark - 1].entry == entry ? captured[mark - 1].state : pairs_get(&engine->pairs, i, entry);
}

/* Tells of what particle i is tested against, but for another that has been told of. */
static void tell_tests_of(struct touchstone_engine *engine, uint32_t i, const uint32_t *list, size_t candidates,
						  uint32_t but)
{
	uint32_t count;
	const struct pair_state *captured = pairs_of(&engine->pairs, i, &count);
	struct tests tests;
	tests.count = tests.captured = 0;
	for (uint32_t k = 0; k < count; k++) engine->captured[entry_particle(captured[k].entry)] = (uint16_t)(k + 1);
	for (size_t k = 0; k < candidates; k++) {
		if (entry_particle(list[k]) == but) continue;
		add_test(engine, i, list[k], marked_state(engine, i, list[k], captured), &tests);
		if (tests.count == LOOKED_OVER) tell_some(engine, i, &tests);
	}
	tell_some(engine, i, &tests);
	for (uint32_t k = 0; k < count; k++) engine->captured[entry_particle(captured[k].entry)] = 0;
}

/* Tells of all that the particles of an event may meet next: each pair once. */
static void tell_tests(struct touchstone_engine *engine, const uint32_t *particle, uint32_t *const list[2],
					   const size_t candidates[2], int particles)
{
	tell_tests_of(engine, particle[0], list[0], candidates[0], particle[0]);
	if (particles > 1) tell_tests_of(engine, particle[1], list[1], candidates[1], particle[0]);
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
