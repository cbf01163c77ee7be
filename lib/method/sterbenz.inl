/* sterbenz: t = 2^k x, with k such that the outer coefficients of the equation for x are near 1; where the middle one
 * is then so large that the discriminant is b^2, each root is one quotient; otherwise as kahan.
 *
 * Source: Sterbenz, "Floating-Point Computation", 1974, with Kahan's discriminant as in Goualard, "The ins and outs of
 * solving quadratic equations with floating-point arithmetic", 2023. From given a, b and c nothing overflows or
 * underflows on the way; what rounding and the range did to a, b and c before is not undone.
 *
 * Bound: none over r and v. Witnesses, one negative by 2^-53 and one missed:
 *     ball-ball 0x1.fffffffffffffp-1 0 0 -1 0 0 1
 *     ball-ball -0x1.20ead74f39b9bp+2 0x1.7369d85fc87fap+0 0 1 0 0 0x1.7369d85fc87fcp+0 */

static inline struct roots sterbenz(struct quadratic *f)
{
	long a_exponent = exponent_of(f->a), difference = exponent_of(f->c) - a_exponent;
	long k = difference / 2 - (difference % 2 < 0), shift = a_exponent + k;
	if (exponent_of(f->b) - shift > num_bits() + 2) {
		num by_a = times_power(divide(negated(f->b), f->a), 1), by_q = times_power(divide(f->c, negated(f->b)), -1);
		bool positive = less(f->b, from_double(0));
		return positive ? (struct roots){true, by_q, by_a} : (struct roots){true, by_a, by_q};
	}
	struct quadratic scaled = {.a = times_power(f->a, -a_exponent),
							   .b = times_power(f->b, -shift),
							   .c = times_power(f->c, -a_exponent - 2 * k)};
	struct roots roots = kahan(&scaled);
	f->discriminant = times_power(scaled.discriminant, 2 * shift);
	roots.earlier = times_power(roots.earlier, k);
	roots.later = times_power(roots.later, k);
	return roots;
}

static inline num sterbenz_ball_ball(const struct balls *balls, struct quadratic *f)
{
	return meeting_by(sterbenz, balls, f);
}

static inline num sterbenz_ball_leave(const struct balls *balls, struct quadratic *f)
{
	return parting_by(sterbenz, balls, f);
}
