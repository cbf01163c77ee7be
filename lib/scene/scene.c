#include "scene/scene.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "scene/check.h"
#include "scene/placement.h"
#include "scene/random.h"
#include "scene/velocity.h"

void scene_free(struct touchstone_scene *scene)
{
	free((void *)scene->particles);
	free((void *)scene->species);
	free((void *)scene->walls);
	free((void *)scene->virtual_walls);
	for (size_t p = 0; p < scene->potential_count; p++) free((void *)scene->potentials[p].steps);
	free((void *)scene->potentials);
	*scene = (struct touchstone_scene){0};
}

static bool given(const struct scene_recipe *recipe)
{
	return recipe->positions == SCENE_GIVEN;
}

static bool check_fractions(const struct scene_recipe *recipe, struct scene_error *error)
{
	double sum = 0;
	bool negative = false;
	for (size_t s = 0; s < recipe->species_count; s++) {
		sum += recipe->species[s].fraction;
		negative |= !(recipe->species[s].fraction >= 0);
	}
	if (!negative && fabs(sum - 1) < 1e-3) return true;
	return scene_refuse(error, "species", SIZE_MAX, "fractions that add up to %g; accepted: 0 or more each, 1 in all",
						sum);
}

static bool check_given(const struct scene_recipe *recipe, struct scene_error *error)
{
	for (size_t p = 0; p < recipe->particle_count; p++)
		if (recipe->particles[p].species >= recipe->species_count)
			return scene_refuse(error, "species", p, "particle %zu is of species %u; accepted: below %zu", p,
								recipe->particles[p].species, recipe->species_count);
	return true;
}

/* What only the recipe knows; the rest is checked on the scene itself. */
static bool check_recipe(const struct scene_recipe *recipe, struct scene_error *error)
{
	if (recipe->dimensions < 1 || recipe->dimensions > 3)
		return scene_refuse(error, "dimensions", SIZE_MAX, "%d; accepted: 1, 2 or 3", recipe->dimensions);
	if (recipe->particle_count < 1 || recipe->particle_count > SCENE_MOST_PARTICLES)
		return scene_refuse(error, "particles", SIZE_MAX, "%zu; accepted: 1 to %d", recipe->particle_count,
							SCENE_MOST_PARTICLES);
	if (!(recipe->density >= 0) || !isfinite(recipe->density))
		return scene_refuse(error, "density", SIZE_MAX, "%g; accepted: a finite number above 0", recipe->density);
	bool maxwell = recipe->velocities == SCENE_MAXWELL;
	if (!(recipe->temperature >= 0) || !isfinite(recipe->temperature) || (maxwell && recipe->temperature == 0))
		return scene_refuse(error, "start.temperature", SIZE_MAX, "%g; accepted: a finite number above 0",
							recipe->temperature);
	if (recipe->species_count < 1) return scene_refuse(error, "species", SIZE_MAX, "none; accepted: 1 or more");
	return scene_check_restitution(recipe->boundary_restitution, "boundary_restitution", error) &&
		   (given(recipe) ? check_given(recipe, error) : check_fractions(recipe, error));
}

/* Deals the particles to the species, each in proportion and the last few by the largest remainders, and mixes them. */
static bool deal_species(const struct scene_recipe *recipe, struct touchstone_particle *particles,
						 struct random_state *random)
{
	size_t species_count = recipe->species_count, dealt = 0;
	double *owed = malloc(species_count * sizeof *owed);
	if (!owed) return false;
	for (size_t s = 0; s < species_count; s++) {
		double exact = recipe->species[s].fraction * (double)recipe->particle_count, whole = floor(exact);
		owed[s] = exact - whole;
		for (; whole > 0 && dealt < recipe->particle_count; whole--) particles[dealt++].species = (uint32_t)s;
	}
	while (dealt < recipe->particle_count) {
		size_t most = 0;
		for (size_t s = 1; s < species_count; s++)
			if (owed[s] > owed[most]) most = s;
		owed[most]--;
		particles[dealt++].species = (uint32_t)most;
	}
	free(owed);
	for (size_t p = recipe->particle_count - 1; species_count > 1 && p > 0; p--) {
		size_t other = (size_t)random_below(random, p + 1);
		uint32_t species = particles[p].species;
		particles[p].species = particles[other].species;
		particles[other].species = species;
	}
	return true;
}

/* The scene's particles with their species, and with their places where these are given. */
static struct touchstone_particle *make_particles(const struct scene_recipe *recipe, struct random_state *random)
{
	struct touchstone_particle *particles = calloc(recipe->particle_count, sizeof *particles);
	if (!particles) return NULL;
	if (recipe->particles) memcpy(particles, recipe->particles, recipe->particle_count * sizeof *particles);
	if (given(recipe) || deal_species(recipe, particles, random)) return particles;
	free(particles);
	return NULL;
}

static struct touchstone_species *make_species(const struct scene_recipe *recipe)
{
	struct touchstone_species *species = calloc(recipe->species_count, sizeof *species);
	for (size_t s = 0; species && s < recipe->species_count; s++) species[s] = recipe->species[s].body;
	return species;
}

static void set_length_1(double normal[3])
{
	double length = sqrt(normal[0] * normal[0] + normal[1] * normal[1] + normal[2] * normal[2]);
	for (int axis = 0; axis < 3; axis++) normal[axis] /= length;
}

/* The walls listed, then those at the ends of axes. */
static struct touchstone_wall *make_walls(const struct scene_recipe *recipe, const double box[3], size_t *count)
{
	struct touchstone_wall *walls = calloc(6 + recipe->wall_count, sizeof *walls);
	if (!walls) return NULL;
	*count = 0;
	for (size_t w = 0; w < recipe->wall_count; w++) {
		struct touchstone_wall *wall = &walls[(*count)++];
		*wall = recipe->walls[w];
		set_length_1(wall->normal);
	}
	for (int axis = 0; axis < recipe->dimensions; axis++) {
		if (recipe->boundary[axis] != SCENE_WALLS) continue;
		for (int side = -1; side <= 1; side += 2) {
			struct touchstone_wall *wall = &walls[(*count)++];
			wall->point[axis] = side * box[axis] / 2;
			wall->normal[axis] = -side;
			wall->restitution = recipe->boundary_restitution;
		}
	}
	return walls;
}

/* Copies the potentials, each with its steps, and the virtual walls; false when there is no memory. */
static bool copy_interactions(const struct scene_recipe *recipe, struct touchstone_scene *scene)
{
	struct touchstone_potential *potentials = calloc(recipe->potential_count + 1, sizeof *potentials);
	struct touchstone_virtual_wall *walls = calloc(recipe->virtual_wall_count + 1, sizeof *walls);
	scene->potentials = potentials;
	scene->virtual_walls = walls;
	if (!potentials || !walls) return false;
	for (size_t p = 0; p < recipe->potential_count; p++) {
		potentials[p] = recipe->potentials[p];
		size_t size = potentials[p].step_count * sizeof *potentials[p].steps;
		struct touchstone_step *steps = malloc(size + 1);
		potentials[p].steps = steps;
		scene->potential_count++;
		if (!steps) return false;
		if (size) memcpy(steps, recipe->potentials[p].steps, size);
	}
	for (size_t w = 0; w < recipe->virtual_wall_count; w++) {
		walls[w] = recipe->virtual_walls[w];
		set_length_1(walls[w].normal);
	}
	scene->virtual_wall_count = recipe->virtual_wall_count;
	return true;
}

/* By Newton's rule from above, which falls until it has arrived. */
static double cube_root(double x)
{
	double root = x > 1 ? x : 1;
	for (;;) {
		double next = root - (root * root * root - x) / (3 * root * root);
		if (!(next < root)) return root;
		root = next;
	}
}

/* Twice the farthest that a particle reaches along an axis. */
static double extent_needed(const struct touchstone_scene *scene, int axis)
{
	double farthest = 0;
	for (size_t p = 0; p < scene->particle_count; p++) {
		const struct touchstone_particle *particle = &scene->particles[p];
		double reach = fabs(particle->position[axis]) + scene->species[particle->species].diameter / 2;
		if (reach > farthest) farthest = reach;
	}
	return 2 * farthest;
}

static void set_box(const struct scene_recipe *recipe, struct touchstone_scene *scene)
{
	double volume = placement_content(scene) / recipe->density;
	double side = scene->dimensions == 3 ? cube_root(volume) : scene->dimensions == 2 ? sqrt(volume) : volume;
	for (int axis = 0; axis < scene->dimensions; axis++) {
		scene->periodic[axis] = recipe->boundary[axis] == SCENE_PERIODIC;
		scene->box[axis] = recipe->density > 0 ? side : recipe->box[axis];
		bool as_needed = given(recipe) && recipe->boundary[axis] == SCENE_OPEN && scene->box[axis] == 0;
		if (as_needed) scene->box[axis] = extent_needed(scene, axis);
	}
}

bool scene_build(const struct scene_recipe *recipe, uint64_t seed, struct touchstone_scene *scene,
				 struct scene_error *error)
{
	*scene = (struct touchstone_scene){
		.dimensions = recipe->dimensions,
		.restitution = recipe->restitution,
		.form = recipe->form,
		.search = recipe->search,
		.cell = recipe->cell,
		.clock = recipe->clock,
		.contact_time = recipe->contact_time,
		.shrinking = recipe->shrinking,
		.search_step = recipe->search_step,
	};
	if (!check_recipe(recipe, error)) return false;
	memcpy(scene->acceleration, recipe->acceleration, sizeof scene->acceleration);
	struct random_state random = random_seed(seed);
	struct touchstone_particle *particles = make_particles(recipe, &random);
	scene->particles = particles;
	scene->species = make_species(recipe);
	bool built = particles && scene->species;
	if (built) {
		scene->particle_count = recipe->particle_count;
		scene->species_count = recipe->species_count;
		set_box(recipe, scene);
		scene->walls = make_walls(recipe, scene->box, &scene->wall_count);
		built = scene->walls && copy_interactions(recipe, scene);
	}
	if (!built) scene_refuse(error, "particles", SIZE_MAX, "no memory for %zu", recipe->particle_count);
	built = built && scene_check_frame(scene, error) && placement_fill(recipe, scene, particles, &random, error);
	if (built) velocity_draw(scene, particles, recipe->velocities, recipe->temperature, &random);
	built = built && scene_check_particles(scene, error);
	if (!built) scene_free(scene);
	return built;
}
