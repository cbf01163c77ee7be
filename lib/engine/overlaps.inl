/* Which particles overlap, to the last sign. */

/* Where a particle is, at a moment that is known elsewhere. */
struct standing {
	struct body body;
	struct place place;
};

/* Writes a distance as an exact sum of doubles, filled with zeros. */
static void write_contact(num distance, double contact[TOUCHSTONE_MOST_TERMS])
{
	memset(contact, 0, TOUCHSTONE_MOST_TERMS * sizeof *contact);
	expand(distance, contact, TOUCHSTONE_MOST_TERMS);
}

/* Writes the position of `first`, seen from the image of `second` that is meant, as exact sums of doubles, filled with
 * zeros; returns how many there are per axis. */
static int separation_terms(const struct touchstone_engine *engine, const struct standing *first,
							const struct standing *second, const int image[3],
							double terms[3][3 * TOUCHSTONE_MOST_TERMS])
{
	int most = 0, count[3] = {0};
	for (int axis = 0; axis < engine->dimensions; axis++) {
		double *to = terms[axis];
		int32_t places = first->place.index[axis] - second->place.index[axis] - image[axis] * engine->places[axis];
		int own = expand(first->body.position[axis], to, TOUCHSTONE_MOST_TERMS);
		int other = expand(negated(second->body.position[axis]), to + own, TOUCHSTONE_MOST_TERMS);
		count[axis] = own + other;
		if (places) to[count[axis]++] = places * engine->place_width[axis];
		if (count[axis] > most) most = count[axis];
	}
	for (int axis = 0; axis < 3; axis++)
		for (int term = count[axis]; term < most; term++) terms[axis][term] = 0;
	return most;
}

/* Whether a particle may overlap one that stands where it is now: in double, with room for what the working arithmetic
 * rounds on the way there (less than 8 units of each of these lengths). Most neighbours may not. */
static bool may_overlap(const struct touchstone_engine *engine, const struct standing *first, uint32_t entry,
						double contact, double rounding)
{
	uint32_t j = entry_particle(entry);
	const struct body *body = &engine->body[j];
	double wait = engine->now.page - body->page + to_double(sub(engine->now.time, body->time));
	double squares = 0, lengths = contact;
	for (int axis = 0; axis < engine->dimensions; axis++) {
		int32_t places =
			first->place.index[axis] - engine->place[j].index[axis] - entry_image(entry, axis) * engine->places[axis];
		double here = to_double(first->body.position[axis]), there = to_double(body->position[axis]);
		double speed = to_double(body->velocity[axis]), path = speed * wait;
		if (engine->accelerated) path += to_double(engine->half_acceleration[axis]) * wait * wait;
		double apart = here - there - path + places * engine->place_width[axis];
		lengths += fabs(here) + fabs(there) + fabs(path) + fabs(speed) * engine->page_turn;
		squares += apart * apart;
	}
	double near = contact + rounding * lengths;
	return squares < near * near;
}

/* By how much a particle overlaps one that stands where it is now; 0 when it does not. */
static double overlap_depth(const struct touchstone_engine *engine, const struct standing *first, uint32_t entry,
							num contact)
{
	uint32_t j = entry_particle(entry);
	struct standing second = {engine->body[j], engine->place[j]};
	const int image[3] = {entry_image(entry, 0), entry_image(entry, 1), entry_image(entry, 2)};
	double terms[3][3 * TOUCHSTONE_MOST_TERMS], distance[TOUCHSTONE_MOST_TERMS];
	advance(engine, &second.body, &second.place, engine->now);
	int count = separation_terms(engine, first, &second, image, terms);
	write_contact(contact, distance);
	return fmax(0, -excess_signed(terms, count, distance));
}

/* Of the neighbours of particle i, keeps those that may overlap it. */
static size_t keep_near(const struct touchstone_engine *engine, uint32_t i, const struct standing *first,
						uint32_t *candidate, size_t candidates)
{
	double rounding = (ldexp(1, -engine->bits) + 0x1p-40) * 8;
	size_t near = 0;
	for (size_t k = 0; k < candidates; k++) {
		double contact = to_double(contact_distance(engine, i, entry_particle(candidate[k])));
		candidate[near] = candidate[k];
		near += may_overlap(engine, first, candidate[k], contact, rounding);
	}
	return near;
}

/* The same by their shadows, which are as of now. */
static size_t keep_near_by_shadow(const struct touchstone_engine *engine, uint32_t i, uint32_t *candidate,
								  size_t candidates)
{
	double unit = engine->shadows.per_length, own = to_double(contact_distance(engine, i, i));
	uint32_t kept[LOOKED_OVER + 16];
	struct bounds bounds;
	size_t near = 0;
	cast_shadow(engine, i);
	for (uint32_t k = 0; k < LOOKED_OVER + 16; k++) bounds.inner[k] = (float)(own * unit), bounds.outer[k] = INFINITY;
	for (size_t at = 0, some; at < candidates; at += some) {
		some = candidates - at < LOOKED_OVER ? candidates - at : LOOKED_OVER;
		for (uint32_t k = 0; engine->species_count > 1 && k < some; k++) {
			num contact = contact_distance(engine, i, entry_particle(candidate[at + k]));
			bounds.inner[k] = (float)(to_double(contact) * unit);
		}
		size_t found = out_of_bounds(engine, i, candidate + at, &bounds, some, kept);
		for (size_t k = 0; k < found; k++) candidate[near++] = candidate[at + kept[k]];
	}
	return near;
}

static size_t engine_overlaps(const struct touchstone_engine *engine, uint32_t particle,
							  struct touchstone_overlap *list, size_t room)
{
	if (engine->count < 2) return 0;
	uint32_t i = engine->index_of[particle], *candidate = engine->candidate[0];
	struct standing first = {engine->body[i], engine->place[i]};
	advance(engine, &first.body, &first.place, engine->now);
	size_t candidates = cells_around(&engine->cells, engine->itinerary[i].cell, i, candidate), found = 0;
	const struct shadows *shadows = &engine->shadows;
	if (shadows->shadow && since_base(engine, engine->now.page, to_double(engine->now.time)) == shadows->now)
		candidates = keep_near_by_shadow(engine, i, candidate, candidates);
	else
		candidates = keep_near(engine, i, &first, candidate, candidates);
	for (size_t k = 0; k < candidates; k++) {
		uint32_t j = entry_particle(candidate[k]);
		const struct potential *potential = potential_between(engine, i, j);
		if (potential && !potential->hard) continue;
		double depth = overlap_depth(engine, &first, candidate[k], contact_distance(engine, i, j));
		if (!(depth > 0)) continue;
		if (found < room) list[found] = (struct touchstone_overlap){engine->itinerary[j].id, depth};
		found++;
	}
	return found;
}
