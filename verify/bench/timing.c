#include "bench/timing.h"

#include <math.h>
#include <stdio.h>

#include "command/progress.h"
#include "command/simulation.h"
#include "measure/course.h"
#include "scene/random.h"

__attribute__((noinline)) void bench_run(struct touchstone_engine *engine, const struct touchstone_limits *limits)
{
	touchstone_run(engine, limits, NULL);
}

/* An engine in equilibrium; otherwise nothing is left to close. */
static bool begin(struct simulation *simulation, const struct scene_file *file, uint64_t seed, const volatile int *stop,
				  double *start_up, char error[STORE_ERROR])
{
	double began = progress_clock();
	*error = '\0';
	if (!simulation_open(simulation, file, seed, error)) return false;
	*start_up = progress_clock() - began;
	if (course_equilibrate(simulation->engine, file->equilibrate, &(struct watch){.stop = stop})) return true;
	simulation_close(simulation);
	return false;
}

/* Whether the run came through; why not, unless it was stopped. */
static bool came_through(const struct scene_file *file, const struct touchstone_status *status, uint64_t events,
						 const volatile int *stop, char error[STORE_ERROR])
{
	if (status->verdict == TOUCHSTONE_DONE && status->events == events) return true;
	if (!(stop && *stop))
		snprintf(error, STORE_ERROR, "%.80s: ended after %llu of %llu events: %.160s", file->name,
				 (unsigned long long)status->events, (unsigned long long)events,
				 *status->reason ? status->reason : "no event is left");
	return false;
}

bool engine_time(const struct scene_file *file, uint64_t events, const volatile int *stop, struct engine_timing *timing,
				 char error[STORE_ERROR])
{
	struct simulation simulation;
	if (!begin(&simulation, file, file->seed, stop, &timing->start_up, error)) return false;
	const struct touchstone_limits limits = {.events = events, .time = INFINITY, .stop = stop};
	struct touchstone_status status;
	double began = progress_clock();
	bench_run(simulation.engine, &limits);
	timing->event = 1e9 * (progress_clock() - began) / (double)events;
	touchstone_status(simulation.engine, &status);
	timing->bytes = (double)status.memory / status.count;
	timing->digest = status.digest;
	simulation_close(&simulation);
	return came_through(file, &status, events, stop, error);
}

bool engine_count(const struct scene_file *file, uint64_t events, char error[STORE_ERROR])
{
	struct simulation simulation;
	struct touchstone_status status;
	double start_up;
	if (!begin(&simulation, file, file->seed, NULL, &start_up, error)) return false;
	bench_run(simulation.engine, &(struct touchstone_limits){.events = events, .time = INFINITY});
	touchstone_status(simulation.engine, &status);
	simulation_close(&simulation);
	return came_through(file, &status, events, NULL, error);
}

bool speed_up(const struct scene_file *file, uint64_t events, const struct cores *cores, const volatile int *stop,
			  double *times, char error[STORE_ERROR])
{
	enum { RUNS = 2 };
	struct simulation simulation[RUNS];
	const struct touchstone_limits limits = {.events = events, .time = INFINITY, .stop = stop};
	struct touchstone_status status[RUNS];
	double taken[RUNS] = {0}, start_up;
	int open = 0;
	while (open < RUNS && begin(&simulation[open], file, 1 + (uint64_t)open, stop, &start_up, error)) open++;
	bool good = open == RUNS;
	if (good) {
		double alone = progress_clock();
		bench_run(simulation[0].engine, &limits);
		alone = progress_clock() - alone;
		touchstone_recount(simulation[0].engine);
#pragma omp parallel for schedule(static, 1) num_threads(RUNS)
		for (int run = 0; run < RUNS; run++) {
			cores_stay(cores->chosen[run]);
			double mine = progress_clock();
			bench_run(simulation[run].engine, &limits);
			taken[run] = progress_clock() - mine;
		}
		*times = RUNS * alone / fmax(taken[0], taken[1]);
	}
	for (int run = 0; run < open; run++) {
		touchstone_status(simulation[run].engine, &status[run]);
		good = good && came_through(file, &status[run], events, stop, error);
		simulation_close(&simulation[run]);
	}
	return good;
}

bool drop_time(uint64_t plates, const volatile int *stop, double *seconds, char error[STORE_ERROR])
{
	enum { BATCH = 256 };
	struct touchstone_drop drop[BATCH] = {0};
	struct touchstone_landing landing[BATCH];
	struct random_state random = random_seed(1);
	*seconds = 0;
	*error = '\0';
	for (uint64_t done = 0; done < plates; done += BATCH) {
		if (stop && *stop) return false;
		size_t count = plates - done < BATCH ? (size_t)(plates - done) : BATCH;
		for (size_t i = 0; i < count; i++) {
			drop[i] = (struct touchstone_drop){.gravity = -1, .restitution = 0.5, .order = 1, .most = 4000};
			drop[i].plate[0] = random_uniform(&random);
		}
		double began = progress_clock();
		if (!touchstone_drop("binary64", "stable", drop, count, landing, NULL, NULL, error)) return false;
		*seconds += progress_clock() - began;
		for (size_t i = 0; i < count; i++)
			if (landing[i].verdict != TOUCHSTONE_COLLAPSED) {
				snprintf(error, STORE_ERROR, "the ball over the plate at %a did not come to rest", drop[i].plate[0]);
				return false;
			}
	}
	return true;
}
