#include "scene/check.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>

#include "scene/convection.h"
#include "scene/potential.h"
#include "scene/spatial_hash.h"

bool scene_refuse(struct scene_error *error, const char *key, size_t particle, const char *format, ...)
{
	snprintf(error->key, sizeof error->key, "%s", key);
	error->particle = particle;
	va_list arguments;
	va_start(arguments, format);
	vsnprintf(error->text, sizeof error->text, format, arguments);
	va_end(arguments);
	return false;
}

static bool finite_vector(const double vector[3])
{
	return isfinite(vector[0]) && isfinite(vector[1]) && isfinite(vector[2]);
}

bool scene_check_restitution(struct touchstone_restitution restitution, const char *key, struct scene_error *error)
{
	double coefficient = restitution.coefficient;
	if (restitution.law == TOUCHSTONE_VISCOELASTIC) {
		if (coefficient >= 0 && isfinite(coefficient)) return true;
		return scene_refuse(error, key, SIZE_MAX, "a viscoelastic dissipation of %g; accepted: 0 or more", coefficient);
	}
	if (coefficient >= 0 && coefficient <= 1) return true;
	return scene_refuse(error, key, SIZE_MAX, "%g is no coefficient of restitution; accepted: 0 to 1", coefficient);
}

static bool check_species(const struct touchstone_scene *scene, struct scene_error *error)
{
	if (scene->species_count < 1) return scene_refuse(error, "species", SIZE_MAX, "none; accepted: 1 or more");
	for (size_t s = 0; s < scene->species_count; s++) {
		const char *names[] = {"diameter", "mass"};
		const double values[] = {scene->species[s].diameter, scene->species[s].mass};
		for (int i = 0; i < 2; i++) {
			if (values[i] > 0 && isfinite(values[i])) continue;
			char key[48];
			snprintf(key, sizeof key, "species[%zu].%s", s, names[i]);
			return scene_refuse(error, key, SIZE_MAX, "%g; accepted: a finite number above 0", values[i]);
		}
	}
	return true;
}

static double widest_diameter(const struct touchstone_scene *scene)
{
	double widest = 0;
	for (size_t s = 0; s < scene->species_count; s++)
		if (scene->species[s].diameter > widest) widest = scene->species[s].diameter;
	return widest;
}

/* Depths up to this are rounding: 64 ulp of the longest side of the box. */
static double rounding_of(const struct touchstone_scene *scene)
{
	double longest = 0;
	for (int axis = 0; axis < scene->dimensions; axis++)
		if (scene->box[axis] > longest) longest = scene->box[axis];
	return 64 * 0x1p-52 * longest;
}

static bool check_box(const struct touchstone_scene *scene, struct scene_error *error)
{
	for (int axis = 0; axis < scene->dimensions; axis++) {
		double extent = scene->box[axis];
		if (!(extent > 0) || !isfinite(extent))
			return scene_refuse(error, "box", SIZE_MAX, "an extent of %g along %c; accepted: a finite number above 0",
								extent, "xyz"[axis]);
	}
	double widest = widest_diameter(scene), rounding = rounding_of(scene);
	for (int axis = 0; axis < scene->dimensions; axis++)
		if (scene->periodic[axis] && scene->box[axis] < widest - rounding)
			return scene_refuse(error, "box", SIZE_MAX,
								"%g along periodic %c, so that a particle overlaps its own image; accepted: %g or more",
								scene->box[axis], "xyz"[axis], widest);
	return true;
}

static bool check_walls(const struct touchstone_scene *scene, struct scene_error *error)
{
	for (size_t w = 0; w < scene->wall_count; w++) {
		const struct touchstone_wall *wall = &scene->walls[w];
		char key[48];
		snprintf(key, sizeof key, "walls[%zu].point", w);
		if (!finite_vector(wall->point))
			return scene_refuse(error, key, SIZE_MAX, "not finite; accepted: finite numbers");
		double squared = 0;
		for (int axis = 0; axis < 3; axis++) squared += wall->normal[axis] * wall->normal[axis];
		snprintf(key, sizeof key, "walls[%zu].normal", w);
		if (!(fabs(squared - 1) < 1e-12))
			return scene_refuse(error, key, SIZE_MAX,
								"a normal of no direction; accepted: a finite vector that is not 0");
		snprintf(key, sizeof key, "walls[%zu].restitution", w);
		if (!scene_check_restitution(wall->restitution, key, error)) return false;
	}
	return true;
}

bool scene_check_frame(const struct touchstone_scene *scene, struct scene_error *error)
{
	if (scene->dimensions < 1 || scene->dimensions > 3)
		return scene_refuse(error, "dimensions", SIZE_MAX, "%d; accepted: 1, 2 or 3", scene->dimensions);
	if (scene->particle_count < 1 || scene->particle_count > SCENE_MOST_PARTICLES)
		return scene_refuse(error, "particles", SIZE_MAX, "%zu; accepted: 1 to %d", scene->particle_count,
							SCENE_MOST_PARTICLES);
	if (!check_species(scene, error) || !check_box(scene, error) || !check_walls(scene, error)) return false;
	if (!scene_check_restitution(scene->restitution, "restitution", error)) return false;
	if (!convection_check(scene, error)) return false;
	if (!potential_check(scene, error) || !potential_check_virtual_walls(scene, error)) return false;
	if (!finite_vector(scene->acceleration))
		return scene_refuse(error, "gravity", SIZE_MAX, "not finite; accepted: finite numbers");
	if (!(scene->cell >= 0) || !isfinite(scene->cell))
		return scene_refuse(error, "cell", SIZE_MAX, "%g; accepted: a finite number above 0, or 0 to have it chosen",
							scene->cell);
	if (!(scene->clock >= 0) || !isfinite(scene->clock))
		return scene_refuse(error, "clock", SIZE_MAX, "%g; accepted: a finite number, 0 or more", scene->clock);
	return true;
}

/* Finite, of a known species, on the axes there are and, where these are periodic, in the box. */
static bool check_place(const struct touchstone_scene *scene, size_t p, struct scene_error *error)
{
	const struct touchstone_particle *particle = &scene->particles[p];
	if (particle->species >= scene->species_count)
		return scene_refuse(error, "species", p, "particle %zu is of species %u; accepted: 0 to %zu", p,
							particle->species, scene->species_count - 1);
	if (!finite_vector(particle->position) || !finite_vector(particle->velocity))
		return scene_refuse(error, "particles", p, "particle %zu has a coordinate that is not finite", p);
	for (int axis = 0; axis < 3; axis++) {
		double position = particle->position[axis];
		if (axis >= scene->dimensions) {
			if (position == 0 && particle->velocity[axis] == 0) continue;
			return scene_refuse(error, "particles", p, "particle %zu leaves the %d dimensions of the scene", p,
								scene->dimensions);
		}
		double half = scene->box[axis] / 2;
		if (scene->periodic[axis] && !(position >= -half && position <= half))
			return scene_refuse(error, "particles", p, "particle %zu at %g along periodic %c; accepted: %g to %g", p,
								position, "xyz"[axis], -half, half);
	}
	return true;
}

static bool check_beyond_walls(const struct touchstone_scene *scene, size_t p, double rounding,
							   struct scene_error *error)
{
	const struct touchstone_particle *particle = &scene->particles[p];
	double radius = scene->species[particle->species].diameter / 2;
	for (size_t w = 0; w < scene->wall_count; w++) {
		const struct touchstone_wall *wall = &scene->walls[w];
		double distance = 0;
		for (int axis = 0; axis < scene->dimensions; axis++)
			distance += (particle->position[axis] - wall->point[axis]) * wall->normal[axis];
		if (distance >= radius - rounding) continue;
		return scene_refuse(
			error, "particles", p,
			"particle %zu reaches %g through the wall at (%g, %g, %g); accepted: a centre at least half a "
			"diameter (%g) in front of it",
			p, radius - distance, wall->point[0], wall->point[1], wall->point[2], radius);
	}
	return true;
}

/* Names the pair that overlaps most. */
static bool check_overlaps(const struct touchstone_scene *scene, double rounding, struct scene_error *error)
{
	struct spatial_hash hash;
	if (!spatial_hash_create(&hash, scene))
		return scene_refuse(error, "particles", SIZE_MAX, "no memory for %zu", scene->particle_count);
	double deepest = 0;
	uint32_t first = 0, second = 0;
	for (int level = 0; level < SPATIAL_HASH_LEVELS; level++) {
		if (!hash.used[level]) continue;
		for (uint32_t p = 0; p < scene->particle_count; p++) {
			if (hash.level[scene->particles[p].species] != level) continue;
			uint32_t other = p;
			double depth = spatial_hash_depth(&hash, p, INFINITY, &other);
			if (depth > deepest) deepest = depth, first = p, second = other;
			spatial_hash_insert(&hash, p);
		}
	}
	spatial_hash_destroy(&hash);
	if (deepest <= rounding) return true;
	uint32_t smaller = first < second ? first : second, larger = first < second ? second : first;
	return scene_refuse(error, "particles", larger,
						"particles %u and %u overlap by %g, deepest of all; accepted: start states without overlap",
						smaller, larger, deepest);
}

bool scene_check_particles(const struct touchstone_scene *scene, struct scene_error *error)
{
	double rounding = rounding_of(scene);
	for (size_t p = 0; p < scene->particle_count; p++)
		if (!check_place(scene, p, error) || !check_beyond_walls(scene, p, rounding, error)) return false;
	return check_overlaps(scene, rounding, error);
}

bool scene_check(const struct touchstone_scene *scene, struct scene_error *error)
{
	return scene_check_frame(scene, error) && scene_check_particles(scene, error);
}
