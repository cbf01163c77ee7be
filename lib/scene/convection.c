#include "scene/convection.h"

#include <math.h>
#include <stdlib.h>

#include "scene/check.h"

void convection_free(struct touchstone_scene *scene)
{
	free((void *)scene->convection.temperatures);
	free((void *)scene->convection.wall_temperatures);
}

bool convection_check(const struct touchstone_scene *scene, struct scene_error *error)
{
	const struct touchstone_convection *convection = &scene->convection;
	if (!(scene->thermostat >= 0) || !isfinite(scene->thermostat))
		return scene_refuse(error, "thermostat", SIZE_MAX, "%g; accepted: a finite number above 0", scene->thermostat);
	if (!convection->temperatures) return true;
	if (!isfinite(convection->kick) || !isfinite(convection->neutral))
		return scene_refuse(error, "convection", SIZE_MAX, "not finite; accepted: finite numbers");
	if (scene->dimensions < 2)
		return scene_refuse(error, "convection", SIZE_MAX, "in 1 dimension; accepted: in 2 or 3 dimensions");
	for (size_t p = 0; p < scene->particle_count; p++)
		if (!isfinite(convection->temperatures[p]))
			return scene_refuse(error, "convection", p, "particle %zu has a temperature that is not finite", p);
	return true;
}

bool convection_start(const struct scene_recipe *recipe, struct touchstone_scene *scene, struct scene_error *error)
{
	const struct scene_convection *asked = &recipe->convection;
	if (!asked->heats) return true;
	int last = scene->dimensions - 1;
	double *temperatures = malloc(scene->particle_count * sizeof *temperatures);
	double *walls = malloc((scene->wall_count + 1) * sizeof *walls);
	scene->convection = (struct touchstone_convection){temperatures, walls, asked->kick, asked->neutral};
	if (!temperatures || !walls)
		return scene_refuse(error, "particles", SIZE_MAX, "no memory for %zu", scene->particle_count);
	for (size_t p = 0; p < scene->particle_count; p++) {
		const double *position = scene->particles[p].position;
		temperatures[p] = position[0] / scene->box[0] < position[last] / scene->box[last];
	}
	for (size_t w = 0; w < scene->wall_count; w++) {
		bool lower = scene->walls[w].normal[last] == 1, end = w >= recipe->wall_count;
		bool upper = scene->walls[w].normal[last] == -1;
		walls[w] = end && lower ? asked->walls[0] : end && upper ? asked->walls[1] : NAN;
	}
	return convection_check(scene, error);
}
