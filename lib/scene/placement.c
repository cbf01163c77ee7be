#include "scene/placement.h"

#include <math.h>
#include <stdio.h>

#include "scene/check.h"
#include "scene/insertion.h"
#include "scene/lattice.h"

double scene_close_packing(int dimensions)
{
	return dimensions == 3 ? sqrt(2) : dimensions == 2 ? 2 / sqrt(3) : 1;
}

double placement_content(const struct touchstone_scene *scene)
{
	double total = 0;
	for (size_t p = 0; p < scene->particle_count; p++) {
		double diameter = scene->species[scene->particles[p].species].diameter, power = diameter;
		for (int axis = 1; axis < scene->dimensions; axis++) power *= diameter;
		total += power;
	}
	return total;
}

/* Brings given positions that lie beyond a periodic end back into the box. */
static void wrap(const struct touchstone_scene *scene, struct touchstone_particle *particles)
{
	for (size_t p = 0; p < scene->particle_count; p++)
		for (int axis = 0; axis < scene->dimensions; axis++) {
			double *position = &particles[p].position[axis], box = scene->box[axis];
			if (!scene->periodic[axis] || fabs(*position) <= box / 2) continue;
			*position -= box * floor(*position / box + 0.5);
			if (*position < -box / 2) *position = -box / 2;
			if (*position > box / 2) *position = box / 2;
		}
}

static double widest_diameter(const struct touchstone_scene *scene)
{
	double widest = 0;
	for (size_t p = 0; p < scene->particle_count; p++) {
		double diameter = scene->species[scene->particles[p].species].diameter;
		if (diameter > widest) widest = diameter;
	}
	return widest;
}

static double density_of(const struct touchstone_scene *scene)
{
	double volume = 1;
	for (int axis = 0; axis < scene->dimensions; axis++) volume *= scene->box[axis];
	return placement_content(scene) / volume;
}

static bool place_on_lattice(const struct scene_recipe *recipe, const struct touchstone_scene *scene,
							 struct touchstone_particle *particles, struct scene_error *error)
{
	struct lattice_box box = {.dimensions = scene->dimensions, .diameter = widest_diameter(scene)};
	double longest = 0, reached = density_of(scene);
	bool walled = false;
	for (int axis = 0; axis < scene->dimensions; axis++) {
		box.extent[axis] = scene->box[axis];
		box.periodic[axis] = scene->periodic[axis];
		box.walled[axis] = recipe->boundary[axis] == SCENE_WALLS;
		walled |= box.walled[axis];
		if (box.extent[axis] > longest) longest = box.extent[axis];
	}
	struct lattice lattice = lattice_fit(&box, recipe->positions == SCENE_LATTICE, scene->particle_count);
	if (lattice.sites > 0 && lattice.distance >= box.diameter - 64 * 0x1p-52 * longest) {
		lattice_place(&lattice, particles, scene->particle_count);
		return true;
	}
	const char *key = recipe->density > 0 ? "density" : "box";
	if (walled)
		return scene_refuse(
			error, key, SIZE_MAX,
			"at density %g a lattice of %zu sites between walls has no room for diameter %g; accepted: a lower "
			"density",
			reached, scene->particle_count, box.diameter);
	for (int axis = 0; axis < scene->dimensions; axis++) reached *= lattice.distance / box.diameter;
	return scene_refuse(
		error, key, SIZE_MAX,
		"at density %g the nearest of %zu lattice sites are %g apart, too close for diameter %g; accepted "
		"for this many particles: up to %.9g",
		density_of(scene), scene->particle_count, lattice.distance, box.diameter,
		reached * (1 - 1e-8) /* not rounded up */);
}

/* Many equal particles that are well beyond the end of random placement need not be tried. */
static bool hopeless(const struct touchstone_scene *scene)
{
	for (size_t s = 1; s < scene->species_count; s++)
		if (scene->species[s].diameter != scene->species[0].diameter) return false;
	return scene->particle_count > 10000 && density_of(scene) > 1.05 * insertion_end(scene->dimensions);
}

static bool place_at_random(const struct scene_recipe *recipe, struct touchstone_scene *scene,
							struct touchstone_particle *particles, struct random_state *random,
							struct scene_error *error)
{
	char text[96];
	snprintf(text, sizeof text, "accepted: a lower density, up to about %g for equal particles, or a lattice",
			 insertion_end(scene->dimensions));
	if (hopeless(scene))
		return scene_refuse(error, "start.positions", SIZE_MAX, "random placement ends before density %g; %s",
							density_of(scene), text);
	size_t placed = insertion_place(scene, particles, random);
	if (placed == scene->particle_count) return true;
	if (placed == SIZE_MAX)
		return scene_refuse(error, "particles", SIZE_MAX, "no memory for %zu", scene->particle_count);
	if (recipe->packing_limit > 0 && scene->species_count == 1 && placed > 0) { /* those placed come first */
		scene->particle_count = placed;
		return true;
	}
	return scene_refuse(error, "start.positions", SIZE_MAX, "random placement found room for %zu of %zu particles; %s",
						placed, scene->particle_count, text);
}

bool placement_fill(const struct scene_recipe *recipe, struct touchstone_scene *scene,
					struct touchstone_particle *particles, struct random_state *random, struct scene_error *error)
{
	if (recipe->positions == SCENE_GIVEN) {
		wrap(scene, particles);
		return true;
	}
	double density = density_of(scene), limit = scene_close_packing(scene->dimensions);
	if (density > limit * (1 + 1e-12))
		return scene_refuse(error, recipe->density > 0 ? "density" : "box", SIZE_MAX,
							"a density of %g is beyond close packing; accepted: above 0, up to %.9g in %d dimensions",
							density, floor(limit * 1e8) / 1e8, scene->dimensions);
	if (recipe->positions == SCENE_RANDOM) return place_at_random(recipe, scene, particles, random, error);
	return place_on_lattice(recipe, scene, particles, error);
}
