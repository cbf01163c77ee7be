/* The event loop. */

static void out_of_memory(struct touchstone_engine *engine)
{
	engine->verdict = TOUCHSTONE_HALTED;
	snprintf(engine->reason, sizeof engine->reason, "memory ran out at t = %.17g", moment_double(engine->now));
}

/* A particle leaves its cell, and perhaps its image of the box: it is looked up in the new one. */
static void cross(struct touchstone_engine *engine, uint32_t i)
{
	struct home *home = &engine->home[i];
	int axis = (home->next - 1) / 2, side = (home->next - 1) % 2 ? 1 : -1;
	int cell = home->cell[axis] + side, last = engine->cells.count[axis];
	bool wraps = cell < 1 || cell > last;
	engine->lookups++;
	cells_remove(&engine->cells, home->cell, i);
	if (wraps) {
		cell -= side * last;
		engine->place[i].index[axis] -= side * engine->places[axis];
	}
	home->cell[axis] = (uint16_t)cell;
	if (!cells_insert(&engine->cells, home->cell, i)) {
		int count[3] = {engine->cells.count[0], engine->cells.count[1], engine->cells.count[2]};
		if (!make_cells(engine, count, 2 * engine->cells.capacity)) {
			out_of_memory(engine);
			return;
		}
	}
	if (wraps) { /* images are counted from here on: whoever knew the old one asks again */
		engine->appointment[i].changes++;
		predict(engine, i);
	} else {
		predict_beyond(engine, i, axis, side);
	}
	schedule(engine, i);
}

/* A round of the agenda is over: a good time to see whether the layout still fits. */
static void look_over(struct touchstone_engine *engine)
{
	struct agenda *agenda = &engine->agenda;
	if (engine->page_length == INFINITY && engine->search == TOUCHSTONE_CELLS) {
		double slack = slack_needed(engine, moment_double(engine->now), typical_speed(engine));
		if (slack > engine->slack) {
			engine->slack = 2 * slack;
			if (!lay_out(engine)) out_of_memory(engine);
			return;
		}
	}
	double per_day = (double)agenda->sorted / (double)agenda->opened;
	bool crowded = per_day > 48, empty = per_day < 3 && agenda->day < engine->page_length;
	if (crowded || empty) {
		double day = fmin(agenda->day * (crowded ? 0.25 : 4), engine->page_length);
		if (!lay_out_agenda(engine, day)) out_of_memory(engine);
	} else {
		agenda->sorted = agenda->opened = 0;
	}
}

/* Has the partner had another event since the appointment was made? Then its own search has replaced it. */
static bool stale(const struct touchstone_engine *engine, uint32_t i)
{
	const struct appointment *appointment = &engine->appointment[i];
	return engine->home[i].meets == TOUCHSTONE_CONTACT &&
		   engine->appointment[entry_particle(appointment->partner)].changes != appointment->partner_changes;
}

static void execute(struct touchstone_engine *engine, uint32_t i)
{
	uint32_t partner = engine->appointment[i].partner;
	engine->now = (struct moment){engine->appointment[i].page, engine->appointment[i].time};
	if (engine->home[i].meets == TOUCHSTONE_WALL) {
		rebound(engine, i, partner);
	} else {
		collide(engine, i, partner);
		predict(engine, entry_particle(partner));
		schedule(engine, entry_particle(partner));
	}
	predict(engine, i);
	schedule(engine, i);
}

static enum touchstone_verdict engine_run(struct touchstone_engine *engine, const struct touchstone_limits *limits,
										  const struct touchstone_observer *observer)
{
	struct agenda *agenda = &engine->agenda;
	uint64_t left = UINT64_MAX - engine->events;
	uint64_t last = engine->events + (limits->events < left ? limits->events : left);
	engine->observer = observer;
	while (engine->verdict == TOUCHSTONE_DONE) {
		if (agenda->size == 0) {
			bool turned = false;
			if (!agenda_open(agenda, engine, &turned)) break;
			if (turned) {
				look_over(engine);
				continue;
			}
		}
		struct entry entry = agenda->heap[0];
		uint32_t i = entry.particle;
		if (!entry_holds(engine, &entry)) {
			heap_drop(agenda, engine);
		} else if (engine->home[i].next != NEXT_IS_PHYSICAL) {
			heap_drop(agenda, engine);
			cross(engine, i);
		} else if (stale(engine, i)) {
			heap_drop(agenda, engine);
			engine->lookups++;
			predict(engine, i);
			schedule(engine, i);
		} else if (engine->events == last) {
			break;
		} else if (engine->appointment[i].page + to_double(engine->appointment[i].time) > limits->time) {
			double page = limits->time >= engine->page_length ? floor(limits->time / engine->page_length) : 0;
			if (page > 0) page *= engine->page_length;
			engine->now = (struct moment){page, from_double(limits->time - page)};
			break;
		} else {
			heap_drop(agenda, engine);
			execute(engine, i);
		}
		if (agenda->exhausted) out_of_memory(engine);
	}
	engine->observer = NULL;
	return engine->verdict;
}
