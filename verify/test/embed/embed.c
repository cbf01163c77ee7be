#include <math.h>
#include <stdio.h>
#include <touchstone.h>

int main(void)
{
	struct touchstone_particle balls[] = {{{-1, 0, 0}, {1, 0, 0}, 0}, {{1, 0, 0}, {0, 0, 0}, 0}};
	struct touchstone_species species = {.diameter = 1, .mass = 1};
	struct touchstone_scene scene = {.dimensions = 1,
									 .particle_count = 2,
									 .particles = balls,
									 .species_count = 1,
									 .species = &species,
									 .periodic = {true},
									 .box = {8},
									 .restitution = {TOUCHSTONE_CONSTANT, 1}};
	char error[160];
	struct touchstone_engine *engine = touchstone_create(&scene, "mpfr:200", "stable", error);
	struct touchstone_status status;
	if (!engine) return fprintf(stderr, "%s\n", error), 1;
	touchstone_run(engine, &(struct touchstone_limits){.events = 100, .time = INFINITY}, NULL);
	touchstone_status(engine, &status);
	printf("%llu collisions by t = %g\n", (unsigned long long)status.collisions, status.time);
	touchstone_destroy(engine);
}
