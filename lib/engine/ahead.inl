/* What the notes of the next days will want is fetched into the cache, in three steps, each a day after that which
 * tells where it is: a note's itinerary; then what its particle and its partner are and who is around the one; then who
 * is around the other. And while one event looks for what comes next, those around the next one are listed, and their
 * shadows fetched. Where particles are so many that none is in the cache by chance, every step would wait for memory:
 * in a gas of 10^6 the days and large pages (engine/memory.h) save a fifth of the time, the lists (with what
 * engine/cells.c leaves unread) a quarter of the rest. Where they are fewer, in one of 10^4, all of that would cost
 * more than it saves, by a tenth; but a note's itinerary a day before, and its particles when the day comes, save a
 * thirtieth, and with neighbour lists in liquids a fourteenth. No event depends on it. */

/* What an event changes and looks at, of one of its particles. */
static void particle_ahead(const struct touchstone_engine *engine, uint32_t i)
{
	ahead(&engine->body[i]);
	ahead(&engine->place[i]);
	if (engine->shadows.shadow) ahead(&engine->shadows.shadow[i]);
	if (engine->pairs.bucket) ahead(&engine->pairs.bucket[i]);
	if (engine->neighbours.skin > 0) ahead(&engine->neighbours.pairs.bucket[i]);
}

/* The cell where a particle will be looked for when what comes next for it has come, and the step to there. */
static void next_cell(const struct itinerary *itinerary, uint16_t cell[3], int step[3])
{
	memcpy(cell, itinerary->cell, sizeof itinerary->cell);
	if (itinerary->next == NEXT_IS_PHYSICAL || itinerary->next >= LEAVES_ANCHOR) return;
	int axis = (itinerary->next - 1) / 2;
	step[axis] = 2 * ((itinerary->next - 1) % 2) - 1;
	cell[axis] = (uint16_t)(cell[axis] + step[axis]);
}

/* The partner in what comes next, or the particle itself. */
static uint32_t next_partner(const struct touchstone_engine *engine, uint32_t i)
{
	const struct itinerary *itinerary = &engine->itinerary[i];
	bool meets = itinerary->next == NEXT_IS_PHYSICAL && with_particle(itinerary->meets);
	return meets ? entry_particle(itinerary->partner) : i;
}

/* The same of both its particles, of one whose itinerary is there. */
static void particles_ahead(const struct touchstone_engine *engine, uint32_t i)
{
	uint32_t partner = next_partner(engine, i);
	particle_ahead(engine, i);
	ahead(&engine->itinerary[partner]);
	particle_ahead(engine, partner);
}

/* Today: its itinerary is there by now, and where days are many its partner's. */
static void note_at_hand(const void *context, struct note note)
{
	const struct touchstone_engine *engine = context;
	if (engine->agenda.wide)
		cells_ahead(&engine->cells, engine->itinerary[next_partner(engine, note.particle)].cell);
	else
		particles_ahead(engine, note.particle);
}

/* Tomorrow. */
static void note_ahead(const void *context, struct note note)
{
	const struct touchstone_engine *engine = context;
	if (!note_holds(context, note)) return;
	uint16_t cell[3];
	int step[3] = {0};
	next_cell(&engine->itinerary[note.particle], cell, step);
	cells_ahead(&engine->cells, cell);
	particles_ahead(engine, note.particle);
}

/* The day after. */
static void note_far_ahead(const void *context, struct note note)
{
	const struct touchstone_engine *engine = context;
	ahead(&engine->itinerary[note.particle]);
}

/* Lists into candidate[p] who is around a particle: that may be done already. */
static size_t list_around(struct touchstone_engine *engine, uint32_t i, int p)
{
	struct listing *listing = &engine->listing[p];
	uint32_t *list = engine->candidate[p];
	if (listing->particle != i || listing->changes != engine->cells.changes)
		return cells_around(&engine->cells, engine->itinerary[i].cell, i, list);
	engine->candidate[p] = listing->entry;
	listing->entry = list;
	listing->particle = nobody;
	return listing->count;
}

/* Lists who is around a particle that will have an event. */
static void list_event(struct touchstone_engine *engine, uint32_t i, struct listing *listing)
{
	listing->particle = i;
	listing->changes = engine->cells.changes;
	listing->count = cells_around(&engine->cells, engine->itinerary[i].cell, i, listing->entry);
}

/* Lists whom a particle will find that will leave its cell, unless that leads out of the box. */
static void list_crossing(struct touchstone_engine *engine, uint32_t i, struct listing *listing)
{
	uint16_t cell[3];
	int step[3] = {0};
	next_cell(&engine->itinerary[i], cell, step);
	bool inside = true;
	for (int axis = 0; axis < engine->dimensions; axis++)
		inside &= cell[axis] >= 1 && cell[axis] <= engine->cells.count[axis];
	listing->count = inside ? cells_entered(&engine->cells, cell, step, i, listing->entry) : 0;
}

/* Lists for the search that comes after the one at hand, and fetches the shadows it will look at: of the event that
 * stands first in the agenda. */
static void list_ahead(struct touchstone_engine *engine)
{
	const struct agenda *agenda = &engine->agenda;
	const struct shadow *shadow = engine->shadows.shadow;
	if (!agenda->wide || !agenda->size || !shadow || !note_holds(engine, agenda->heap[0].note)) return;
	uint32_t i = agenda->heap[0].note.particle, partner = next_partner(engine, i);
	uint8_t next = engine->itinerary[i].next;
	struct listing *listing = engine->listing;
	if (next >= LEAVES_ANCHOR) return;
	for (int p = 0; p < 2; p++) listing[p].particle = nobody, listing[p].count = 0;
	if (next == NEXT_IS_PHYSICAL)
		list_event(engine, i, &listing[0]);
	else
		list_crossing(engine, i, &listing[0]);
	if (partner != i) list_event(engine, partner, &listing[1]);
	for (int p = 0; p < 2; p++)
		for (size_t k = 0; k < listing[p].count; k++) ahead(&shadow[entry_particle(listing[p].entry[k])]);
}

/* The same where there are neighbour lists: fetches those of that event. */
static void neighbours_ahead(const struct touchstone_engine *engine)
{
	const struct agenda *agenda = &engine->agenda;
	if (!agenda->size) return;
	uint32_t i = agenda->heap[0].note.particle, partner = next_partner(engine, i);
	pairs_ahead(&engine->neighbours.pairs, i);
	if (partner != i) pairs_ahead(&engine->neighbours.pairs, partner);
}

/* And of a particle whose list is there, what stands in it. */
static void listed_ahead(const struct touchstone_engine *engine, uint32_t i)
{
	uint32_t count;
	const struct pair_state *listed = pairs_of(&engine->neighbours.pairs, i, &count);
	for (uint32_t k = 0; k < count; k++) ahead(&engine->shadows.shadow[entry_particle(listed[k].entry)]);
	pairs_ahead(&engine->pairs, i);
}
