#include "measure/misreading.h"

#include <search.h>
#include <stdio.h>
#include <stdlib.h>

static const uint32_t nobody = UINT32_MAX;

/* A pair in the ledger, numbered as in the scene, the smaller number first. */
struct ledger_pair {
	uint32_t first, second;
	int state;
};

static int compare(const void *a, const void *b)
{
	const struct ledger_pair *x = a, *y = b;
	if (x->first != y->first) return x->first < y->first ? -1 : 1;
	return (x->second > y->second) - (x->second < y->second);
}

static int look_up(const struct misreading *misreading, uint32_t first, uint32_t second)
{
	struct ledger_pair *const *found = tfind(&(struct ledger_pair){first, second, 0}, &misreading->ledger, compare);
	return found ? (*found)->state : 0;
}

static void write_down(struct misreading *misreading, uint32_t first, uint32_t second, int state)
{
	struct ledger_pair key = {first, second, state}, **found = tfind(&key, &misreading->ledger, compare);
	if (found && state) {
		(*found)->state = state;
	} else if (found) {
		struct ledger_pair *entry = *found;
		tdelete(entry, &misreading->ledger, compare);
		free(entry);
	} else if (state) {
		struct ledger_pair *entry = malloc(sizeof *entry);
		if (entry) *entry = key;
		if (entry && tsearch(entry, &misreading->ledger, compare)) return;
		free(entry);
		misreading->exhausted = true;
	}
}

void misreading_begin(struct misreading *misreading, const struct touchstone_scene *scene,
					  struct touchstone_engine *engine)
{
	*misreading = (struct misreading){.scene = scene, .last.kind = TOUCHSTONE_CROSSING};
	for (uint32_t p = 0; p < scene->particle_count; p++) {
		size_t count = touchstone_captured(engine, p, NULL, 0);
		struct touchstone_captured *list = malloc((count + 1) * sizeof *list);
		if (!list) {
			misreading->exhausted = true;
			return;
		}
		touchstone_captured(engine, p, list, count);
		for (size_t k = 0; k < count; k++)
			if (p < list[k].partner) write_down(misreading, p, list[k].partner, list[k].state);
		free(list);
	}
}

void misreading_end(struct misreading *misreading)
{
	while (misreading->ledger) {
		struct ledger_pair *entry = *(struct ledger_pair **)misreading->ledger;
		tdelete(entry, &misreading->ledger, compare);
		free(entry);
	}
}

/* Potential energy of a pair in a state: so many of its steps, from outside, it is within. */
static double energy_in(const struct misreading *misreading, uint32_t first, uint32_t second, int state)
{
	const struct touchstone_scene *scene = misreading->scene;
	uint32_t a = scene->particles[first].species, b = scene->particles[second].species;
	for (size_t p = 0; state > 0 && p < scene->potential_count; p++) {
		const struct touchstone_potential *potential = &scene->potentials[p];
		const uint32_t *species = potential->species;
		bool theirs = (species[0] == a && species[1] == b) || (species[0] == b && species[1] == a);
		if (theirs) return potential->steps[potential->step_count - (size_t)state].energy;
	}
	return 0;
}

/* Whether this is what the event before it was. */
static bool alike(const struct touchstone_event *a, const struct touchstone_event *b)
{
	return a->kind == b->kind && a->first == b->first && a->second == b->second && a->time >= b->time;
}

/* Enters a misreading; `third` is whom one of the pair has met, or nobody where the two have met each other. */
static void misread(struct misreading *misreading, uint32_t first, uint32_t second, uint32_t third, int was, int read)
{
	const struct touchstone_event *event = &misreading->last;
	bool own = third == nobody;
	struct misread_pair *earliest = own ? &misreading->repeated : &misreading->missed;
	if (!earliest->event)
		*earliest =
			(struct misread_pair){misreading->events, event->time, event->kind, first, second, third, was, read};
	misreading->repeats += own;
	misreading->misses += !own;
	misreading->energy += energy_in(misreading, first, second, read) - energy_in(misreading, first, second, was);
	write_down(misreading, first, second, read);
}

void misreading_see(void *context, struct touchstone_engine *engine, const struct touchstone_event *event)
{
	(void)engine;
	struct misreading *misreading = context;
	if (event->kind == TOUCHSTONE_CROSSING) return;
	misreading->events++;
	misreading->alike = alike(&misreading->last, event) ? misreading->alike + 1 : 1;
	misreading->last = *event;
	if (misreading->alike == MISREADING_STUCK && !misreading->stuck.event)
		misreading->stuck = (struct misread_pair){.event = misreading->events,
												  .time = event->time,
												  .kind = event->kind,
												  .first = event->first,
												  .second = event->second,
												  .third = nobody,
												  .was = event->before,
												  .read = event->before};
	if (event->kind != TOUCHSTONE_WALL) write_down(misreading, event->first, event->second, event->after);
}

void misreading_test(void *context, struct touchstone_engine *engine, const struct touchstone_test *test)
{
	(void)engine;
	struct misreading *misreading = context;
	const struct touchstone_event *event = &misreading->last;
	int was = look_up(misreading, test->first, test->second);
	if (was == test->state || misreading->exhausted) return;
	bool pair = event->kind != TOUCHSTONE_WALL;
	bool own = pair && test->first == event->first && test->second == event->second;
	bool one_met = test->first == event->first || test->second == event->first;
	uint32_t third = own ? nobody : one_met && pair ? event->second : event->first;
	misread(misreading, test->first, test->second, third, was, test->state);
}

const char *misreading_event(enum touchstone_kind kind)
{
	static const char *const kinds[] = {"contact", "wall contact", "capture", "release", "bounce", "crossing"};
	return kinds[kind];
}

const char *misreading_tell(const struct misread_pair *pair, char text[200])
{
	char after[80] = "right after it";
	if (pair->third != nobody) snprintf(after, sizeof after, "when one of them met %u", pair->third);
	if (!pair->event)
		snprintf(text, 200, "none");
	else if (pair->was == pair->read)
		snprintf(text, 200, "event %llu: %s of %u and %u for the %dth time in a row, at t = %.17g",
				 (unsigned long long)pair->event, misreading_event(pair->kind), pair->first, pair->second,
				 MISREADING_STUCK, pair->time);
	else
		snprintf(text, 200, "event %llu: %u and %u, within %d step%s, read as within %d %s, at t = %.17g",
				 (unsigned long long)pair->event, pair->first, pair->second, pair->was, pair->was == 1 ? "" : "s",
				 pair->read, after, pair->time);
	return text;
}
