/* A ball over a plate and nothing else (2014 paper, section 5). */

/* The gap, as eq. 12 writes it or with the contact position computed once. */
static num drop_gap(num position, num plate, num contact, unsigned order)
{
	return order % 2 ? sub(position, add(plate, contact)) : sub(sub(position, plate), contact);
}

/* The flight r + v t + g t^2 / 2, summed in one of three ways. */
static num drop_flight(num position, num speed, num gravity, num wait, unsigned order)
{
	num half = from_double(0.5), bend = mul(mul(half, gravity), mul(wait, wait));
	switch (order / 2) {
	case 0:
		return add(add(position, mul(speed, wait)), bend);
	case 1:
		return add(position, add(mul(speed, wait), bend));
	default:
		return add(position, mul(wait, add(speed, mul(mul(half, gravity), wait))));
	}
}

static struct touchstone_landing drop_one(const struct method *method, const struct touchstone_drop *drop,
										  touchstone_bounce *bounce, void *context)
{
	/* A time that has once failed to advance goes on failing: the ball is then at or below contact, where its next
	 * flight is no longer than twice its speed over |g|. */
	enum { ENOUGH = 16 };
	struct touchstone_landing landing = {.verdict = TOUCHSTONE_DONE};
	num zero = from_double(0), contact = from_double(0.5), plate = zero;
	for (int term = 0; term < TOUCHSTONE_MOST_TERMS && drop->plate[term] != 0; term++)
		plate = add(plate, from_double(drop->plate[term]));
	num gravity = from_double(drop->gravity), restitution = from_double(drop->restitution);
	num position = add(plate, from_double(1)), speed = zero, time = zero;
	expand(plate, landing.plate, TOUCHSTONE_MOST_TERMS);
	expand(position, landing.start, TOUCHSTONE_MOST_TERMS);
	for (int stalled = 0; stalled < ENOUGH && landing.events < drop->most; landing.events++) {
		num gap = drop_gap(position, plate, contact, drop->order);
		struct flight flight = {gap, speed, gravity, zero};
		struct quadratic f;
		num wait = method->ball_plane(&flight, &f);
		bool backwards = method->policy & POLICY_BACKWARDS;
		if (!is_finite(wait) || (less(wait, zero) && !backwards)) {
			landing.verdict = TOUCHSTONE_HALTED;
			break;
		}
		position = drop_flight(position, speed, gravity, wait, drop->order);
		speed = negated(mul(restitution, add(speed, mul(gravity, wait))));
		num next = add(time, wait);
		stalled = less(time, next) ? 0 : stalled + 1;
		time = next;
		if (bounce)
			bounce(context, to_double(time), to_double(drop_gap(position, plate, contact, drop->order)),
				   to_double(speed));
		if (stalled == ENOUGH) landing.verdict = TOUCHSTONE_COLLAPSED;
	}
	expand(time, landing.time, TOUCHSTONE_MOST_TERMS);
	landing.gap = to_double(drop_gap(position, plate, contact, drop->order));
	return landing;
}

static bool unit_drop(const char *method, const struct touchstone_drop *drop, size_t count,
					  struct touchstone_landing *landing, touchstone_bounce *bounce, void *context, char error[160])
{
	const struct method *chosen = find_policy(method, error);
	if (!chosen) return false;
	for (size_t i = 0; i < count; i++) landing[i] = drop_one(chosen, &drop[i], bounce, context);
	return true;
}
