/* The event loop. */

/* A particle has gone far from its anchor: it gets another one, which may be in another cell and image of the box, and
 * looks at those that have come near. What it meant to do stands, as for one that has left its cell. */
static void find_neighbours(struct touchstone_engine *engine, uint32_t i)
{
	struct itinerary *itinerary = &engine->itinerary[i];
	float from[3], to[3] = {0};
	double wait = anchor_wait(engine, i);
	uint16_t cell[3] = {itinerary->cell[0], itinerary->cell[1], itinerary->cell[2]};
	int wraps[3] = {0};
	memcpy(from, engine->neighbours.anchor[i].at, sizeof from);
	for (int axis = 0; axis < engine->dimensions; axis++) {
		double at = coordinate_in_image(engine, i, axis) + to_double(engine->body[i].velocity[axis]) * wait;
		if (engine->periodic[axis] && fabs(at) > engine->box[axis] / 2) wraps[axis] = at > 0 ? -1 : 1;
		at += wraps[axis] * engine->box[axis];
		to[axis] = (float)at;
		cell[axis] = cell_of(engine, at, axis);
	}
	bool wrapped = wraps[0] || wraps[1] || wraps[2], enough = unlist(engine, i, from, wrapped ? nowhere : to);
	for (int axis = 0; axis < engine->dimensions; axis++)
		if (wraps[axis]) shift_image(engine, i, axis, wraps[axis]);
	if (memcmp(cell, itinerary->cell, sizeof cell) != 0) {
		cells_remove(&engine->cells, itinerary->cell, i);
		memcpy(itinerary->cell, cell, sizeof cell);
		enough &= enter_cell(engine, i);
	}
	cast_shadow(engine, i);
	size_t fresh;
	if (!enough || !move_anchor(engine, i, wrapped ? nowhere : from, to, &fresh)) {
		out_of_memory(engine);
		return;
	}
	if (wrapped) {
		itinerary->changes++;
		predict(engine, i);
	} else {
		predict_fresh(engine, i, fresh);
	}
	schedule(engine, i);
}

/* A particle leaves its cell, and perhaps its image of the box: it is looked up in the new one. */
static void cross(struct touchstone_engine *engine, uint32_t i)
{
	struct itinerary *itinerary = &engine->itinerary[i];
	uint8_t face;
	if (itinerary->next == LEAVES_ANCHOR) {
		find_neighbours(engine, i);
		return;
	}
	double flight = engine->accelerated || engine->roomy ? leaving_wait(engine, i, &face) : 0;
	if (engine->accelerated) itinerary->entered = flight; /* a parabola may pass a face twice */
	int step[3] = {0};
	step[(itinerary->next - 1) / 2] = (itinerary->next - 1) % 2 ? 1 : -1;
	if (engine->roomy) may_step(engine, i, flight, step);
	bool wraps = move_by(engine, i, step);
	if (engine->verdict != TOUCHSTONE_DONE) return;
	cast_shadow(engine, i);
	if (wraps)
		predict(engine, i);
	else
		predict_entered(engine, i, step);
	schedule(engine, i);
}

/* A round of the agenda is over: a good time to see whether the layout still fits. */
static void look_over(struct touchstone_engine *engine)
{
	struct agenda *agenda = &engine->agenda;
	if (engine->page_length == INFINITY && engine->search != TOUCHSTONE_ALL) {
		double slack = slack_needed(engine, moment_double(engine->now), typical_speed(engine));
		if (slack > engine->slack) {
			engine->slack = 1.125 * slack; /* no more: a late clock asks for much already, and cells would be few */
			if (!lay_out(engine)) out_of_memory(engine);
			return;
		}
	}
	double per_day = (double)agenda->sorted / (double)agenda->opened;
	bool crowded = per_day > 36, empty = per_day < 3 && agenda->day < engine->page_length;
	if (crowded || empty) {
		double day = fmin(agenda->day * (crowded ? 0.25 : 4), engine->page_length);
		if (!lay_out_agenda(engine, day)) out_of_memory(engine);
	} else {
		agenda->sorted = agenda->opened = 0;
	}
}

/* Has the partner had another event since this one's itinerary was made? Then its own search has replaced it. */
static bool stale(const struct touchstone_engine *engine, uint32_t i)
{
	const struct itinerary *itinerary = &engine->itinerary[i];
	return with_particle(engine->itinerary[i].meets) &&
		   engine->itinerary[entry_particle(itinerary->partner)].changes != itinerary->partner_changes;
}

static void execute(struct touchstone_engine *engine, uint32_t i)
{
	uint32_t partner = engine->itinerary[i].partner, met[2] = {i, entry_particle(partner)};
	uint8_t meets = engine->itinerary[i].meets;
	int particles = with_particle(meets) ? 2 : 1;
	unsigned policy = engine->method->policy;
	engine->now = (struct moment){engine->itinerary[i].page, engine->itinerary[i].time};
	for (int p = 0; engine->neighbours.skin > 0 && p < particles; p++) listed_ahead(engine, met[p]);
	if (policy & POLICY_SEARCH) search_back(engine, i, meets, partner);
	keep_time(engine);
	if (meets == TOUCHSTONE_CONTACT)
		collide(engine, i, partner);
	else if (meets == TOUCHSTONE_WALL)
		rebound(engine, i, partner);
	else
		meet_step(engine, i, partner, meets == TOUCHSTONE_CAPTURE);
	for (int p = 0; p < particles; p++) {
		engine->itinerary[met[p]].entered = 0;
		int step[3] = {0};
		if (engine->roomy && may_step(engine, met[p], 0, step)) move_by(engine, met[p], step);
		cast_shadow(engine, met[p]);
	}
	if (engine->roomy && !engine->cells.entry) return; /* memory ran out */
	if (engine->last_met) remember_event(engine, met, particles);
	if (policy & (POLICY_BACKWARDS | POLICY_SEARCH) && far_back(engine)) {
		if (!lay_out(engine)) out_of_memory(engine);
		return;
	}
	engine->executing = true;
	predict_all(engine, met, particles);
	engine->executing = false;
	for (int p = 0; p < particles; p++) schedule(engine, met[p]);
}

/* Takes the engine to a time at which nothing happens. */
static void wait_until(struct touchstone_engine *engine, double time)
{
	double page = time >= engine->page_length ? floor(time / engine->page_length) * engine->page_length : 0;
	engine->now = (struct moment){page, from_double(time - page)};
}

/* Looks for what a particle does next, though it has had no event. */
static void look_again(struct touchstone_engine *engine, uint32_t i)
{
	cast_shadow(engine, i);
	predict(engine, i);
	schedule(engine, i);
}

/* When the earliest entry of the agenda falls due. */
static double due(const struct touchstone_engine *engine, const struct entry *entry)
{
	if (entry->kind) {
		const struct itinerary *itinerary = &engine->itinerary[entry->note.particle];
		return itinerary->page + to_double(itinerary->time);
	}
	return engine->agenda.today * engine->agenda.day; /* of bookkeeping the day is near enough */
}

/* So many looks in a row without an event, and the particles may as well never meet. */
static uint64_t patience(const struct touchstone_engine *engine)
{
	return (UINT64_C(1) << 22) + UINT64_C(64) * engine->count;
}

/* After so many looks in a row, or when asked to: where time stands still no day ends, at whose end that is asked too.
 */
static bool give_up(const struct touchstone_engine *engine, const struct touchstone_limits *limits, uint64_t looks)
{
	return looks > patience(engine) || (looks % 4096 == 0 && limits->stop && *limits->stop);
}

static enum touchstone_verdict engine_run(struct touchstone_engine *engine, const struct touchstone_limits *limits,
										  const struct touchstone_observer *observer)
{
	struct agenda *agenda = &engine->agenda;
	uint64_t left = UINT64_MAX - engine->events, looks = 0;
	uint64_t last = engine->events + (limits->events < left ? limits->events : left);
	engine->observer = observer;
	while (engine->verdict == TOUCHSTONE_DONE) {
		if (agenda->size == 0) {
			bool turned = false;
			if (limits->stop && *limits->stop) break;
			if (!agenda_open(agenda, engine, &turned)) {
				double day = day_length(engine);
				if (!agenda->beyond || day <= agenda->day) break;
				if (!lay_out_agenda(engine, day)) out_of_memory(engine);
				continue;
			}
			if (turned) {
				look_over(engine);
				continue;
			}
			if (engine->shadows.now > shadows_last(engine)) cast_shadows(engine);
		}
		struct entry entry = agenda->heap[0];
		uint32_t i = entry.note.particle;
		if (!note_holds(engine, entry.note)) {
			heap_drop(agenda, engine);
		} else if (due(engine, &entry) > limits->time) {
			wait_until(engine, limits->time);
			break;
		} else if (engine->itinerary[i].next != NEXT_IS_PHYSICAL || stale(engine, i)) {
			if (give_up(engine, limits, ++looks)) break;
			engine->lookups++;
			heap_drop(agenda, engine);
			uint8_t next = engine->itinerary[i].next;
			if (next != NEXT_IS_PHYSICAL && next != LOOKS_AGAIN)
				cross(engine, i);
			else if (next == LOOKS_AGAIN || !postpone(engine, i))
				look_again(engine, i);
		} else if (open_of(engine, i) > 0) {
			heap_drop(agenda, engine);
			settle_now(engine, i);
		} else if (engine->events == last) {
			break;
		} else if (engine->itinerary[i].meets == TOUCHSTONE_CROSSING) {
			if (give_up(engine, limits, ++looks)) break;
			heap_drop(agenda, engine);
			pass_virtual_wall(engine, i);
			look_again(engine, i);
		} else {
			looks = 0;
			heap_drop(agenda, engine);
			execute(engine, i);
		}
		if (agenda->exhausted) out_of_memory(engine);
	}
	engine->observer = NULL;
	return engine->verdict;
}
