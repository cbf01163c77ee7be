/* The solvers of the literature as finders: a solver gives both roots of a t^2 + 2 b t + c, and knows nothing of balls.
 * Two that meet do so at the earlier, two that part at the later root, whatever its sign. */

struct roots {
	bool real;
	num earlier, later;
};

typedef struct roots quadratic_solver(struct quadratic *f);

/* The roots q / a and c / q, where q is of the sign that -b has: neither cancels. */
static inline struct roots roots_through(const struct quadratic *f, num q)
{
	num by_a = divide(q, f->a), by_q = divide(f->c, q);
	bool positive = less(f->b, from_double(0));
	return positive ? (struct roots){true, by_q, by_a} : (struct roots){true, by_a, by_q};
}

/* b moved away from zero by a positive amount, and turned: the q of the same name. */
static inline num turned_away(num b, num amount)
{
	return less(b, from_double(0)) ? sub(amount, b) : negated(add(b, amount));
}

static inline num meeting_by(quadratic_solver *solver, const struct balls *balls, struct quadratic *f)
{
	if (!approaching(balls, f)) return from_double(INFINITY);
	complete_ball_ball(balls, f);
	struct roots roots = solver(f);
	return roots.real ? roots.earlier : from_double(INFINITY);
}

static inline num parting_by(quadratic_solver *solver, const struct balls *balls, struct quadratic *f)
{
	ball_leave(balls, f);
	if (!less(from_double(0), f->a)) return from_double(INFINITY); /* at rest: no quadratic */
	struct roots roots = solver(f);
	return roots.real ? roots.later : from_double(INFINITY);
}
