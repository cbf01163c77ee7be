#include "command/simulation.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "command/interrupt.h"
#include "measure/course.h"

bool simulation_prepare(struct simulation *simulation, const struct scene_file *file, uint64_t seed,
						char error[STORE_ERROR])
{
	struct scene_file seeded = *file; /* for reading only */
	seeded.seed = seed;
	*simulation = (struct simulation){0};
	return scene_file_build(&seeded, &simulation->scene, error);
}

bool simulation_start(struct simulation *simulation, const struct scene_file *file,
					  const struct touchstone_snapshot *state, char error[STORE_ERROR])
{
	const struct touchstone_scene *scene = &simulation->scene;
	char reason[160];
	if (state)
		simulation->engine = touchstone_restore(scene, file->arithmetic, file->method, state, reason);
	else
		simulation->engine = touchstone_create(scene, file->arithmetic, file->method, reason);
	if (!simulation->engine) snprintf(error, STORE_ERROR, "%.200s: %s", file->name, reason);
	return simulation->engine;
}

bool simulation_open(struct simulation *simulation, const struct scene_file *file, uint64_t seed,
					 char error[STORE_ERROR])
{
	if (!simulation_prepare(simulation, file, seed, error)) return false;
	if (simulation_start(simulation, file, NULL, error)) return true;
	simulation_close(simulation);
	return false;
}

/* At the last event two particles touch, or are at a step, and rounding could put them on either side of it: some time
 * later, as it passes between two events, none do. */
static void fly_on(struct touchstone_engine *engine, double begun)
{
	struct touchstone_status status;
	touchstone_status(engine, &status);
	double later = status.time + (status.time - begun) / (double)(status.events + 1);
	touchstone_run(engine, &(struct touchstone_limits){UINT64_MAX, later, interrupt_flag()}, NULL);
}

bool simulation_begin_anew(struct simulation *simulation, const struct scene_file *file, char error[STORE_ERROR])
{
	struct touchstone_scene *scene = &simulation->scene;
	struct touchstone_particle *particles = malloc(scene->particle_count * sizeof *particles);
	if (!particles) {
		snprintf(error, STORE_ERROR, "%.200s: no memory for %zu particles", file->name, scene->particle_count);
		return false;
	}
	fly_on(simulation->engine, scene->clock);
	for (uint32_t p = 0; p < scene->particle_count; p++) {
		particles[p].species = scene->particles[p].species;
		touchstone_state(simulation->engine, p, particles[p].position, particles[p].velocity);
	}
	struct touchstone_status status;
	touchstone_status(simulation->engine, &status);
	touchstone_destroy(simulation->engine);
	free((void *)scene->particles);
	scene->particles = particles;
	scene->clock = status.time;
	return simulation_start(simulation, file, NULL, error);
}

void simulation_close(struct simulation *simulation)
{
	touchstone_destroy(simulation->engine);
	scene_free(&simulation->scene);
}

bool simulation_names(const struct scene_file *file, char error[STORE_ERROR])
{
	/* Dropping no balls at all asks for the names and nothing else. */
	char reason[160];
	if (!touchstone_drop(file->arithmetic, touchstone_method_name(0), NULL, 0, NULL, NULL, NULL, reason))
		return scene_file_refuse(file, error, "arithmetic", "%s", reason);
	if (!touchstone_drop(file->arithmetic, file->method, NULL, 0, NULL, NULL, NULL, reason))
		return scene_file_refuse(file, error, "method", "%s", reason);
	return true;
}

/* What one run's slices are reported to: the line of all runs, and what is to be expected of this one. */
struct reporter {
	struct simulation_progress *progress;
	const struct touchstone_limits *limits;
	double besides, begun; /* events in other calls; time at which this one began */
	double done;           /* events of this call */
};

/* How many events a run has ahead and behind it; where only time limits it, what its pace so far lets expect. */
static double expected(const struct reporter *reporter, double now)
{
	const struct touchstone_limits *limits = reporter->limits;
	double pace = (limits->time - reporter->begun) / (now - reporter->begun);
	double by_time = limits->time < INFINITY ? reporter->done * pace : INFINITY;
	return fmin(limits->events < UINT64_MAX ? (double)limits->events : INFINITY, by_time);
}

static void report(void *context, uint64_t more, const struct touchstone_status *now)
{
	struct reporter *reporter = context;
	struct simulation_progress *progress = reporter->progress;
	reporter->done += (double)more;
#pragma omp critical(simulation_progress)
	{
		progress->done += (double)more;
		double total = (reporter->besides + expected(reporter, now->time)) * progress->runs;
		if (progress->tell)
			progress->tell(progress->context, progress->done, total);
		else
			progress_show(&progress->line, progress->done, total);
	}
}

bool simulation_advance(struct simulation *simulation, const struct touchstone_limits *limits,
						const struct touchstone_observer *observer, struct simulation_progress *progress,
						uint64_t besides)
{
	struct touchstone_status now;
	touchstone_status(simulation->engine, &now);
	struct reporter reporter = {progress, limits, (double)besides, now.time, 0};
	uint64_t until = limits->events < UINT64_MAX - now.events ? now.events + limits->events : UINT64_MAX;
	struct watch watch = {
		.stop = interrupt_flag(),
		.progress = progress ? report : NULL,
		.context = &reporter,
	};
	struct touchstone_limits part = *limits;
	uint64_t every = simulation->every;
	for (;;) { /* from pause to pause */
		uint64_t events = now.events, left = every ? every - events % every : UINT64_MAX;
		part.events = left < until - events ? left : until - events;
		bool through = course_run(simulation->engine, &part, observer, &watch);
		touchstone_status(simulation->engine, &now);
		bool more = through && now.verdict == TOUCHSTONE_DONE && now.events - events == part.events;
		if (!more || !every || now.events >= until) return through;
		for (int p = 0; p < PAUSES; p++)
			if (simulation->pause[p].look) simulation->pause[p].look(simulation->pause[p].context);
	}
}

bool simulation_horizon(const struct simulation *simulation, const struct scene_file *file, const char *against,
						const struct touchstone_limits *limits, struct simulation_progress *progress, uint64_t besides,
						struct horizon *horizon, char error[STORE_ERROR])
{
	struct reporter reporter = {progress, limits, (double)besides, simulation->scene.clock, 0};
	struct watch watch = {interrupt_flag(), progress ? report : NULL, &reporter};
	char reason[160];
	bool found =
		horizon_find(&simulation->scene, file->method, file->arithmetic, against, limits, &watch, horizon, reason);
	if (!found) snprintf(error, STORE_ERROR, "%.200s: %s", file->name, reason);
	return found;
}
