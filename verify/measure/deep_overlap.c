#include "measure/deep_overlap.h"

#include <math.h>
#include <stdlib.h>

bool deep_overlaps_make(struct deep_overlaps *overlaps, const struct touchstone_scene *scene)
{
	*overlaps = (struct deep_overlaps){
		.scene = scene,
		.position = malloc(scene->particle_count * sizeof *overlaps->position),
		.sorted = malloc(scene->particle_count * sizeof *overlaps->sorted),
	};
	return overlaps->position && overlaps->sorted;
}

void deep_overlaps_free(struct deep_overlaps *overlaps)
{
	free(overlaps->position);
	free(overlaps->sorted);
}

static double diameter(const struct deep_overlaps *overlaps, uint32_t p)
{
	return overlaps->scene->species[overlaps->scene->particles[p].species].diameter;
}

static double nearness(const struct deep_overlaps *overlaps, uint32_t p, uint32_t q)
{
	const struct touchstone_scene *scene = overlaps->scene;
	double square = 0, contact = (diameter(overlaps, p) + diameter(overlaps, q)) / 2;
	for (int axis = 0; axis < scene->dimensions; axis++) {
		double offset = overlaps->position[p][axis] - overlaps->position[q][axis];
		if (scene->periodic[axis]) offset -= scene->box[axis] * rint(offset / scene->box[axis]);
		square += offset * offset;
	}
	return sqrt(square) / contact;
}

static double nearness_to_wall(const struct deep_overlaps *overlaps, uint32_t p, size_t w)
{
	const struct touchstone_wall *wall = &overlaps->scene->walls[w];
	double distance = 0;
	for (int axis = 0; axis < overlaps->scene->dimensions; axis++)
		distance += wall->normal[axis] * (overlaps->position[p][axis] - wall->point[axis]);
	return 2 * distance / diameter(overlaps, p);
}

double deep_overlaps_depth(const struct deep_overlaps *overlaps, const struct deep_overlap *overlap)
{
	return overlap->wall ? nearness_to_wall(overlaps, overlap->first, overlap->second)
						 : nearness(overlaps, overlap->first, overlap->second);
}

static int by_place(const void *one, const void *other)
{
	const double *a = one, *b = other;
	int places = (a[0] > b[0]) - (a[0] < b[0]);
	return places ? places : (a[1] > b[1]) - (a[1] < b[1]);
}

static void sort(struct deep_overlaps *overlaps)
{
	const struct touchstone_scene *scene = overlaps->scene;
	for (uint32_t p = 0; p < scene->particle_count; p++) {
		double x = overlaps->position[p][0];
		if (scene->periodic[0]) x -= scene->box[0] * rint(x / scene->box[0]);
		overlaps->sorted[p][0] = x;
		overlaps->sorted[p][1] = p;
	}
	qsort(overlaps->sorted, scene->particle_count, sizeof *overlaps->sorted, by_place);
}

static double largest_diameter(const struct deep_overlaps *overlaps)
{
	double largest = 0;
	for (uint32_t p = 0; p < overlaps->scene->particle_count; p++) largest = fmax(largest, diameter(overlaps, p));
	return largest;
}

static void look_at_pair(const struct deep_overlaps *overlaps, uint32_t p, uint32_t q, struct deep_overlap *deepest)
{
	double near = nearness(overlaps, p, q);
	if (near < deepest->depth) *deepest = (struct deep_overlap){p < q ? p : q, p < q ? q : p, false, near};
}

static void look_at_pairs(struct deep_overlaps *overlaps, struct deep_overlap *deepest)
{
	const size_t count = overlaps->scene->particle_count;
	const double(*sorted)[2] = (const double(*)[2])overlaps->sorted;
	const double reach = largest_diameter(overlaps) * deepest->depth, box = overlaps->scene->box[0];
	sort(overlaps);
	for (size_t i = 0; i < count; i++)
		for (size_t step = 1; step < count; step++) {
			bool around = i + step >= count;
			size_t j = around ? i + step - count : i + step;
			if (around && !overlaps->scene->periodic[0]) break;
			if (sorted[j][0] + (around ? box : 0) - sorted[i][0] > reach) break;
			look_at_pair(overlaps, (uint32_t)sorted[i][1], (uint32_t)sorted[j][1], deepest);
		}
}

bool deep_overlaps_find(struct deep_overlaps *overlaps, double part, struct deep_overlap *deepest)
{
	const struct touchstone_scene *scene = overlaps->scene;
	*deepest = (struct deep_overlap){.depth = part};
	if (scene->potential_count == 0) look_at_pairs(overlaps, deepest);
	for (uint32_t p = 0; p < scene->particle_count; p++)
		for (uint32_t w = 0; w < scene->wall_count; w++) {
			double near = nearness_to_wall(overlaps, p, w);
			if (near < deepest->depth) *deepest = (struct deep_overlap){p, w, true, near};
		}
	return deepest->depth < part;
}
