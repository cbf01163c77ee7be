#include "scene/potential.h"

#include <math.h>
#include <stdio.h>

#include "scene/check.h"

static double mean_diameter(const struct touchstone_scene *scene, uint32_t first, uint32_t second)
{
	return (scene->species[first].diameter + scene->species[second].diameter) / 2;
}

static bool joins(const struct touchstone_potential *potential, uint32_t first, uint32_t second)
{
	const uint32_t *species = potential->species;
	return (species[0] == first && species[1] == second) || (species[0] == second && species[1] == first);
}

double potential_core(const struct touchstone_scene *scene, uint32_t first, uint32_t second)
{
	for (size_t p = 0; p < scene->potential_count; p++)
		if (joins(&scene->potentials[p], first, second)) return scene->potentials[p].core;
	return mean_diameter(scene, first, second);
}

/* Outwards, beyond the core, of finite energies, and no wider than a periodic box. */
static bool check_steps(const struct touchstone_scene *scene, size_t p, struct scene_error *error)
{
	const struct touchstone_potential *potential = &scene->potentials[p];
	double inner = potential->core;
	char key[80];
	for (size_t s = 0; s < potential->step_count; s++) {
		const struct touchstone_step *step = &potential->steps[s];
		snprintf(key, sizeof key, "potentials[%zu].steps[%zu].distance", p, s);
		if (!(step->distance > 0) || !isfinite(step->distance))
			return scene_refuse(error, key, SIZE_MAX, "%g; accepted: a finite number above 0", step->distance);
		if (s == 0 && step->distance <= inner)
			return scene_refuse(error, key, SIZE_MAX, "%g is within the core of %g; accepted: steps beyond the core",
								step->distance, inner);
		if (step->distance <= inner)
			return scene_refuse(error, key, SIZE_MAX,
								"%g after %g; accepted: steps from the innermost outwards, each farther than the last",
								step->distance, inner);
		inner = step->distance;
		for (int axis = 0; axis < scene->dimensions; axis++)
			if (scene->periodic[axis] && step->distance > scene->box[axis])
				return scene_refuse(error, key, SIZE_MAX,
									"%g, farther than a particle is from its own image along %c; accepted: up to %g",
									step->distance, "xyz"[axis], scene -> box[axis]);
		snprintf(key, sizeof key, "potentials[%zu].steps[%zu].energy", p, s);
		if (!isfinite(step->energy))
			return scene_refuse(error, key, SIZE_MAX, "%g; accepted: a finite number (what never gives way is a core)",
								step->energy);
	}
	return true;
}

bool potential_check(const struct touchstone_scene *scene, struct scene_error *error)
{
	if (scene->potential_count && scene->species_count > POTENTIAL_MOST_SPECIES)
		return scene_refuse(error, "potentials", SIZE_MAX, "given for %zu species; accepted: up to %d of them",
							scene->species_count, POTENTIAL_MOST_SPECIES);
	for (size_t p = 0; p < scene->potential_count; p++) {
		const struct touchstone_potential *potential = &scene->potentials[p];
		const uint32_t *species = potential->species;
		char key[80];
		snprintf(key, sizeof key, "potentials[%zu].between", p);
		if (species[0] >= scene->species_count || species[1] >= scene->species_count)
			return scene_refuse(error, key, SIZE_MAX, "species %u and %u; accepted: 0 to %zu", species[0], species[1],
								scene->species_count - 1);
		for (size_t other = 0; other < p; other++)
			if (joins(&scene->potentials[other], species[0], species[1]))
				return scene_refuse(error, key, SIZE_MAX, "the same species as in potentials[%zu]; accepted: each once",
									other);
		double widest = mean_diameter(scene, species[0], species[1]);
		snprintf(key, sizeof key, "potentials[%zu].core", p);
		if (!(potential->core >= 0 && potential->core <= widest))
			return scene_refuse(error, key, SIZE_MAX, "%g; accepted: 0 for none, up to %g, the mean of the diameters",
								potential->core, widest);
		snprintf(key, sizeof key, "potentials[%zu].restitution", p);
		if (!scene_check_restitution(potential->restitution, key, error) || !check_steps(scene, p, error)) return false;
	}
	return true;
}

bool potential_check_virtual_walls(const struct touchstone_scene *scene, struct scene_error *error)
{
	for (size_t w = 0; w < scene->virtual_wall_count; w++) {
		const struct touchstone_virtual_wall *wall = &scene->virtual_walls[w];
		double squared = 0;
		int axes = 0;
		char key[80];
		for (int axis = 0; axis < 3; axis++) {
			double at = wall->point[axis], half = scene->box[axis] / 2;
			bool periodic = axis < scene->dimensions && scene->periodic[axis];
			squared += wall->normal[axis] * wall->normal[axis];
			axes += wall->normal[axis] != 0;
			snprintf(key, sizeof key, "virtual_walls[%zu].point", w);
			if (!isfinite(at) || (periodic && fabs(at) > half))
				return scene_refuse(error, key, SIZE_MAX, "%g along %c; accepted: finite numbers, in a periodic box",
									at, "xyz"[axis]);
		}
		snprintf(key, sizeof key, "virtual_walls[%zu].normal", w);
		if (!(fabs(squared - 1) < 1e-12))
			return scene_refuse(error, key, SIZE_MAX,
								"a normal of no direction; accepted: a finite vector that is not 0");
		for (int axis = 0; axis < scene->dimensions; axis++)
			if (scene->periodic[axis] && wall->normal[axis] != 0 && axes > 1)
				return scene_refuse(error, key, SIZE_MAX,
									"aslant to the periodic axis %c; accepted: along it, or across it", "xyz"[axis]);
	}
	return true;
}

static double power(double x, int exponent)
{
	double product = 1;
	for (int factor = 0; factor < exponent; factor++) product *= x;
	return product;
}

/* Integral of (length/r)^exponent r^(dimensions - 1) from `inner` to `outer`. */
static double moment(double length, int exponent, int dimensions, double inner, double outer)
{
	int left = exponent - dimensions;
	double there = power(length / inner, left), here = power(length / outer, left);
	return power(length, dimensions) * (there - here) / left;
}

void potential_lennard_jones(const struct lennard_jones *law, int dimensions, size_t count,
							 struct touchstone_step *steps)
{
	double inner = law->core;
	for (size_t s = 0; s < count; s++) {
		double part = (double)(s + 1) / (double)count;
		double outer = s + 1 < count ? law->core + (law->cutoff - law->core) * part : law->cutoff;
		double volume = (power(outer, dimensions) - power(inner, dimensions)) / dimensions;
		double repulsion = moment(law->length, 12, dimensions, inner, outer);
		double attraction = moment(law->length, 6, dimensions, inner, outer);
		steps[s] = (struct touchstone_step){outer, 4 * law->energy * (repulsion - attraction) / volume};
		inner = outer;
	}
}
