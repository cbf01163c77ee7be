/* numerical-recipes: q = -(B + sgn(B) sqrt(B^2 - 4 a c)) / 2 with B = 2 b, roots q / a and c / q.
 *
 * Source: Press, Teukolsky, Vetterling and Flannery, "Numerical Recipes", 3rd edition, 2007, eqs. 5.6.4 and 5.6.5; the
 * GNU Scientific Library has the same.
 *
 * Bound: none. Witnesses, one negative by 2^-53, one invented, and one that is no number, where
 * B^2 overflows:
 *     ball-ball 0x1.fffffffffffffp-1 0 0 -1 0 0 1
 *     ball-ball -0x1.fe8adeff2cb38p+1 0x1.29e3db2c33b4cp-1 0 1 0 0 0x1.29e3db2c33b49p-1
 *     ball-ball 0x1p400 0 0 -0x1p200 0 0 1 */

static inline struct roots numerical_recipes(struct quadratic *f)
{
	num zero = from_double(0), half = from_double(0.5), four = from_double(4), twice = mul(from_double(2), f->b);
	num discriminant = sub(mul(twice, twice), mul(mul(four, f->a), f->c));
	f->discriminant = mul(from_double(0.25), discriminant);
	if (less(discriminant, zero)) return (struct roots){.real = false};
	return roots_through(f, mul(half, turned_away(twice, root(discriminant))));
}

static inline num numerical_recipes_ball_ball(const struct balls *balls, struct quadratic *f)
{
	return meeting_by(numerical_recipes, balls, f);
}

static inline num numerical_recipes_ball_leave(const struct balls *balls, struct quadratic *f)
{
	return parting_by(numerical_recipes, balls, f);
}
