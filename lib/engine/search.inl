/* From what a particle may meet to what it meets first, and onto the agenda. */

/* Ties in time are broken by kind, particles and image, never by where a structure happens to hold them. */
static uint64_t rank_of(const struct touchstone_engine *engine, uint32_t i, uint32_t partner, uint8_t meets)
{
	uint64_t low = engine->itinerary[i].id, high = partner, images = 0;
	if (with_particle(meets)) {
		high = engine->itinerary[entry_particle(partner)].id;
		images = partner >> ENTRY_BITS;
		if (high < low) { /* the same pair seen from the other side */
			uint64_t other = low;
			low = high, high = other;
			images = entry_mirrored(partner, i) >> ENTRY_BITS;
		}
	}
	return (uint64_t)meets << 58 | low << 32 | high << 6 | images;
}

static bool moment_before(struct moment a, struct moment b)
{
	return a.page != b.page ? a.page < b.page : less(a.time, b.time);
}

static const char *met_name(uint8_t meets)
{
	return with_particle(meets) ? "particle" : meets == TOUCHSTONE_WALL ? "wall" : "virtual wall";
}

/* The method has no answer that the engine could go on with. */
static void halt(struct touchstone_engine *engine, uint32_t i, const struct body *later, num wait, uint8_t meets,
				 uint32_t partner)
{
	bool pair = with_particle(meets), negative = less(wait, from_double(0));
	engine->verdict = negative || is_finite(later->velocity[0]) ? TOUCHSTONE_HALTED : TOUCHSTONE_DIVERGED;
	engine->blamed[0] = engine->itinerary[i].id;
	engine->blamed[1] = pair                       ? engine->itinerary[entry_particle(partner)].id
						: meets == TOUCHSTONE_WALL ? partner
												   : partner / 2;
	snprintf(engine->reason, sizeof engine->reason, "the time from particle %u to %s %u is %s, at t = %.17g",
			 engine->blamed[0], met_name(meets), engine->blamed[1], negative ? "negative" : "not a number",
			 later->page + to_double(later->time));
}

static void out_of_memory(struct touchstone_engine *engine)
{
	engine->verdict = TOUCHSTONE_HALTED;
	snprintf(engine->reason, sizeof engine->reason, "memory ran out at t = %.17g", moment_double(engine->now));
}

/* Weighs one more possible event of particle i. */
static inline void consider_moment(struct touchstone_engine *engine, uint32_t i, struct moment moment, uint8_t meets,
								   uint32_t partner, struct plan *plan)
{
	static const double too_far = 0x1p52; /* pages: further than any run goes */
	if (moment.page > too_far * engine->page_length || !is_finite(moment.time)) return;
	if (plan->meets != MEETS_NOTHING) {
		bool later = moment_before(plan->moment, moment);
		if (!later && !moment_before(moment, plan->moment))
			later = rank_of(engine, i, plan->partner, plan->meets) <= rank_of(engine, i, partner, meets);
		not_before(engine, later ? moment : plan->moment, plan);
		if (later) return;
	}
	*plan = (struct plan){moment, partner, meets, true, 0, plan->second};
}

static num early_meeting(const struct touchstone_engine *engine, struct balls *balls, struct quadratic *f);
static num early_landing(const struct touchstone_engine *engine, struct flight *flight, struct quadratic *f);
static void consider_odd(struct touchstone_engine *engine, uint32_t i, const struct body *later, num wait,
						 uint8_t meets, uint32_t partner, struct plan *plan);

/* The same for one that is `wait` after the last event of `later`; or, when that is no time at all, the end. */
static void consider(struct touchstone_engine *engine, uint32_t i, const struct body *later, num wait, uint8_t meets,
					 uint32_t partner, struct plan *plan)
{
	if (to_double(wait) == INFINITY || engine->verdict != TOUCHSTONE_DONE) return;
	if (!is_finite(wait) || less(wait, from_double(0)))
		consider_odd(engine, i, later, wait, meets, partner, plan);
	else
		consider_moment(engine, i, moment_on(engine, later->page, add(later->time, wait)), meets, partner, plan);
}

/* When i and an entry have their event at a distance, by the method's finder for it and by its policy: `step` is the
 * step they are then at, or NULL at a core. */
static inline num pair_wait(const struct touchstone_engine *engine, ball_finder *finder, uint32_t i, uint32_t entry,
							const struct balls *balls, const struct step *step)
{
	struct quadratic f;
	unsigned policy = engine->method->policy;
	if (!(policy & (POLICY_STRETCH | POLICY_LAST_EVENT))) return finder(balls, &f);
	struct balls later = *balls;
	num skipped = skip_least_time(engine, i, entry, &later), wait = add(skipped, finder(&later, &f));
	return policy & POLICY_STRETCH ? stretched(engine, balls, &f, wait, step, finder == engine->method->ball_ball)
								   : wait;
}

/* Weighs the meetings of particle i with so many entries that are not captured. */
static void consider_pairs(struct touchstone_engine *engine, uint32_t i, const uint32_t *candidate, size_t candidates,
						   struct plan *plan)
{
	bool early = engine->method->policy & POLICY_EARLY;
	for (size_t k = 0; k < candidates; k++) {
		struct balls balls;
		uint32_t j = entry_particle(candidate[k]);
		const struct body *later = relative_state(engine, i, candidate[k], balls.r, balls.v);
		uint8_t meets = first_meeting(engine, i, j, &balls.contact);
		if (meets == MEETS_NOTHING) continue;
		const struct step *step = meets == TOUCHSTONE_CAPTURE ? potential_between(engine, i, j)->step : NULL;
		struct quadratic f;
		num wait = early ? early_meeting(engine, &balls, &f)
						 : pair_wait(engine, engine->method->ball_ball, i, candidate[k], &balls, step);
		consider(engine, i, later, wait, meets, candidate[k], plan);
	}
}

static void consider_walls(struct touchstone_engine *engine, uint32_t i, struct plan *plan)
{
	for (size_t w = 0; w < engine->wall_count; w++) {
		struct flight flight = over_wall(engine, i, &engine->wall[w]);
		struct quadratic f;
		bool early = engine->method->policy & POLICY_EARLY;
		num wait = early ? early_landing(engine, &flight, &f) : engine->method->ball_plane(&flight, &f);
		consider(engine, i, &engine->body[i], wait, TOUCHSTONE_WALL, (uint32_t)w, plan);
	}
}

static void plan_keep(struct touchstone_engine *engine, uint32_t i, const struct plan *plan)
{
	struct itinerary *itinerary = &engine->itinerary[i];
	engine->itinerary[i].meets = plan->meets;
	if (keeps_second(engine)) engine->second[i] = plan->second;
	if (!plan->fresh) return;
	if (!(plan->open > 0)) forget_open(engine, i);
	itinerary->time = plan->moment.time;
	itinerary->page = plan->moment.page;
	itinerary->partner = plan->partner;
	if (with_particle(plan->meets))
		itinerary->partner_changes = engine->itinerary[entry_particle(plan->partner)].changes;
}

static void consider_captured(struct touchstone_engine *engine, const uint32_t *particle, int particles,
							  struct plan *plan);
static void consider_stored(struct touchstone_engine *engine, const struct pairs *pairs, uint32_t more,
							const uint32_t *particle, int particles, struct plan *plan);
static void consider_listed(struct touchstone_engine *engine, uint32_t i, const struct pair_state *pair, uint32_t count,
							struct plan *plan);
static size_t without_captured(struct touchstone_engine *engine, uint32_t i, uint32_t *candidate, size_t candidates);
static void consider_virtual_walls(struct touchstone_engine *engine, uint32_t i, struct plan *plan);
static bool stale(const struct touchstone_engine *engine, uint32_t i);
static void schedule(struct touchstone_engine *engine, uint32_t i);
static bool sieve_listens(struct touchstone_engine *engine, const uint32_t *particle, int particles);
static void tell_tests(struct touchstone_engine *engine, const uint32_t *particle, uint32_t *const list[2],
					   const size_t candidates[2], int particles);

/* The same as the list of neighbours has it. */
static void predict_listed(struct touchstone_engine *engine, const uint32_t *particle, int particles,
						   struct plan plan[2])
{
	if (engine->executing && engine->listener) {
		size_t candidates[2] = {0};
		for (int p = 0; p < particles; p++) candidates[p] = list_around(engine, particle[p], p);
		tell_tests(engine, particle, engine->candidate, candidates, particles);
	}
	neighbours_ahead(engine);
	consider_stored(engine, &engine->neighbours.pairs, 1, particle, particles, plan);
}

/* Looks at everything that one or two particles may meet. Two that have just met are looked after step by step
 * together: each step waits for the one before it, and not for the other particle's. */
static void predict_all(struct touchstone_engine *engine, const uint32_t *particle, int particles)
{
	const struct plan nothing = {.meets = MEETS_NOTHING, .second = INFINITY};
	struct plan plan[2] = {nothing, nothing}; /* so many as are needed would be cleared by a slow instruction */
	size_t candidates[2] = {0};
	bool captures = engine->captured;
	if (captures && engine->neighbours.skin == 0)
		for (int p = 0; p < particles; p++) pairs_ahead(&engine->pairs, particle[p]);
	for (int p = 0; p < particles; p++) forget_open(engine, particle[p]);
	for (int p = 0; engine->wall_count && p < particles; p++) consider_walls(engine, particle[p], &plan[p]);
	for (int p = 0; engine->side && p < particles; p++) consider_virtual_walls(engine, particle[p], &plan[p]);
	if (engine->neighbours.skin > 0) {
		predict_listed(engine, particle, particles, plan);
	} else if (engine->count > 1) {
		uint32_t *const *list = engine->candidate;
		for (int p = 0; p < particles; p++) candidates[p] = list_around(engine, particle[p], p);
		if (captures && engine->method->policy & POLICY_POSITIONAL)
			for (int p = 0; p < particles; p++) read_all_again(engine, particle[p], list[p], candidates[p]);
		bool heard = captures && engine->executing && engine->listener;
		bool sieved = heard && sieve_listens(engine, particle, particles);
		if (heard && !sieved) tell_tests(engine, particle, list, candidates, particles);
		if (captures) consider_captured(engine, particle, particles, plan);
		sift(engine, particle, particles, candidates, plan);
		list_ahead(engine);
		if (sieved) tell_tests(engine, particle, list, candidates, particles);
		engine->shadows.sieve.heard = 0;
		for (int p = 0; captures && p < particles; p++)
			candidates[p] = without_captured(engine, particle[p], list[p], candidates[p]);
		for (int p = 0; p < particles; p++) consider_pairs(engine, particle[p], list[p], candidates[p], &plan[p]);
	}
	for (int p = 0; p < particles; p++) plan_keep(engine, particle[p], &plan[p]);
}

static void predict(struct touchstone_engine *engine, uint32_t i)
{
	predict_all(engine, &i, 1);
}

/* When a particle meets its partner, if that was deferred. */
static void settle(struct touchstone_engine *engine, uint32_t i, struct plan *plan)
{
	const uint32_t partner = engine->itinerary[i].partner;
	*plan = (struct plan){.meets = MEETS_NOTHING};
	forget_open(engine, i);
	consider_pairs(engine, i, &partner, 1, plan);
}

/* The same for one whose turn has come. */
static void settle_now(struct touchstone_engine *engine, uint32_t i)
{
	struct plan plan;
	settle(engine, i, &plan);
	plan_keep(engine, i, &plan);
	schedule(engine, i);
}

/* A particle has come into a cell by a step from one next to it: looks only where it did not look from there. What it
 * meant to do stands unless something comes before it; if that is stale, its partner's own search has seen what
 * replaced it. */
static void predict_entered(struct touchstone_engine *engine, uint32_t i, const int step[3])
{
	const struct itinerary *itinerary = &engine->itinerary[i];
	struct plan plan = {
		{itinerary->page, itinerary->time}, itinerary->partner, itinerary->meets, false, open_of(engine, i), 0};
	uint32_t *list = engine->candidate[0];
	size_t candidates = cells_entered(&engine->cells, engine->itinerary[i].cell, step, i, list);
	sift(engine, &i, 1, &candidates, &plan);
	list_ahead(engine);
	if (candidates && plan.open > 0 && !stale(engine, i)) settle(engine, i, &plan);
	if (engine->captured) candidates = without_captured(engine, i, list, candidates);
	consider_pairs(engine, i, list, candidates, &plan);
	plan_keep(engine, i, &plan);
}

/* The same for `fresh` particles that have come near, at the end of its list. */
static void predict_fresh(struct touchstone_engine *engine, uint32_t i, size_t fresh)
{
	const struct itinerary *itinerary = &engine->itinerary[i];
	struct plan plan = {
		{itinerary->page, itinerary->time}, itinerary->partner, itinerary->meets, false, 0, second_of(engine, i)};
	uint32_t count;
	const struct pair_state *listed = pairs_of(&engine->neighbours.pairs, i, &count);
	consider_listed(engine, i, listed + count - fresh, (uint32_t)fresh, &plan);
	plan_keep(engine, i, &plan);
}

static bool note_holds(const void *context, struct note note)
{
	const struct touchstone_engine *engine = context;
	return engine->itinerary[note.particle].stamp == note.stamp;
}

static struct entry entry_of(const void *context, struct note note)
{
	const struct touchstone_engine *engine = context;
	const struct itinerary *itinerary = &engine->itinerary[note.particle];
	if (itinerary->next != NEXT_IS_PHYSICAL)
		return (struct entry){.time = from_double(itinerary->leaves), .note = note};
	if (open_of(engine, note.particle) > 0) return (struct entry){.time = itinerary->time, .note = note};
	return (struct entry){itinerary->time, note, itinerary->partner, UINT32_C(1) + itinerary->meets};
}

static bool entry_first(const void *context, const struct entry *a, const struct entry *b)
{
	if (less(a->time, b->time)) return true;
	if (less(b->time, a->time)) return false;
	if (!a->kind || !b->kind) return a->kind < b->kind;
	return rank_of(context, a->note.particle, a->partner, (uint8_t)(a->kind - 1)) <
		   rank_of(context, b->note.particle, b->partner, (uint8_t)(b->kind - 1));
}

/* Puts what comes next for a particle on the agenda, in a page. What was there for it no longer holds. */
static inline void enter_note(struct touchstone_engine *engine, uint32_t i, double page)
{
	uint32_t stamp = ++engine->itinerary[i].stamp;
	agenda_push(&engine->agenda, engine, page, entry_of(engine, (struct note){i, stamp}));
}

/* Finds out what that is, and puts it there. What was there for it no longer holds. */
static void schedule(struct touchstone_engine *engine, uint32_t i)
{
	struct itinerary *itinerary = &engine->itinerary[i];
	double page = itinerary->page, time = double_below(itinerary->time);
	bool meets = itinerary->meets != MEETS_NOTHING;
	itinerary->next = NEXT_IS_PHYSICAL;
	if (!meets || !stays(engine, i, (page - engine->body[i].page) + (time - to_double(engine->body[i].time)))) {
		double leaves_page = 0;
		uint8_t face;
		itinerary->leaves = leaving(engine, i, &leaves_page, &face);
		bool leaves = itinerary->leaves < INFINITY;
		if (leaves && (!meets || leaves_page < page || (leaves_page == page && itinerary->leaves < time))) {
			itinerary->next = face;
			page = leaves_page;
		} else if (!meets) {
			engine->itinerary[i].stamp++;
			return;
		}
	}
	enter_note(engine, i, page);
}
