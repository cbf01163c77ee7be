/* naive: the roots as a textbook has them, with no thought for states that rounding made invalid.
 *
 * Source: 2014 paper, section 3 (eq. 7, the earlier root) and eq. 12 (the largest root over a plate). A pair that
 * overlaps and approaches gives a negative time; a ball that cannot leave the plate gives no number at all. Both
 * halt a run by this method: there is no answer to go on with. */

static num naive_ball_ball(struct ball_ball f)
{
	num zero = from_double(0), never = from_double(INFINITY);
	if (!less(f.b, zero)) return never;
	num discriminant = sub(mul(f.b, f.b), mul(f.a, f.c));
	if (less(discriminant, zero)) return never;
	return divide(sub(negated(f.b), root(discriminant)), f.a);
}

static num naive_ball_plane(struct ball_plane f)
{
	num zero = from_double(0), two = from_double(2), never = from_double(INFINITY);
	if (!less(f.acceleration, zero) && !less(zero, f.acceleration))
		return less(f.speed, zero) ? divide(f.gap, negated(f.speed)) : never;
	num discriminant = sub(mul(f.speed, f.speed), mul(mul(two, f.acceleration), f.gap));
	if (less(zero, f.acceleration)) {
		if (!less(f.speed, zero) || less(discriminant, zero)) return never;
		return negated(divide(add(f.speed, root(discriminant)), f.acceleration));
	}
	return negated(divide(add(f.speed, root(discriminant)), f.acceleration));
}
