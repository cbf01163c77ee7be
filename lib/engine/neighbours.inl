/* Neighbour lists (Verlet 1967, Phys. Rev. 159, 98), for particles that have many others within a step of their
 * potential. Most of those are far from every distance at which something may happen to them, and stay so for a while.
 *
 * Every particle has an anchor: where it was when its list was made. Pairs whose anchors are no farther than a skin
 * from such a distance are listed, by both of their particles, and after an event only they are asked. A particle that
 * has gone about half a skin from its anchor gets another one: this takes the place of its passage from cell to cell,
 * and cells hold anchors. A pair that is not listed is farther from every step than the cells' slack, on the side that
 * its state says, so that nothing can happen to it. This needs a method whose states and distances agree up to
 * rounding. */

/* What a list holds: pairs near contact, and those near a step. */
static void set_bands(const struct touchstone_engine *engine, double skin, struct bands *bands)
{
	bands->count = 0;
	for (size_t a = 0; a < engine->species_count; a++)
		for (size_t b = 0; b <= a; b++) {
			num first;
			const struct potential *potential = potential_of(engine, a, b);
			species_meeting(engine, a, b, &first);
			double core = to_double(potential ? potential->core : first);
			if (core > 0) bands_add(bands, 0, core + skin);
			for (uint32_t s = 0; potential && s < potential->step_count; s++) {
				double distance = to_double(potential->step[s].distance);
				bands_add(bands, fmax(distance - skin, 0), distance + skin);
			}
		}
}

/* How many neighbours a list has where particles stand at random. */
static double listed(const struct touchstone_engine *engine, const struct bands *bands)
{
	static const double ball[] = {2, 3.14159, 4.18879}; /* of radius 1, in 1, 2 and 3 dimensions */
	double volume = 1, covered = 0;
	int dimensions = engine->dimensions;
	for (int axis = 0; axis < dimensions; axis++) volume *= engine->box[axis];
	for (int b = 0; b < bands->count; b++)
		covered += pow(bands->high[b], dimensions / 2.0) - pow(bands->low[b], dimensions / 2.0);
	return covered * ball[dimensions - 1] * engine->count / volume;
}

/* Chooses the skin, or none where lists would not pay. Found by trial, with 13 500 particles, by user time per event:
 * lists of 16 to 28 cost the same; where 1.4 partners stand within the outermost step lists cost more than cells, where
 * 7 do they cost half. Sides of virtual walls are told for particles in the box, which one away from its anchor may not
 * be. */
static void choose_skin(struct touchstone_engine *engine)
{
	static const double members = 20, fewest = 4;
	struct neighbours *neighbours = &engine->neighbours;
	bool exact = engine->method->sieve == SIEVE_ORDER && engine->method->policy == 0;
	neighbours->skin = 0;
	if (!engine->captured || !engine->shadows.shadow || !exact || engine->side) return;
	struct bands bands = {.count = 1, .high = {(float)(engine->reach * engine->reach)}};
	if (listed(engine, &bands) < fewest) return;
	double thin = 0, thick = engine->reach, rounding = engine->slack;
	for (int axis = 0; axis < engine->dimensions; axis++) {
		if (engine->periodic[axis]) thick = fmin(thick, engine->box[axis] - engine->reach - 2 * engine->slack);
		rounding += 0x1p-20 * engine->box[axis];
	}
	for (int step = 0; step < 20; step++) {
		double skin = (thin + thick) / 2;
		set_bands(engine, skin, &bands);
		*(listed(engine, &bands) < members ? &thin : &thick) = skin;
	}
	if (thin < 16 * rounding) return;
	neighbours->skin = thin;
	neighbours->free = thin / 2 - rounding;
	set_bands(engine, thin, &neighbours->bands);
}

/* How long after its last event a particle has gone so far from its anchor that it needs another. */
static double anchor_wait(const struct touchstone_engine *engine, uint32_t i)
{
	const float *anchor = engine->neighbours.anchor[i].at;
	double free = engine->neighbours.free, a = 0, b = 0, c = -free * free;
	for (int axis = 0; axis < engine->dimensions; axis++) {
		double velocity = to_double(engine->body[i].velocity[axis]);
		double offset = coordinate_in_image(engine, i, axis) - anchor[axis];
		a += velocity * velocity, b += offset * velocity, c += offset * offset;
	}
	if (!(a > 0)) return INFINITY;
	double end = sqrt(fmax(b * b - a * c, 0));
	return fmax(b > 0 ? -c / (end + b) : (end - b) / a, 0);
}

/* Whether a flight from its last event leaves a particle near its anchor. */
static inline bool leaves_anchor(const struct touchstone_engine *engine, uint32_t i, double flight)
{
	const float *anchor = engine->neighbours.anchor[i].at;
	double square = 0;
	for (int axis = 0; axis < engine->dimensions; axis++) {
		double path = to_double(engine->body[i].velocity[axis]) * flight;
		double offset = coordinate_in_image(engine, i, axis) + path - anchor[axis];
		square += offset * offset;
	}
	return !(square < engine->neighbours.free * engine->neighbours.free);
}

/* Of `count` entries, those that are near the anchor `to` and were not near the anchor `from`. */
static size_t newly_near(const struct touchstone_engine *engine, const float from[3], const float to[3],
						 const uint32_t *entry, size_t count, uint32_t *found)
{
	const struct neighbours *neighbours = &engine->neighbours;
	float box[3];
	for (int axis = 0; axis < 3; axis++) box[axis] = (float)(axis < engine->dimensions ? engine->box[axis] : 0);
	return neighbours->lister(&neighbours->bands, neighbours->anchor, box, from, to, entry, count, found);
}

static const float nowhere[3] = {NAN, NAN, NAN};

static bool enlist(struct touchstone_engine *engine, uint32_t i, uint32_t entry, uint32_t state)
{
	return pairs_add(&engine->neighbours.pairs, i, entry, 1 + state);
}

/* The state of a pair that was not listed while particle i had its anchor at `from`: what the distance of the anchors
 * says, which is near no step. */
static uint32_t unlisted_state(const struct touchstone_engine *engine, uint32_t i, const float from[3], uint32_t entry)
{
	uint32_t j = entry_particle(entry), state = 0;
	const float *other = engine->neighbours.anchor[j].at;
	const struct potential *potential = potential_between(engine, i, j);
	double square = 0;
	if (!potential || isnan(from[0])) return pairs_get(&engine->pairs, i, entry);
	for (int axis = 0; axis < engine->dimensions; axis++) {
		double offset = (double)from[axis] - other[axis] - entry_image(entry, axis) * engine->box[axis];
		square += offset * offset;
	}
	while (state < potential->step_count && square < pow(to_double(potential->step[state].distance), 2)) state++;
	return state;
}

/* Takes out of the list of particle i, which had its anchor at `from`, all that are not near `to`. */
static bool unlist(struct touchstone_engine *engine, uint32_t i, const float from[3], const float to[3])
{
	struct pairs *pairs = &engine->neighbours.pairs;
	uint32_t count, *entry = engine->candidate[0], *gone = engine->candidate[1];
	const struct pair_state *list = pairs_of(pairs, i, &count);
	for (uint32_t k = 0; k < count; k++) entry[k] = list[k].entry;
	for (uint32_t k = 0; k < 16; k++) entry[count + k] = 0;
	size_t going = newly_near(engine, to, from, entry, count, gone);
	bool enough = true;
	for (size_t k = 0; k < going; k++) enough &= pairs_set(pairs, i, gone[k], 0);
	return enough;
}

/* Moves the anchor of particle i, whose cell is that of the new one; writes to candidate[1] who has been listed anew,
 * and how many. False when memory ran out. */
static bool move_anchor(struct touchstone_engine *engine, uint32_t i, const float from[3], const float to[3],
						size_t *fresh)
{
	uint32_t *candidate = engine->candidate[0], *found = engine->candidate[1];
	size_t candidates = cells_around(&engine->cells, engine->itinerary[i].cell, i, candidate);
	bool enough = true;
	*fresh = newly_near(engine, from, to, candidate, candidates, found);
	for (size_t k = 0; k < *fresh; k++)
		enough &= enlist(engine, i, found[k], unlisted_state(engine, i, from, found[k]));
	memcpy(engine->neighbours.anchor[i].at, to, 3 * sizeof *to);
	return enough;
}

static size_t neighbours_memory(const struct touchstone_engine *engine)
{
	const struct neighbours *neighbours = &engine->neighbours;
	return pairs_memory(&neighbours->pairs) + (neighbours->anchor ? engine->count * sizeof *neighbours->anchor : 0);
}

static double coordinate_now(const struct touchstone_engine *engine, uint32_t i, int axis);

/* Forgets all lists: particles may be shifted to other images, and are put into cells. */
static void forget_neighbours(struct touchstone_engine *engine)
{
	pairs_destroy(&engine->neighbours.pairs);
}

/* Makes all lists anew, from where particles are now. */
static bool list_neighbours(struct touchstone_engine *engine)
{
	struct neighbours *neighbours = &engine->neighbours;
	if (neighbours->skin == 0) return true;
	neighbours->lister = bands_machine(0);
	if (!neighbours->anchor) neighbours->anchor = calloc(engine->count, sizeof *neighbours->anchor);
	bool enough = pairs_create(&neighbours->pairs, engine->count) && neighbours->anchor;
	for (uint32_t i = 0; enough && i < engine->count; i++)
		for (int axis = 0; axis < engine->dimensions; axis++)
			neighbours->anchor[i].at[axis] = (float)coordinate_now(engine, i, axis);
	for (uint32_t i = 0; enough && i < engine->count; i++) {
		uint32_t *candidate = engine->candidate[0], *found = engine->candidate[1];
		size_t candidates = cells_around(&engine->cells, engine->itinerary[i].cell, i, candidate);
		size_t near = newly_near(engine, nowhere, neighbours->anchor[i].at, candidate, candidates, found);
		for (size_t k = 0; k < near; k++)
			if (entry_particle(found[k]) < i)
				enough &= enlist(engine, i, found[k], pairs_get(&engine->pairs, i, found[k]));
	}
	return enough;
}
