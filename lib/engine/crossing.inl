/* Virtual walls: planes that count what passes, and change nothing (2016 paper, section 4). On which side a particle is
 * was read from its position once and is changed by its crossings only. A crossing leaves the particle's last event as
 * it is, so that it rounds nothing and the digest of a run does not know of it. */

static int32_t *side_of(const struct touchstone_engine *engine, uint32_t i, size_t w)
{
	return &engine->side[i * engine->virtual_wall_count + w];
}

/* A body over image `number` of a virtual wall; beyond it, distance and speed are negative. */
static struct flight over_image(const struct touchstone_engine *engine, const struct body *body, struct place place,
								const struct virtual_wall *wall, int32_t number)
{
	if (wall->axis >= 0) place.index[wall->axis] -= number * wall->along * engine->places[wall->axis];
	return over_plane(engine, body, &place, &wall->plane, from_double(0));
}

/* When a point leaves the side of a plane that it is on. */
static num crossing_wait(const struct touchstone_engine *engine, struct flight flight, bool in_front)
{
	struct quadratic f;
	if (!in_front) {
		flight.distance = negated(flight.distance);
		flight.speed = negated(flight.speed);
		flight.acceleration = negated(flight.acceleration);
	}
	if (engine->accelerated) return engine->method->ball_plane(&flight, &f);
	return engine->method->half_space(&(struct passage){flight.distance, flight.speed}, &f);
}

/* Weighs a particle's crossings. On a bent path it may come back through the wall it has passed last, and is asked from
 * there. */
static void consider_virtual_walls(struct touchstone_engine *engine, uint32_t i, struct plan *plan)
{
	struct body body = engine->body[i];
	struct place place = engine->place[i];
	if (engine->accelerated && moment_before((struct moment){body.page, body.time}, engine->crossed[i]))
		advance(engine, &body, &place, engine->crossed[i]);
	for (size_t w = 0; w < engine->virtual_wall_count; w++) {
		const struct virtual_wall *wall = &engine->virtual_wall[w];
		int32_t side = *side_of(engine, i, w);
		for (int ahead = 0; ahead < 2; ahead++) { /* the image behind it, and the one in front of it */
			if (wall->axis < 0 && side + ahead != 0) continue;
			struct flight flight = over_image(engine, &body, place, wall, side + ahead);
			num wait = crossing_wait(engine, flight, !ahead);
			consider(engine, i, &body, wait, TOUCHSTONE_CROSSING, (uint32_t)(2 * w) + (uint32_t)ahead, plan);
		}
	}
}

/* A particle passes a virtual wall: its side changes, and it is counted. */
static void pass_virtual_wall(struct touchstone_engine *engine, uint32_t i)
{
	struct itinerary *itinerary = &engine->itinerary[i];
	uint32_t number = itinerary->partner / 2, ahead = itinerary->partner % 2;
	struct virtual_wall *wall = &engine->virtual_wall[number];
	struct touchstone_flux *flux = &wall->flux[ahead ? 0 : 1];
	struct moment moment = {itinerary->page, itinerary->time}, before = engine->now;
	int32_t *side = side_of(engine, i, number);
	struct body body = engine->body[i];
	struct place place = engine->place[i];
	advance(engine, &body, &place, moment);
	if (engine->observer) {
		struct flight over = over_image(engine, &body, place, wall, *side + (int32_t)ahead);
		struct touchstone_event event = {
			.kind = TOUCHSTONE_CROSSING, .before = *side, .after = *side + (ahead ? 1 : -1)};
		engine->now = moment;
		tell(engine, &event, i, number, over.distance, from_double(0), ahead ? over.speed : negated(over.speed),
			 from_double(0));
		engine->now = before;
	}
	double mass = to_double(engine->mass[place.species]), square = 0;
	for (int axis = 0; axis < engine->dimensions; axis++) {
		double speed = to_double(body.velocity[axis]);
		flux->momentum[axis] += mass * speed;
		square += speed * speed;
	}
	flux->count++;
	flux->mass += mass;
	flux->energy += mass * square / 2;
	*side += ahead ? 1 : -1;
	engine->crossed[i] = moment;
	engine->kinds[TOUCHSTONE_CROSSING]++;
}

/* Reads every particle's side from its position: once, before the first event. Exactly on a wall it is in front. */
static void read_sides(struct touchstone_engine *engine)
{
	num zero = from_double(0);
	for (uint32_t i = 0; engine->side && i < engine->count; i++)
		for (size_t w = 0; w < engine->virtual_wall_count; w++) {
			const struct virtual_wall *wall = &engine->virtual_wall[w];
			const struct body *body = &engine->body[i];
			struct place place = engine->place[i];
			int32_t side = 0;
			while (less(over_image(engine, body, place, wall, side).distance, zero) && (wall->axis >= 0 || side == 0))
				side--;
			while (wall->axis >= 0 && !less(over_image(engine, body, place, wall, side + 1).distance, zero)) side++;
			*side_of(engine, i, w) = side;
			engine->crossed[i] = engine->now;
		}
}
