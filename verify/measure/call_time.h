/* How long a call takes, in nanoseconds of the calling thread's time, measured here and now: several callees side by
 * side, so that whatever slows the machine for a while slows them all. */
#ifndef VERIFY_CALL_TIME_H
#define VERIFY_CALL_TIME_H

#include <stddef.h>

/* One that is timed. `call` does its work `count` times; with a count of 0 it does all but the work, and that time is
 * subtracted. */
struct call_time {
	void (*call)(void *context, size_t count);
	void *context;
	double nanoseconds; /* found: the median over the repetitions, per unit of work */
};

/* Times all callees in turn, over and over, after one call each to warm up. */
void call_time_measure(struct call_time *callee, size_t callees, size_t count);

#endif
