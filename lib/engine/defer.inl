/* When a meeting is, asked only when its turn comes. Of the meetings that are found most are overtaken by another event
 * of one of the two; where operations take long, so does finding out when they would have been. Where the sieve leaves
 * one partner, which is surely met, its bounds stand in for the time: from the earlier one on the particle's note is
 * due in the agenda, and then the method is asked. Bodies are as they were until then, or the note is stale, so that
 * the answer is the same: of mpfr:113 a gas of 2916 takes 0.9 of the time. */

/* In twin it would save nothing. */
enum { may_take_long = sizeof(num) > sizeof(double), take_long = sizeof(num) > 2 * sizeof(double) };

/* Makes room for what is deferred, in scenes of hard particles that meet nothing else. */
static bool set_deferral(struct touchstone_engine *engine)
{
	static const int fine = 53, quadruple = 113; /* bits: so that a bound is not rounded */
	bool alone = !engine->captured && !engine->wall_count && !engine->side && engine->method->policy == 0;
	bool sieved = engine->shadows.shadow && engine->method->sieve == SIEVE_ORDER;
	bool slow = take_long || (may_take_long && engine->bits >= quadruple);
	if (!slow || engine->bits < fine || !alone || !sieved) return true;
	engine->shadows.sieve.timed = true;
	engine->open = calloc(engine->count, sizeof *engine->open);
	return engine->open;
}

/* By how much a particle's meeting may be later than its itinerary says: 0 where that is when it is. */
static inline float open_of(const struct touchstone_engine *engine, uint32_t i)
{
	return may_take_long && engine->open ? engine->open[i] : 0;
}

static inline void forget_open(struct touchstone_engine *engine, uint32_t i)
{
	if (may_take_long && engine->open) engine->open[i] = 0;
}

/* Plans to meet the only one that a search has left, if the sieve is sure of that. */
static bool defer(struct touchstone_engine *engine, uint32_t i, const struct sieve_search *left, struct plan *plan)
{
	static const double less = 1 - 0x1p-48;
	const struct shadows *shadows = &engine->shadows;
	if (!engine->open || left->count != 1 || !(left->by < INFINITY) || plan->meets != MEETS_NOTHING) return false;
	double from = fmax(0, (double)(left->from - shadows->sieve.late)), by = (double)(left->by + shadows->sieve.late);
	double time = (shadows->base_time + (shadows->now + from) / shadows->per_time) * less;
	engine->open[i] = (float)(1.001 * (by - from) / shadows->per_time) + 0x1p-100f;
	*plan = (struct plan){moment_on(engine, shadows->base_page, from_double(fmax(0, time))),
						  left->entry[0],
						  TOUCHSTONE_CONTACT,
						  true,
						  engine->open[i],
						  0};
	return true;
}
