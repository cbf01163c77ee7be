/* From what a particle may meet to what it meets first, and onto the agenda. */

/* Ties in time are broken by kind, particles and image, never by where a structure happens to hold them. */
static uint64_t rank_of(const struct touchstone_engine *engine, uint32_t i, uint32_t partner, uint8_t meets)
{
	uint64_t low = engine->home[i].id, high = partner, images = 0;
	if (meets == TOUCHSTONE_CONTACT) {
		high = engine->home[entry_particle(partner)].id;
		images = partner >> ENTRY_BITS;
		if (high < low) { /* the same pair seen from the other side: +1 and -1 change places */
			uint64_t other = low;
			low = high, high = other;
			images = (images & 0x15) << 1 | (images & 0x2a) >> 1;
		}
	}
	return (uint64_t)meets << 58 | low << 32 | high << 6 | images;
}

static bool moment_before(struct moment a, struct moment b)
{
	return a.page != b.page ? a.page < b.page : less(a.time, b.time);
}

/* The method has no answer that the engine could go on with. */
static void halt(struct touchstone_engine *engine, uint32_t i, const struct body *later, num wait, uint8_t meets,
				 uint32_t partner)
{
	bool pair = meets == TOUCHSTONE_CONTACT, negative = less(wait, from_double(0));
	engine->verdict = negative || is_finite(later->velocity[0]) ? TOUCHSTONE_HALTED : TOUCHSTONE_DIVERGED;
	engine->blamed[0] = engine->home[i].id;
	engine->blamed[1] = pair ? engine->home[entry_particle(partner)].id : partner;
	snprintf(engine->reason, sizeof engine->reason, "the time from particle %u to %s %u is %s, at t = %.17g",
			 engine->blamed[0], pair ? "particle" : "wall", engine->blamed[1], negative ? "negative" : "not a number",
			 later->page + to_double(later->time));
}

/* Weighs one more possible event of particle i. */
static inline void consider_moment(struct touchstone_engine *engine, uint32_t i, struct moment moment, uint8_t meets,
								   uint32_t partner, struct plan *plan)
{
	static const double too_far = 0x1p52; /* pages: further than any run goes */
	if (moment.page > too_far * engine->page_length || !is_finite(moment.time)) return;
	if (plan->meets != MEETS_NOTHING) {
		if (moment_before(plan->moment, moment)) return;
		if (!moment_before(moment, plan->moment) &&
			rank_of(engine, i, plan->partner, plan->meets) <= rank_of(engine, i, partner, meets))
			return;
	}
	*plan = (struct plan){moment, partner, meets, true};
}

/* The same for one that is `wait` after the last event of `later`; or, when that is no time at all, the end. */
static void consider(struct touchstone_engine *engine, uint32_t i, const struct body *later, num wait, uint8_t meets,
					 uint32_t partner, struct plan *plan)
{
	if (to_double(wait) == INFINITY || engine->verdict != TOUCHSTONE_DONE) return;
	if (!is_finite(wait) || less(wait, from_double(0)))
		halt(engine, i, later, wait, meets, partner);
	else
		consider_moment(engine, i, moment_on(engine, later->page, add(later->time, wait)), meets, partner, plan);
}

static void consider_pairs(struct touchstone_engine *engine, uint32_t i, size_t candidates, struct plan *plan)
{
	const uint32_t *candidate = engine->candidate;
	for (size_t k = 0; k < candidates; k++) {
		struct balls balls;
		struct quadratic f;
		const struct body *later = relative_state(engine, i, candidate[k], balls.r, balls.v);
		balls.contact = contact_distance(engine, i, entry_particle(candidate[k]));
		consider(engine, i, later, engine->method->ball_ball(&balls, &f), TOUCHSTONE_CONTACT, candidate[k], plan);
	}
}

static void consider_walls(struct touchstone_engine *engine, uint32_t i, struct plan *plan)
{
	for (size_t w = 0; w < engine->wall_count; w++) {
		struct flight flight = over_wall(engine, i, &engine->wall[w]);
		struct quadratic f;
		num wait = engine->method->ball_plane(&flight, &f);
		consider(engine, i, &engine->body[i], wait, TOUCHSTONE_WALL, (uint32_t)w, plan);
	}
}

static void plan_keep(struct touchstone_engine *engine, uint32_t i, const struct plan *plan)
{
	struct appointment *appointment = &engine->appointment[i];
	engine->home[i].meets = plan->meets;
	if (!plan->fresh) return;
	appointment->time = plan->moment.time;
	appointment->page = plan->moment.page;
	appointment->partner = plan->partner;
	if (plan->meets == TOUCHSTONE_CONTACT)
		appointment->partner_changes = engine->appointment[entry_particle(plan->partner)].changes;
}

/* Looks at everything a particle may meet. */
static void predict(struct touchstone_engine *engine, uint32_t i)
{
	struct plan plan = {.meets = MEETS_NOTHING};
	if (engine->wall_count) consider_walls(engine, i, &plan);
	if (engine->count > 1)
		engine->pairs(engine, i, cells_around(&engine->cells, engine->home[i].cell, engine->candidate), &plan);
	plan_keep(engine, i, &plan);
}

/* A particle has come into a cell through one face: looks only at what lies beyond the opposite one. What it meant to
 * do stands unless something comes before it; if that is stale, its partner's own search has seen what replaced it. */
static void predict_beyond(struct touchstone_engine *engine, uint32_t i, int axis, int side)
{
	const struct appointment *appointment = &engine->appointment[i];
	struct plan plan = {{appointment->page, appointment->time}, appointment->partner, engine->home[i].meets, false};
	size_t candidates = cells_beyond(&engine->cells, engine->home[i].cell, axis, side, engine->candidate);
	engine->pairs(engine, i, candidates, &plan);
	plan_keep(engine, i, &plan);
}

/* How long after its last event a particle passes a face `gap` ahead of where that event left it, under constant
 * acceleration, if it does so after `passed`; INFINITY if it does not. */
static double crossing_time(double gap, double speed, double acceleration, double passed)
{
	if (acceleration == 0) return speed > 0 ? gap / speed : INFINITY;
	double radicand = speed * speed + 2 * acceleration * gap;
	if (radicand < 0) return acceleration < 0 ? INFINITY : fmax(passed, -speed / acceleration);
	double end = sqrt(radicand);
	double time = speed > 0 ? 2 * gap / (speed + end) : (end - speed) / acceleration;
	if (time >= passed) return time;
	double gap_now = gap - passed * (speed + acceleration / 2 * passed);
	return gap_now <= 0 && speed + acceleration * passed > 0 ? passed : INFINITY;
}

/* When, since its page began, a particle leaves its cell, and by which face; INFINITY if it never does. In double for
 * every arithmetic: the cells' slack pays for the rounding. */
static double leaving(const struct touchstone_engine *engine, uint32_t i, double *page, uint8_t *next)
{
	const struct body *body = &engine->body[i];
	const struct home *home = &engine->home[i];
	if (!engine->cells.entry) return INFINITY;
	double time = to_double(body->time), soonest = INFINITY;
	for (int axis = 0; axis < engine->dimensions; axis++) {
		double side = engine->cell_side[axis], speed = to_double(body->velocity[axis]);
		double position = to_double(body->position[axis]) + engine->place[i].index[axis] * engine->place_width[axis];
		double low = (home->cell[axis] - 1) * side - engine->box[axis] / 2, high = low + side;
		bool ends = !engine->periodic[axis]; /* beyond the last cell there is no other */
		bool closed_low = ends && home->cell[axis] == 1,
			 closed_high = ends && home->cell[axis] == engine->cells.count[axis];
		double up = INFINITY, down = INFINITY;
		if (!engine->accelerated) {
			bool rises = speed > 0;
			if (speed != 0 && !(rises ? closed_high : closed_low)) up = ((rises ? high : low) - position) / speed;
			if (up < soonest) soonest = up, *next = (uint8_t)(1 + 2 * axis + rises);
			continue;
		}
		double gravity = to_double(engine->acceleration[axis]),
			   passed = moment_double(engine->now) - (body->page + time);
		if (!closed_high) up = crossing_time(high - position, speed, gravity, passed);
		if (!closed_low) down = crossing_time(position - low, -speed, -gravity, passed);
		if (up < soonest) soonest = up, *next = (uint8_t)(2 + 2 * axis);
		if (down < soonest) soonest = down, *next = (uint8_t)(1 + 2 * axis);
	}
	if (soonest == INFINITY) return INFINITY;
	soonest += time;
	double pages = soonest >= engine->page_length ? floor(soonest / engine->page_length) : 0;
	if (pages > 0x1p52) return INFINITY;
	if (pages > 0) soonest -= pages * engine->page_length;
	*page = body->page + (pages > 0 ? pages * engine->page_length : 0);
	return soonest;
}

static bool note_holds(const void *context, struct note note)
{
	const struct touchstone_engine *engine = context;
	return engine->appointment[note.particle].stamp == note.stamp;
}

static struct entry entry_of(const void *context, struct note note)
{
	const struct touchstone_engine *engine = context;
	const struct home *home = &engine->home[note.particle];
	if (home->next != NEXT_IS_PHYSICAL) return (struct entry){.time = from_double(home->leaves), .note = note};
	const struct appointment *appointment = &engine->appointment[note.particle];
	return (struct entry){appointment->time, note, appointment->partner, UINT32_C(1) + home->meets};
}

static bool entry_first(const void *context, const struct entry *a, const struct entry *b)
{
	if (less(a->time, b->time)) return true;
	if (less(b->time, a->time)) return false;
	if (!a->kind || !b->kind) return a->kind < b->kind;
	return rank_of(context, a->note.particle, a->partner, (uint8_t)(a->kind - 1)) <
		   rank_of(context, b->note.particle, b->partner, (uint8_t)(b->kind - 1));
}

/* Puts the next thing that happens to a particle on the agenda. What was there for it no longer holds. */
static void schedule(struct touchstone_engine *engine, uint32_t i)
{
	struct appointment *appointment = &engine->appointment[i];
	struct home *home = &engine->home[i];
	double page = 0;
	bool meets = home->meets != MEETS_NOTHING;
	appointment->stamp++;
	home->leaves = leaving(engine, i, &page, &home->next);
	if (meets && (home->leaves == INFINITY || appointment->page < page ||
				  (appointment->page == page && double_below(appointment->time) <= home->leaves))) {
		page = appointment->page;
		home->next = NEXT_IS_PHYSICAL;
	} else if (home->leaves == INFINITY) {
		return;
	}
	agenda_push(&engine->agenda, engine, page, entry_of(engine, (struct note){i, appointment->stamp}));
}
