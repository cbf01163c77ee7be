/* Writes scene files as C, for the live page: its scenes are those of cases/, read by the same reader, and the page
 * needs no reader of its own. What only counts (virtual walls) or comes before the scene (equilibration) is left out.
 * Names of scenes in the folder `stress` begin with "stress-". Usage: recipes FILE.yaml...
 * >recipes.inl */
#include <stdio.h>
#include <string.h>

#include "store/scene_file.h"

static void write_vector(const char *name, const double vector[3])
{
	printf("\t\t.%s = {%a, %a, %a},\n", name, vector[0], vector[1], vector[2]);
}

static void write_restitution(const char *name, struct touchstone_restitution restitution)
{
	printf("\t\t.%s = {%d, %a},\n", name, (int)restitution.law, restitution.coefficient);
}

static void write_species(const struct scene_recipe *recipe)
{
	printf("\t\t.species_count = %zu,\n\t\t.species = (const struct scene_species[]){", recipe->species_count);
	for (size_t s = 0; s < recipe->species_count; s++) {
		const struct scene_species *species = &recipe->species[s];
		printf("{%a, {%a, %a}}, ", species->fraction, species->body.diameter, species->body.mass);
	}
	printf("},\n");
}

static void write_walls(const struct scene_recipe *recipe)
{
	if (!recipe->wall_count) return;
	printf("\t\t.wall_count = %zu,\n\t\t.walls = (const struct touchstone_wall[]){", recipe->wall_count);
	for (size_t w = 0; w < recipe->wall_count; w++) {
		const struct touchstone_wall *wall = &recipe->walls[w];
		printf("{{%a, %a, %a}, {%a, %a, %a}, {%d, %a}}, ", wall->point[0], wall->point[1], wall->point[2],
			   wall->normal[0], wall->normal[1], wall->normal[2], (int)wall->restitution.law,
			   wall->restitution.coefficient);
	}
	printf("},\n");
}

static void write_particles(const struct scene_recipe *recipe)
{
	if (!recipe->particles) return;
	printf("\t\t.particles = (const struct touchstone_particle[]){");
	for (size_t p = 0; p < recipe->particle_count; p++) {
		const struct touchstone_particle *particle = &recipe->particles[p];
		printf("{{%a, %a, %a}, {%a, %a, %a}, %u}, ", particle->position[0], particle->position[1],
			   particle->position[2], particle->velocity[0], particle->velocity[1], particle->velocity[2],
			   particle->species);
	}
	printf("},\n");
}

static void write_potentials(const struct scene_recipe *recipe)
{
	if (!recipe->potential_count) return;
	printf("\t\t.potential_count = %zu,\n\t\t.potentials = (const struct touchstone_potential[]){",
		   recipe->potential_count);
	for (size_t p = 0; p < recipe->potential_count; p++) {
		const struct touchstone_potential *potential = &recipe->potentials[p];
		printf("{{%u, %u}, %a, {%d, %a}, %zu, (const struct touchstone_step[]){", potential->species[0],
			   potential->species[1], potential->core, (int)potential->restitution.law,
			   potential->restitution.coefficient, potential->step_count);
		for (size_t s = 0; s < potential->step_count; s++)
			printf("{%a, %a}, ", potential->steps[s].distance, potential->steps[s].energy);
		printf("{0}}}, ");
	}
	printf("},\n");
}

static void write_recipe(const char *prefix, const struct scene_file *file)
{
	const struct scene_recipe *recipe = &file->recipe;
	printf("\t{\"%s%s\", \"%s\", {\n\t\t.dimensions = %d,\n\t\t.particle_count = %zu,\n\t\t.density = %a,\n", prefix,
		   file->name, file->title, recipe->dimensions, recipe->particle_count, recipe->density);
	write_vector("box", recipe->box);
	printf("\t\t.boundary = {%d, %d, %d},\n", (int)recipe->boundary[0], (int)recipe->boundary[1],
		   (int)recipe->boundary[2]);
	write_restitution("boundary_restitution", recipe->boundary_restitution);
	write_restitution("restitution", recipe->restitution);
	write_species(recipe);
	write_walls(recipe);
	write_potentials(recipe);
	write_particles(recipe);
	write_vector("acceleration", recipe->acceleration);
	const struct scene_convection *convection = &recipe->convection;
	if (convection->heats)
		printf("\t\t.convection = {true, %a, %a, {%a, %a}},\n", convection->kick, convection->neutral,
			   convection->walls[0], convection->walls[1]);
	printf("\t\t.thermostat = %a,\n\t\t.packing_limit = %a,\n\t\t.positions = %d,\n\t\t.velocities = %d,\n"
		   "\t\t.temperature = %a,\n\t\t.form = %d,\n\t\t.clock = %a,\n",
		   recipe->thermostat, recipe->packing_limit, (int)recipe->positions, (int)recipe->velocities,
		   recipe->temperature, (int)recipe->form, recipe->clock);
	printf("\t\t.contact_time = %a,\n\t\t.shrinking = %a,\n\t\t.search_step = %a,\n\t}},\n", recipe->contact_time,
		   recipe->shrinking, recipe->search_step);
}

int main(int argc, char **argv)
{
	for (int i = 1; i < argc; i++) {
		char error[STORE_ERROR];
		struct scene_file *file = scene_file_open(argv[i], 0, NULL, error);
		if (!file) {
			fprintf(stderr, "recipes: %s\n", error);
			return 2;
		}
		write_recipe(strstr(argv[i], "stress/") ? "stress-" : "", file);
		scene_file_close(file);
	}
	return 0;
}
