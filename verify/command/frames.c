#include "command/frames.h"

#include <stdio.h>
#include <stdlib.h>

#include "store/extended_xyz.h"

bool frames_begin(struct frames *frames, struct simulation *simulation, const char *path, char error[STORE_ERROR])
{
	const struct touchstone_scene *scene = &simulation->scene;
	size_t count = scene->particle_count;
	bool stepped = false;
	for (size_t p = 0; p < scene->potential_count; p++) stepped |= scene->potentials[p].step_count > 0;
	*frames = (struct frames){.simulation = simulation};
	frames->particles = malloc(count * sizeof *frames->particles);
	if (stepped) frames->captured = malloc(count * sizeof *frames->captured);
	bool enough = frames->particles && (frames->captured || !stepped);
	if (!enough) snprintf(error, STORE_ERROR, "%.200s: no memory for %zu particles", path, count);
	if (enough && aside_open(&frames->file, error, "%s", path)) return true;
	free(frames->particles);
	free(frames->captured);
	return false;
}

/* The particles as they are now; their species and the box are those of the scene. */
static void add(void *context)
{
	struct frames *frames = context;
	struct touchstone_scene scene = frames->simulation->scene;
	const struct touchstone_engine *engine = frames->simulation->engine;
	struct touchstone_status status;
	touchstone_status(engine, &status);
	for (uint32_t p = 0; p < scene.particle_count; p++) {
		struct touchstone_particle *particle = &frames->particles[p];
		particle->species = scene.particles[p].species;
		touchstone_state(engine, p, particle->position, particle->velocity);
		if (frames->captured) frames->captured[p] = (uint32_t)touchstone_captured(engine, p, NULL, 0);
	}
	scene.particles = frames->particles;
	extended_xyz_frame(frames->file.stream, &scene, status.time, frames->captured);
}

void frames_follow(struct frames *frames)
{
	frames->simulation->pause[PAUSE_FRAME] = (struct simulation_pause){add, frames};
	add(frames);
}

static void end(struct frames *frames)
{
	frames->simulation->pause[PAUSE_FRAME] = (struct simulation_pause){0};
	free(frames->particles);
	free(frames->captured);
}

bool frames_end(struct frames *frames, char error[STORE_ERROR])
{
	add(frames);
	end(frames);
	return aside_keep(&frames->file, error);
}

void frames_drop(struct frames *frames)
{
	end(frames);
	aside_drop(&frames->file);
}
