/* What the sieve is told of the scene: shadows in units near the contact distance and the time in which a typical
 * particle flies so far, with time counted from a base that follows the run. */

/* Time from the shadows' base to a moment, in their unit. */
static double since_base(const struct touchstone_engine *engine, double page, double time)
{
	const struct shadows *shadows = &engine->shadows;
	return ((page - shadows->base_page) + (time - shadows->base_time)) * shadows->per_time;
}

/* Renews the shadow of a particle for the time of the search. */
static void cast_shadow(struct touchstone_engine *engine, uint32_t i)
{
	struct shadows *shadows = &engine->shadows;
	if (!shadows->shadow) return;
	const struct body *body = &engine->body[i];
	const struct place *place = &engine->place[i];
	double flight = shadows->now - since_base(engine, body->page, to_double(body->time)), position[3], velocity[3];
	for (int axis = 0; axis < 3; axis++) {
		velocity[axis] = to_double(body->velocity[axis]) * shadows->per_speed;
		position[axis] = coordinate_in_image(engine, i, axis) * shadows->per_length + velocity[axis] * flight;
	}
	double radius = shadows->radius[place->species] * shadows->per_length;
	shadows->machine->cast(&shadows->shadow[i], position[0], position[1], position[2], shadows->now, velocity[0],
						   velocity[1], velocity[2], radius);
}

/* The time of the search is that of the last event: no event of a pair is earlier, and none that is left is. */
static void keep_time(struct touchstone_engine *engine)
{
	struct shadows *shadows = &engine->shadows;
	struct sieve *sieve = &shadows->sieve;
	double clock = engine->page_length < INFINITY ? engine->page_length : moment_double(engine->now);
	shadows->now = since_base(engine, engine->now.page, to_double(engine->now.time));
	sieve->now = sieve->span = (float)shadows->now;
	sieve->age = (float)(shadows->age + shadows->now);
	clock *= shadows->per_time;
	sieve->drift = (float)(16 * (sieve->roundoff * sieve->age + 0x1p-53 * (sieve->age + clock)));
	sieve->late = (float)(4 * (sieve->roundoff + 0x1p-53) * (sieve->age + clock));
}

static const double shadows_last = 64; /* units of time: the error of a time in binary32 grows as long */

static double typical_speed(const struct touchstone_engine *engine)
{
	double sum = 0;
	for (uint32_t i = 0; i < engine->count; i++)
		for (int axis = 0; axis < engine->dimensions; axis++) {
			double speed = to_double(engine->body[i].velocity[axis]);
			sum += speed * speed;
		}
	return sqrt(sum / engine->count);
}

static double power_of_two_below(double x)
{
	int exponent;
	frexp(x, &exponent);
	return ldexp(1, exponent - 1);
}

/* Begins anew from where the run is: base, units, and every shadow. */
static void cast_shadows(struct touchstone_engine *engine)
{
	struct shadows *shadows = &engine->shadows;
	if (!shadows->shadow) return;
	double speed = typical_speed(engine);
	shadows->base_page = engine->now.page;
	shadows->base_time = to_double(engine->now.time);
	shadows->per_length = 1 / power_of_two_below(engine->reach);
	shadows->per_time = speed > 0 && speed < INFINITY ? power_of_two_below(speed) * shadows->per_length : 1;
	shadows->per_speed = shadows->per_length / shadows->per_time;
	shadows->now = shadows->age = 0;
	for (uint32_t i = 0; i < engine->count; i++) {
		const struct body *body = &engine->body[i];
		shadows->age = fmax(shadows->age, -since_base(engine, body->page, to_double(body->time)));
		cast_shadow(engine, i);
	}
	struct sieve *sieve = &shadows->sieve;
	double place = 0;
	sieve->boxes = 0;
	for (int axis = 0; axis < 3; axis++) {
		if (axis < engine->dimensions) place = fmax(place, engine->place_width[axis]);
		sieve->box[axis] = engine->periodic[axis] ? (float)(engine->box[axis] * shadows->per_length) : 0;
		sieve->boxes += sieve->box[axis];
	}
	sieve->roundoff = (float)ldexp(1, -engine->bits);
	sieve->grain = (float)ldexp(place * shadows->per_length, 1 - engine->bits);
	sieve->by_order = engine->method->sieve == SIEVE_ORDER;
	keep_time(engine);
}

/* What comes after the plan is of no interest: in the sieve's time, from now. */
static float latest_planned(const struct touchstone_engine *engine, const struct plan *plan)
{
	const struct sieve *sieve = &engine->shadows.sieve;
	if (!sieve->by_order || plan->meets == MEETS_NOTHING) return INFINITY;
	double latest = since_base(engine, plan->moment.page, to_double(plan->moment.time)) - engine->shadows.now;
	return (float)(latest * (latest > 0 ? 1.0001 : 1) + 0x1p-20 + sieve->late);
}

/* Pairs of one particle, and when each of them may have its next event. */
enum { FORESEEN = 64 };
struct forecast {
	const struct pair_state *pair;
	uint32_t count, more;         /* each holds so much more than its state */
	uint32_t first;               /* which of them may have the first event, */
	float soonest[FORESEEN + 16]; /* and the times after the search's before which they have none */
};

/* Whether this is of use: whether pairs may be left out for others. */
static bool sieves_states(const struct touchstone_engine *engine)
{
	return engine->shadows.shadow && engine->method->sieve == SIEVE_ORDER;
}

/* Foresees `count` pairs of particle i, no more than FORESEEN. */
static void foresee(struct touchstone_engine *engine, uint32_t i, const struct pair_state *pair, uint32_t count,
					uint32_t more, struct forecast *forecast)
{
	struct shadows *shadows = &engine->shadows;
	uint32_t entry[FORESEEN + 16], images = 0;
	float outer[FORESEEN + 16], inner[FORESEEN + 16], scale = (float)shadows->per_length;
	const struct limits *limits = engine->species_count == 1 ? engine->potential->limits : NULL;
	forecast->pair = pair;
	forecast->count = count;
	forecast->more = more;
	forecast->first = 0;
	forecast->soonest[0] = INFINITY;
	if (!count) return;
	for (uint32_t k = 0; k < count; k++) {
		uint32_t state = pair[k].state - more;
		entry[k] = pair[k].entry;
		images |= entry[k];
		struct limits own = limits ? limits[state] : limits_of(engine, i, entry_particle(entry[k]), state);
		outer[k] = own.outer * scale;
		inner[k] = own.inner * scale;
	}
	for (uint32_t k = count; k < count + 16; k++) entry[k] = entry[0], outer[k] = inner[k] = 1;
	shadows->sieve.images = images >> ENTRY_BITS;
	struct held held = {entry, outer, inner};
	forecast->first =
		(uint32_t)shadows->machine->hold(&shadows->sieve, shadows->shadow, i, &held, count, forecast->soonest);
	__builtin_prefetch(&engine->body[entry_particle(entry[forecast->first])]);
}

/* Of the entries listed for one or two particles, keeps those that they may meet before their plans. */
static void sift(struct touchstone_engine *engine, const uint32_t *particle, int particles, size_t *candidates,
				 const struct plan *plan)
{
	struct shadows *shadows = &engine->shadows;
	if (!shadows->shadow) return;
	struct sieve_search search[2];
	shadows->sieve.images = false;
	for (int p = 0; p < particles; p++) {
		shadows->sieve.images |= cells_at_border(&engine->cells, engine->itinerary[particle[p]].cell);
		search[p] =
			(struct sieve_search){particle[p], engine->candidate[p], candidates[p], latest_planned(engine, &plan[p])};
	}
	shadows->machine->pass(&shadows->sieve, shadows->shadow, search, particles);
	for (int p = 0; p < particles; p++) {
		candidates[p] = search[p].count;
		/* Mostly one, and seldom more than two. A loop over so many as there are would have to be guessed. */
		for (int k = 0; k < 2; k++) {
			uint32_t other = entry_particle(engine->candidate[p][k]);
			__builtin_prefetch(&engine->body[other]);
			__builtin_prefetch(&engine->place[other]);
			__builtin_prefetch(&engine->itinerary[other]);
		}
	}
}
