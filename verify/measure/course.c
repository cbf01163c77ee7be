#include "measure/course.h"

#include <math.h>
#include <time.h>

enum { SLICE = 16384 };

double course_clock(void)
{
	struct timespec now;
	clock_gettime(CLOCK_MONOTONIC, &now);
	return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

/* Runs to a limit, slice by slice; true when it was stopped on the way. */
static bool run_slices(struct touchstone_engine *engine, const struct course *course, struct touchstone_limits limits,
					   const struct touchstone_observer *observer)
{
	uint64_t done = 0;
	while (done < limits.events) {
		if (course->stop && *course->stop) return true;
		uint64_t left = limits.events - done, slice = left < SLICE ? left : SLICE;
		struct touchstone_status before, after;
		touchstone_status(engine, &before);
		enum touchstone_verdict verdict =
			touchstone_run(engine, &(struct touchstone_limits){slice, limits.time}, observer);
		touchstone_status(engine, &after);
		uint64_t executed = after.events - before.events;
		done += executed;
		if (course->progress) course->progress(course->context, executed);
		if (verdict != TOUCHSTONE_DONE || executed < slice) return false;
	}
	return false;
}

struct course_end course_run(struct touchstone_engine *engine, const struct course *course)
{
	struct course_end end = {.stopped = false};
	if (course->equilibrate > 0) {
		touchstone_status(engine, &end.status);
		double events = ceil(course->equilibrate * end.status.count / 2); /* a collision is one event of two */
		touchstone_elastic(engine, true);
		end.stopped = run_slices(engine, course, (struct touchstone_limits){(uint64_t)events, INFINITY}, NULL);
		touchstone_elastic(engine, false);
		touchstone_recount(engine);
	}
	double begin = course_clock();
	if (!end.stopped) end.stopped = run_slices(engine, course, course->limits, course->observer);
	end.seconds = course_clock() - begin;
	touchstone_status(engine, &end.status);
	return end;
}
