#include "measure/course.h"

#include <math.h>
#include <time.h>

static double clock_now(void)
{
	struct timespec now;
	clock_gettime(CLOCK_MONOTONIC, &now);
	return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

bool course_run(struct touchstone_engine *engine, const struct touchstone_limits *limits,
				const struct touchstone_observer *observer, const struct watch *watch)
{
	struct touchstone_status now;
	touchstone_status(engine, &now);
	uint64_t slice = 256, left = limits->events;
	while (left > 0) {
		if (watch && watch->stop && *watch->stop) return false;
		struct touchstone_limits part = *limits;
		part.events = slice < left ? slice : left;
		if (watch) part.stop = watch->stop;
		uint64_t events = now.events;
		double clock = clock_now();
		touchstone_run(engine, &part, observer);
		touchstone_status(engine, &now);
		uint64_t executed = now.events - events;
		left -= executed;
		if (watch && watch->progress) watch->progress(watch->context, executed, &now);
		if (now.verdict != TOUCHSTONE_DONE || executed < part.events) break;
		double took = clock_now() - clock;
		if (took < 0.05) slice *= 2;
		if (took > 0.2 && slice > 1) slice /= 2;
	}
	return !(watch && watch->stop && *watch->stop && left > 0);
}

uint64_t course_events(double collisions, size_t particles)
{
	double events = ceil(collisions * (double)particles / 2);
	return events < 0x1p63 ? (uint64_t)events : UINT64_MAX;
}

bool course_equilibrate(struct touchstone_engine *engine, double collisions, const struct watch *watch)
{
	struct touchstone_status status;
	touchstone_status(engine, &status);
	struct touchstone_limits limits = {.events = course_events(collisions, status.count), .time = INFINITY};
	touchstone_elastic(engine, true);
	bool through = course_run(engine, &limits, NULL, watch);
	touchstone_elastic(engine, false);
	touchstone_recount(engine);
	return through;
}
