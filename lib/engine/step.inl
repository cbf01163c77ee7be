/* Pairs within a step of their potential: what they may do next, and what happens at a step (2016 paper, section 3 and
 * algorithm 3). Their state is what was tracked, never what their distance says. */

/* Weighs the events of particle i with a partner it has captured: leaving the innermost step they are within, or
 * meeting the next one, or the core. */
static void consider_partner(struct touchstone_engine *engine, uint32_t i, struct pair_state captured,
							 struct plan *plan)
{
	uint32_t entry = captured.entry, state = captured.state;
	const struct potential *potential = potential_between(engine, i, entry_particle(entry));
	const struct step *within = &potential->step[state - 1], *next = within + 1;
	struct balls balls;
	const struct body *later = relative_state(engine, i, entry, balls.r, balls.v);
	balls.contact = within->distance;
	num wait = pair_wait(engine, engine->method->ball_leave, i, entry, &balls, within);
	consider(engine, i, later, wait, TOUCHSTONE_RELEASE, entry, plan);
	bool innermost = state == potential->step_count;
	if (innermost && !potential->hard) return;
	balls.contact = innermost ? potential->core : next->distance;
	wait = pair_wait(engine, engine->method->ball_ball, i, entry, &balls, innermost ? NULL : next);
	consider(engine, i, later, wait, innermost ? TOUCHSTONE_CONTACT : TOUCHSTONE_CAPTURE, entry, plan);
}

/* Weighs the events of particle i with one of the pairs that were foreseen. */
static inline void consider_foreseen(struct touchstone_engine *engine, uint32_t i, const struct forecast *forecast,
									 uint32_t k, struct plan *plan)
{
	struct pair_state pair = {forecast->pair[k].entry, forecast->pair[k].state - forecast->more};
	if (pair.state)
		consider_partner(engine, i, pair, plan);
	else
		consider_pairs(engine, i, &pair.entry, 1, plan);
}

/* Weighs the events of particle i with so many pairs: with that which may come first, and then with those that may come
 * before it. */
static void consider_forecast(struct touchstone_engine *engine, uint32_t i, const struct forecast *forecast,
							  struct plan *plan)
{
	uint32_t early[FORESEEN + 16], first = forecast->first;
	if (!forecast->count) return;
	float latest = latest_planned(engine, plan), soonest = forecast->soonest[first];
	if (!(soonest > latest) && soonest != INFINITY) {
		consider_foreseen(engine, i, forecast, first, plan);
		latest = latest_planned(engine, plan);
	}
	float later;
	size_t some = engine->shadows.machine->sooner(forecast->soonest, forecast->count, latest, early, &later);
	for (size_t k = 0; k < some; k++) {
		if (early[k] == first) continue;
		if (forecast->soonest[early[k]] > latest) {
			later = fminf(later, forecast->soonest[early[k]]);
			continue;
		}
		consider_foreseen(engine, i, forecast, early[k], plan);
		latest = latest_planned(engine, plan);
	}
	not_before_bound(engine, later, plan);
}

/* The same with what stands in a store, `more` than its state, for one or two particles: step by step together. */
static void consider_stored(struct touchstone_engine *engine, const struct pairs *pairs, uint32_t more,
							const uint32_t *particle, int particles, struct plan *plan)
{
	struct forecast forecast[2];
	uint32_t left[2] = {0};
	for (int p = 0; p < particles; p++) {
		forecast[p].pair = pairs_of(pairs, particle[p], &left[p]);
		forecast[p].more = more;
	}
	while (left[0] || left[1]) {
		for (int p = 0; p < particles; p++) forecast[p].count = left[p] < FORESEEN ? left[p] : FORESEEN;
		foresee(engine, particle, particles, forecast);
		for (int p = 0; p < particles; p++) {
			consider_forecast(engine, particle[p], &forecast[p], &plan[p]);
			forecast[p].pair += forecast[p].count;
			left[p] -= forecast[p].count;
		}
	}
}

/* With all that one or two particles have captured. */
static void consider_captured(struct touchstone_engine *engine, const uint32_t *particle, int particles,
							  struct plan *plan)
{
	if (sieves_states(engine)) {
		consider_stored(engine, &engine->pairs, 0, particle, particles, plan);
		return;
	}
	for (int p = 0; p < particles; p++) {
		uint32_t count;
		const struct pair_state *captured = pairs_of(&engine->pairs, particle[p], &count);
		for (uint32_t k = 0; k < count; k++) consider_partner(engine, particle[p], captured[k], &plan[p]);
	}
}

/* With so many pairs that are listed. */
static void consider_listed(struct touchstone_engine *engine, uint32_t i, const struct pair_state *pair, uint32_t count,
							struct plan *plan)
{
	for (uint32_t some; count; pair += some, count -= some) {
		struct forecast forecast;
		some = count < FORESEEN ? count : FORESEEN;
		forecast.pair = pair, forecast.count = some, forecast.more = 1;
		foresee(engine, &i, 1, &forecast);
		consider_forecast(engine, i, &forecast, plan);
	}
}

/* Takes what particle i has captured out of a list of entries it may meet; returns how many are left. The sieve may
 * have seen them before: it keeps those that approach, since none is surely outside the step it has not left, and none
 * makes it leave out another. */
static size_t without_captured(struct touchstone_engine *engine, uint32_t i, uint32_t *candidate, size_t candidates)
{
	uint32_t count;
	const struct pair_state *captured = pairs_of(&engine->pairs, i, &count);
	size_t left = 0;
	if (!count) return candidates;
	for (uint32_t k = 0; k < count; k++) engine->captured[entry_particle(captured[k].entry)] = (uint16_t)(k + 1);
	for (size_t k = 0; k < candidates; k++) {
		uint16_t mark = engine->captured[entry_particle(candidate[k])];
		bool held = mark && captured[mark - 1].entry == candidate[k];
		if (mark && !held) held = pairs_get(&engine->pairs, i, candidate[k]); /* another image of the same */
		candidate[left] = candidate[k];
		left += !held;
	}
	for (uint32_t k = 0; k < count; k++) engine->captured[entry_particle(captured[k].entry)] = 0;
	return left;
}

/* What is taken from r.v at a step, over r.r: after it (r.v)^2 / r.r is less by `climb`, and its sign says in or out.
 * Where the sign stays, the difference of the two is written so that nothing cancels; a step without height takes
 * nothing. */
static num step_kick(num rv, num rr, num climb, bool inwards)
{
	num zero = from_double(0);
	if (!less(climb, zero) && !less(zero, climb)) return zero;
	num after = root(sub(mul(rv, rv), mul(climb, rr)));
	if (inwards) after = negated(after);
	bool onwards = inwards ? less(rv, zero) : less(zero, rv);
	return onwards ? divide(climb, add(rv, after)) : divide(sub(rv, after), rr);
}

/* What is taken from r.v, over r.r, where a pair turns back at a step: twice r.v, or nothing when rounding has turned
 * it already.
 *
 * A pair within the step that moves along it cannot be turned by a reflection: where r.v rounds to 0 that does nothing,
 * and at a distance above the step's by rounding no path leads back in. By the stable rule its next event is now, again
 * and for ever: with plain reflections 108 particles at four steps were stuck after 800 events in short:11
 * (lib/test/step_engine_test.c, coarse_pairs_are_not_stuck). So it turns back with (r.v)^2 of at least 16 n (v.v)
 * (r.r), n the roundoff, which leads in from a distance too long by a factor of 1 + 8 n, and changes the kinetic energy
 * of the pair's relative motion by 16 n of it at most. About 16 n of all bounces are so slow. */
static num turning_kick(const struct touchstone_engine *engine, const struct encounter *encounter, bool inwards)
{
	num rv = encounter->rv, zero = from_double(0), twice = divide(add(rv, rv), encounter->rr);
	if (inwards) return less(rv, zero) ? twice : zero;
	num square = mul(dot(encounter->v, encounter->v), encounter->rr);
	num least = root(mul(from_double(ldexp(16, -engine->bits)), square));
	if (!less(rv, least)) return twice;
	return less(negated(rv), least) ? divide(add(rv, least), encounter->rr) : zero;
}

/* Two particles are at a step of their potential, on their way in or out: they pass it, which changes their state and
 * speeds them up or slows them down, or turn back if they are too slow to climb it. */
static void meet_step(struct touchstone_engine *engine, uint32_t i, uint32_t entry, bool inwards)
{
	struct encounter encounter = bring_together(engine, i, entry);
	const struct potential *potential = potential_between(engine, i, encounter.j);
	uint32_t state = state_of(engine, i, entry), passed = inwards ? state + 1 : state - 1;
	const struct step *step = &potential->step[inwards ? state : state - 1];
	num climb = inwards ? step->climb : negated(step->climb), rv = encounter.rv;
	bool passes = climbs(climb, encounter.rr, rv);
	struct touchstone_event event = {
		.kind = !passes   ? TOUCHSTONE_BOUNCE
				: inwards ? TOUCHSTONE_CAPTURE
						  : TOUCHSTONE_RELEASE,
		.before = (int)state,
		.after = (int)(passes ? passed : state),
	};
	if (passes)
		event.energy =
			(passed ? potential->step[passed - 1].energy : 0) - (state ? potential->step[state - 1].energy : 0);
	num kick = passes ? step_kick(rv, encounter.rr, climb, inwards) : turning_kick(engine, &encounter, inwards);
	part(engine, &encounter, kick, &event, step->distance);
	if (passes && !set_state(engine, potential, i, entry, state, passed)) out_of_memory(engine);
}
