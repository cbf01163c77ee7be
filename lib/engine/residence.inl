/* In which cell a particle is looked for, and how long it stays there. What no event can tell from its position: a cell
 * may be wider than a search needs, and then a particle is not moved to the next one at the face, but where it has
 * strayed so far beyond that two particles which have strayed towards each other are still not missed. By then it may
 * go on along other axes too. A straight flight so passes from cell to cell less than half as often. */

/* Where the last event left a particle along an axis, from the low end of the box. */
static double coordinate_in_box(const struct touchstone_engine *engine, uint32_t i, int axis)
{
	return coordinate_in_image(engine, i, axis) + engine->box[axis] / 2;
}

/* How long after its last event a particle passes a face `gap` ahead of where that event left it, under constant
 * acceleration, if it does so after `passed`; INFINITY if it does not. */
static double crossing_time(double gap, double speed, double acceleration, double passed)
{
	if (acceleration == 0) return speed > 0 ? gap / speed : INFINITY;
	double radicand = speed * speed + 2 * acceleration * gap;
	if (radicand < 0 || (radicand == 0 && acceleration < 0)) /* out of reach, or a touch that goes no further */
		return acceleration < 0 ? INFINITY : fmax(passed, -speed / acceleration);
	double end = sqrt(radicand);
	double time = speed > 0 ? 2 * gap / (speed + end) : (end - speed) / acceleration;
	if (time >= passed) return time;
	double gap_now = gap - passed * (speed + acceleration / 2 * passed);
	return gap_now <= 0 && speed + acceleration * passed > 0 ? passed : INFINITY;
}

/* The middle of the cell a particle is in, along an axis, and how far from there it leaves it. */
static double middle_along(const struct touchstone_engine *engine, uint32_t i, int axis)
{
	return (engine->itinerary[i].cell[axis] - 0.5) * engine->cell_side[axis];
}

static double room_along(const struct touchstone_engine *engine, int axis)
{
	return 0.5 * engine->cell_side[axis] + engine->stray[axis];
}

/* Whether there is no other cell beyond that one, up or down an axis. */
static bool ends_along(const struct touchstone_engine *engine, uint32_t i, int axis, bool up)
{
	return !engine->periodic[axis] && engine->itinerary[i].cell[axis] == (up ? engine->cells.count[axis] : 1);
}

/* How long after its last event a particle leaves its cell along an axis, and whether by the upper face. For straight
 * flights without branches, which a processor would have to guess. */
static double leaving_along(const struct touchstone_engine *engine, uint32_t i, int axis, bool *upper)
{
	double speed = to_double(engine->body[i].velocity[axis]), room = room_along(engine, axis);
	double offset = coordinate_in_box(engine, i, axis) - middle_along(engine, i, axis);
	if (!engine->accelerated) {
		*upper = speed > 0;
		if (speed == 0 || ends_along(engine, i, axis, *upper)) return INFINITY; /* seldom, or always */
		return (copysign(room, speed) - offset) / speed;
	}
	double gravity = to_double(engine->acceleration[axis]), passed = engine->itinerary[i].entered;
	double up = INFINITY, down = INFINITY;
	if (!ends_along(engine, i, axis, true)) up = crossing_time(room - offset, speed, gravity, passed);
	if (!ends_along(engine, i, axis, false)) down = crossing_time(offset + room, -speed, -gravity, passed);
	*upper = up < down;
	return *upper ? up : down;
}

/* How long after its last event a particle leaves the cell it is in, and by which face; INFINITY if it never does. */
static double leaving_wait(const struct touchstone_engine *engine, uint32_t i, uint8_t *next)
{
	double soonest = INFINITY;
	int face = 0;
	if (engine->neighbours.skin > 0) {
		*next = LEAVES_ANCHOR;
		return anchor_wait(engine, i);
	}
	for (int axis = 0; axis < engine->dimensions; axis++) {
		bool upper;
		double time = leaving_along(engine, i, axis, &upper);
		bool sooner = time < soonest;
		face += sooner * (1 + 2 * axis + upper - face);
		soonest = time < soonest ? time : soonest;
	}
	*next = (uint8_t)face;
	return soonest;
}

/* The same as a moment: page, and time since it began. In double for every arithmetic: the cells' slack pays for the
 * rounding. */
static double leaving(const struct touchstone_engine *engine, uint32_t i, double *page, uint8_t *next)
{
	if (!engine->cells.entry) return INFINITY;
	double soonest = leaving_wait(engine, i, next) + to_double(engine->body[i].time), begins = engine->body[i].page;
	if (engine->uneven) {
		begins = floor(begins * engine->pages_per_time) * engine->page_length;
		soonest += engine->body[i].page - begins;
	}
	double pages = soonest * engine->pages_per_time;
	if (!(pages < 0x1p52) || soonest == INFINITY) return INFINITY;
	double turned = pages > 0 ? (double)(int64_t)pages * engine->page_turn : 0;
	*page = begins + turned;
	return soonest - turned;
}

/* Does a straight flight end in the cell where it begins? Then it does not leave it, and when it would is no matter. */
static inline bool stays(const struct touchstone_engine *engine, uint32_t i, double flight)
{
	if (engine->accelerated) return false;
	if (engine->neighbours.skin > 0) return !leaves_anchor(engine, i, flight);
	bool inside = true;
	for (int axis = 0; axis < engine->dimensions; axis++) {
		double end = coordinate_in_box(engine, i, axis) + to_double(engine->body[i].velocity[axis]) * flight;
		inside &= fabs(end - middle_along(engine, i, axis)) < room_along(engine, axis);
	}
	return inside;
}

/* Has a straight flight come to where a particle may as well be in the next cell along it? Adds those axes to `step`,
 * where they are not in it; false if there is none. */
static bool may_step(const struct touchstone_engine *engine, uint32_t i, double flight, int step[3])
{
	bool any = false;
	for (int axis = 0; axis < engine->dimensions; axis++) {
		double speed = to_double(engine->body[i].velocity[axis]);
		double at = coordinate_in_box(engine, i, axis) + speed * flight;
		double ahead = copysign(1, speed) * (at - middle_along(engine, i, axis));
		bool up = speed > 0, there = ahead >= 0.5 * engine->cell_side[axis] - engine->stray[axis];
		bool steps = there & (speed != 0) & (step[axis] == 0) & !ends_along(engine, i, axis, up);
		step[axis] += steps * (2 * up - 1);
		any |= steps;
	}
	return any;
}

static void out_of_memory(struct touchstone_engine *engine);

/* Enters every particle into its cell; false when one is too full. */
static bool fill_cells(struct touchstone_engine *engine)
{
	for (uint32_t i = 0; i < engine->count; i++)
		if (!cells_insert(&engine->cells, engine->itinerary[i].cell, i)) return false;
	return true;
}

/* The next larger capacity of a cell: small steps first, since what a search reads grows with it. */
static uint32_t larger_capacity(uint32_t capacity)
{
	return capacity < 16 ? capacity + 4 : 2 * capacity;
}

/* Makes cells of the wanted capacity, or of the least larger one in which all particles find room; false when memory
 * does not suffice. */
static bool make_cells(struct touchstone_engine *engine, const int count[3], uint32_t capacity)
{
	for (;; capacity = larger_capacity(capacity)) {
		cells_destroy(&engine->cells);
		free(engine->lists);
		engine->lists = NULL;
		if (!cells_create(&engine->cells, engine->dimensions, engine->periodic, count, capacity)) return false;
		size_t most = cells_most(&engine->cells) + 32;
		engine->lists = malloc(4 * most * sizeof *engine->lists);
		if (!engine->lists) return false;
		for (int p = 0; p < 2; p++) {
			engine->candidate[p] = engine->lists + p * most;
			engine->listing[p] = (struct listing){.entry = engine->lists + (2 + p) * most, .particle = nobody};
		}
		if (fill_cells(engine)) return true;
	}
}

/* Enters a particle into its cell; false when memory ran out. */
static bool enter_cell(struct touchstone_engine *engine, uint32_t i)
{
	if (cells_insert(&engine->cells, engine->itinerary[i].cell, i)) return true;
	int count[3] = {engine->cells.count[0], engine->cells.count[1], engine->cells.count[2]};
	return make_cells(engine, count, larger_capacity(engine->cells.capacity));
}

/* Takes a particle out of its cell and into one next to it. Returns whether that is in another image of the box. */
static bool move_by(struct touchstone_engine *engine, uint32_t i, const int step[3])
{
	struct itinerary *itinerary = &engine->itinerary[i];
	bool wraps = false;
	cells_remove(&engine->cells, itinerary->cell, i);
	for (int axis = 0; axis < engine->dimensions; axis++) {
		int cell = itinerary->cell[axis] + step[axis], last = engine->cells.count[axis];
		if (cell < 1 || cell > last) {
			cell -= step[axis] * last;
			shift_image(engine, i, axis, -step[axis]);
			wraps = true;
		}
		itinerary->cell[axis] = (uint16_t)cell;
	}
	if (!enter_cell(engine, i)) out_of_memory(engine);
	if (wraps) itinerary->changes++; /* images are counted from here on: whoever knew the old one asks again */
	return wraps;
}
