/* compensated: the stable rule over a, b, c and a discriminant that are formed in twice the precision.
 *
 * Source: sums and products with their errors carried along (Ogita, Rump and Oishi, "Accurate sum and dot product",
 * SIAM Journal on Scientific Computing 26(6), 2005: Dot2); where b or c cancels nearly all of what is summed, the terms
 * are sifted until nothing is left to cancel (their Sum-K, with as many passes as it takes).
 *
 * Bound: at most 4 ulp, and no event missed or invented, wherever the discriminant is above 2^-k b^2 in magnitude, k =
 * 40 (fewer where the precision is below 44 bits: compensated_bits()). With u half an ulp of 1: the discriminant,
 * rounded, is u off and its root, rounded, 1.5 u; b, c and a, rounded, are u off each; the sum u; together 3.5 u, 4 ulp
 * with the rounding of the quotient. What twice the precision leaves open adds 13 u^2 2^(k/2) and what cancels in b and
 * c 2^-4 u, below 0.1 u in all. The largest error that 10^6 inputs of the test showed, 3.14 ulp: ball-leave
 * 0x1.159e575eae8fap-1 0x1.ae7400a7b25cp-2 0x1.747dac982341ap-1 -0x1.d398d3b7a19d6p-1 -0x1.36a038c8f3de2p-1
 * -0x1.bd78942184b8dp+0 1 */

struct pair {
	num high, low; /* high: the sum of the two, rounded */
};

static inline __attribute__((always_inline)) struct pair pair_sum(num a, num b)
{
	num sum = add(a, b);
	return (struct pair){sum, sum_rest(a, b, sum)};
}

static inline __attribute__((always_inline)) struct pair pair_product(num a, num b)
{
	num product = mul(a, b);
	return (struct pair){product, product_rest(a, b, product)};
}

/* x1 y1 + .. + xn yn, n <= 4, as the sum, what its roundings left out, and the sum of the magnitudes. */
struct sum {
	num high, rest, size;
};

static inline __attribute__((always_inline)) struct sum first_term(num x, num y)
{
	struct pair product = pair_product(x, y);
	return (struct sum){product.high, product.low, magnitude(product.high)};
}

static inline __attribute__((always_inline)) struct sum next_term(struct sum before, num x, num y)
{
	struct pair product = pair_product(x, y), sum = pair_sum(before.high, product.high);
	return (struct sum){sum.high, add(before.rest, add(sum.low, product.low)),
						add(before.size, magnitude(product.high))};
}

static inline __attribute__((always_inline)) struct sum sum_dot(const num x[3], const num y[3])
{
	return next_term(next_term(first_term(x[0], y[0]), x[1], y[1]), x[2], y[2]);
}

/* r^2 - contact^2 */
static inline __attribute__((always_inline)) struct sum sum_c(const struct balls *balls)
{
	return next_term(sum_dot(balls->r, balls->r), balls->contact, negated(balls->contact));
}

/* Error at most n^2 u^2 size. */
static inline __attribute__((always_inline)) struct pair summed(struct sum sum)
{
	return pair_sum(sum.high, sum.rest);
}

/* The same to a relative error of some 8 u^2 whatever cancels. Each pass of exact sums moves what was rounded off to
 * the terms below; it ends when those no longer matter to the highest, or, at the latest, when all is sorted. */
__attribute__((noinline)) static struct pair sifted_dot(int n, const num x[], const num y[])
{
	num term[8], small = from_double(ldexp(1, 2 - num_bits())), rest, size;
	int count = 2 * n;
	for (int i = 0; i < n; i++) {
		struct pair product = pair_product(x[i], y[i]);
		term[i] = product.low, term[n + i] = product.high;
	}
	for (int pass = 0; pass < 64; pass++) {
		for (int i = 1; i < count; i++) {
			struct pair sum = pair_sum(term[i], term[i - 1]);
			term[i] = sum.high, term[i - 1] = sum.low;
		}
		rest = size = from_double(0);
		for (int i = 0; i + 1 < count; i++) {
			rest = add(rest, term[i]);
			size = add(size, magnitude(term[i]));
		}
		if (!less(mul(small, magnitude(term[count - 1])), size)) break;
	}
	return pair_sum(term[count - 1], rest);
}

/* k, such that the error stated below holds where the discriminant is above 2^-k b^2. */
static inline int compensated_bits(void)
{
	return num_bits() < 44 ? num_bits() - 4 : 40;
}

/* What a sum of this size must exceed so that nothing more need be done. */
static inline num enough_of(struct sum sum)
{
	return mul(from_double(ldexp(1, 8 + compensated_bits() / 2 - num_bits())), sum.size);
}

/* Whether so much cancels that the relative error may be above 2^(-k/2 - 4) u. */
static inline bool cancels(struct pair total, struct sum sum)
{
	return less(magnitude(total.high), enough_of(sum));
}

static inline __attribute__((always_inline)) struct pair compensated_b(const struct balls *balls, struct sum sum)
{
	struct pair total = summed(sum);
	return cancels(total, sum) ? sifted_dot(3, balls->r, balls->v) : total;
}

static inline __attribute__((always_inline)) struct pair compensated_c(const struct balls *balls)
{
	struct sum sum = sum_c(balls);
	struct pair total = summed(sum);
	const num *r = balls->r, contact = balls->contact;
	return cancels(total, sum)
			   ? sifted_dot(4, (num[]){r[0], r[1], r[2], contact}, (num[]){r[0], r[1], r[2], negated(contact)})
			   : total;
}

/* b^2 - a c, to 13 u^2 (b^2 + |a c|) before it is rounded. */
static inline num pair_discriminant(struct pair a, struct pair b, struct pair c)
{
	num two = from_double(2);
	struct pair square = pair_product(b.high, b.high), product = pair_product(a.high, c.high);
	square.low = add(square.low, mul(mul(two, b.high), b.low));
	product.low = add(product.low, add(mul(a.high, c.low), mul(a.low, c.high)));
	struct pair difference = pair_sum(square.high, negated(product.high));
	return add(difference.high, add(difference.low, sub(square.low, product.low)));
}

static inline __attribute__((always_inline)) num compensated_ball_ball(const struct balls *balls, struct quadratic *f)
{
	struct sum sum = sum_dot(balls->r, balls->v);
	f->b = sum.high;
	if (less(enough_of(sum), f->b)) return from_double(INFINITY); /* one pair in two: what is left out is far smaller */
	struct pair b = compensated_b(balls, sum);
	f->b = b.high;
	if (!less(f->b, from_double(0))) return from_double(INFINITY);
	struct pair a = summed(sum_dot(balls->v, balls->v)), c = compensated_c(balls);
	f->a = a.high;
	f->c = c.high;
	f->discriminant = pair_discriminant(a, b, c);
	return stable_meeting(f);
}

static inline __attribute__((always_inline)) num compensated_ball_leave(const struct balls *balls, struct quadratic *f)
{
	struct pair a = summed(sum_dot(balls->v, balls->v)), b = compensated_b(balls, sum_dot(balls->r, balls->v)),
				c = compensated_c(balls);
	*f = (struct quadratic){a.high, b.high, c.high, pair_discriminant(a, b, c)};
	return stable_parting(f);
}

static inline __attribute__((always_inline)) num compensated_ball_plane(const struct flight *flight,
																		struct quadratic *f)
{
	struct pair a = {flight->acceleration, from_double(0)}, b = {flight->speed, from_double(0)};
	struct pair c = pair_sum(flight->distance, negated(flight->contact));
	f->a = a.high;
	f->b = b.high;
	f->c = c.high;
	a.high = mul(from_double(2), a.high);
	if (bent(f)) f->discriminant = pair_discriminant(a, b, c);
	return stable_landing(f);
}

static inline void compensated_claim(enum touchstone_shape shape, struct touchstone_claim *claim)
{
	int bits = num_bits();
	if (shape == TOUCHSTONE_HALF_SPACE) { /* one quotient */
		*claim = (struct touchstone_claim){.most_ulp = 0.5, .never_misses = true, .never_phantom = true};
	} else {
		*claim = (struct touchstone_claim){.discriminant_bits = compensated_bits(), .most_ulp = 4};
		claim->never_misses = claim->never_phantom = bits >= 11;
		if (bits < 11) claim->most_ulp = INFINITY; /* twice the precision is then too little to speak of */
	}
	if (bits > 53) claim->most_ulp = 0.5 + fmin(4, ldexp(1, 58 - bits)); /* rounded to double in the end */
	claim->never_negative = claim->never_nan = true;
	claim_within_range(claim);
}
