#include "measure/inconsistency.h"

#include <math.h>
#include <stdlib.h>

#include "overlap/excess.h"

static const uint32_t nobody = UINT32_MAX;

/* Excesses up to this may have another sign than the exact ones, of positions in so many bits. */
static double doubtful(int bits)
{
	return ldexp(16, -bits);
}

bool inconsistency_begin(struct inconsistency *inconsistency, int bits, size_t particles)
{
	*inconsistency = (struct inconsistency){
		.bits = bits,
		.listener = {inconsistency_test, inconsistency, inconsistency_reach, doubtful(bits), 0},
		.met = {nobody, nobody},
	};
	inconsistency->last = malloc(particles * sizeof *inconsistency->last);
	for (size_t p = 0; inconsistency->last && p < particles; p++)
		inconsistency->last[p] = (struct inconsistency_last){0, nobody, nobody};
	return inconsistency->last;
}

void inconsistency_end(struct inconsistency *inconsistency)
{
	free(inconsistency->last);
	inconsistency->last = NULL;
}

void inconsistency_merge(struct inconsistency *into, const struct inconsistency *from)
{
	into->events += from->events;
	for (int kind = 0; kind < INCONSISTENCIES; kind++) into->count[kind] += from->count[kind];
}

/* Whether the tests after the later of both last events found the pair inconsistent. */
static bool misread_when_found(const struct inconsistency *inconsistency, uint32_t first, uint32_t second)
{
	const struct inconsistency_last *a = &inconsistency->last[first], *b = &inconsistency->last[second];
	return a->event >= b->event ? a->misread == second : b->misread == first;
}

/* During an observer's call: whether the pair whose event or test it is stands within its distance, exactly; at it, it
 * does not. */
static bool stands_within(const struct touchstone_engine *engine)
{
	double terms[3][3 * TOUCHSTONE_MOST_TERMS], distance[TOUCHSTONE_MOST_TERMS];
	int count = touchstone_separation(engine, terms, distance);
	return excess_signed(terms, count, distance) < 0;
}

/* Whether a step's event finds the pair on the side on which its state is not. */
static bool misplaced(const struct touchstone_engine *engine, const struct touchstone_event *event)
{
	bool at_step =
		event->kind == TOUCHSTONE_CAPTURE || event->kind == TOUCHSTONE_RELEASE || event->kind == TOUCHSTONE_BOUNCE;
	if (!at_step) return false;
	bool belongs_inside =
		event->kind == TOUCHSTONE_RELEASE || (event->kind == TOUCHSTONE_BOUNCE && event->approach < 0);
	return stands_within(engine) != belongs_inside;
}

void inconsistency_see(void *context, struct touchstone_engine *engine, const struct touchstone_event *event)
{
	struct inconsistency *inconsistency = context;
	if (event->kind == TOUCHSTONE_CROSSING) return;
	bool pair = event->kind != TOUCHSTONE_WALL;
	uint64_t number = ++inconsistency->events;
	inconsistency->met[0] = event->first;
	inconsistency->met[1] = pair ? event->second : nobody;
	/* looked at when the pair's separation is known: by then it is in the cache */
	for (int p = 0; p < 1 + pair; p++) __builtin_prefetch(&inconsistency->last[inconsistency->met[p]]);
	if (pair) {
		inconsistency->count[INCONSISTENT_EXECUTED] += misplaced(engine, event);
		inconsistency->count[INCONSISTENT_FOUND] += misread_when_found(inconsistency, event->first, event->second);
	}
	for (int p = 0; p < 1 + pair; p++) {
		struct inconsistency_last *last = &inconsistency->last[inconsistency->met[p]];
		inconsistency->before[p] = *last;
		*last = (struct inconsistency_last){number, inconsistency->met[1 - p], nobody};
	}
}

/* The state that a pair's separation speaks for, exactly. */
static int read_state(const struct inconsistency *inconsistency, const struct touchstone_engine *engine,
					  const struct touchstone_test *test)
{
	if (fabs(test->excess) > doubtful(inconsistency->bits)) return test->within;
	return stands_within(engine) ? test->step + 1 : test->step;
}

/* Which kind a test is: whose event it follows. */
static enum inconsistency_kind kind_of(const struct inconsistency *inconsistency, const struct touchstone_test *test)
{
	bool swapped = test->first != inconsistency->met[0] && test->first != inconsistency->met[1];
	uint32_t met = swapped ? test->second : test->first, other = swapped ? test->first : test->second;
	int p = met == inconsistency->met[1];
	if (other == inconsistency->met[1 - p]) return INCONSISTENT_AFTER;
	const struct inconsistency_last *mine = &inconsistency->before[p], *yours = &inconsistency->last[other];
	bool own = mine->event > 0 && mine->event == yours->event && mine->partner == other;
	return own ? INCONSISTENT_LATER : INCONSISTENT_OTHERS;
}

void inconsistency_test(void *context, struct touchstone_engine *engine, const struct touchstone_test *test)
{
	struct inconsistency *inconsistency = context;
	if (read_state(inconsistency, engine, test) == test->state) return;
	inconsistency->count[kind_of(inconsistency, test)]++;
	struct inconsistency_last *first = &inconsistency->last[test->first], *second = &inconsistency->last[test->second];
	if (first->event == inconsistency->events) first->misread = test->second;
	if (second->event == inconsistency->events) second->misread = test->first;
}

static const struct {
	const char *name, *about;
} kinds[INCONSISTENCIES] = {
	[INCONSISTENT_EXECUTED] = {"executed", "the pair whose event it is, when it is executed"},
	[INCONSISTENT_FOUND] = {"found", "that pair, when its event was found: the separation Alder and Wainwright store"},
	[INCONSISTENT_AFTER] = {"after", "that pair, when it is next tested: right after its event"},
	[INCONSISTENT_LATER] = {"later", "that pair, when it is first tested because of another's event"},
	[INCONSISTENT_OTHERS] = {"others", "any other pair of the two, at the event and when tested right after it"},
};

const char *inconsistency_name(enum inconsistency_kind kind)
{
	return kinds[kind].name;
}

const char *inconsistency_about(enum inconsistency_kind kind)
{
	return kinds[kind].about;
}
