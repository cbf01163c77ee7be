#include "scene/velocity.h"

#include <math.h>

/* A sum that carries what rounding dropped (Neumaier 1974). */
struct sum {
	double high, low;
};

static void add(struct sum *sum, double term)
{
	double total = sum->high + term;
	double back = total - sum->high; /* Knuth's two-sum */
	sum->low += (sum->high - (total - back)) + (term - back);
	sum->high = total;
}

static double mass_of(const struct touchstone_scene *scene, const struct touchstone_particle *particle)
{
	return scene->species[particle->species].mass;
}

static double momentum(const struct touchstone_scene *scene, const struct touchstone_particle *particles, int axis)
{
	struct sum sum = {0};
	for (size_t p = 0; p < scene->particle_count; p++)
		add(&sum, mass_of(scene, &particles[p]) * particles[p].velocity[axis]);
	return sum.high + sum.low;
}

/* Takes away the velocity of the common centre of mass. */
static void bring_to_rest(const struct touchstone_scene *scene, struct touchstone_particle *particles)
{
	struct sum mass = {0};
	for (size_t p = 0; p < scene->particle_count; p++) add(&mass, mass_of(scene, &particles[p]));
	for (int axis = 0; axis < scene->dimensions; axis++) {
		double drift = momentum(scene, particles, axis) / (mass.high + mass.low);
		for (size_t p = 0; p < scene->particle_count; p++) particles[p].velocity[axis] -= drift;
	}
}

/* Gives what rounding left of the total momentum to the last particle. */
static void settle(const struct touchstone_scene *scene, struct touchstone_particle *particles)
{
	struct touchstone_particle *last = &particles[scene->particle_count - 1];
	for (int axis = 0; axis < scene->dimensions; axis++)
		last->velocity[axis] -= momentum(scene, particles, axis) / mass_of(scene, last);
}

static void scale(const struct touchstone_scene *scene, struct touchstone_particle *particles, double temperature)
{
	struct sum twice_energy = {0};
	for (size_t p = 0; p < scene->particle_count; p++)
		for (int axis = 0; axis < scene->dimensions; axis++) {
			double velocity = particles[p].velocity[axis];
			add(&twice_energy, mass_of(scene, &particles[p]) * velocity * velocity);
		}
	double present = twice_energy.high + twice_energy.low;
	if (present <= 0) return;
	double factor = sqrt((double)scene->dimensions * (double)scene->particle_count * temperature / present);
	for (size_t p = 0; p < scene->particle_count; p++)
		for (int axis = 0; axis < scene->dimensions; axis++) particles[p].velocity[axis] *= factor;
}

void velocity_draw(const struct touchstone_scene *scene, struct touchstone_particle *particles,
				   enum scene_velocities law, double temperature, struct random_state *random)
{
	if (law == SCENE_AS_GIVEN) return;
	for (size_t p = 0; p < scene->particle_count; p++) {
		double width = law == SCENE_MAXWELL ? sqrt(temperature / mass_of(scene, &particles[p])) : 0;
		for (int axis = 0; axis < scene->dimensions; axis++)
			particles[p].velocity[axis] = law == SCENE_MAXWELL   ? width * random_normal(random)
										  : law == SCENE_UNIFORM ? 2 * random_uniform(random) - 1
																 : 0;
	}
	if (law == SCENE_REST) return;
	bool several = scene->particle_count > 1;
	if (several) bring_to_rest(scene, particles);
	if (temperature > 0) scale(scene, particles, temperature);
	if (several) settle(scene, particles);
}
