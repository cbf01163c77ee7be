/* What the sieve is told of the scene: shadows in units near the contact distance and the time in which a typical
 * particle flies so far, with time counted from a base that follows the run. */

/* Time from the shadows' base to a moment, in their unit. */
static double since_base(const struct touchstone_engine *engine, double page, double time)
{
	const struct shadows *shadows = &engine->shadows;
	return ((page - shadows->base_page) + (time - shadows->base_time)) * shadows->per_time;
}

/* Renews the shadow of a particle for the time of the search. */
static void cast_shadow(const struct touchstone_engine *engine, uint32_t i)
{
	const struct shadows *shadows = &engine->shadows;
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

/* From now to the latest moment of the run, where it may have gone back. */
static double gone_back(const struct touchstone_engine *engine)
{
	if (!(engine->method->policy & (POLICY_BACKWARDS | POLICY_SEARCH))) return 0;
	return fmax(0, since_base(engine, engine->latest.page, to_double(engine->latest.time)) - engine->shadows.now);
}

/* The time of the search is that of the last event: no event of a pair is earlier, and none that is left is. Where time
 * has gone back, others may have had their last events after it, though not after the latest moment of the run. */
static void keep_time(struct touchstone_engine *engine)
{
	struct shadows *shadows = &engine->shadows;
	struct sieve *sieve = &shadows->sieve;
	double clock = engine->page_length < INFINITY ? engine->page_length : moment_double(engine->now);
	shadows->now = since_base(engine, engine->now.page, to_double(engine->now.time));
	shadows->back = gone_back(engine);
	sieve->now = (float)shadows->now;
	sieve->span = fmaxf(sieve->span, fabsf(sieve->now));
	shadows->oldest = (float)fmax(shadows->age + shadows->now, shadows->back);
	clock *= shadows->per_time;
	double rounded = (sieve->roundoff + 0x1p-53) * (shadows->oldest + clock);
	sieve->drift = (float)(8 * rounded);
	sieve->late = (float)(4 * rounded);
}

/* How long ago at most the last events of those were that search; or how long after now those of others may be. */
static float age_of(const struct touchstone_engine *engine, const uint32_t *particle, int particles)
{
	const struct shadows *shadows = &engine->shadows;
	double age = shadows->back;
	for (int p = 0; p < particles; p++) {
		const struct body *body = &engine->body[particle[p]];
		double since = shadows->now - since_base(engine, body->page, to_double(body->time));
		age = since > age ? since : age;
	}
	return (float)(age * (1 + 0x1p-20));
}

/* Units of time: the error of a time in binary32 grows as long, and so does, where numbers are coarse, what is not
 * known of how long ago last events were. */
static double shadows_last(const struct touchstone_engine *engine)
{
	return engine->bits < 32 ? 16 : 64;
}

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
	sieve->boxes = sieve->span = 0;
	sieve->length = 1;
	for (int axis = 0; axis < 3; axis++) {
		if (axis < engine->dimensions) place = fmax(place, engine->place_width[axis]);
		sieve->box[axis] = engine->periodic[axis] ? (float)(engine->box[axis] * shadows->per_length) : 0;
		sieve->boxes += sieve->box[axis];
		sieve->length = fmaxf(sieve->length, (float)(1.5 * engine->cell_side[axis] * shadows->per_length));
	}
	sieve->roundoff = (float)ldexp(1, -engine->bits);
	sieve->grain = (float)ldexp(place * shadows->per_length, 1 - engine->bits);
	sieve->by_order = engine->method->sieve == SIEVE_ORDER;
	keep_time(engine);
}

/* What the working arithmetic has after a bound of the sieve's is surely not before this: both in the sieve's time,
 * from now. */
static double bound_surely(const struct touchstone_engine *engine, double bound)
{
	double least = bound - 0x1p-20 - (double)engine->shadows.sieve.late;
	return least / (least > 0 ? 1.0001 : 1);
}

/* What comes after the plan is of no interest: in the sieve's time, from now. */
static float latest_planned(const struct touchstone_engine *engine, const struct plan *plan)
{
	const struct sieve *sieve = &engine->shadows.sieve;
	if (!sieve->by_order || plan->meets == MEETS_NOTHING) return INFINITY;
	double latest = since_base(engine, plan->moment.page, to_double(plan->moment.time)) - engine->shadows.now;
	latest += (double)plan->open * engine->shadows.per_time;
	return (float)(latest * (latest > 0 ? 1.0001 : 1) + 0x1p-20 + sieve->late);
}

/* Whether it is of use to foresee pairs: whether some may be left out for others. */
static bool sieves_states(const struct touchstone_engine *engine)
{
	return engine->shadows.shadow && engine->method->sieve == SIEVE_ORDER;
}

/* Pairs of one particle, and when each of them may have its next event. */
enum { FORESEEN = 64 };
struct forecast {
	const struct pair_state *pair;
	uint32_t count, more;         /* each holds so much more than its state */
	uint32_t first;               /* which of them may have the first event, */
	float soonest[FORESEEN + 16]; /* and the times after the search's before which they have none */
	struct pair_state numbered[FORESEEN];
};

/* What the sieve is asked of the pairs of particle i: where there are many kinds, each is given the number of its
 * limits for its state. */
static struct sieve_outlook outlook_of(const struct touchstone_engine *engine, uint32_t i, struct forecast *forecast)
{
	const struct limits *limits = engine->shadows.limits;
	struct sieve_outlook outlook = {i, forecast->pair, limits, forecast->count, forecast->soonest, 0};
	if (engine->species_count == 1) {
		outlook.limits += 1 - forecast->more;
		return outlook;
	}
	for (uint32_t k = 0; k < forecast->count; k++) {
		uint32_t entry = forecast->pair[k].entry;
		size_t number = limits_number(engine, i, entry_particle(entry), forecast->pair[k].state - forecast->more);
		forecast->numbered[k] = (struct pair_state){entry, (uint32_t)number};
	}
	outlook.pair = forecast->numbered;
	return outlook;
}

/* Foresees the pairs of one or two particles, no more than FORESEEN each. */
static void foresee(struct touchstone_engine *engine, const uint32_t *particle, int particles,
					struct forecast *forecast)
{
	struct shadows *shadows = &engine->shadows;
	struct sieve_outlook outlook[2];
	for (int p = 0; p < particles; p++) {
		outlook[p] = outlook_of(engine, particle[p], &forecast[p]);
	}
	shadows->sieve.age = age_of(engine, particle, particles);
	shadows->machine->hold(&shadows->sieve, shadows->shadow, outlook, particles);
	for (int p = 0; p < particles; p++) {
		forecast[p].first = (uint32_t)outlook[p].first;
		if (forecast[p].count) ahead(&engine->body[entry_particle(forecast[p].pair[outlook[p].first].entry)]);
	}
}

static bool defer(struct touchstone_engine *engine, uint32_t i, const struct sieve_search *left, struct plan *plan);

/* Of the entries listed for one or two particles, keeps those that they may meet before their plans, unless there is
 * one that can be planned for as it is. */
static void sift(struct touchstone_engine *engine, const uint32_t *particle, int particles, size_t *candidates,
				 struct plan *plan)
{
	struct shadows *shadows = &engine->shadows;
	if (!shadows->shadow) return;
	struct sieve_search search[2];
	shadows->sieve.images = false;
	for (int p = 0; p < particles; p++) {
		shadows->sieve.images |= cells_at_border(&engine->cells, engine->itinerary[particle[p]].cell);
		search[p] = (struct sieve_search){.self = particle[p],
										  .entry = engine->candidate[p],
										  .count = candidates[p],
										  .latest = latest_planned(engine, &plan[p])};
	}
	shadows->sieve.age = age_of(engine, particle, particles);
	shadows->machine->pass(&shadows->sieve, shadows->shadow, search, particles);
	for (int p = 0; p < particles; p++) {
		candidates[p] = search[p].count;
		if (shadows->sieve.timed && defer(engine, particle[p], &search[p], &plan[p])) candidates[p] = 0;
		/* Mostly one, and seldom more than two. A loop over so many as there are would have to be guessed. */
		for (int k = 0; k < 2; k++) {
			uint32_t other = entry_particle(engine->candidate[p][k]);
			ahead(&engine->body[other]);
			ahead(&engine->place[other]);
			ahead(&engine->itinerary[other]);
		}
	}
}

/* ------------------------------------------------------------------ who is where */

enum { LOOKED_OVER = 64 };

/* Between which distances up to LOOKED_OVER entries of one particle ought to be, in the shadows' unit; more is read
 * than counts. */
struct bounds {
	uint32_t entry[LOOKED_OVER + 16];
	float inner[LOOKED_OVER + 16], outer[LOOKED_OVER + 16];
};

/* Of `count` entries of particle i, whose shadow is as of now, writes the numbers of those that may not be within their
 * bounds, in their order. */
static size_t out_of_bounds(const struct touchstone_engine *engine, uint32_t i, const uint32_t *entry,
							const struct bounds *bounds, size_t count, uint32_t kept[LOOKED_OVER + 16])
{
	const struct shadows *shadows = &engine->shadows;
	struct sieve sieve = shadows->sieve;
	struct held held = {entry, bounds->outer, bounds->inner};
	sieve.images = cells_at_border(&engine->cells, engine->itinerary[i].cell);
	sieve.age = age_of(engine, &i, 1);
	return shadows->machine->check(&sieve, shadows->shadow, i, &held, count, kept);
}
