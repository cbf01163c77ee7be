/* What an observer of tests is told: the pairs that a search after an event asks about. The sieve does not come into
 * it, since it leaves out pairs that part, whatever state they are in. */

/* Whether an entry may be within the observer's reach, by its shadow, which is off by far less than the margin.
 * Particle i's own shadow is as of now. */
static bool may_be_near(const struct touchstone_engine *engine, uint32_t i, uint32_t entry)
{
	const struct shadows *shadows = &engine->shadows;
	if (!shadows->shadow) return true;
	const struct shadow *mine = &shadows->shadow[i], *other = &shadows->shadow[entry_particle(entry)];
	float flight = mine->time - other->time, square = 0,
		  near = (float)(1.05 * engine->tested_reach * engine->reach * shadows->per_length);
	near += 0x1p-18f * shadows->sieve.boxes;
	for (int axis = 0; axis < 3; axis++) {
		float shift = (float)entry_image(entry, axis) * shadows->sieve.box[axis];
		float offset = mine->position[axis] - (other->position[axis] + shift + other->velocity[axis] * flight);
		square += offset * offset;
	}
	return !(square > near * near);
}

/* Tells of one pair, unless it is in the outermost state and beyond the observer's reach. */
static void tell_test(struct touchstone_engine *engine, uint32_t i, uint32_t entry)
{
	uint32_t j = entry_particle(entry), nearest = 0;
	const struct potential *potential = potential_between(engine, i, j);
	if (!potential || !potential->step_count) return;
	struct balls balls;
	relative_state(engine, i, entry, balls.r, balls.v);
	num square = dot(balls.r, balls.r);
	double excess = INFINITY;
	for (uint32_t s = 0; s < potential->step_count; s++) {
		num limit = mul(potential->step[s].distance, potential->step[s].distance);
		double beyond = to_double(divide(sub(square, limit), limit));
		if (fabs(beyond) < fabs(excess)) excess = beyond, nearest = s;
	}
	uint32_t state = pairs_get(&engine->pairs, i, entry), first = engine->itinerary[i].id;
	uint32_t second = engine->itinerary[j].id;
	double farthest = to_double(potential->step[0].distance) * engine->tested_reach;
	if (state == 0 && to_double(square) > farthest * farthest) return;
	for (int axis = 0; first > second && axis < engine->dimensions; axis++) balls.r[axis] = negated(balls.r[axis]);
	struct touchstone_test test = {
		.first = first < second ? first : second,
		.second = first < second ? second : first,
		.state = (int)state,
		.within = (int)state_at(potential, square),
		.step = (int)nearest,
		.excess = excess,
	};
	engine->tested_offset = balls.r;
	engine->touching_distance = potential->step[nearest].distance;
	engine->tested(engine->tested_context, engine, &test);
	engine->tested_offset = NULL;
}

/* Tells of all that the particles of an event may meet next: each pair once. */
static void tell_tests(struct touchstone_engine *engine, const uint32_t *particle, uint32_t *const list[2],
					   const size_t candidates[2], int particles)
{
	for (int p = 0; p < particles; p++) {
		uint32_t i = particle[p], captured;
		pairs_of(&engine->pairs, i, &captured);
		for (size_t k = 0; k < candidates[p]; k++) {
			uint32_t entry = list[p][k];
			if (p == 1 && entry_particle(entry) == particle[0]) continue;
			if (may_be_near(engine, i, entry) || (captured && pairs_get(&engine->pairs, i, entry)))
				tell_test(engine, i, entry);
		}
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
