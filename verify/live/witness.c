#include "live/witness.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "scene/potential.h"

static const uint32_t nobody = UINT32_MAX;
static const double visible = 0.1; /* of the contact distance */

/* The largest number whose rounding may move a particle: 1, or in the absolute form a coordinate or the distance
 * that it flies in the time on the clock. */
static double largest(const struct touchstone_scene *scene)
{
	double most = 1;
	for (size_t p = 0; scene->form == TOUCHSTONE_ABSOLUTE && p < scene->particle_count; p++)
		for (int axis = 0; axis < scene->dimensions; axis++) {
			const struct touchstone_particle *particle = &scene->particles[p];
			most = fmax(most, fmax(fabs(particle->position[axis]), scene->clock * fabs(particle->velocity[axis])));
		}
	return most;
}

bool witness_begin(struct witness *witness, const struct touchstone_scene *scene, int bits)
{
	size_t particles = scene->particle_count;
	*witness = (struct witness){
		.rounding = fmax(ldexp(32 * largest(scene), 1 - bits), 0x1p-44),
		.first_failure = NAN,
		.first_sight = NAN,
		.last_time = -INFINITY,
		.met = malloc(particles * sizeof *witness->met),
		.inside = malloc(particles * sizeof *witness->inside),
		.count = (uint32_t)particles,
	};
	if (!witness->met || !witness->inside || !three_body_begin(&witness->three_body, particles)) return false;
	for (uint32_t p = 0; p < particles; p++) witness->met[p] = witness->inside[p] = nobody;
	return true;
}

void witness_end(struct witness *witness)
{
	free(witness->met);
	free(witness->inside);
	witness->met = witness->inside = NULL;
	three_body_end(&witness->three_body);
}

static void fail(struct witness *witness, double time)
{
	if (isnan(witness->first_failure)) witness->first_failure = time;
}

void witness_stop(struct witness *witness, double time)
{
	fail(witness, time);
	if (isnan(witness->first_sight)) witness->first_sight = time;
}

void witness_see(struct witness *witness, struct touchstone_engine *engine, const struct touchstone_event *event)
{
	uint32_t first = event->first, second = event->second;
	three_body_see(&witness->three_body, engine, event);
	witness->log[witness->seen++ % WITNESS_LOG] = *event;
	if (event->time < witness->last_time) witness->backwards++;
	witness->last_time = event->time;
	if (event->kind != TOUCHSTONE_CONTACT) {
		witness->met[first] = nobody;
		if (event->kind != TOUCHSTONE_WALL && event->kind != TOUCHSTONE_CROSSING) witness->met[second] = nobody;
		return;
	}
	witness->repeated += witness->met[first] == second && witness->met[second] == first;
	witness->parting += event->approach <= 0;
	witness->met[first] = second;
	witness->met[second] = first;
}

/* Takes note of a pair that overlaps. */
static void note(struct witness *witness, uint32_t p, uint32_t other, double share, double time)
{
	bool before = witness->inside[p] == other;
	witness->overlapping++;
	witness->entangled += before;
	witness->dropped += !before;
	if (share > witness->deepest) witness->deepest = share;
	fail(witness, time);
	if (share >= visible && isnan(witness->first_sight)) witness->first_sight = time;
}

bool witness_look(struct witness *witness, const struct touchstone_scene *now, double time, float *depth)
{
	struct spatial_hash hash;
	if (!spatial_hash_create(&hash, now)) return false;
	memset(depth, 0, now->particle_count * sizeof *depth);
	witness->overlapping = witness->entangled = 0;
	witness->deepest = 0;
	for (int level = 0; level < SPATIAL_HASH_LEVELS; level++) {
		if (!hash.used[level]) continue;
		for (uint32_t p = 0; p < now->particle_count; p++) {
			if (hash.level[now->particles[p].species] != level) continue;
			uint32_t other = nobody;
			double deep = spatial_hash_depth(&hash, p, INFINITY, &other);
			spatial_hash_insert(&hash, p);
			bool inside = deep > witness->rounding;
			if (inside) {
				double contact = potential_core(now, now->particles[p].species, now->particles[other].species);
				float share = (float)(deep / contact);
				note(witness, p, other, deep / contact, time);
				if (share > depth[p]) depth[p] = share;
				if (share > depth[other]) depth[other] = share;
			}
			witness->inside[p] = inside ? other : nobody;
		}
	}
	spatial_hash_destroy(&hash);
	if (witness->deepest > witness->deepest_ever) witness->deepest_ever = witness->deepest;
	return true;
}
