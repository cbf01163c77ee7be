#include "measure/vessel.h"

#include <math.h>

#include "measure/start_state.h"

static const double equilibrate = 20; /* elastic collisions per particle */
enum { GRID = 42 };                   /* bits after the point */

bool vessel_fill(struct vessel *vessel, uint64_t seed, const struct watch *watch, char error[160])
{
	struct scene_recipe recipe = start_spheres(VESSEL_SPHERES, 0);
	for (int axis = 0; axis < 3; axis++) {
		recipe.box[axis] = VESSEL_WIDTH;
		recipe.boundary[axis] = SCENE_WALLS;
	}
	*vessel = (struct vessel){.middle = 0};
	if (!start_scene(&recipe, seed, equilibrate, watch, &vessel->scene, error)) return false;
	struct touchstone_particle *particles = (struct touchstone_particle *)vessel->scene.particles;
	for (size_t p = 0; p < vessel->scene.particle_count; p++)
		for (int axis = 0; axis < 3; axis++)
			particles[p].position[axis] = ldexp(rint(ldexp(particles[p].position[axis], GRID)), -GRID);
	return true;
}

void vessel_empty(struct vessel *vessel)
{
	scene_free(&vessel->scene);
}

/* The walls stand half-way between two places, and such a tie goes to the even one: so an even number of places off. */
double vessel_middle(double box)
{
	double places = 2 * VESSEL_WIDTH; /* VESSEL_WIDTH is that of a place */
	return floor((box - VESSEL_WIDTH) / 2 / places) * places;
}

void vessel_put(struct vessel *vessel, enum touchstone_form form, double box, double clock)
{
	struct touchstone_scene *scene = &vessel->scene;
	struct touchstone_particle *particles = (struct touchstone_particle *)scene->particles;
	struct touchstone_wall *walls = (struct touchstone_wall *)scene->walls;
	double middle = vessel_middle(box);
	for (int axis = 0; axis < 3; axis++) {
		for (size_t p = 0; p < scene->particle_count; p++) particles[p].position[axis] += middle - vessel->middle;
		for (size_t w = 0; w < scene->wall_count; w++) walls[w].point[axis] += middle - vessel->middle;
		scene->box[axis] = box;
	}
	vessel->middle = middle;
	scene->form = form;
	scene->clock = clock;
}
