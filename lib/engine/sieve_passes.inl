/* The sieve (engine/sieve.h), in the steps of a machine (engine/sieve_lanes.inl). */

INLINE lanes size_of(lanes x)
{
	return (lanes)((whole_lanes)x & 0x7fffffff);
}

/* How far the image an entry means is shifted along an axis. */
INLINE lanes shift_of(whole_lanes entry, int axis, float box)
{
	whole_lanes code = entry >> (ENTRY_BITS + 2 * axis) & 3;
	return __builtin_convertvector((code & 1) - (code >> 1), lanes) * box;
}

/* Whether entries are images of particles. */
INLINE bool any_image(const uint32_t *entry)
{
	whole_lanes which;
	memcpy(&which, entry, sizeof which);
	return any(which & (int32_t)~ENTRY_PARTICLE);
}

/* The particle that searches, and the factors of its bounds that are the same for all others. */
struct own {
	struct shadow shadow;
	float speed, g_fixed, g_time, two_lengths, per_length, b_fixed, b_slope;
};

INLINE struct own own_of(const struct sieve *sieve, const struct shadow *shadow)
{
	const float *x = shadow->position, *v = shadow->velocity, n = sieve->roundoff;
	float size = fabsf(x[0]) + fabsf(x[1]) + fabsf(x[2]);
	float length = sieve->length;
	return (struct own){.shadow = *shadow,
						.speed = fabsf(v[0]) + fabsf(v[1]) + fabsf(v[2]),
						.g_fixed = 8 * u * (sieve->boxes + size) + sieve->grain,
						.g_time = 12 * u * sieve->span + sieve->drift,
						.two_lengths = 2 * length,
						.per_length = 6 / length,
						.b_fixed = (10 * u + 8 * n) * length,
						.b_slope = (30 * u + 24 * n) / length};
}

/* Particles as it sees them at the time of the search, in the terms of sieve.h: S, a, b, r.r, and what their
 * bounds come to: E_c, but for s^2, is c_fixed + r.r c_slope. */
struct others {
	lanes radius, s, a, b, rr, c_fixed, c_slope, error_b;
};

INLINE struct others others_of(const struct sieve *sieve, const struct own *own, const struct shadow *shadow,
							   const uint32_t *entry, bool images)
{
	lanes field[FIELDS];
	fetch(shadow, entry, field);
	if (images) {
		whole_lanes which;
		memcpy(&which, entry, sizeof which);
		for (int axis = 0; axis < 3; axis++) field[axis] += shift_of(which, axis, sieve->box[axis]);
	}
	const float n = sieve->roundoff, age = sieve->age;
	const lanes zero = {0};
	lanes wait = sieve->now - field[3];
	struct others others = {.radius = field[7], .s = all(own->speed), .a = zero, .b = zero, .rr = zero};
	for (int axis = 0; axis < 3; axis++) {
		lanes theirs = field[4 + axis], v = own->shadow.velocity[axis] - theirs;
		lanes r = own->shadow.position[axis] - (field[axis] + theirs * wait);
		others.s += size_of(theirs);
		others.a += v * v;
		others.b += r * v;
		others.rr += r * r;
	}
	lanes g = own->g_fixed + own->g_time * others.s;
	others.c_fixed = g * (own->two_lengths + 4 * g) + (64 * n * age * age) * (others.s * others.s) + tiny;
	others.c_slope = own->per_length * g + (144 * u + 192 * n);
	others.error_b =
		others.s * (2 * g + own->b_fixed + (16 * n * age + sieve->late) * others.s + own->b_slope * others.rr) + tiny;
	return others;
}

/* E_c, for no distance whose square is larger. */
INLINE lanes error_of_c(const struct sieve *sieve, const struct others *o, lanes square)
{
	return o->c_fixed + (32 * u + 64 * sieve->roundoff) * square + o->c_slope * o->rr;
}

/* When pairs meet at a distance: not before `low`; and, where that is sure, not after `high`. */
struct meeting {
	lanes low, high;
	mask misses, sure;
};

INLINE struct meeting meeting_of(const struct others *o, lanes c, lanes q)
{
	static const float fine = 0x1p-9f; /* for a root and an inverse that are near */
	const lanes zero = {0}, error_b = o->error_b;
	lanes error_d = 2 * (o->s * o->s) * q + tiny, d = o->b * o->b - o->a * c, most = d + error_d, least = d - error_d;
	struct meeting meeting;
	meeting.misses = less(error_b, o->b) | less(most, zero);
	lanes end = near_root(larger(most, all(tiny)));
	meeting.low = (c - q) * near_inverse(error_b - o->b + end) * (1 - fine);
	meeting.sure = less(o->b + error_b, zero) & less(all(tiny), least) & less(least, all(huge)) & less(q, c);
	lanes begin = near_root(larger(least, all(tiny)));
	meeting.high = (c + q) * near_inverse(begin - o->b - error_b) * (1 + fine);
	return meeting;
}

/* The latest meeting that is still of interest, when some surely come no later than `high`. */
INLINE float latest_of(const struct sieve *sieve, float latest, lanes high)
{
	float soonest = minimum(high) * 1.0001f + sieve->late;
	return soonest < latest ? soonest : latest;
}

/* Which pairs are surely beyond what is heard. */
INLINE mask unheard(const struct sieve *sieve, const struct others *o, lanes square)
{
	lanes farthest = square * (sieve->heard * sieve->heard);
	return less(error_of_c(sieve, o, farthest), o->rr - farthest);
}

/* How far a search has come. */
struct progress {
	struct own own;
	float latest;
	size_t kept;
};

/* When the last of those that are kept meets. */
INLINE void tell_time(struct sieve_search *search, const struct meeting *meeting, flags kept)
{
	float low[LANES], high[LANES];
	if (!kept) return;
	memcpy(low, &meeting->low, sizeof low);
	memcpy(high, &meeting->high, sizeof high);
	int last = 31 - __builtin_clz(kept);
	search->from = low[last];
	search->by = bits(meeting->sure) >> last & 1 ? high[last] : INFINITY;
}

/* The next lanes of one search, or of two: step by step together, since each step waits for the one before it and not
 * for those of the other. */
INLINE void sift_next(const struct sieve *sieve, const struct shadow *shadow, struct sieve_search *search,
					  struct progress *progress, int searches, size_t at)
{
	const lanes never = all(INFINITY);
	struct others others[2];
	struct meeting meeting[2];
	lanes square[2];
	mask none[2], out[2];
	for (int k = 0; k < searches; k++)
		others[k] = others_of(sieve, &progress[k].own, shadow, search[k].entry + at, sieve->images);
	for (int k = 0; k < searches; k++) {
		lanes contact = progress[k].own.shadow.radius + others[k].radius;
		square[k] = contact * contact;
		meeting[k] = meeting_of(&others[k], others[k].rr - square[k], error_of_c(sieve, &others[k], square[k]));
	}
	for (int k = 0; k < searches; k++) {
		none[k] = behind(search[k].count - at);
		out[k] = none[k] | meeting[k].misses;
		if (sieve->heard > 0) out[k] &= none[k] | unheard(sieve, &others[k], square[k]);
	}
	if (bits(out[0] & out[searches - 1]) == all_lanes) return;
	for (int k = 0; k < searches && sieve->by_order; k++) {
		progress[k].latest =
			latest_of(sieve, progress[k].latest, pick(meeting[k].sure & ~out[k], meeting[k].high, never));
		mask late = less(all(progress[k].latest), meeting[k].low);
		if (sieve->heard > 0) late &= unheard(sieve, &others[k], square[k]);
		out[k] |= late;
	}
	for (int k = 0; k < searches && sieve->timed; k++) tell_time(&search[k], &meeting[k], bits(~out[k]) & all_lanes);
	for (int k = 0; k < searches; k++)
		progress[k].kept += pack(bits(~out[k]) & all_lanes, search[k].entry + at, search[k].entry + progress[k].kept);
}

INLINE void pass_of(const struct sieve *sieve, const struct shadow *shadow, struct sieve_search *search, int searches)
{
	struct progress progress[2];
	size_t at = 0;
	for (int k = 0; k < searches; k++)
		progress[k] = (struct progress){.own = own_of(sieve, &shadow[search[k].self]), .latest = search[k].latest};
	if (searches == 2)
		for (; at < search[0].count && at < search[1].count; at += LANES)
			sift_next(sieve, shadow, search, progress, 2, at);
	for (int k = 0; k < searches; k++) {
		for (size_t rest = at; rest < search[k].count; rest += LANES)
			sift_next(sieve, shadow, &search[k], &progress[k], 1, rest);
		search[k].count = progress[k].kept;
	}
}

MACHINE static void pass(const struct sieve *sieve, const struct shadow *shadow, struct sieve_search *search,
						 int searches)
{
	if (searches == 1)
		pass_of(sieve, shadow, search, 1);
	else
		pass_of(sieve, shadow, search, 2);
}

/* No event of a pair comes before: that of meeting where it surely meets, that of parting where it surely does not, and
 * now where that is in doubt. Both are a quotient with a root in it, of which one is formed. */
INLINE lanes bound_of(const struct sieve *sieve, const struct others *o, lanes inner, lanes outer)
{
	const float fine = 0x1p-18f + 16 * sieve->roundoff;
	const lanes zero = {0};
	mask parts = less(zero, outer);
	lanes farther = pick(parts, outer, inner);
	lanes q = error_of_c(sieve, o, farther * farther), error_b = o->error_b, b = o->b + error_b;
	lanes error_a = (16 * u + 8 * sieve->roundoff) * (o->s * o->s) + tiny, a = o->a + error_a;
	lanes c_meets = o->rr - inner * inner, c = o->rr - outer * outer + q;
	lanes error_d = 2 * (o->s * o->s) * q + tiny, d = o->b * o->b - o->a * c_meets;
	mask misses = less(error_b, o->b) | less(d + error_d, zero);
	mask meets = less(b, zero) & less(error_d, d);
	lanes square = pick(meets, d + error_d, b * b * (1 - 32 * u) - a * c);
	lanes end = root(larger(square, zero));
	mask opens = less(zero, b);
	lanes over = pick(meets, c_meets - q, pick(opens, -c, end - b));
	lanes under = pick(meets, error_b - o->b + end, pick(opens, b + end, a));
	lanes low = over / under * (1 - fine);
	return pick(meets | (misses & parts), low, pick(misses, all(INFINITY), zero));
}

/* The next lanes of one outlook, or of two: step by step together. */
INLINE void hold_next(const struct sieve *sieve, const struct shadow *shadow, struct sieve_outlook *outlook,
					  const struct own *own, float *least, int outlooks, size_t at)
{
	lanes outer[2], inner[2];
	struct others others[2];
	for (int k = 0; k < outlooks; k++) {
		uint32_t entry[LANES] __attribute__((aligned(64)));
		limits_of(outlook[k].pair + at, outlook[k].count - at, outlook[k].limits, entry, &outer[k], &inner[k]);
		others[k] = others_of(sieve, &own[k], shadow, entry, any_image(entry));
	}
	for (int k = 0; k < outlooks; k++) {
		lanes low = bound_of(sieve, &others[k], inner[k], outer[k]);
		low = pick(behind(outlook[k].count - at), all(INFINITY), low);
		memcpy(outlook[k].soonest + at, &low, sizeof low);
		float least_here = minimum(low);
		if (!(least_here < least[k])) continue;
		least[k] = least_here;
		outlook[k].first = at + (size_t)__builtin_ctz(bits(~less(all(least_here), low)));
	}
}

INLINE void hold_of(const struct sieve *sieve, const struct shadow *shadow, struct sieve_outlook *outlook, int outlooks)
{
	struct own own[2];
	float least[2] = {INFINITY, INFINITY};
	size_t at = 0;
	for (int k = 0; k < outlooks; k++) own[k] = own_of(sieve, &shadow[outlook[k].self]), outlook[k].first = 0;
	if (outlooks == 2)
		for (; at < outlook[0].count && at < outlook[1].count; at += LANES)
			hold_next(sieve, shadow, outlook, own, least, 2, at);
	for (int k = 0; k < outlooks; k++)
		for (size_t rest = at; rest < outlook[k].count; rest += LANES)
			hold_next(sieve, shadow, &outlook[k], &own[k], &least[k], 1, rest);
}

MACHINE static void hold(const struct sieve *sieve, const struct shadow *shadow, struct sieve_outlook *outlook,
						 int outlooks)
{
	if (outlooks == 1)
		hold_of(sieve, shadow, outlook, 1);
	else
		hold_of(sieve, shadow, outlook, 2);
}

MACHINE static size_t check(const struct sieve *sieve, const struct shadow *shadow, uint32_t self,
							const struct held *held, size_t count, uint32_t *kept)
{
	const struct own own = own_of(sieve, &shadow[self]);
	const lanes zero = {0};
	size_t found = 0;
	for (size_t k = 0; k < count; k += LANES) {
		struct others others = others_of(sieve, &own, shadow, held->entry + k, sieve->images);
		lanes inner, outer;
		memcpy(&inner, held->inner + k, sizeof inner);
		memcpy(&outer, held->outer + k, sizeof outer);
		lanes least = inner * inner, most = outer * outer;
		mask beyond = ~less(zero, inner) | less(error_of_c(sieve, &others, least), others.rr - least);
		mask within = ~less(outer, all(INFINITY)) | less(error_of_c(sieve, &others, most), most - others.rr);
		mask out = behind(count - k) | (beyond & within);
		whole_lanes number = numbers() + (int32_t)k;
		uint32_t each[LANES];
		memcpy(each, &number, sizeof each);
		flags in = bits(~out) & all_lanes;
		if (in) found += pack(in, each, kept + found);
	}
	return found;
}

MACHINE static size_t sooner(const float *soonest, size_t count, float latest, uint32_t *kept, float *later)
{
	lanes least = all(INFINITY);
	const lanes last = all(latest < FLT_MAX ? latest : FLT_MAX);
	size_t found = 0;
	for (size_t k = 0; k < count; k += LANES) {
		lanes low;
		memcpy(&low, soonest + k, sizeof low);
		whole_lanes number = numbers() + (int32_t)k;
		uint32_t each[LANES];
		memcpy(each, &number, sizeof each);
		mask out = less(last, low);
		least = smaller(least, pick(out, low, all(INFINITY)));
		found += pack(bits(~out) & all_lanes, each, kept + found);
	}
	*later = minimum(least);
	return found;
}
