/* Where to look: laying out cells and agenda. Any layout gives the same events; a poor one only takes longer. */

/* How much wider than the largest distance at which anything happens a cell must be, so that no rounding of positions,
 * of the reach of a far pair's discriminant, or (absolute form) of a late clock hides a neighbour; nor a method that
 * has its events early or late. */
static double slack_needed(const struct touchstone_engine *engine, double clock, double speed)
{
	double extent = 0, roundoff = ldexp(1, -engine->bits);
	for (int axis = 0; axis < engine->dimensions; axis++) extent = fmax(extent, engine->box[axis]);
	double drift = engine->page_length < INFINITY ? engine->page_length : clock;
	bool shifts = engine->method->policy & (POLICY_STRETCH | POLICY_LAST_EVENT);
	double shift = shifts ? to_double(engine->correction_time) : 0;
	return 0x1p-14 * engine->reach + 16 * roundoff * (extent * (1 + extent / engine->largest) + 8 * drift * speed) +
		   8 * shift * speed;
}

/* Coordinate of a particle now, in the image of the box it is in. */
static double coordinate_now(const struct touchstone_engine *engine, uint32_t i, int axis)
{
	const struct body *body = &engine->body[i];
	double wait = moment_double(engine->now) - (body->page + to_double(body->time));
	double path = to_double(body->velocity[axis]) * wait;
	if (engine->accelerated) path += to_double(engine->half_acceleration[axis]) * wait * wait;
	return coordinate_in_image(engine, i, axis) + path;
}

/* The cell a coordinate lies in; outside the grid the nearest one. */
static uint16_t cell_of(const struct touchstone_engine *engine, double coordinate, int axis)
{
	double cell = floor((coordinate + engine->box[axis] / 2) / engine->cell_side[axis]);
	return (uint16_t)(1 + fmin(fmax(cell, 0), engine->cells.count[axis] - 1));
}

/* Chooses the grid for the particles as they are now. */
static bool lay_out_cells(struct touchstone_engine *engine)
{
	static const int most_per_axis = 60000;
	forget_neighbours(engine);
	choose_skin(engine);
	double volume = 1, content = engine->count, reach = engine->reach + engine->slack + engine->neighbours.skin;
	int count[3] = {1, 1, 1};
	for (int axis = 0; axis < engine->dimensions; axis++) {
		volume *= engine->box[axis];
		content *= engine->reach;
	}
	/* Particles per cell, found by trial: the cells of a search should hold about as many as the sieve takes at once.
	 * Where spheres are far apart, larger cells: crossing one costs more than looking at more neighbours. */
	static const double few_neighbours[] = {4, 1.5}; /* in 1 and 2 dimensions */
	int dimensions = engine->dimensions;
	double occupancy = dimensions < 3 ? few_neighbours[dimensions - 1] : 0.45 * pow(content / volume, -1.0 / 3);
	double side = engine->wanted_cell > 0 ? engine->wanted_cell
										  : pow(volume * occupancy / engine->count, 1.0 / engine->dimensions);
	side = fmax(side, reach);
	for (int axis = 0; axis < engine->dimensions; axis++) {
		if (engine->search != TOUCHSTONE_ALL)
			count[axis] = (int)fmin(fmax(floor(engine->box[axis] / side), 1), most_per_axis);
		engine->cell_side[axis] = engine->box[axis] / count[axis];
		/* sides of virtual walls are told for particles in the box */
		engine->stray[axis] = engine->side ? 0 : fmax(0, (engine->cell_side[axis] - reach) / 2);
		engine->cells.count[axis] = count[axis];
	}
	static const double far = 0.125; /* of a cell */
	bool by_faces = !engine->accelerated && engine->neighbours.skin == 0;
	engine->roomy = by_faces && engine->stray[0] > far * engine->cell_side[0];
	for (uint32_t i = 0; i < engine->count; i++) {
		const struct body *body = &engine->body[i];
		engine->itinerary[i].entered = moment_double(engine->now) - (body->page + to_double(body->time));
		for (int axis = 0; axis < engine->dimensions; axis++) {
			double coordinate = coordinate_now(engine, i, axis), box = engine->box[axis];
			if (engine->periodic[axis] && fabs(coordinate) > box / 2) { /* the image that is in the box */
				double boxes = rint(coordinate / box);
				coordinate -= boxes * box;
				for (; boxes != 0; boxes -= copysign(1, boxes)) shift_image(engine, i, axis, boxes > 0 ? -1 : 1);
			}
			engine->itinerary[i].cell[axis] = cell_of(engine, coordinate, axis);
		}
	}
	return make_cells(engine, count, 4);
}

static int compare_doubles(const void *a, const void *b)
{
	double x = *(const double *)a, y = *(const double *)b;
	return (x > y) - (x < y);
}

/* A length for the agenda's days, from how soon a sample of the particles has something to do. */
static double day_length(const struct touchstone_engine *engine)
{
	enum { SAMPLE = 1024 };
	static const double entries_per_day = 9;
	double wait[SAMPLE], now = moment_double(engine->now);
	uint32_t found = 0, stride = engine->count / SAMPLE + 1;
	for (uint32_t i = 0; i < engine->count; i += stride) {
		const struct itinerary *itinerary = &engine->itinerary[i];
		uint8_t next;
		double page = 0, key = leaving(engine, i, &page, &next), soonest = page + key - now;
		if (engine->itinerary[i].meets != MEETS_NOTHING)
			soonest = fmin(soonest, itinerary->page + to_double(itinerary->time) - now);
		if (soonest > 0 && soonest < INFINITY) wait[found++] = soonest;
	}
	double day = fmin(engine->page_length, 1);
	if (found) {
		qsort(wait, found, sizeof *wait, compare_doubles);
		double part = fmax(0.1, 1.0 / found);
		day = wait[(uint32_t)(part * found + 0.5) - 1] * entries_per_day / (part * engine->count);
	}
	int exponent;
	frexp(day, &exponent);
	return fmin(ldexp(1, exponent - 1), engine->page_length);
}

/* Lays out the agenda anew and enters every particle. */
static bool lay_out_agenda(struct touchstone_engine *engine, double day)
{
	size_t days = 64;
	while (days < engine->count / 8) days *= 2;
	agenda_destroy(&engine->agenda);
	if (!agenda_create(&engine->agenda, day, days, engine->now.page, to_double(engine->now.time))) return false;
	for (uint32_t i = 0; i < engine->count; i++) schedule(engine, i);
	return !engine->agenda.exhausted;
}

/* Predicts every particle's next event. */
static bool look_ahead(struct touchstone_engine *engine)
{
	cast_shadows(engine);
	if (!list_neighbours(engine)) return false;
	for (uint32_t i = 0; i < engine->count; i++) predict(engine, i);
	return lay_out_agenda(engine, day_length(engine));
}

/* Lays out everything for the state as it is. */
static bool lay_out(struct touchstone_engine *engine)
{
	return (engine->count < 2 || lay_out_cells(engine)) && look_ahead(engine);
}
