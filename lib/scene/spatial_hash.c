#include "scene/spatial_hash.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "scene/potential.h"

static const uint32_t nobody = UINT32_MAX;

static double clamped(double value, double low, double high)
{
	return value < low ? low : value > high ? high : value;
}

/* Sorts the species into levels and sets the width of each level's cells. */
static void sort_levels(struct spatial_hash *hash)
{
	const struct touchstone_scene *scene = hash->scene;
	double widest = 0;
	for (size_t s = 0; s < scene->species_count; s++)
		if (scene->species[s].diameter > widest) widest = scene->species[s].diameter;
	for (size_t s = 0; s < scene->species_count; s++) {
		int level = 0;
		for (double half = widest / 2; scene->species[s].diameter <= half && level < SPATIAL_HASH_LEVELS - 1; half /= 2)
			level++;
		hash->level[s] = (uint8_t)level;
		hash->used[level] = true;
	}
	double side = widest;
	for (int level = 0; level < SPATIAL_HASH_LEVELS; level++, side /= 2) {
		for (int axis = 0; axis < scene->dimensions; axis++) {
			hash->count[level][axis] = (int64_t)clamped(scene->box[axis] / side, 1, 0x1p30);
			hash->per_length[level][axis] =
				scene->periodic[axis] ? (double)hash->count[level][axis] / scene->box[axis] : 1 / side;
		}
	}
}

bool spatial_hash_create(struct spatial_hash *hash, const struct touchstone_scene *scene)
{
	*hash = (struct spatial_hash){.scene = scene};
	size_t buckets = 1;
	while (buckets < scene->particle_count) buckets *= 2;
	hash->mask = (uint32_t)(buckets - 1);
	hash->level = malloc(scene->species_count);
	hash->first = malloc(buckets * sizeof *hash->first);
	hash->entry = aligned_alloc(32, scene->particle_count * sizeof *hash->entry);
	if (!hash->level || !hash->first || !hash->entry) {
		spatial_hash_destroy(hash);
		return false;
	}
	memset(hash->first, 0xff, buckets * sizeof *hash->first);
	sort_levels(hash);
	return true;
}

void spatial_hash_destroy(struct spatial_hash *hash)
{
	free(hash->level);
	free(hash->first);
	free(hash->entry);
	*hash = (struct spatial_hash){0};
}

/* The cell a coordinate falls into. Far out on an open axis all fall into the last cell, which is as good. */
static int64_t cell_of(const struct spatial_hash *hash, int level, int axis, double coordinate)
{
	double per_length = hash->per_length[level][axis];
	if (!hash->scene->periodic[axis]) return (int64_t)clamped(floor(coordinate * per_length), -0x1p40, 0x1p40);
	double last = (double)(hash->count[level][axis] - 1);
	return (int64_t)clamped((coordinate + hash->scene->box[axis] / 2) * per_length, 0, last);
}

/* Cells in a row along x have buckets in a row, so that a sweep along it stays in the cache. */
static uint32_t row_of(int level, int64_t y, int64_t z)
{
	uint64_t mixed = (uint64_t)y * UINT64_C(0x9e3779b97f4a7c15) + (uint64_t)z * UINT64_C(0xc2b2ae3d27d4eb4f) +
					 (uint64_t)level * UINT64_C(0x165667b19e3779f9);
	return (uint32_t)(mixed >> 32);
}

void spatial_hash_insert(struct spatial_hash *hash, uint32_t particle)
{
	const struct touchstone_particle *one = &hash->scene->particles[particle];
	int level = hash->level[one->species];
	int64_t cell[3] = {0};
	for (int axis = 0; axis < hash->scene->dimensions; axis++)
		cell[axis] = cell_of(hash, level, axis, one->position[axis]);
	uint32_t *first = &hash->first[(row_of(level, cell[1], cell[2]) + (uint32_t)cell[0]) & hash->mask];
	struct spatial_hash_entry *entry = &hash->entry[particle];
	memcpy(entry->position, one->position, sizeof entry->position);
	entry->species = one->species;
	entry->next = *first;
	*first = particle;
}

/* The cells along one axis in which a neighbour may be; returns how many. */
static int cells_near(const struct spatial_hash *hash, int level, int axis, double coordinate, int64_t near[3])
{
	near[0] = 0;
	if (axis >= hash->scene->dimensions) return 1;
	int64_t cell = cell_of(hash, level, axis, coordinate);
	near[0] = cell, near[1] = cell + 1, near[2] = cell - 1;
	if (!hash->scene->periodic[axis]) return 3;
	int64_t count = hash->count[level][axis];
	if (near[1] == count) near[1] = 0;
	if (near[2] < 0) near[2] = count - 1;
	return count < 3 ? (int)count : 3;
}

/* Squared distance of centres, to the nearest image. */
static double distance_squared(const struct touchstone_scene *scene, const double first[3], const double second[3])
{
	double sum = 0;
	for (int axis = 0; axis < scene->dimensions; axis++) {
		double apart = first[axis] - second[axis];
		if (scene->periodic[axis]) {
			double half = scene->box[axis] / 2;
			if (apart > half)
				apart -= scene->box[axis];
			else if (apart < -half)
				apart += scene->box[axis];
		}
		sum += apart * apart;
	}
	return sum;
}

/* Looks through one chain for a deeper overlap than `deepest`. */
static double chain_depth(const struct spatial_hash *hash, uint32_t link, uint32_t particle, double deepest,
						  uint32_t *other)
{
	const struct touchstone_scene *scene = hash->scene;
	const struct touchstone_particle *one = &scene->particles[particle];
	for (uint32_t next; link != nobody; link = next) {
		const struct spatial_hash_entry *two = &hash->entry[link];
		next = two->next;
		double contact = potential_core(scene, one->species, two->species);
		double squared = distance_squared(scene, one->position, two->position);
		if (squared >= contact * contact || link == particle) continue;
		double depth = contact - sqrt(squared);
		if (depth > deepest) deepest = depth, *other = link;
	}
	return deepest;
}

/* The first links of the chains around a particle, asked for ahead of their use; returns how many there are. */
static int chains_near(const struct spatial_hash *hash, int level, const double position[3], uint32_t chains[27])
{
	int64_t near[3][3];
	int count[3], chain_count = 0;
	for (int axis = 0; axis < 3; axis++) count[axis] = cells_near(hash, level, axis, position[axis], near[axis]);
	for (int z = 0; z < count[2]; z++)
		for (int y = 0; y < count[1]; y++) {
			uint32_t row = row_of(level, near[1][y], near[2][z]);
			for (int x = 0; x < count[0]; x++) {
				uint32_t first = hash->first[(row + (uint32_t)near[0][x]) & hash->mask];
				chains[chain_count] = first;
				chain_count += first != nobody;
			}
		}
	for (int i = 0; i < chain_count; i++) __builtin_prefetch(&hash->entry[chains[i]]);
	return chain_count;
}

double spatial_hash_depth(const struct spatial_hash *hash, uint32_t particle, double enough, uint32_t *other)
{
	const struct touchstone_particle *one = &hash->scene->particles[particle];
	double deepest = 0;
	for (int level = 0; level <= hash->level[one->species] && deepest <= enough; level++) {
		if (!hash->used[level]) continue;
		uint32_t chains[27];
		int count = chains_near(hash, level, one->position, chains);
		for (int i = 0; i < count && deepest <= enough; i++)
			deepest = chain_depth(hash, chains[i], particle, deepest, other);
	}
	return deepest;
}
