/* The clock around one repetition of each kind of measurement.
 *
 * Each returns true when it was measured; false with a message when it could not be, and with none ("") when `stop`
 * ended it. */
#ifndef VERIFY_BENCH_TIMING_H
#define VERIFY_BENCH_TIMING_H

#include "bench/cores.h"
#include "store/scene_file.h"

struct engine_timing {
	double start_up; /* seconds: from the scene file's words to an engine that can run */
	double event;    /* nanoseconds for each event, after equilibration */
	double bytes;    /* per particle */
	uint64_t digest; /* of the events timed */
};
bool engine_time(const struct scene_file *file, uint64_t events, const volatile int *stop, struct engine_timing *timing,
				 char error[STORE_ERROR]);

/* The same run without a clock: all that is done for its events, and nothing else, is done within the function
 * bench_run, by whose name others can count. */
bool engine_count(const struct scene_file *file, uint64_t events, char error[STORE_ERROR]);
void bench_run(struct touchstone_engine *engine, const struct touchstone_limits *limits);

/* How many times the events of one run are executed in the time it takes alone when two independent runs, with seeds 1
 * and 2, have a core each: 2 at best. */
bool speed_up(const struct scene_file *file, uint64_t events, const struct cores *cores, const volatile int *stop,
			  double *times, char error[STORE_ERROR]);

/* Seconds until a ball has come to rest on each of so many plates, uniform in [0, 1), in binary64. */
bool drop_time(uint64_t plates, const volatile int *stop, double *seconds, char error[STORE_ERROR]);

#endif
