#include "bench/findings.h"

#include <math.h>
#include <stdio.h>

const size_t speed_up_particles[SPEED_UPS] = {13500, 108000};

void findings_begin(struct findings *findings, const struct effort *effort)
{
	*findings = (struct findings){.effort = *effort};
	for (int p = 0; p < POINTS; p++) findings->engine[p].bytes = findings->engine[p].instructions = NAN;
}

static int spheres(size_t particles, double density, const char *arithmetic, const char *search)
{
	return point_of("hard-spheres", particles, density, arithmetic, search);
}

bool findings_agree(const struct findings *findings)
{
	uint64_t filtered = findings->engine[spheres(2916, 0.5, "mpfr:113", "cells")].digest;
	uint64_t unfiltered = findings->engine[spheres(2916, 0.5, "mpfr:113", "unsieved")].digest;
	return filtered == unfiltered || !filtered || !unfiltered;
}

/* ---- rows */

const char *quantity_name(enum quantity quantity)
{
	static const char *const names[QUANTITIES] = {
		[NANOSECONDS] = "nanoseconds_per_event",
		[INSTRUCTIONS] = "instructions_per_event",
		[BYTES] = "bytes_per_particle",
		[START_UP] = "start_up_seconds",
		[SECONDS] = "seconds",
		[TIMES] = "times_one_run",
	};
	return names[quantity];
}

void findings_rows(const struct findings *findings, struct row rows[ROWS])
{
	struct row *row = rows;
	for (int r = 0; r < ROWS; r++)
		for (int q = 0; q < QUANTITIES; q++) rows[r].value[q] = spread_exact(NAN);
	for (int p = 0; p < POINTS; p++, row++) {
		const struct engine_cost *cost = &findings->engine[p];
		char name[POINT_NAME];
		snprintf(row->name, ROW_NAME, "%s", point_name(&points[p], name));
		row->value[NANOSECONDS] = spread_of(&cost->event);
		row->value[INSTRUCTIONS] = spread_exact(cost->instructions);
		row->value[BYTES] = spread_exact(cost->bytes);
		row->value[START_UP] = spread_of(&cost->start_up);
	}
	snprintf(row->name, ROW_NAME, "10^6 balls come to rest");
	row++->value[SECONDS] = spread_of(&findings->drop);
	for (int s = 0; s < SPEED_UPS; s++, row++) {
		snprintf(row->name, ROW_NAME, "2 runs on 2 cores, %zu", speed_up_particles[s]);
		row->value[TIMES] = spread_of(&findings->speed_up[s]);
	}
}

/* ---- demands */

bool demand_met(const struct demand *demand)
{
	return demand->at_most ? demand->found.median <= demand->limit : demand->found.median >= demand->limit;
}

void findings_demands(const struct findings *findings, struct demand demands[DEMANDS])
{
	const struct engine_cost *engine = findings->engine;
	const struct engine_cost *million = &engine[spheres(1000188, 0.5, "binary64", "cells")];
	const struct sample *gas = &engine[spheres(13500, 0.5, "binary64", "cells")].event,
						*small = &engine[spheres(2916, 0.5, "binary64", "cells")].event;
	const struct {
		const char *what;
		double limit;
		const struct sample *over, *under;
	} ratio[] = {
		{"an event among 1 000 188 spheres, over one among 13 500", 2, &million->event, gas},
		{"an event in mpfr:113 without the sieve, over binary64", 25,
		 &engine[spheres(2916, 0.5, "mpfr:113", "unsieved")].event, small},
		{"an event in mpfr:113, rejections filtered, over binary64", 8,
		 &engine[spheres(2916, 0.5, "mpfr:113", "cells")].event, small},
		{"an event in twin, over binary64", 8, &engine[spheres(2916, 0.5, "twin", "cells")].event, small},
		{"an event in short:24, over binary64", 6, &engine[spheres(2916, 0.5, "short:24", "cells")].event, small},
		{"an event at restitution 0.9, over an elastic one", 1.15,
		 &engine[point_of("inelastic-spheres", 13500, 0.5, "binary64", "cells")].event, gas},
		{"an event among discs, over one among spheres", 1,
		 &engine[point_of("discs", 13500, 0.5, "binary64", "cells")].event, gas},
	};
	enum { RATIOS = sizeof ratio / sizeof *ratio };
	_Static_assert(RATIOS + 3 + SPEED_UPS == DEMANDS, "all demands are counted");
	struct demand *demand = demands;
	for (int r = 0; r < RATIOS; r++)
		*demand++ =
			(struct demand){ratio[r].what, true, ratio[r].limit, spread_of_ratio(ratio[r].over, ratio[r].under)};
	*demand++ = (struct demand){"bytes per particle, 1 000 188 spheres", true, 250, spread_exact(million->bytes)};
	*demand++ = (struct demand){"seconds to start with 1 000 188 spheres", true, 5, spread_of(&million->start_up)};
	*demand++ = (struct demand){"seconds until 10^6 balls have come to rest", true, 2, spread_of(&findings->drop)};
	static const char *const side_by_side[SPEED_UPS] = {"two runs on two cores, times one: 13 500 spheres",
														"two runs on two cores, times one: 108 000 spheres"};
	for (int s = 0; s < SPEED_UPS; s++)
		*demand++ = (struct demand){side_by_side[s], false, 1.8, spread_of(&findings->speed_up[s])};
}
