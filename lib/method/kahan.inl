/* kahan: the discriminant b^2 - a c by two fused multiply-adds, then q = -(b + sgn(b) sqrt(discriminant)), roots q / a
 * and c / q. Nothing is scaled.
 *
 * Source: Kahan, "On the cost of floating-point computation without extra-precise arithmetic", 2004. From given a, b
 * and c the discriminant is within 1.5 ulp unless something overflows or underflows (Jeannerod, Louvet and Muller,
 * "Further analysis of Kahan's algorithm for the accurate computation of 2 x 2 determinants", Mathematics of
 * Computation 82(284), 2013); what rounding did to a, b and c before is not undone.
 *
 * Bound: none over r and v. Witnesses, one negative by 2^-53, one missed, and one that is no number, where b^2
 * overflows:
 *     ball-ball 0x1.fffffffffffffp-1 0 0 -1 0 0 1
 *     ball-ball -0x1.20ead74f39b9bp+2 0x1.7369d85fc87fap+0 0 1 0 0 0x1.7369d85fc87fcp+0
 *     ball-ball 0x1p400 0 0 -0x1p200 0 0 1 */

static inline __attribute__((always_inline)) num kahan_discriminant(num a, num b, num c)
{
	num product = mul(a, c), rest = fused(negated(a), c, product);
	return add(fused(b, b, negated(product)), rest);
}

static inline struct roots kahan(struct quadratic *f)
{
	f->discriminant = kahan_discriminant(f->a, f->b, f->c);
	if (less(f->discriminant, from_double(0))) return (struct roots){.real = false};
	return roots_through(f, turned_away(f->b, root(f->discriminant)));
}

static inline num kahan_ball_ball(const struct balls *balls, struct quadratic *f)
{
	return meeting_by(kahan, balls, f);
}

static inline num kahan_ball_leave(const struct balls *balls, struct quadratic *f)
{
	return parting_by(kahan, balls, f);
}
