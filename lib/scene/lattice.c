#include "scene/lattice.h"

#include <math.h>

/* How far apart `layers` layers are along an axis, and where the first lies. Between walls they spread out until the
 * outer ones touch. */
static double layer_spacing(const struct lattice_box *box, int axis, size_t layers, double *first)
{
	double extent = box->extent[axis], spacing = extent / (double)layers;
	*first = (spacing - extent) / 2;
	if (!box->walled[axis] || spacing >= box->diameter) return spacing;
	*first = (box->diameter - extent) / 2;
	return layers > 1 ? (extent - box->diameter) / (double)(layers - 1) : 0;
}

/* Number of sites, 0 when that many layers cannot be. */
static size_t site_count(const struct lattice_box *box, bool centred, const size_t layers[3])
{
	size_t points = 1;
	for (int axis = 0; axis < box->dimensions; axis++) {
		if (centred && box->periodic[axis] && layers[axis] % 2) return 0;
		if (__builtin_mul_overflow(points, layers[axis], &points)) return 0;
	}
	return centred ? points / 2 + points % 2 : points;
}

/* Distance of nearest sites: one layer away on one axis, or, when centred, on two axes, or two layers on one. */
static double nearest(const struct lattice_box *box, bool centred, const size_t layers[3], const double spacing[3])
{
	double least = INFINITY;
	int axes = box->dimensions;
	for (int a = 0; a < axes; a++) {
		double step = spacing[a] * (centred ? 2 : 1);
		if ((layers[a] > (centred ? 2 : 1) || box->periodic[a]) && step * step < least) least = step * step;
		for (int b = 0; centred && b < a; b++) {
			double diagonal = spacing[a] * spacing[a] + spacing[b] * spacing[b];
			if (layers[a] > 1 && layers[b] > 1 && diagonal < least) least = diagonal;
		}
	}
	return sqrt(least);
}

static struct lattice lattice_of(const struct lattice_box *box, bool centred, const size_t layers[3])
{
	struct lattice lattice = {.dimensions = box->dimensions, .centred = centred, .layers = {1, 1, 1}};
	for (int axis = 0; axis < box->dimensions; axis++) {
		lattice.layers[axis] = layers[axis];
		lattice.spacing[axis] = layer_spacing(box, axis, layers[axis], &lattice.first[axis]);
		if (box->walled[axis] && box->extent[axis] < box->diameter) return lattice;
	}
	lattice.sites = site_count(box, centred, layers);
	lattice.distance = nearest(box, centred, layers, lattice.spacing);
	return lattice;
}

/* Keeps the better of two; equal to a rounding is equal. */
static void improve(struct lattice *best, struct lattice other, size_t count)
{
	if (other.sites < count) return;
	const double rounding = 1e-12;
	bool wider = best->sites == 0 || other.distance > best->distance * (1 + rounding);
	bool smaller = other.distance >= best->distance * (1 - rounding) && other.sites < best->sites;
	if (wider || smaller) *best = other;
}

/* More layers along an axis only bring sites closer: true when `layers` of them are already too close to win. */
static bool too_close(const struct lattice_box *box, bool centred, int axis, size_t layers, double best)
{
	double first, spacing = layer_spacing(box, axis, layers, &first);
	return layers > 2 && spacing * (centred ? 2 : 1) < best * (1 - 1e-9);
}

/* Layers along the last axis that make up for those along the others. */
static size_t last_layers(const struct lattice_box *box, bool centred, size_t others, size_t count)
{
	size_t points = centred ? 2 * count - 1 : count, layers = (points + others - 1) / others;
	return centred && box->periodic[box->dimensions - 1] ? layers + layers % 2 : layers;
}

struct lattice lattice_fit(const struct lattice_box *box, bool centred, size_t count)
{
	struct lattice best = {0};
	centred = centred && box->dimensions > 1;
	size_t most = centred ? 2 * count : count, layers[3] = {1, 1, 1};
	if (box->dimensions == 1) return layers[0] = count, lattice_of(box, centred, layers);
	for (layers[0] = 1; layers[0] <= most && !too_close(box, centred, 0, layers[0], best.distance); layers[0]++) {
		if (box->dimensions == 2) {
			layers[1] = last_layers(box, centred, layers[0], count);
			improve(&best, lattice_of(box, centred, layers), count);
			continue;
		}
		for (layers[1] = 1; layers[1] <= most && !too_close(box, centred, 1, layers[1], best.distance); layers[1]++) {
			layers[2] = last_layers(box, centred, layers[0] * layers[1], count);
			improve(&best, lattice_of(box, centred, layers), count);
		}
	}
	return best;
}

void lattice_place(const struct lattice *lattice, struct touchstone_particle *particles, size_t count)
{
	size_t site = 0, placed = 0;
	for (size_t z = 0; z < lattice->layers[2]; z++)
		for (size_t y = 0; y < lattice->layers[1]; y++)
			for (size_t x = 0; x < lattice->layers[0]; x++) {
				if (lattice->centred && (x + y + z) % 2) continue;
				/* in whole numbers, particle p stands on site p * sites / count */
				uint64_t wanted = placed < count ? (uint64_t)placed * lattice->sites / count : UINT64_MAX;
				if (site++ != wanted) continue;
				const size_t index[3] = {x, y, z};
				for (int axis = 0; axis < lattice->dimensions; axis++)
					particles[placed].position[axis] =
						lattice->first[axis] + (double)index[axis] * lattice->spacing[axis];
				placed++;
			}
}
