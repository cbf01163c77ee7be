#include "measure/three_body.h"

#include <math.h>
#include <stdlib.h>

bool three_body_begin(struct three_body *three_body, size_t particles)
{
	*three_body = (struct three_body){.particles = (uint32_t)particles};
	three_body->trio = calloc(particles, sizeof *three_body->trio);
	return three_body->trio;
}

void three_body_end(struct three_body *three_body)
{
	free(three_body->trio);
	three_body->trio = NULL;
}

enum { ROOM = 16 }; /* no more spheres than 12 touch one of their size */

/* The third particle that one of a pair overlaps, if it does and there is one; otherwise the partner itself. `depth`
 * tells by how much it overlaps the partner; 0: not at all. */
static uint32_t third_of(const struct touchstone_engine *engine, uint32_t particle, uint32_t partner, double *depth)
{
	struct touchstone_overlap list[ROOM];
	size_t count = touchstone_overlaps(engine, particle, list, ROOM);
	uint32_t third = partner;
	*depth = 0;
	for (size_t k = 0; k < count && k < ROOM; k++)
		if (list[k].partner == partner)
			*depth = list[k].depth;
		else
			third = list[k].partner;
	return third;
}

/* Enters an encounter of three, unless it is the one that all of them were in last. */
static void enter(struct three_body *three_body, uint32_t first, uint32_t second, uint32_t third)
{
	uint64_t *trio = three_body->trio;
	bool known = trio[first] && trio[first] == trio[second] && trio[first] == trio[third];
	three_body->events++;
	if (known) return;
	three_body->encounters++;
	trio[first] = trio[second] = trio[third] = three_body->encounters;
}

void three_body_see(void *context, struct touchstone_engine *engine, const struct touchstone_event *event)
{
	static const int64_t clear = 16; /* computed distances err by a few units in the last place */
	struct three_body *three_body = context;
	if (event->kind != TOUCHSTONE_CONTACT) return;
	uint32_t first = event->first, second = event->second, third = second;
	uint64_t *trio = three_body->trio;
	double depth = 0;
	three_body->contacts++;
	if (trio[first] != trio[second]) trio[first] = trio[second] = 0;
	if (event->steps > clear) return;
	third = third_of(engine, first, second, &depth);
	if (depth == 0) return;
	three_body->overlapping++;
	three_body->depth += depth;
	three_body->deepest = fmax(three_body->deepest, depth);
	if (third == second) third = third_of(engine, second, first, &depth);
	if (third != second && third != first) enter(three_body, first, second, third);
}

double three_body_rate(const struct three_body *three_body, struct interval *interval)
{
	double contacts = (double)three_body->contacts;
	*interval = interval_of_rate(three_body->events, contacts);
	return (double)three_body->events / contacts;
}

double three_body_encounter_rate(const struct three_body *three_body, struct interval *interval)
{
	double contacts = (double)three_body->contacts;
	*interval = interval_of_rate(three_body->encounters, contacts);
	return (double)three_body->encounters / contacts;
}

void three_body_merge(struct three_body *into, const struct three_body *from)
{
	into->contacts += from->contacts;
	into->overlapping += from->overlapping;
	into->depth += from->depth;
	into->deepest = fmax(into->deepest, from->deepest);
	into->events += from->events;
	into->encounters += from->encounters;
}
