/* What methods have the engine do besides asking their finder (enum policy). */

/* ------------------------------------------------------------------ times before now */

/* Weighs an event whose time is negative or no number: one before now, or the end. */
static void consider_odd(struct touchstone_engine *engine, uint32_t i, const struct body *later, num wait,
						 uint8_t meets, uint32_t partner, struct plan *plan)
{
	bool backwards = engine->method->policy & POLICY_BACKWARDS && is_finite(wait);
	if (backwards)
		consider_moment(engine, i, moment_back_on(engine, later->page, add(later->time, wait)), meets, partner, plan);
	else
		halt(engine, i, later, wait, meets, partner);
}

/* Whether the run has gone back so far that cells, which are kept for the latest moment, may hide a neighbour: a
 * quarter of their slack is left to this. From here on there is more of it, or no cells at all where it would be as
 * wide as what they are for; they have to be laid out anew. */
static bool far_back(struct touchstone_engine *engine)
{
	if (!moment_before(engine->now, engine->latest)) {
		engine->latest = engine->now;
		return false;
	}
	if (engine->search == TOUCHSTONE_ALL) return false;
	double fastest = 0, back = moment_double(engine->latest) - moment_double(engine->now);
	for (uint32_t i = 0; i < engine->count; i++) {
		double square = 0;
		for (int axis = 0; axis < engine->dimensions; axis++) {
			double speed = to_double(engine->body[i].velocity[axis]);
			square += speed * speed;
		}
		fastest = fmax(fastest, square);
	}
	double needed = 4 * back * sqrt(fastest);
	if (needed <= engine->slack) return false;
	engine->slack = 4 * needed; /* so that this is seldom */
	if (!(engine->slack < engine->reach)) engine->search = TOUCHSTONE_ALL;
	return true;
}

/* ------------------------------------------------------------------ contacts moved back */

/* A particle and what it meets, flown from their last events to a moment. */
struct approach {
	num depth; /* how far they overlap, in a measure that is 0 or less where they do not */
	num contact, speed;
};

static struct approach approach_at(const struct touchstone_engine *engine, uint32_t i, uint8_t meets, uint32_t partner,
								   struct moment moment)
{
	struct body first = engine->body[i];
	struct place place = engine->place[i];
	advance(engine, &first, &place, moment);
	if (meets == TOUCHSTONE_WALL) {
		num radius = engine->radius[place.species], zero = from_double(0);
		struct flight over = over_plane(engine, &first, &place, &engine->wall[partner], radius);
		num speed = less(over.speed, zero) ? negated(over.speed) : over.speed;
		return (struct approach){negated(over.distance), radius, speed};
	}
	uint32_t j = entry_particle(partner);
	struct body second = engine->body[j];
	struct place others = engine->place[j];
	advance(engine, &second, &others, moment);
	num r[3], v[3], contact = contact_distance(engine, i, j);
	r[1] = r[2] = v[1] = v[2] = from_double(0);
	for (int axis = 0; axis < engine->dimensions; axis++) {
		r[axis] = offset_of(engine, &first, &place, &second, &others, entry_image(partner, axis), axis);
		v[axis] = sub(first.velocity[axis], second.velocity[axis]);
	}
	return (struct approach){sub(mul(contact, contact), dot(r, r)), contact, root(dot(v, v))};
}

/* If the bodies of an event overlap now, moves now back along their path to where they do not, but no farther than to
 * the later of their last events (method/search.inl). */
static void search_back(struct touchstone_engine *engine, uint32_t i, uint8_t meets, uint32_t partner)
{
	num zero = from_double(0);
	struct approach approach = approach_at(engine, i, meets, partner, engine->now);
	num step = search_step(approach.contact, approach.speed, engine->search_part);
	struct moment began = {engine->body[i].page, engine->body[i].time}, found = engine->now, trial;
	if (with_particle(meets)) {
		const struct body *other = &engine->body[entry_particle(partner)];
		if (moment_before(began, (struct moment){other->page, other->time}))
			began = (struct moment){other->page, other->time};
	}
	while (less(zero, approach.depth)) {
		trial = moment_back_on(engine, engine->now.page, sub(engine->now.time, step));
		found = moment_before(began, trial) ? trial : began;
		if (!moment_before(began, trial)) break;
		approach = approach_at(engine, i, meets, partner, found);
		step = add(step, step);
	}
	engine->now = found;
}

/* ------------------------------------------------------------------ contacts found early */

/* Bodies that are nearer than the longer distance are asked about at the true one. */
static num early_meeting(const struct touchstone_engine *engine, struct balls *balls, struct quadratic *f)
{
	num contact = balls->contact;
	balls->contact = add(contact, engine->margin);
	num wait = engine->method->ball_ball(balls, f);
	if (!less(wait, from_double(0))) return wait;
	balls->contact = contact;
	return engine->method->ball_ball(balls, f);
}

static num early_landing(const struct touchstone_engine *engine, struct flight *flight, struct quadratic *f)
{
	num contact = flight->contact;
	flight->contact = add(contact, engine->margin);
	num wait = engine->method->ball_plane(flight, f);
	if (!less(wait, from_double(0)) && !isnan(to_double(wait))) return wait;
	flight->contact = contact;
	return engine->method->ball_plane(flight, f);
}

/* ------------------------------------------------------------------ collisions soon after another */

/* Whether a particle's collision now is to cost no energy. */
static bool lately(const struct touchstone_engine *engine, uint32_t i)
{
	const struct body *body = &engine->body[i];
	num since = add(sub(engine->now.time, body->time), from_double(engine->now.page - body->page));
	return tc_elastic(since, engine->contact_time);
}

/* ------------------------------------------------------------------ from the scene, and to people */

/* What the scene says, or what the methods' files say where it does not. */
static void read_policy(struct touchstone_engine *engine, const struct touchstone_scene *scene)
{
	double roundoff = ldexp(1, -engine->bits), pull = 0, speed = typical_speed(engine);
	for (int axis = 0; axis < engine->dimensions; axis++) pull = fmax(pull, fabs(scene->acceleration[axis]));
	speed = fmax(speed, sqrt(pull * engine->largest));
	double brief = scene->contact_time > 0 ? scene->contact_time : speed > 0 ? 0x1p-20 * engine->largest / speed : 0;
	engine->contact_time = from_double(brief);
	double part = scene->shrinking > 0 ? scene->shrinking : 64 * roundoff;
	engine->margin = from_double(part * engine->largest);
	engine->search_part = (scene->search_step > 0 ? scene->search_step : 1) * roundoff;
	engine->latest = engine->now;
	if (engine->method->policy & POLICY_EARLY) engine->reach += to_double(engine->margin);
}

static void explain_policy(const struct touchstone_engine *engine, void (*line)(void *context, const char *text),
						   void *context)
{
	char text[240];
	unsigned policy = engine->method->policy;
	if (policy & POLICY_BACKWARDS) line(context, "policy: a negative time is executed, and time goes back");
	if (policy & POLICY_SEARCH) {
		snprintf(text, sizeof text,
				 "policy: a contact that is an overlap is moved back, by steps from %.3g of the contact distance on",
				 engine->search_part);
		line(context, text);
	}
	if (policy & POLICY_EARLY) {
		snprintf(text, sizeof text, "policy: contacts are looked for %.6g early", to_double(engine->margin));
		line(context, text);
	}
	if (policy & POLICY_BRIEF_ELASTIC) {
		snprintf(text, sizeof text, "policy: elastic within %.6g after a collision", to_double(engine->contact_time));
		line(context, text);
	}
}
