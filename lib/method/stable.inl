/* stable: an event occurs after the smallest non-negative dt with f(t+dt) <= 0 and f'(t+dt) < 0.
 *
 * Source: Bannerman, Strobl, Formella and Poeschel 2014, eq. 10, algorithms 1 and 2; 2016 sequel, eq. 3, algorithms 1
 * and 2 (whose two last forms are exchanged: each root is written here in the form that does not cancel).
 * Where that set is open (a ball too slow to leave the plate) the time is its infimum, as in the algorithms.
 *
 * Bound: never negative, and a number for all that does not overflow. What rounding did to f is not undone: near a
 * graze the discriminant may have any error and any sign. Witnesses (binary64), one missed and one invented:
 *     ball-ball -0x1.20ead74f39b9bp+2 0x1.7369d85fc87fap+0 0 1 0 0 0x1.7369d85fc87fcp+0
 *     ball-ball -0x1.fe8adeff2cb38p+1 0x1.29e3db2c33b4cp-1 0 1 0 0 0x1.29e3db2c33b49p-1
 *
 * The rule is a function of the signs and sizes of f's parts, whatever precision those were formed in. */

/* Balls meet: the earlier root. */
static inline num stable_meeting(const struct quadratic *f)
{
	num zero = from_double(0), never = from_double(INFINITY);
	if (!less(f->b, zero)) return never;
	if (!less(zero, f->c)) return zero;
	if (!less(zero, f->discriminant)) return never;
	return divide(f->c, sub(root(f->discriminant), f->b));
}

/* Balls part: the later root; or the closest approach, where they are apart throughout. */
static inline num stable_parting(const struct quadratic *f)
{
	num zero = from_double(0), never = from_double(INFINITY);
	bool approaching = less(f->b, zero);
	if (!less(zero, f->a)) return never;
	if (!approaching && !less(f->c, zero)) return zero;
	if (!less(zero, f->discriminant)) return approaching ? divide(negated(f->b), f->a) : zero;
	num end = root(f->discriminant);
	return approaching ? divide(sub(end, f->b), f->a) : divide(negated(f->c), add(f->b, end));
}

/* Whether a ball's flight is bent, so that its landing needs the discriminant. */
static inline bool bent(const struct quadratic *f)
{
	return less(f->a, from_double(0)) || less(from_double(0), f->a);
}

/* A ball meets a plane. */
static inline num stable_landing(const struct quadratic *f)
{
	num zero = from_double(0), two = from_double(2), never = from_double(INFINITY);
	if (!less(zero, f->c) && less(f->b, zero)) return zero;
	if (!bent(f)) return less(f->b, zero) ? divide(f->c, negated(f->b)) : never;
	if (less(zero, f->a)) { /* pushed away: only a ball that comes fast enough touches, and early */
		if (!less(f->b, zero) || !less(zero, f->discriminant)) return never;
		return divide(mul(two, f->c), sub(root(f->discriminant), f->b));
	}
	if (less(f->discriminant, zero)) /* overlapped and too slow to leave: the peak, where it turns back */
		return divide(f->b, negated(f->a));
	if (less(f->b, zero)) return divide(mul(two, f->c), sub(root(f->discriminant), f->b));
	return divide(add(f->b, root(f->discriminant)), negated(f->a));
}

static inline num stable_ball_ball(const struct balls *balls, struct quadratic *f)
{
	if (!approaching(balls, f)) return from_double(INFINITY);
	complete_ball_ball(balls, f);
	f->discriminant = sub(mul(f->b, f->b), mul(f->a, f->c));
	return stable_meeting(f);
}

static inline num stable_ball_leave(const struct balls *balls, struct quadratic *f)
{
	ball_leave(balls, f);
	f->discriminant = sub(mul(f->b, f->b), mul(f->a, f->c));
	return stable_parting(f);
}

static inline num stable_ball_plane(const struct flight *flight, struct quadratic *f)
{
	ball_plane(flight, f);
	if (bent(f)) f->discriminant = sub(mul(f->b, f->b), mul(mul(from_double(2), f->a), f->c));
	return stable_landing(f);
}

static inline num stable_half_space(const struct passage *passage, struct quadratic *f)
{
	num zero = from_double(0);
	half_space(passage, f);
	if (!less(f->b, zero)) return from_double(INFINITY);
	return less(zero, f->c) ? divide(f->c, negated(f->b)) : zero;
}

/* Every sum and quotient above is of numbers that are not negative. */
static inline void stable_claim(enum touchstone_shape shape, struct touchstone_claim *claim)
{
	(void)shape;
	*claim = (struct touchstone_claim){.most_ulp = INFINITY, .never_negative = true, .never_nan = true};
	claim_within_range(claim);
	claim->least = 0;
}
