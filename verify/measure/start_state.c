#include "measure/start_state.h"

bool start_state(const struct touchstone_scene *scene, double collisions, const struct watch *watch,
				 struct touchstone_particle *particles, char error[160])
{
	struct touchstone_engine *engine = touchstone_create(scene, "binary64", "stable", error);
	if (!engine) return false;
	*error = '\0';
	bool through = course_equilibrate(engine, collisions, watch);
	for (uint32_t i = 0; i < scene->particle_count; i++) {
		touchstone_state(engine, i, particles[i].position, particles[i].velocity);
		particles[i].species = scene->particles[i].species;
	}
	touchstone_destroy(engine);
	return through;
}
