/* Other units of time, larger or smaller by a power of two: every speed and every moment changes its exponent, and no
 * number is rounded. Pages stay as long as they are, so that a gas that has cooled has again as few of them between two
 * collisions as it had, and a time within one is again as fine. */

/* Whether nothing but what speeds are counted in tells one temperature from another. */
static bool scales(const struct touchstone_engine *engine)
{
	bool constant = engine->restitution.law == TOUCHSTONE_CONSTANT;
	for (size_t w = 0; w < engine->wall_count; w++) constant &= engine->wall[w].restitution.law == TOUCHSTONE_CONSTANT;
	for (size_t p = 0; p < engine->potential_count; p++)
		constant &= !engine->potential[p].step_count && engine->potential[p].restitution.law == TOUCHSTONE_CONSTANT;
	return constant && !engine->accelerated;
}

static struct moment moment_scaled(struct moment moment, num factor, double page_factor)
{
	return (struct moment){moment.page * page_factor, mul(moment.time, factor)};
}

static bool engine_rescale(struct touchstone_engine *engine, int exponent)
{
	static const int most = 64; /* in one step */
	if (!scales(engine) || exponent < -most || exponent > most) return false;
	double slower = ldexp(1, -exponent);
	num speed = from_double(ldexp(1, exponent)), time = from_double(slower);
	for (uint32_t i = 0; i < engine->count; i++) {
		struct body *body = &engine->body[i];
		struct moment last = moment_scaled((struct moment){body->page, body->time}, time, slower);
		body->page = last.page;
		body->time = last.time;
		for (int axis = 0; axis < engine->dimensions; axis++) body->velocity[axis] = mul(body->velocity[axis], speed);
		if (engine->crossed) engine->crossed[i] = moment_scaled(engine->crossed[i], time, slower);
	}
	engine->now = moment_scaled(engine->now, time, slower);
	engine->uneven |= exponent > 0 && engine->page_turn > 0;
	engine->slack = slack_needed(engine, moment_double(engine->now), typical_speed(engine));
	if (!lay_out(engine)) out_of_memory(engine);
	return true;
}
