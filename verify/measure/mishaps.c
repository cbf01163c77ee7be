#include "measure/mishaps.h"

#include <math.h>
#include <stdlib.h>

bool mishaps_begin(struct mishaps *mishaps, size_t particles, int bits)
{
	*mishaps = (struct mishaps){.deep = ldexp(MISHAP_DEEP, 1 - bits)};
	bool enough = three_body_begin(&mishaps->three_body, particles);
	mishaps->partner = calloc(particles, sizeof *mishaps->partner);
	mishaps->deeply = calloc(particles, sizeof *mishaps->deeply);
	if (enough && mishaps->partner && mishaps->deeply) return true;
	mishaps_end(mishaps);
	return false;
}

void mishaps_end(struct mishaps *mishaps)
{
	three_body_end(&mishaps->three_body);
	free(mishaps->partner);
	free(mishaps->deeply);
	mishaps->partner = mishaps->deeply = NULL;
}

void mishaps_see(void *context, struct touchstone_engine *engine, const struct touchstone_event *event)
{
	struct mishaps *mishaps = context;
	uint32_t *partner = mishaps->partner, first = event->first, second = event->second;
	if (event->kind == TOUCHSTONE_WALL) partner[first] = 0;
	if (event->kind != TOUCHSTONE_CONTACT) return;
	mishaps->repeated += partner[first] == second + 1 && partner[second] == first + 1;
	partner[first] = second + 1;
	partner[second] = first + 1;
	three_body_see(&mishaps->three_body, engine, event);
}

void mishaps_look(struct mishaps *mishaps, const struct touchstone_engine *engine)
{
	enum { ROOM = 16 };
	for (uint32_t particle = 0; particle < mishaps->three_body.particles; particle++) {
		struct touchstone_overlap list[ROOM];
		size_t count = touchstone_overlaps(engine, particle, list, ROOM);
		uint32_t deepest = 0;
		double depth = mishaps->deep;
		for (size_t k = 0; k < count && k < ROOM; k++)
			if (list[k].depth > depth) depth = list[k].depth, deepest = list[k].partner + 1;
		bool still = deepest && deepest == mishaps->deeply[particle];
		mishaps->entangled += still && particle < deepest - 1;
		mishaps->deeply[particle] = deepest;
	}
}
