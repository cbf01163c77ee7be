/* shrink: contacts are found a little early, so that rounding does not make them overlaps.
 *
 * Source: Poeschel and Schwager, "Computational Granular Dynamics", Springer 2005, as the 2014 paper tells it in
 * section 3: "biasing the movement of particles by (temporarily) modifying the particle diameter so that detected
 * interactions occur at a small distance from the invalid state"; and the quotient c / (-b + sqrt(b^2 - a c)), which it
 * takes from there as well. Formula: the earlier root for a contact distance longer by m; for bodies that are within
 * that distance already, for the true one (that is what is temporary). m is `shrinking` times the largest diameter, 64
 * roundoffs where the scene says nothing: about the spread of the paper's figure 3. The engine adds m and asks twice
 * (engine/policy.inl). Assumed: m is the same for all pairs and planes. It prevents overlaps and has no rule for them:
 * a pair that overlaps and approaches all the same, pushed by a third, has a negative time, for which there is no
 * answer.
 *
 * Bound: none. Witness, without an answer:
 *     ball-ball 0x1.fffffffffffffp-1 0 0 -1 0 0 1 */

static inline num shrink_ball_ball(const struct balls *balls, struct quadratic *f)
{
	num zero = from_double(0), never = from_double(INFINITY);
	if (!approaching(balls, f)) return never;
	complete_ball_ball(balls, f);
	f->discriminant = sub(mul(f->b, f->b), mul(f->a, f->c));
	if (!less(zero, f->discriminant)) return never;
	return divide(f->c, sub(root(f->discriminant), f->b));
}

static inline num shrink_ball_plane(const struct flight *flight, struct quadratic *f)
{
	num zero = from_double(0), two = from_double(2), never = from_double(INFINITY);
	ball_plane(flight, f);
	if (!bent(f)) return less(f->b, zero) ? divide(f->c, negated(f->b)) : never;
	f->discriminant = sub(mul(f->b, f->b), mul(mul(two, f->a), f->c));
	bool away = less(zero, f->a);
	if (away && (!less(f->b, zero) || !less(zero, f->discriminant))) return never;
	if (away || less(f->b, zero)) return divide(mul(two, f->c), sub(root(f->discriminant), f->b));
	return negated(divide(add(f->b, root(f->discriminant)), f->a));
}
