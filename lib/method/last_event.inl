/* last-event: two particles that have just met may not meet again before a minimum time.
 *
 * Source: Frenkel and Maguire 1983, as the 2016 paper tells it (section 2): for thin hard rods, which meet many times
 * in a row, each particle's last event is stored, and a collision of the same two is not looked for before a minimum
 * time, computed from their dynamics. Built here, for steps and for hard bodies, which have no such time of their own:
 * states are read from separations as by `positional`; but a pair whose last event was one with each other is looked
 * at, and its state read, only from
 *
 *     t = 1024 n d / v
 *
 * after it on, with n the roundoff of the working arithmetic, d the largest distance at which anything happens, and v
 * the root mean square of the speeds at the start. Its finders are those of `stable`.
 *
 * What goes wrong: a pair that moves along its step is not beyond rounding by then; and when a third particle meets one
 * of the two, the last event is that one, and the pair is read where it stands. */

/* Whether the last event of i and of an entry was one with each other. */
static bool have_just_met(const struct touchstone_engine *engine, uint32_t i, uint32_t j)
{
	const struct body *first = &engine->body[i], *second = &engine->body[j];
	const struct itinerary *itinerary = engine->itinerary;
	bool both = engine->last_met[i] == itinerary[j].id && engine->last_met[j] == itinerary[i].id;
	if (!both || first->page != second->page) return false;
	return !less(first->time, second->time) && !less(second->time, first->time);
}

/* Takes a pair that has just met to the time from which it is looked at; returns how long that is. Under other methods
 * that is no time. */
static num skip_least_time(const struct touchstone_engine *engine, uint32_t i, uint32_t entry, struct balls *balls)
{
	bool skips = engine->method->policy & POLICY_LAST_EVENT && have_just_met(engine, i, entry_particle(entry));
	if (!skips) return from_double(0);
	num wait = engine->correction_time;
	for (int axis = 0; axis < engine->dimensions; axis++)
		balls->r[axis] = add(balls->r[axis], mul(balls->v[axis], wait));
	return wait;
}

/* Remembers whom the particles of an event have met. */
static void remember_event(struct touchstone_engine *engine, const uint32_t met[2], int particles)
{
	for (int p = 0; p < particles; p++)
		engine->last_met[met[p]] = particles == 2 ? engine->itinerary[met[1 - p]].id : nobody;
}
