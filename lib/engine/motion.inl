/* Motion between events, and the relative state of two particles. Both are pure functions of what the last events
 * left: when they are asked for makes no difference. */

/* Time from one body's last event to another's. */
static inline num elapsed(const struct body *from, const struct body *to)
{
	return add(sub(to->time, from->time), from_double(to->page - from->page));
}

/* After a change of units (engine/rescale.inl) the page of a body's last event may begin within a page: what comes of
 * it is counted from where that one begins. It is rounded so that no time runs backwards. */
static struct moment moment_evened(const struct touchstone_engine *engine, struct moment moment)
{
	double length = engine->page_length, begins = floor(moment.page * engine->pages_per_time) * length;
	if (begins == moment.page) return moment;
	num rest = from_double(moment.page - begins), time = add(moment.time, rest);
	if (less(sub(time, rest), moment.time)) time = add(time, from_double(ldexp(length, -engine->bits)));
	return (struct moment){begins, time};
}

/* The moment `time` after the beginning of a page, on the page on which it falls. */
static inline struct moment moment_on(const struct touchstone_engine *engine, double page, num time)
{
	struct moment moment = {page, time};
	if (engine->uneven) {
		moment = moment_evened(engine, moment);
		time = moment.time;
	}
	double length = engine->page_length, near = to_double(time);
	if (!(near >= length)) return moment;
	double pages = floor(near / length);
	moment.time = sub(time, from_double(pages * length));
	if (less(moment.time, from_double(0))) moment.time = sub(time, from_double(--pages * length));
	moment.page += pages * length;
	return moment;
}

/* The same for a time that may lie before the beginning of the page. */
static struct moment moment_back_on(const struct touchstone_engine *engine, double page, num time)
{
	double length = engine->page_length, near = to_double(time);
	if (near >= 0 || length == INFINITY) return moment_on(engine, page, time);
	double pages = floor(near / length);
	time = sub(time, from_double(pages * length));
	if (!(to_double(time) < length)) time = from_double(0), pages++;
	return (struct moment){page + pages * length, time};
}

static inline double moment_double(struct moment moment)
{
	return moment.page + to_double(moment.time);
}

/* Where along an axis the last event left a particle, in the image of the box it is in: for looking about. */
static inline double coordinate_in_image(const struct touchstone_engine *engine, uint32_t i, int axis)
{
	return to_double(engine->body[i].position[axis]) + engine->place[i].index[axis] * engine->place_width[axis];
}

/* The place so many steps from another. None in the box is nearly as far as the bounds: only a state that somebody has
 * altered, with more speed than its events allow for, comes to them. */
static inline int32_t place_after(int32_t index, double steps)
{
	static const double most = 1 << 29;
	return (int32_t)fmax(-most, fmin(index + steps, most));
}

/* Flies a body to a moment, and counts its position from the place it has reached. */
static void advance(const struct touchstone_engine *engine, struct body *body, struct place *place,
					struct moment moment)
{
	num wait = add(sub(moment.time, body->time), from_double(moment.page - body->page));
	for (int axis = 0; axis < engine->dimensions; axis++) {
		num path = mul(body->velocity[axis], wait);
		if (engine->accelerated) {
			path = add(path, mul(engine->half_acceleration[axis], mul(wait, wait)));
			body->velocity[axis] = add(body->velocity[axis], mul(engine->acceleration[axis], wait));
		}
		num position = add(body->position[axis], path);
		double width = engine->place_width[axis], offset = to_double(position);
		if (2 * fabs(offset) > width && width > 0) {
			double steps = rint(offset / width);
			position = sub(position, mul(from_double(steps), engine->place_size[axis]));
			place->index[axis] = place_after(place->index[axis], steps);
		}
		body->position[axis] = position;
	}
	body->time = moment.time;
	body->page = moment.page;
}

/* Position of one body seen from image `image` of another. Whether they are counted from one place is asked only where
 * operations take long: it has to be guessed on every axis, which would cost a gas in binary64 a twentieth of its time.
 */
static inline num offset_of(const struct touchstone_engine *engine, const struct body *body, const struct place *place,
							const struct body *other, const struct place *others, int image, int axis)
{
	num offset = sub(body->position[axis], other->position[axis]);
	int32_t places = place->index[axis] - others->index[axis] - image * engine->places[axis];
	if (sizeof(num) > sizeof(double) && places == 0) return offset;
	return add(offset, mul(from_double(places), engine->place_size[axis]));
}

/* Position of particle i seen from image `image` of particle j, each where its own last event left it. */
static inline num offset_between(const struct touchstone_engine *engine, uint32_t i, uint32_t j, int image, int axis)
{
	return offset_of(engine, &engine->body[i], &engine->place[i], &engine->body[j], &engine->place[j], image, axis);
}

/* Relative position and velocity of i and an entry j at the later of their last events, and which of the two that
 * was. Exchanging the two changes every sign and nothing else. */
static inline const struct body *relative_state(const struct touchstone_engine *engine, uint32_t i, uint32_t entry,
												num r[3], num v[3])
{
	uint32_t j = entry_particle(entry);
	const struct body *first = &engine->body[i], *second = &engine->body[j];
	num wait = elapsed(second, first), zero = from_double(0);
	r[1] = r[2] = v[1] = v[2] = zero;
	bool second_flies = !less(wait, zero); /* the earlier one flies on to meet the later one's time */
	const struct body *flies = second_flies ? second : first;
	for (int axis = 0; axis < engine->dimensions; axis++) {
		num path = mul(flies->velocity[axis], wait);
		v[axis] = sub(first->velocity[axis], second->velocity[axis]);
		if (engine->accelerated) {
			num bend = mul(engine->half_acceleration[axis], mul(wait, wait));
			path = second_flies ? add(path, bend) : sub(path, bend);
			num gain = mul(engine->acceleration[axis], wait), gained = add(flies->velocity[axis], gain);
			if (!second_flies) gained = sub(flies->velocity[axis], gain);
			v[axis] = second_flies ? sub(first->velocity[axis], gained) : sub(gained, second->velocity[axis]);
		}
		r[axis] = sub(offset_between(engine, i, j, entry_image(entry, axis), axis), path);
	}
	return second_flies ? first : second;
}

/* A body over a wall that it touches at so much from its centre. Where its centre is in contact is formed first: near
 * it the difference is then exact, and a ball at rest is at rest (the other order lets the rounding of every landing
 * through; the table of orders that `reproduce fig7` prints shows what that does). The distance is that from contact.
 */
static inline struct flight over_plane(const struct touchstone_engine *engine, const struct body *body,
									   const struct place *place, const struct wall *wall, num radius)
{
	num gap = from_double(0), speed = gap;
	for (int axis = 0; axis < engine->dimensions; axis++) {
		num touching = add(wall->position[axis], mul(wall->normal[axis], radius));
		num offset = sub(body->position[axis], touching);
		int32_t places = place->index[axis] - wall->index[axis];
		if (places) offset = add(offset, mul(from_double(places), engine->place_size[axis]));
		gap = add(gap, mul(wall->normal[axis], offset));
		speed = add(speed, mul(wall->normal[axis], body->velocity[axis]));
	}
	return (struct flight){gap, speed, wall->acceleration, from_double(0)};
}

/* A particle over a wall, at the particle's last event. */
static struct flight over_wall(const struct touchstone_engine *engine, uint32_t i, const struct wall *wall)
{
	const struct place *place = &engine->place[i];
	return over_plane(engine, &engine->body[i], place, wall, engine->radius[place->species]);
}
