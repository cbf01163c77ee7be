#include "store/scene_identity.h"

#include "store/checksum.h"

/* Numbers that are equal count as the same: zeros of either sign are. */
static uint64_t with_numbers(uint64_t sum, const double *numbers, size_t count)
{
	for (size_t n = 0; n < count; n++) {
		double number = numbers[n] + 0.0;
		sum = checksum(sum, &number, sizeof number);
	}
	return sum;
}

static uint64_t with_word(uint64_t sum, uint64_t word)
{
	return checksum(sum, &word, sizeof word);
}

static uint64_t with_restitution(uint64_t sum, const struct touchstone_restitution *restitution)
{
	return with_numbers(with_word(sum, restitution->law), &restitution->coefficient, 1);
}

static uint64_t with_particles(uint64_t sum, const struct touchstone_scene *scene)
{
	sum = with_word(sum, scene->particle_count);
	for (size_t p = 0; p < scene->particle_count; p++) {
		const struct touchstone_particle *particle = &scene->particles[p];
		sum = with_numbers(sum, particle->position, 3);
		sum = with_numbers(sum, particle->velocity, 3);
		sum = with_word(sum, particle->species);
	}
	sum = with_word(sum, scene->species_count);
	for (size_t s = 0; s < scene->species_count; s++) {
		sum = with_numbers(sum, &scene->species[s].diameter, 1);
		sum = with_numbers(sum, &scene->species[s].mass, 1);
	}
	return sum;
}

static uint64_t with_potentials(uint64_t sum, const struct touchstone_scene *scene)
{
	sum = with_word(sum, scene->potential_count);
	for (size_t p = 0; p < scene->potential_count; p++) {
		const struct touchstone_potential *potential = &scene->potentials[p];
		sum = with_word(with_word(sum, potential->species[0]), potential->species[1]);
		sum = with_restitution(with_numbers(sum, &potential->core, 1), &potential->restitution);
		sum = with_word(sum, potential->step_count);
		for (size_t s = 0; s < potential->step_count; s++) {
			sum = with_numbers(sum, &potential->steps[s].distance, 1);
			sum = with_numbers(sum, &potential->steps[s].energy, 1);
		}
	}
	return sum;
}

static uint64_t with_walls(uint64_t sum, const struct touchstone_scene *scene)
{
	sum = with_word(sum, scene->wall_count);
	for (size_t w = 0; w < scene->wall_count; w++) {
		sum = with_numbers(sum, scene->walls[w].point, 3);
		sum = with_numbers(sum, scene->walls[w].normal, 3);
		sum = with_restitution(sum, &scene->walls[w].restitution);
	}
	sum = with_word(sum, scene->virtual_wall_count);
	for (size_t w = 0; w < scene->virtual_wall_count; w++) {
		sum = with_numbers(sum, scene->virtual_walls[w].point, 3);
		sum = with_numbers(sum, scene->virtual_walls[w].normal, 3);
	}
	return sum;
}

static uint64_t with_heat(uint64_t sum, const struct touchstone_scene *scene)
{
	const struct touchstone_convection *convection = &scene->convection;
	sum = with_numbers(sum, &scene->thermostat, 1);
	sum = with_word(sum, convection->temperatures != NULL);
	if (!convection->temperatures) return sum;
	sum = with_numbers(sum, convection->temperatures, scene->particle_count);
	sum = with_numbers(sum, convection->wall_temperatures, scene->wall_count);
	sum = with_numbers(sum, &convection->kick, 1);
	return with_numbers(sum, &convection->neutral, 1);
}

uint64_t scene_identity(const struct touchstone_scene *scene)
{
	uint64_t sum = with_word(0, (uint64_t)scene->dimensions);
	sum = with_particles(sum, scene);
	sum = with_walls(sum, scene);
	sum = with_potentials(sum, scene);
	for (int axis = 0; axis < scene->dimensions; axis++) sum = with_word(sum, scene->periodic[axis]);
	sum = with_numbers(sum, scene->box, (size_t)scene->dimensions);
	sum = with_numbers(sum, scene->acceleration, 3);
	sum = with_restitution(sum, &scene->restitution);
	sum = with_word(sum, scene->form);
	sum = with_numbers(sum, &scene->clock, 1);
	sum = with_numbers(sum, &scene->contact_time, 1);
	sum = with_numbers(sum, &scene->shrinking, 1);
	sum = with_numbers(sum, &scene->search_step, 1);
	sum = with_heat(sum, scene);
	return with_word(sum, scene->grain);
}
