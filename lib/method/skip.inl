/* skip: bodies that overlap are not tested until they have parted.
 *
 * Source: 2014 paper, section 3: approaches that "implicitly disable interactions between overlapped pairs". Formula: c
 * < 0 means no event; everything else is the stable rule. On a straight path two balls part once, so they do not meet
 * again before one of them has had another event. Over a plate that pulls, a ball that will rise out of it is tested
 * from there: its event is the later root; one that will not falls through.
 * Assumed, since the paper describes codes of others and no code: overlapped is c < 0, without a tolerance, so that
 * touching bodies are tested.
 *
 * Bound: never negative. Witness, missed; the balls pass through each other:
 *     ball-ball 0x1.fffffffffffffp-1 0 0 -1 0 0 1 */

static inline num skip_ball_ball(const struct balls *balls, struct quadratic *f)
{
	num wait = stable_ball_ball(balls, f);
	bool overlapped = less(f->b, from_double(0)) && less(f->c, from_double(0));
	return overlapped ? from_double(INFINITY) : wait;
}

static inline num skip_ball_plane(const struct flight *flight, struct quadratic *f)
{
	num zero = from_double(0), wait = stable_ball_plane(flight, f);
	if (!less(f->c, zero)) return wait;
	bool parts = less(f->a, zero) && less(zero, f->b) && less(zero, f->discriminant);
	return parts ? wait : from_double(INFINITY);
}
