/* What two particles are to each other: hard bodies, or steps of a potential around a core (2016 paper, fig. 1). */

/* The potential between two species; NULL for hard bodies. */
static inline const struct potential *potential_of(const struct touchstone_engine *engine, size_t a, size_t b)
{
	if (!engine->potential_of) return NULL;
	uint32_t number = engine->potential_of[a * engine->species_count + b];
	return number < engine->potential_count ? &engine->potential[number] : NULL;
}

static inline const struct potential *potential_between(const struct touchstone_engine *engine, uint32_t i, uint32_t j)
{
	if (engine->species_count == 1) return engine->potential;
	return potential_of(engine, engine->place[i].species, engine->place[j].species);
}

/* What happens first to particles of two species that come from afar, and at which distance. */
static uint8_t species_meeting(const struct touchstone_engine *engine, size_t a, size_t b, num *distance)
{
	const struct potential *potential = potential_of(engine, a, b);
	if (!potential) {
		*distance = add(engine->radius[a], engine->radius[b]);
		return TOUCHSTONE_CONTACT;
	}
	*distance = potential->step_count ? potential->step[0].distance : potential->core;
	return potential->step_count ? TOUCHSTONE_CAPTURE : potential->hard ? TOUCHSTONE_CONTACT : MEETS_NOTHING;
}

static inline uint8_t first_meeting(const struct touchstone_engine *engine, uint32_t i, uint32_t j, num *distance)
{
	*distance = engine->outermost;
	if (engine->species_count == 1) return engine->outermost_kind;
	return species_meeting(engine, engine->place[i].species, engine->place[j].species, distance);
}

/* The number in the shadows' table of the distances between which a pair in some state is. */
static inline size_t limits_number(const struct touchstone_engine *engine, uint32_t i, uint32_t j, uint32_t state)
{
	const struct potential *potential = potential_between(engine, i, j);
	if (potential) return potential->limits + state;
	return engine->shadows.hard_limits + engine->place[i].species * engine->species_count + engine->place[j].species;
}

/* Distance at which two hard bodies, or two cores, are in contact. */
static num contact_distance(const struct touchstone_engine *engine, uint32_t i, uint32_t j)
{
	const struct potential *potential = potential_between(engine, i, j);
	if (potential) return potential->core;
	return add(engine->radius[engine->place[i].species], engine->radius[engine->place[j].species]);
}

static struct touchstone_restitution restitution_between(const struct touchstone_engine *engine, uint32_t i, uint32_t j)
{
	const struct potential *potential = potential_between(engine, i, j);
	return potential ? potential->restitution : engine->restitution;
}

/* Whether a pair with (r.v)^2 = rv^2 and r.r = rr passes a step of this climb. */
static inline bool climbs(num climb, num rr, num rv)
{
	return !less(from_double(0), climb) || less(mul(climb, rr), mul(rv, rv));
}

/* The potential energy of all pairs together, by their tracked states. */
static double potential_energy(const struct touchstone_engine *engine)
{
	double sum = 0;
	for (size_t p = 0; p < engine->potential_count; p++)
		for (uint32_t s = 0; s < engine->potential[p].step_count; s++)
			sum += engine->potential[p].step[s].energy * (double)engine->potential[p].step[s].pairs;
	return sum;
}

/* State of particle i and an entry with which it has an event. */
static inline uint32_t state_of(const struct touchstone_engine *engine, uint32_t i, uint32_t entry)
{
	const struct neighbours *neighbours = &engine->neighbours;
	if (neighbours->pairs.bucket) return pairs_get(&neighbours->pairs, i, entry) - 1; /* a shorter list */
	return engine->pairs.bucket ? pairs_get(&engine->pairs, i, entry) : 0;
}

/* Gives a pair that has the potential `potential` another state, and counts it there. */
static bool set_state(struct touchstone_engine *engine, const struct potential *potential, uint32_t i, uint32_t entry,
					  uint32_t before, uint32_t after)
{
	if (before) potential->step[before - 1].pairs--;
	if (after) potential->step[after - 1].pairs++;
	bool enough = before ? pairs_set(&engine->pairs, i, entry, after) : pairs_add(&engine->pairs, i, entry, after);
	if (engine->neighbours.pairs.bucket) enough &= pairs_set(&engine->neighbours.pairs, i, entry, 1 + after);
	return enough;
}

/* The state that a pair's distance speaks for, its square being given: at a step the pair is outside it. */
static uint32_t state_at(const struct potential *potential, num square)
{
	uint32_t state = 0;
	for (; state < potential->step_count; state++) {
		num distance = potential->step[state].distance;
		if (!less(square, mul(distance, distance))) break;
	}
	return state;
}

/* Reads every pair's state from the positions: once, before the first event (2016 paper, section 2). */
static bool read_states(struct touchstone_engine *engine)
{
	bool enough = true;
	for (uint32_t i = 0; enough && engine->pairs.bucket && i < engine->count; i++) {
		uint32_t *list = engine->candidate[0];
		size_t candidates = engine->count > 1 ? cells_around(&engine->cells, engine->itinerary[i].cell, i, list) : 0;
		for (size_t k = 0; k < candidates; k++) {
			uint32_t j = entry_particle(list[k]);
			const struct potential *potential = potential_between(engine, i, j);
			if (j >= i || !potential) continue;
			num r[3], v[3];
			relative_state(engine, i, list[k], r, v);
			uint32_t state = state_at(potential, dot(r, r));
			if (state) enough &= set_state(engine, potential, i, list[k], 0, state);
		}
	}
	return enough;
}

/* From here on a particle is counted one box farther along an axis (by 1 or -1), and so are its captured partners'
 * images and the images of virtual walls between which it is. */
static void shift_image(struct touchstone_engine *engine, uint32_t i, int axis, int by)
{
	engine->place[i].index[axis] += by * engine->places[axis];
	if (engine->pairs.bucket) pairs_shift(&engine->pairs, i, axis, by);
	for (size_t w = 0; engine->side && w < engine->virtual_wall_count; w++)
		if (engine->virtual_wall[w].axis == axis)
			engine->side[i * engine->virtual_wall_count + w] += by * engine->virtual_wall[w].along;
}
