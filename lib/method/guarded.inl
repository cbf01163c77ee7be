/* guarded: two guards before the rule, as a simulator has them: balls whose a is below 2^-52 or whose c is negative
 * have no event.
 *
 * Source: the simulator that papers/collision-readme.txt describes. The guards are meant to keep divisions sound and
 * pairs that have just met from meeting again at once; what they do is lose pairs: two balls that overlap by one
 * rounding error pass through each other, and so do balls that are slow in the units of the scene. The first guard has
 * a meaning for balls only; a plane or a half-space loses what is beyond it.
 *
 * Bound: never negative, and a number for all that does not overflow. Witnesses, both missed, one by each guard:
 *     ball-ball 0x1.fffffffffffffp-1 0 0 -1 0 0 1
 *     ball-ball 2 0 0 -0x1p-27 0 0 1 */

static inline num guarded_ball_ball(const struct balls *balls, struct quadratic *f)
{
	num never = from_double(INFINITY);
	if (!approaching(balls, f)) return never;
	complete_ball_ball(balls, f);
	if (less(f->a, from_double(0x1p-52)) || less(f->c, from_double(0))) return never;
	f->discriminant = sub(mul(f->b, f->b), mul(f->a, f->c));
	return stable_meeting(f);
}

static inline num guarded_ball_leave(const struct balls *balls, struct quadratic *f)
{
	ball_leave(balls, f);
	f->discriminant = sub(mul(f->b, f->b), mul(f->a, f->c));
	bool guarded = less(f->a, from_double(0x1p-52)) || less(from_double(0), f->c);
	return guarded ? from_double(INFINITY) : stable_parting(f);
}

static inline num guarded_ball_plane(const struct flight *flight, struct quadratic *f)
{
	num wait = stable_ball_plane(flight, f);
	return less(f->c, from_double(0)) ? from_double(INFINITY) : wait;
}

static inline num guarded_half_space(const struct passage *passage, struct quadratic *f)
{
	num wait = stable_half_space(passage, f);
	return less(f->c, from_double(0)) ? from_double(INFINITY) : wait;
}

static inline void guarded_claim(enum touchstone_shape shape, struct touchstone_claim *claim)
{
	stable_claim(shape, claim);
}
