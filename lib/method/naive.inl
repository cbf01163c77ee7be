/* naive: the roots as a textbook has them, with no thought for states that rounding made invalid.
 *
 * Source: 2014 paper, section 3 (eq. 7, the earlier root) and eq. 12 (the largest root over a plate). A pair that
 * overlaps and approaches gives a negative time; a ball that cannot leave the plate gives no number at all. Both
 * halt a run by this method: there is no answer to go on with.
 *
 * Bound: none. Witnesses, one negative by 2^-53 and one that is no number:
 *     ball-ball 0x1.fffffffffffffp-1 0 0 -1 0 0 1
 *     ball-plane 0x1.fffffffffffffp-2 0 -1 0x1p-1 */

static inline num naive_ball_ball(const struct balls *balls, struct quadratic *f)
{
	num zero = from_double(0), never = from_double(INFINITY);
	if (!approaching(balls, f)) return never;
	complete_ball_ball(balls, f);
	f->discriminant = sub(mul(f->b, f->b), mul(f->a, f->c));
	if (less(f->discriminant, zero)) return never;
	return divide(sub(negated(f->b), root(f->discriminant)), f->a);
}

static inline num naive_ball_leave(const struct balls *balls, struct quadratic *f)
{
	ball_leave(balls, f);
	f->discriminant = sub(mul(f->b, f->b), mul(f->a, f->c));
	if (less(f->discriminant, from_double(0))) return from_double(INFINITY);
	return divide(sub(root(f->discriminant), f->b), f->a);
}

static inline num naive_ball_plane(const struct flight *flight, struct quadratic *f)
{
	num zero = from_double(0), two = from_double(2), never = from_double(INFINITY);
	ball_plane(flight, f);
	if (!bent(f)) return less(f->b, zero) ? divide(f->c, negated(f->b)) : never;
	f->discriminant = sub(mul(f->b, f->b), mul(mul(two, f->a), f->c));
	if (less(zero, f->a) && (!less(f->b, zero) || less(f->discriminant, zero))) return never;
	return negated(divide(add(f->b, root(f->discriminant)), f->a));
}

static inline num naive_half_space(const struct passage *passage, struct quadratic *f)
{
	half_space(passage, f);
	return less(f->b, from_double(0)) ? divide(f->c, negated(f->b)) : from_double(INFINITY);
}
