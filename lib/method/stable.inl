/* stable: an event occurs after the smallest non-negative dt with f(t+dt) <= 0 and f'(t+dt) < 0.
 *
 * Source: Bannerman, Strobl, Formella and Poeschel 2014, eq. 10, algorithms 1 and 2; 2016 sequel, algorithm 1.
 * Where that set is open (a ball too slow to leave the plate) the time is its infimum, as in the algorithms. */

static num stable_ball_ball(struct ball_ball f)
{
	num zero = from_double(0), never = from_double(INFINITY);
	if (!less(f.b, zero)) return never;
	if (!less(zero, f.c)) return zero;
	num discriminant = sub(mul(f.b, f.b), mul(f.a, f.c));
	if (!less(zero, discriminant)) return never;
	return divide(f.c, sub(root(discriminant), f.b));
}

static num stable_ball_plane(struct ball_plane f)
{
	num zero = from_double(0), two = from_double(2), never = from_double(INFINITY);
	if (!less(zero, f.gap) && less(f.speed, zero)) return zero;
	if (!less(f.acceleration, zero) && !less(zero, f.acceleration))
		return less(f.speed, zero) ? divide(f.gap, negated(f.speed)) : never;

	num discriminant = sub(mul(f.speed, f.speed), mul(mul(two, f.acceleration), f.gap));
	if (less(zero, f.acceleration)) { /* pushed away: only a ball that comes fast enough touches, and early */
		if (!less(f.speed, zero) || !less(zero, discriminant)) return never;
		return divide(mul(two, f.gap), sub(root(discriminant), f.speed));
	}
	if (less(discriminant, zero)) /* overlapped and too slow to leave: the peak, where it turns back */
		return divide(f.speed, negated(f.acceleration));
	if (less(f.speed, zero)) return divide(mul(two, f.gap), sub(root(discriminant), f.speed));
	return divide(add(f.speed, root(discriminant)), negated(f.acceleration));
}
