/* What an event does: flight to contact, impulse, and the record of it. */

/* Restitution at an impact with normal speed `speed`. The viscoelastic law is the Pade form of Mueller and Poeschel
 * 2011 (Phys. Rev. E 84, 021302) in v* = beta^(1/2) speed^(1/10). It is a model, evaluated in double for every
 * arithmetic, with a root found by Newton's method so that every machine agrees on it. */
static double restitution_at(struct touchstone_restitution law, double speed)
{
	if (law.law == TOUCHSTONE_CONSTANT) return law.coefficient;
	if (!(speed > 0)) return 1;
	int exponent;
	double fraction = frexp(speed, &exponent), root = 1;
	for (; exponent % 5; exponent++) fraction /= 2;
	for (int i = 0; i < 12; i++) root = (4 * root + fraction / (root * root * root * root)) / 5;
	double x = sqrt(law.coefficient) * sqrt(ldexp(root, exponent / 5));
	return (1 + 0.501086 * x) / (1 + x * (0.501086 + x * (1.15345 + x * (0.577977 + x * 0.532178))));
}

static const uint64_t first_digest = UINT64_C(0x746f756368);

static uint64_t mix(uint64_t digest, uint64_t word)
{
	digest = (digest ^ word) * UINT64_C(0x9e3779b97f4a7c15);
	return digest ^ digest >> 32;
}

static uint64_t bits_of(double x)
{
	uint64_t bits;
	memcpy(&bits, &x, sizeof bits);
	return bits;
}

/* Writes a finite x as a sum of doubles, each the nearest to what is left; returns how many. The same for every
 * arithmetic that holds the same number. */
static int expand(num x, double *terms, int most)
{
	int count = 0;
	for (; count < most; count++) {
		terms[count] = to_double(x);
		if (terms[count] == 0 || !isfinite(terms[count])) break;
		x = sub(x, from_double(terms[count]));
	}
	return count;
}

/* Mixes in the moment that is now. */
static uint64_t mix_now(const struct touchstone_engine *engine, uint64_t digest)
{
	double terms[TOUCHSTONE_MOST_TERMS];
	digest = mix(digest, bits_of(engine->now.page + 0.0));
	int count = expand(engine->now.time, terms, TOUCHSTONE_MOST_TERMS);
	for (int i = 0; i < count; i++) digest = mix(digest, bits_of(terms[i]));
	return digest;
}

/* Enters an event into the digest: its rank says kind and particles, its moment when. */
static void record(struct touchstone_engine *engine, uint64_t rank)
{
	static const uint64_t images = 63; /* of no meaning outside: when a particle changes its image is bookkeeping */
	engine->digest = mix_now(engine, mix(engine->digest, rank & ~images));
	engine->events++;
}

/* Counts an event, with another entry or a wall, against a particle for which hardly any time has passed since its last
 * one. Many simultaneous contacts in a row are in order (each of n balls in a cradle has up to n); far beyond that a
 * particle is not getting anywhere. */
static void count_stall(struct touchstone_engine *engine, uint32_t i, uint8_t meets, uint32_t other, bool stalled)
{
	struct itinerary *itinerary = &engine->itinerary[i];
	itinerary->stalls = stalled ? itinerary->stalls + 1 : 0;
	if (itinerary->stalls < 256 + 4 * engine->count || engine->verdict != TOUCHSTONE_DONE) return;
	engine->verdict = TOUCHSTONE_COLLAPSED;
	engine->blamed[0] = engine->blamed[1] = itinerary->id;
	if (with_particle(meets)) engine->blamed[1] = other = engine->itinerary[entry_particle(other)].id;
	snprintf(engine->reason, sizeof engine->reason, "%u events of particle %u (the last with %s %u) at t = %.17g",
			 itinerary->stalls, itinerary->id, met_name(meets), other, moment_double(engine->now));
}

/* Whether a particle's last event was now, as far as the clock can tell: within two units in its last place. (A ball
 * at rest may go on for ever by one such unit a bounce, when its flights round up to it.) */
static bool stalls(const struct touchstone_engine *engine, uint32_t i)
{
	const struct body *body = &engine->body[i];
	num since = add(sub(engine->now.time, body->time), from_double(engine->now.page - body->page));
	num clock = engine->page_length < INFINITY ? from_double(engine->page_length) : engine->now.time;
	return !less(mul(engine->two_units, clock), since);
}

/* How many representable numbers `x` lies above `reference` (near it); the step below a power of two is half. */
static int64_t steps_between(num reference, num x, int bits)
{
	int exponent;
	double fraction = frexp(to_double(reference), &exponent), distance = to_double(sub(x, reference));
	bool finer = distance < 0 && fraction == 0.5;
	double steps = ldexp(distance, bits - exponent + finer);
	return fabs(steps) < 0x1p62 ? (int64_t)rint(steps) : steps < 0 ? INT64_MIN : INT64_MAX;
}

/* Tells the observer of an event, of which `event` holds what is not given here. */
static void tell(struct touchstone_engine *engine, struct touchstone_event *event, uint32_t i, uint32_t other,
				 num distance, num contact, num approach, num impulse)
{
	bool pair = with_particle((uint8_t)event->kind);
	event->first = engine->itinerary[i].id;
	event->second = pair ? engine->itinerary[other].id : other;
	event->time = moment_double(engine->now);
	event->approach = to_double(approach);
	event->impulse = fabs(to_double(impulse));
	event->distance = to_double(distance);
	event->steps = steps_between(contact, distance, engine->bits);
	if (pair && event->second < event->first) {
		uint32_t first = event->second;
		event->second = event->first, event->first = first;
	}
	engine->observer->event(engine->observer->context, engine, event);
}

/* Two particles at the moment of their event. */
struct encounter {
	uint32_t i, j, entry;
	bool i_stalls, j_stalls;
	num r[3], v[3], rr, rv;
};

/* Flies particle i and an entry to now. */
static inline struct encounter bring_together(struct touchstone_engine *engine, uint32_t i, uint32_t entry)
{
	uint32_t j = entry_particle(entry);
	struct encounter encounter;
	encounter.i = i, encounter.j = j, encounter.entry = entry;
	encounter.i_stalls = stalls(engine, i), encounter.j_stalls = stalls(engine, j);
	struct body *first = &engine->body[i], *second = &engine->body[j];
	advance(engine, first, &engine->place[i], engine->now);
	advance(engine, second, &engine->place[j], engine->now);
	num *r = encounter.r, *v = encounter.v, zero = from_double(0);
	r[1] = r[2] = v[1] = v[2] = zero;
	for (int axis = 0; axis < engine->dimensions; axis++) {
		r[axis] = offset_between(engine, i, j, entry_image(entry, axis), axis);
		v[axis] = sub(first->velocity[axis], second->velocity[axis]);
	}
	encounter.rr = dot(r, r);
	encounter.rv = dot(r, v);
	return encounter;
}

/* Speed with which the two come nearer, and how far apart they are. */
static inline num approach_of(const struct encounter *encounter, num *distance)
{
	*distance = root(encounter->rr);
	return negated(divide(encounter->rv, *distance));
}

/* Names the pair to an observer, and tells it of the event. */
static void tell_pair(struct touchstone_engine *engine, const struct encounter *encounter,
					  struct touchstone_event *event, num at, num to_first)
{
	uint32_t i = encounter->i, j = encounter->j;
	bool in_order = engine->itinerary[i].id < engine->itinerary[j].id;
	num distance, approach = approach_of(encounter, &distance), mass = engine->mass[engine->place[i].species];
	engine->touching[0] = in_order ? i : j, engine->touching[1] = in_order ? j : i;
	engine->touching_distance = at;
	for (int axis = 0; axis < engine->dimensions; axis++) {
		int image = entry_image(encounter->entry, axis);
		engine->touching_image[axis] = in_order ? image : -image;
	}
	tell(engine, event, i, j, distance, at, approach, mul(mul(mass, to_first), distance));
}

/* Two particles whose event is at the distance `at` part with changed velocities: r times the kick is taken from their
 * relative velocity, from either by its mass. */
static inline void part(struct touchstone_engine *engine, const struct encounter *encounter, num kick,
						struct touchstone_event *event, num at)
{
	uint32_t i = encounter->i, j = encounter->j;
	if (!is_finite(kick)) {
		engine->verdict = TOUCHSTONE_DIVERGED;
		engine->blamed[0] = engine->itinerary[i].id, engine->blamed[1] = engine->itinerary[j].id;
		snprintf(engine->reason, sizeof engine->reason,
				 "the impulse between particles %u and %u is not finite, at t = %.17g", engine->blamed[0],
				 engine->blamed[1], moment_double(engine->now));
		return;
	}
	num to_first = from_double(0.5), to_second = to_first;
	if (engine->species_count > 1) {
		num mine = engine->mass[engine->place[i].species], yours = engine->mass[engine->place[j].species];
		num both = add(mine, yours);
		to_first = divide(yours, both);
		to_second = divide(mine, both);
	}
	to_first = mul(to_first, kick);
	to_second = mul(to_second, kick);
	if (engine->observer) tell_pair(engine, encounter, event, at, to_first);
	struct body *first = &engine->body[i], *second = &engine->body[j];
	for (int axis = 0; axis < engine->dimensions; axis++) {
		first->velocity[axis] = sub(first->velocity[axis], mul(to_first, encounter->r[axis]));
		second->velocity[axis] = add(second->velocity[axis], mul(to_second, encounter->r[axis]));
	}
	if (engine->method->policy & POLICY_NUDGE) {
		bool inside = event->kind == TOUCHSTONE_CAPTURE ||
					  (event->kind == TOUCHSTONE_BOUNCE && !less(encounter->rv, from_double(0)));
		nudge(engine, i, j, encounter->r, encounter->rr, at, inside, divide(to_first, add(to_first, to_second)));
	}
	record(engine, rank_of(engine, i, encounter->entry, (uint8_t)event->kind));
	engine->kinds[event->kind]++;
	engine->itinerary[i].changes++;
	engine->itinerary[j].changes++;
	count_stall(engine, i, (uint8_t)event->kind, j, encounter->i_stalls);
	count_stall(engine, j, (uint8_t)event->kind, i, encounter->j_stalls);
}

static void exchange_heat(struct touchstone_engine *engine, uint32_t i, uint32_t j);
static void take_heat(struct touchstone_engine *engine, uint32_t i, const struct wall *wall);
static void draw_velocity(const struct touchstone_engine *engine, uint32_t i, const struct wall *wall, num velocity[3]);
static void leave_thermal_wall(struct touchstone_engine *engine, uint32_t i, const num velocity[3]);

/* Two particles collide (2014 paper, eqs. 3 to 5). */
static void collide(struct touchstone_engine *engine, uint32_t i, uint32_t entry)
{
	bool brief =
		engine->method->policy & POLICY_BRIEF_ELASTIC && (lately(engine, i) || lately(engine, entry_particle(entry)));
	struct encounter encounter = bring_together(engine, i, entry);
	struct touchstone_restitution law = restitution_between(engine, i, encounter.j);
	double restitution = 1, speed = 0;
	if (!engine->elastic && !brief) {
		num distance;
		if (law.law != TOUCHSTONE_CONSTANT) speed = to_double(approach_of(&encounter, &distance));
		restitution = restitution_at(law, speed);
	}
	num kick = mul(add(from_double(1), from_double(restitution)), divide(encounter.rv, encounter.rr));
	int state = (int)state_of(engine, i, entry);
	struct touchstone_event event = {.kind = TOUCHSTONE_CONTACT, .before = state, .after = state};
	part(engine, &encounter, kick, &event, contact_distance(engine, i, encounter.j));
	if (engine->temperature && !engine->elastic) exchange_heat(engine, i, encounter.j);
}

/* A particle meets a wall. */
static void rebound(struct touchstone_engine *engine, uint32_t i, uint32_t number)
{
	const struct wall *wall = &engine->wall[number];
	bool stalled = stalls(engine, i), brief = engine->method->policy & POLICY_BRIEF_ELASTIC && lately(engine, i);
	struct body *body = &engine->body[i];
	advance(engine, body, &engine->place[i], engine->now);
	struct flight over = over_wall(engine, i, wall);
	bool thermal = engine->thermostat > 0 && !engine->elastic;
	double coefficient = engine->elastic || brief ? 1 : restitution_at(wall->restitution, -to_double(over.speed));
	num kick = mul(add(from_double(1), from_double(coefficient)), over.speed), leaves[3];
	if (thermal) {
		draw_velocity(engine, i, wall, leaves);
		kick = sub(over.speed, dot(wall->normal, leaves));
	}
	if (engine->observer) {
		uint32_t species = engine->place[i].species;
		num contact = engine->radius[species];
		struct touchstone_event event = {.kind = TOUCHSTONE_WALL};
		tell(engine, &event, i, number, add(over.distance, contact), contact, negated(over.speed),
			 mul(engine->mass[species], kick));
	}
	if (thermal)
		leave_thermal_wall(engine, i, leaves);
	else
		for (int axis = 0; axis < engine->dimensions; axis++)
			body->velocity[axis] = sub(body->velocity[axis], mul(kick, wall->normal[axis]));
	if (engine->temperature && !engine->elastic) take_heat(engine, i, wall);
	record(engine, rank_of(engine, i, number, TOUCHSTONE_WALL));
	engine->kinds[TOUCHSTONE_WALL]++;
	engine->itinerary[i].changes++;
	count_stall(engine, i, TOUCHSTONE_WALL, number, stalled);
}
