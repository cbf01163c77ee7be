/* The future-event list: a calendar of days, each an unsorted pile of notes, and a heap for the day that is open
 * (Paul 2007, with arrays for lists). A note costs one append of eight bytes; what it is about is looked up, and
 * sorted, only when its day comes. A note that was overtaken is not searched for: its stamp no longer fits its
 * particle, and it is dropped when it turns up.
 *
 * A day is 2^k long and lies within one page, so that the day of a moment is exact and entries of one day compare by
 * their time alone. */

struct note {
	uint32_t particle; /* whose event it is */
	uint32_t stamp;
};

/* An event of the day that is open. It holds all that its place in the order depends on: nothing that changes later,
 * not even its being overtaken, may disorder the heap. */
struct entry {
	num time; /* since the page began */
	struct note note;
	uint32_t partner; /* as in struct itinerary */
	uint32_t kind;    /* 0: bookkeeping, which goes first; otherwise 1 + what the particle meets */
};

enum { PILE = 7, WAITING = 8 };

struct pile {                   /* one cache line */
	_Alignas(64) uint32_t more; /* number of the block that goes on with it, which is full; 0: none */
	struct note note[PILE];
};

struct distant {
	double day;
	struct note note;
};

struct agenda {
	double day;         /* length of a day */
	double today;       /* number of the day that is open */
	double horizon;     /* first day that the ring does not hold */
	size_t days;        /* size of the ring, a power of two */
	double per_day;     /* its reciprocal, exactly */
	struct pile *pile;  /* the days of the ring, */
	uint8_t *used;      /* and how many notes each holds: apart, so that to add one waits for no cache line */
	size_t piled;       /* entries in the ring */
	struct pile *block; /* what does not fit into a day's own pile; number 0 is never used */
	uint32_t blocks, block_room, spare;
	struct entry *heap; /* the day that is open */
	size_t size, heap_room;
	struct distant *distant; /* beyond the horizon, in no order, or as a heap with the earliest day first */
	size_t distants, distant_room;
	size_t looked_through;           /* how many there were when those overtaken were last dropped */
	bool sparse;                     /* whether they are that heap */
	size_t beyond;                   /* events so far off that their day has no exact number: they were not entered */
	uint64_t opened, sorted;         /* days opened and entries found there: to judge the length of a day by */
	struct distant waiting[WAITING]; /* where days are many: notes on their way into the ring, */
	uint32_t waits, oldest;          /* so many, and the one of them that came first */
	bool wide;                       /* whether its days are so many that none is in the cache when it is opened */
	bool exhausted;                  /* memory ran out and entries were lost: the agenda is of no more use */
};

/* Of two entries of one day, does `a` come first? Is a note still what its particle means to do, and what is that? */
static bool entry_first(const void *context, const struct entry *a, const struct entry *b);
static bool note_holds(const void *context, struct note note);
static struct entry entry_of(const void *context, struct note note);

/* Fetch into the cache what will be wanted when a note's turn comes: today, tomorrow, and the day after. */
static void note_at_hand(const void *context, struct note note);
static void note_ahead(const void *context, struct note note);
static void note_far_ahead(const void *context, struct note note);

/* Makes room for one more element; false when there is no memory. */
static bool agenda_grow(void **array, size_t *room, size_t used, size_t size)
{
	if (used < *room) return true;
	size_t more = *room + *room / 16 + 16;
	void *grown = realloc(*array, more * size);
	if (!grown) return false;
	*array = grown;
	*room = more;
	return true;
}

static void agenda_destroy(struct agenda *agenda)
{
	free(agenda->pile);
	free(agenda->used);
	free(agenda->block);
	free(agenda->heap);
	free(agenda->distant);
	*agenda = (struct agenda){0};
}

/* Lays out an empty calendar. `day` is a power of two, `days` too; `page` and `offset` say when it begins. */
static bool agenda_create(struct agenda *agenda, double day, size_t days, double page, double offset)
{
	double today = floor(page / day) + floor(offset / day);
	*agenda = (struct agenda){.day = day,
							  .per_day = 1 / day,
							  .days = days,
							  .today = today,
							  .horizon = today + (double)days,
							  .wide = days >= (size_t)1 << 13};
	agenda->pile = memory_room(days * sizeof *agenda->pile);
	agenda->used = calloc(days, sizeof *agenda->used);
	if (agenda->pile) memset(agenda->pile, 0, days * sizeof *agenda->pile);
	return agenda->pile && agenda->used;
}

static size_t agenda_memory(const struct agenda *agenda)
{
	return agenda->days * (sizeof *agenda->pile + sizeof *agenda->used) + agenda->block_room * sizeof *agenda->block +
		   agenda->heap_room * sizeof *agenda->heap + agenda->distant_room * sizeof *agenda->distant;
}

/* Makes room in a full pile by moving what it holds to a block; false when there is no memory. */
static bool pile_move(struct agenda *agenda, struct pile *pile)
{
	uint32_t number = agenda->spare;
	if (number) {
		agenda->spare = agenda->block[number].more;
	} else {
		size_t room = agenda->block_room;
		if (agenda->blocks == 0) agenda->blocks = 1;
		if (!agenda_grow((void **)&agenda->block, &room, agenda->blocks, sizeof *agenda->block)) return false;
		agenda->block_room = (uint32_t)room;
		number = agenda->blocks++;
	}
	agenda->block[number] = *pile;
	pile->more = number;
	return true;
}

/* Where the ring holds a day. */
static size_t place_of(const struct agenda *agenda, double day)
{
	return (size_t)(int64_t)day & (agenda->days - 1);
}

/* A note is given in its two parts, since one put together from them would be read, for the call, before they are
 * written, which takes a hundredth of a gas's time. */
static void pile_put(struct agenda *agenda, double day, uint32_t particle, uint32_t stamp)
{
	size_t place = place_of(agenda, day);
	struct pile *pile = &agenda->pile[place];
	uint8_t *used = &agenda->used[place];
	if (*used == PILE) {
		if (!pile_move(agenda, pile)) {
			agenda->exhausted = true;
			return;
		}
		*used = 0;
	}
	pile->note[(*used)++] = (struct note){particle, stamp};
	agenda->piled++;
}

/* Puts the note that has waited longest into the ring. */
static void waiting_put(struct agenda *agenda)
{
	const struct distant *oldest = &agenda->waiting[agenda->oldest++ % WAITING];
	agenda->waits--;
	pile_put(agenda, oldest->day, oldest->note.particle, oldest->note.stamp);
}

static void waiting_put_all(struct agenda *agenda)
{
	while (agenda->waits) waiting_put(agenda);
}

/* Enters a note into the ring. Where none of its days is in the cache, it waits for its own, and nobody for it. */
static void pile_add(struct agenda *agenda, double day, struct note note)
{
	if (!agenda->wide) {
		pile_put(agenda, day, note.particle, note.stamp);
		return;
	}
	ahead_to_change(&agenda->pile[place_of(agenda, day)]);
	if (agenda->waits == WAITING) waiting_put(agenda);
	agenda->waiting[(agenda->oldest + agenda->waits++) % WAITING] = (struct distant){day, note};
}

/* Enters into the first `size` of the distant, which are a heap, one more. */
static void distant_rise(struct distant *heap, size_t size, struct distant distant)
{
	size_t hole = size;
	for (size_t parent; hole && distant.day < heap[parent = (hole - 1) / 2].day; hole = parent)
		heap[hole] = heap[parent];
	heap[hole] = distant;
}

/* Takes the earliest out of that heap. */
static struct distant distant_take(struct agenda *agenda)
{
	struct distant *heap = agenda->distant, first = heap[0], last = heap[--agenda->distants];
	size_t hole = 0, child;
	while ((child = 2 * hole + 1) < agenda->distants) {
		child += child + 1 < agenda->distants && heap[child + 1].day < heap[child].day;
		if (last.day <= heap[child].day) break;
		heap[hole] = heap[child];
		hole = child;
	}
	heap[hole] = last;
	return first;
}

static void distant_add(struct agenda *agenda, double day, struct note note)
{
	const struct distant distant = {day, note};
	if (!agenda_grow((void **)&agenda->distant, &agenda->distant_room, agenda->distants, sizeof *agenda->distant))
		agenda->exhausted = true;
	else if (agenda->sparse)
		distant_rise(agenda->distant, agenda->distants++, distant);
	else
		agenda->distant[agenda->distants++] = distant;
}

/* Part of its callers: an entry that was put together for a call would be read before it is written, in larger pieces
 * than it was written in, which takes a fiftieth of a gas's time. */
static inline __attribute__((always_inline)) void heap_add(struct agenda *agenda, const void *context,
														   struct entry entry)
{
	if (!agenda_grow((void **)&agenda->heap, &agenda->heap_room, agenda->size, sizeof *agenda->heap)) {
		agenda->exhausted = true;
		return;
	}
	size_t hole = agenda->size++;
	while (hole) {
		size_t parent = (hole - 1) / 2;
		if (!entry_first(context, &entry, &agenda->heap[parent])) break;
		agenda->heap[hole] = agenda->heap[parent];
		hole = parent;
	}
	agenda->heap[hole] = entry;
}

static void heap_drop(struct agenda *agenda, const void *context)
{
	struct entry last = agenda->heap[--agenda->size];
	size_t hole = 0, size = agenda->size;
	for (;;) {
		size_t child = 2 * hole + 1;
		if (child >= size) break;
		if (child + 1 < size && entry_first(context, &agenda->heap[child + 1], &agenda->heap[child])) child++;
		if (!entry_first(context, &agenda->heap[child], &last)) break;
		agenda->heap[hole] = agenda->heap[child];
		hole = child;
	}
	agenda->heap[hole] = last;
}

/* Enters an event of a particle, `entry.time` after the beginning of `page`. What is overdue is served at once, the
 * earliest first. */
static void agenda_push(struct agenda *agenda, const void *context, double page, struct entry entry)
{
	double days = page * agenda->per_day, more = double_below(entry.time) * agenda->per_day;
	if (!(days < 0x1p52 && more < 0x1p52)) {
		agenda->beyond++;
		return;
	}
	double day = days + (double)(int64_t)more; /* pages are whole days, and times are not negative */
	if (day < agenda->today) {
		double early = page - agenda->today * agenda->day + to_double(entry.time);
		entry.time = from_double(fmin(early, -0x1p-100));
		day = agenda->today;
	}
	if (day == agenda->today)
		heap_add(agenda, context, entry);
	else if (day < agenda->horizon)
		pile_add(agenda, day, entry.note);
	else
		distant_add(agenda, day, entry.note);
}

/* Looks through what is beyond the horizon for what is not any more, and for what was overtaken. Returns how many went
 * into the ring. */
static size_t distant_look(struct agenda *agenda, const void *context)
{
	enum { AHEAD = 24 };
	size_t kept = 0, moved = 0;
	for (size_t i = 0; i < agenda->distants; i++) {
		struct distant distant = agenda->distant[i];
		if (agenda->wide && i + AHEAD < agenda->distants) note_far_ahead(context, agenda->distant[i + AHEAD].note);
		if (!note_holds(context, distant.note)) continue;
		if (distant.day < agenda->horizon)
			pile_add(agenda, distant.day, distant.note), moved++;
		else
			agenda->distant[kept++] = distant;
	}
	agenda->distants = agenda->looked_through = kept;
	return moved;
}

/* A new round of the ring begins on `today`. Where it brings but few of those beyond the horizon, they are not all
 * looked through in the rounds that come: they are made a heap. */
static void agenda_turn(struct agenda *agenda, const void *context, double today)
{
	enum { FEW = 16 };
	size_t moved = 0;
	bool heap = agenda->sparse && agenda->distants <= 2 * agenda->looked_through + FEW;
	agenda->today = today;
	agenda->horizon = today + (double)agenda->days;
	if (!heap) moved = distant_look(agenda, context);
	while (heap && agenda->distants && agenda->distant[0].day < agenda->horizon) {
		struct distant next = distant_take(agenda);
		if (note_holds(context, next.note)) pile_add(agenda, next.day, next.note), moved++;
	}
	agenda->sparse = FEW * moved < agenda->distants;
	for (size_t i = 0; agenda->sparse && !heap && i < agenda->distants; i++)
		distant_rise(agenda->distant, i, agenda->distant[i]);
}

/* The first day beyond the horizon that has entries; INFINITY: none. */
static double distant_first(struct agenda *agenda, const void *context)
{
	double first = INFINITY;
	if (agenda->sparse) {
		while (agenda->distants && !note_holds(context, agenda->distant[0].note)) distant_take(agenda);
		return agenda->distants ? agenda->distant[0].day : INFINITY;
	}
	for (size_t i = 0; i < agenda->distants; i++)
		if (agenda->distant[i].day < first && note_holds(context, agenda->distant[i].note))
			first = agenda->distant[i].day;
	return first;
}

/* Enters what so many notes of a pile still hold true into the heap. */
static void pile_enter(struct agenda *agenda, const void *context, const struct pile *pile, uint32_t used)
{
	for (uint32_t i = 0; i < used; i++) {
		if (!note_holds(context, pile->note[i])) continue;
		note_at_hand(context, pile->note[i]);
		heap_add(agenda, context, entry_of(context, pile->note[i]));
	}
	agenda->piled -= used;
	agenda->sorted += used;
}

/* Calls `fetch` for each note of the day that is so many days off. */
static void fetch_notes(const struct agenda *agenda, const void *context, int off,
						void (*fetch)(const void *context, struct note note))
{
	size_t place = place_of(agenda, agenda->today + off);
	const struct pile *pile = &agenda->pile[place];
	uint32_t used = agenda->used[place];
	for (;; used = PILE) {
		for (uint32_t i = 0; i < used; i++) fetch(context, pile->note[i]);
		if (!pile->more) return;
		pile = &agenda->block[pile->more];
	}
}

/* Fetches the days that come into the cache, each thing a day after that which tells where it is. Where days are few
 * they and most of what they lead to are in it, or near: only what is looked at first is fetched. */
static void fetch_ahead(const struct agenda *agenda, const void *context)
{
	if (!agenda->wide) {
		fetch_notes(agenda, context, 1, note_far_ahead);
		return;
	}
	ahead(&agenda->pile[place_of(agenda, agenda->today + 4)]);
	uint32_t more = agenda->pile[place_of(agenda, agenda->today + 3)].more;
	if (more) ahead(&agenda->block[more]);
	fetch_notes(agenda, context, 2, note_far_ahead);
	fetch_notes(agenda, context, 1, note_ahead);
}

/* Opens the next day that has entries; false when there is none. `*turned` tells when a round ended on the way. */
static bool agenda_open(struct agenda *agenda, const void *context, bool *turned)
{
	while (agenda->size == 0) {
		waiting_put_all(agenda);
		if (agenda->piled == 0) {
			double next = distant_first(agenda, context);
			if (next == INFINITY) return false;
			agenda_turn(agenda, context, next);
			*turned = true;
		} else if (++agenda->today == agenda->horizon) {
			agenda_turn(agenda, context, agenda->today);
			*turned = true;
		}
		waiting_put_all(agenda);
		size_t place = place_of(agenda, agenda->today);
		struct pile *pile = &agenda->pile[place];
		pile_enter(agenda, context, pile, agenda->used[place]);
		agenda->used[place] = 0;
		while (pile->more) {
			uint32_t number = pile->more;
			pile_enter(agenda, context, &agenda->block[number], PILE);
			pile->more = agenda->block[number].more;
			agenda->block[number].more = agenda->spare;
			agenda->spare = number;
		}
		agenda->opened++;
		fetch_ahead(agenda, context);
	}
	return true;
}
