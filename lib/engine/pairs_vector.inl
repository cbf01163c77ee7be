/* The search over pairs in binary64, by the stable rule, on straight flights: eight partners at a time, on any machine.
 *
 * This is consider_pairs() of search.inl once more, operation by operation in the same order, so that its results are
 * the same to the last bit; a test holds the two against each other. A partner's body is one cache line: eight lines
 * are loaded and transposed, then every step is one vector operation. Compilers lower the vectors to what the target
 * has; choose_pairs() takes the widest that the machine offers. Measured gain: see `make bench`. */

#ifdef __x86_64__
#include "engine/pairs_avx512.inl"
#endif

enum { LANES = 8 };
typedef double lanes __attribute__((vector_size(LANES * sizeof(double))));
typedef int64_t lane_mask __attribute__((vector_size(LANES * sizeof(int64_t))));
typedef int32_t lane_int __attribute__((vector_size(LANES * sizeof(int32_t))));
typedef int32_t half_int __attribute__((vector_size(LANES / 2 * sizeof(int32_t))));

_Static_assert(sizeof(struct body) == sizeof(lanes), "a body is one row of the transposition");
_Static_assert(sizeof(struct place) == sizeof(half_int), "a place is half a row");

/* Eight bodies in, eight fields out. */
static inline __attribute__((always_inline)) void transpose_lanes(lanes row[LANES])
{
	lanes pair[LANES], quad[LANES];
	for (int i = 0; i < LANES; i += 2) {
		pair[i] = __builtin_shufflevector(row[i], row[i + 1], 0, 8, 2, 10, 4, 12, 6, 14);
		pair[i + 1] = __builtin_shufflevector(row[i], row[i + 1], 1, 9, 3, 11, 5, 13, 7, 15);
	}
	for (int i = 0; i < LANES; i += 4)
		for (int k = 0; k < 2; k++) {
			quad[i + k] = __builtin_shufflevector(pair[i + k], pair[i + k + 2], 0, 1, 8, 9, 4, 5, 12, 13);
			quad[i + k + 2] = __builtin_shufflevector(pair[i + k], pair[i + k + 2], 2, 3, 10, 11, 6, 7, 14, 15);
		}
	for (int k = 0; k < 4; k++) {
		row[k] = __builtin_shufflevector(quad[k], quad[k + 4], 0, 1, 2, 3, 8, 9, 10, 11);
		row[k + 4] = __builtin_shufflevector(quad[k], quad[k + 4], 4, 5, 6, 7, 12, 13, 14, 15);
	}
}

static inline __attribute__((always_inline)) lanes pick(lane_mask mask, lanes yes, lanes no)
{
	return (lanes)(((lane_mask)yes & mask) | ((lane_mask)no & ~mask));
}

static inline __attribute__((always_inline)) bool any(lane_mask mask)
{
	int64_t bits = 0;
	for (int lane = 0; lane < LANES; lane++) bits |= mask[lane];
	return bits;
}

static inline __attribute__((always_inline)) void search_lanes(struct touchstone_engine *engine, uint32_t i,
															   size_t candidates, struct plan *plan)
{
	uint32_t *candidate = engine->candidate;
	const struct body *body = engine->body, *self = &body[i];
	const struct place *place = engine->place;
	const lanes never = (lanes){0} + INFINITY;
	lanes soonest = never;
	lane_mask where = {0}, tie = {0};
	for (size_t k = candidates; k % LANES; k++) candidate[k] = i; /* a particle never meets itself */
	for (size_t k = 0; k < candidates; k += LANES) {
		lanes field[LANES];
		int32_t index[3][LANES];
		uint32_t images = 0;
		for (int lane = 0; lane < LANES; lane++) {
			uint32_t entry = candidate[k + lane], j = entry_particle(entry);
			images |= entry >> ENTRY_BITS;
			memcpy(&field[lane], &body[j], sizeof field[lane]);
			for (int axis = 0; axis < 3; axis++) index[axis][lane] = place[j].index[axis];
		}
		if (images)
			for (int lane = 0; lane < LANES; lane++)
				for (int axis = 0; axis < 3; axis++)
					index[axis][lane] += entry_image(candidate[k + lane], axis) * engine->places[axis];
		transpose_lanes(field);

		lanes wait = (self->time - field[6]) + (self->page - field[7]);
		lane_mask self_flies = wait < 0;
		lanes r[3], v[3];
		for (int axis = 0; axis < 3; axis++) {
			lane_int places;
			memcpy(&places, index[axis], sizeof places);
			lanes shift = __builtin_convertvector(place[i].index[axis] - places, lanes) * engine->place_width[axis];
			lanes offset = (self->position[axis] - field[axis]) + shift;
			lanes other = field[3 + axis], own = (lanes){0} + self->velocity[axis];
			r[axis] = offset - pick(self_flies, own, other) * wait;
			v[axis] = own - other;
		}
		lanes contact = (lanes){0} + engine->contact;
		if (engine->species_count > 1)
			for (int lane = 0; lane < LANES; lane++)
				contact[lane] = contact_distance(engine, i, entry_particle(candidate[k + lane]));
		lanes a = v[0] * v[0] + v[1] * v[1] + v[2] * v[2];
		lanes b = r[0] * v[0] + r[1] * v[1] + r[2] * v[2];
		lanes c = r[0] * r[0] + r[1] * r[1] + r[2] * r[2] - contact * contact;
		lanes discriminant = b * b - a * c;
		lane_mask overlap = c <= 0, meets = (b < 0) & (overlap | (discriminant > 0));
		double radicand[LANES];
		memcpy(radicand, &discriminant, sizeof radicand);
		for (int lane = 0; lane < LANES; lane++) radicand[lane] = sqrt(radicand[lane]);
		memcpy(&discriminant, radicand, sizeof radicand);
		lanes after = pick(overlap, (lanes){0}, c / (discriminant - b));
		/* its own clock is ahead of all others but when it looks again at what it left long ago */
		lane_mask odd = meets & self_flies;
		lanes time = pick(meets & ~self_flies, self->time + after, never);
		tie |= (time == soonest) & (time < never);
		lane_mask sooner = time < soonest;
		where = (sooner & (int64_t)k) | (where & ~sooner);
		soonest = pick(sooner, time, soonest);
		if (any(odd))
			for (int lane = 0; lane < LANES; lane++)
				if (odd[lane]) {
					uint32_t entry = candidate[k + lane];
					consider(engine, i, &body[entry_particle(entry)], after[lane], TOUCHSTONE_CONTACT, entry, plan);
				}
	}
	double first = INFINITY;
	int found = 0;
	size_t entry = 0;
	for (int lane = 0; lane < LANES; lane++) first = soonest[lane] < first ? soonest[lane] : first;
	if (first == INFINITY) return;
	for (int lane = 0; lane < LANES; lane++)
		if (soonest[lane] == first) found++, entry = (size_t)where[lane] + lane;
	if (found > 1 || any(tie))
		consider_pairs(engine, i, candidates, plan); /* ties are rare, and settled where they always are */
	else
		consider_moment(engine, i, moment_on(engine, self->page, first), TOUCHSTONE_CONTACT, candidate[entry], plan);
}

#ifdef __x86_64__
__attribute__((target("arch=x86-64-v3"))) static void search_256(struct touchstone_engine *engine, uint32_t i,
																 size_t candidates, struct plan *plan)
{
	search_lanes(engine, i, candidates, plan);
}
#endif

static void search_128(struct touchstone_engine *engine, uint32_t i, size_t candidates, struct plan *plan)
{
	search_lanes(engine, i, candidates, plan);
}

/* The fastest search that gives the engine's events. */
static pair_search *choose_pairs(const struct touchstone_engine *engine)
{
	if (engine->accelerated || engine->method->ball_ball != stable_ball_ball) return consider_pairs;
#ifdef __x86_64__
	if (has_avx512()) return search_512;
	if (__builtin_cpu_supports("avx2")) return search_256;
#endif
	return search_128;
}
