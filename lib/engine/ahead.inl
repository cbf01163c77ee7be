/* What the notes of the next days will want is fetched into the cache, in three steps, each a day after that which
 * tells where it is: a note's itinerary; then what its particle and its partner are and who is around the one; then who
 * is around the other. Where particles are so many that none is in the cache by chance, every step would wait for
 * memory: in a gas of 10^6 this and large pages (engine/memory.h) save a fifth of the time. No event depends on it. */

/* What an event changes and looks at, of one of its particles. */
static void particle_ahead(const struct touchstone_engine *engine, uint32_t i)
{
	ahead(&engine->body[i]);
	ahead(&engine->place[i]);
	if (engine->shadows.shadow) ahead(&engine->shadows.shadow[i]);
}

/* The cell where a particle will be looked for when what comes next for it has come. */
static void next_cell(const struct itinerary *itinerary, uint16_t cell[3])
{
	memcpy(cell, itinerary->cell, sizeof itinerary->cell);
	if (itinerary->next == NEXT_IS_PHYSICAL || itinerary->next == LEAVES_ANCHOR) return;
	int axis = (itinerary->next - 1) / 2;
	cell[axis] = (uint16_t)(cell[axis] + 2 * ((itinerary->next - 1) % 2) - 1);
}

/* The partner in what comes next, or the particle itself. */
static uint32_t next_partner(const struct touchstone_engine *engine, uint32_t i)
{
	const struct itinerary *itinerary = &engine->itinerary[i];
	bool meets = itinerary->next == NEXT_IS_PHYSICAL && with_particle(itinerary->meets);
	return meets ? entry_particle(itinerary->partner) : i;
}

/* Today: its partner's itinerary is there by now. */
static void note_at_hand(const void *context, struct note note)
{
	const struct touchstone_engine *engine = context;
	if (engine->agenda.wide)
		cells_ahead(&engine->cells, engine->itinerary[next_partner(engine, note.particle)].cell);
	else
		particle_ahead(engine, note.particle);
}

/* Tomorrow. */
static void note_ahead(const void *context, struct note note)
{
	const struct touchstone_engine *engine = context;
	if (!note_holds(context, note)) return;
	uint16_t cell[3];
	next_cell(&engine->itinerary[note.particle], cell);
	cells_ahead(&engine->cells, cell);
	particle_ahead(engine, note.particle);
	uint32_t partner = next_partner(engine, note.particle);
	ahead(&engine->itinerary[partner]);
	particle_ahead(engine, partner);
}

/* The day after. */
static void note_far_ahead(const void *context, struct note note)
{
	const struct touchstone_engine *engine = context;
	ahead(&engine->itinerary[note.particle]);
}
