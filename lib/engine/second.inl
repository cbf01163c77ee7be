/* What a particle does when its partner has met another before. It would have to look again at all that it may meet,
 * though nothing of that has changed but its partner, who has looked itself. So each search also leaves a moment before
 * which nothing happens but what it has planned. Until then the particle need not look, and often it has had an event
 * by then and never does: in wells and on shoulders at density 0.5, whose searches ask all that is listed, 0.16 and
 * 0.19 of the searches per event are repeated ones, and not 0.57 and 0.52. Where there are no lists, in hard bodies and
 * in dilute wells, less is gained (0.18 for 0.31 in spheres at 0.5) than it costs to find that moment out. */

/* Where numbers are coarse a moment is rounded too far, and where operations take long, meetings are deferred. */
static bool set_second(struct touchstone_engine *engine)
{
	static const int fine = 53; /* bits */
	bool sieved = engine->shadows.shadow && engine->method->sieve == SIEVE_ORDER;
	bool pays = engine->captured && !may_take_long && engine->bits >= fine;
	if (!pays || !sieved || engine->method->policy) return true;
	engine->second = calloc(engine->count, sizeof *engine->second);
	return engine->second;
}

/* Whether that is done. */
static inline bool keeps_second(const struct touchstone_engine *engine)
{
	return !may_take_long && engine->second && engine->neighbours.skin > 0;
}

/* What is not planned comes at some moment, */
static inline void not_before(const struct touchstone_engine *engine, struct moment moment, struct plan *plan)
{
	if (!keeps_second(engine)) return;
	double second = moment_double(moment);
	plan->second = second < plan->second ? second : plan->second;
}

/* or not before that, after a search, by a bound of the sieve. */
static inline void not_before_bound(const struct touchstone_engine *engine, float bound, struct plan *plan)
{
	if (!keeps_second(engine) || bound == INFINITY) return;
	const struct shadows *shadows = &engine->shadows;
	double wait = shadows->now + bound_surely(engine, bound);
	double second = shadows->base_page + (shadows->base_time + wait / shadows->per_time);
	plan->second = second < plan->second ? second : plan->second;
}

static inline double second_of(const struct touchstone_engine *engine, uint32_t i)
{
	return keeps_second(engine) ? engine->second[i] : 0;
}

static inline void enter_note(struct touchstone_engine *engine, uint32_t i, double page);

/* Lets a particle whose plan has come to nothing look again when something may happen to it, if that is later than its
 * plan was, and before it leaves its cell. */
static bool postpone(struct touchstone_engine *engine, uint32_t i)
{
	struct itinerary *itinerary = &engine->itinerary[i];
	const struct body *body = &engine->body[i];
	if (!keeps_second(engine)) return false;
	double second = engine->second[i] - 0x1p-48 * fabs(engine->second[i]);
	if (!(second > itinerary->page + to_double(itinerary->time)) || second == INFINITY) return false;
	if (!stays(engine, i, (second - body->page) - to_double(body->time))) return false;
	double page = floor(second * engine->pages_per_time) * engine->page_turn;
	itinerary->next = LOOKS_AGAIN;
	itinerary->leaves = second - page;
	enter_note(engine, i, page);
	return true;
}
