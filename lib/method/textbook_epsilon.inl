/* textbook-epsilon: two moving balls as a textbook on games has them. Balls that overlap meet now, whichever way they
 * move; balls with a < epsilon are at rest; else the earlier root, (-b - sqrt(b^2 - a c)) / a.
 *
 * Source: Ericson, "Real-Time Collision Detection", 2005, section 5.5.5. The epsilon is Ericson's; he leaves its value
 * to the reader, and here it is 2^-52, as in `guarded`.
 *
 * Bound: none. Witnesses, one invented, since it recedes, and one missed, since it is slow:
 *     ball-ball 0x1.fffffffffffffp-1 0 0 1 0 0 1
 *     ball-ball 2 0 0 -0x1p-27 0 0 1 */

static inline num textbook_epsilon_ball_ball(const struct balls *balls, struct quadratic *f)
{
	num zero = from_double(0), never = from_double(INFINITY);
	complete_ball_ball(balls, f);
	if (less(f->c, zero)) return zero;
	if (less(f->a, from_double(0x1p-52)) || !approaching(balls, f)) return never;
	f->discriminant = sub(mul(f->b, f->b), mul(f->a, f->c));
	if (less(f->discriminant, zero)) return never;
	return divide(sub(negated(f->b), root(f->discriminant)), f->a);
}
