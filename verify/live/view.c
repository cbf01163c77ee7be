#include "live/view.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

struct view_place {
	float height; /* towards the eye */
	uint32_t particle;
};

static const double farthest_fade = 0.7, face = 0.92; /* of a sphere at the back; of the sphere within its rim */
static const double halo = 1.6;                       /* radius around one that is inside another: disc.vert */

/* ------------------------------------------------------------------ from space to the plane */

static void place(const struct view *view, const double position[3], double at[2])
{
	double x = position[0] - view->origin[0], y = position[1] - view->origin[1];
	at[0] = view->upright ? 0 : x;
	at[1] = view->upright ? x : view->scene->dimensions > 1 ? y : 0;
}

/* The middle of what the particles span along an axis. */
static double middle(const struct touchstone_scene *scene, int axis)
{
	double least = INFINITY, most = -INFINITY;
	for (size_t p = 0; p < scene->particle_count; p++) {
		least = fmin(least, scene->particles[p].position[axis]);
		most = fmax(most, scene->particles[p].position[axis]);
	}
	return least / 2 + most / 2;
}

bool view_begin(struct view *view, const struct touchstone_scene *scene, const bool open[3])
{
	*view = (struct view){
		.scene = scene,
		.upright = scene->dimensions == 1 && scene->acceleration[0] != 0,
		.open = open[0] || open[1],
		.room = 2 * scene->particle_count,
	};
	for (int axis = 0; axis < scene->dimensions; axis++) view->origin[axis] = open[axis] ? middle(scene, axis) : 0;
	view->disc = malloc(view->room * VIEW_PER_DISC * sizeof *view->disc);
	view->line = malloc(2 * VIEW_MOST_JOINED * VIEW_PER_LINE * sizeof *view->line);
	view->order = malloc(scene->particle_count * sizeof *view->order);
	return view->disc && view->line && view->order;
}

void view_end(struct view *view)
{
	free(view->disc);
	free(view->line);
	free(view->order);
	*view = (struct view){0};
}

/* ------------------------------------------------------------------ discs */

static bool grow(struct view *view)
{
	if (view->discs < view->room) return true;
	float *disc = realloc(view->disc, 2 * view->room * VIEW_PER_DISC * sizeof *disc);
	if (!disc) return false;
	view->disc = disc;
	view->room *= 2;
	return true;
}

/* How far to shift what reaches across a seam, so that it shows on the other side; 0: it does not. */
static double across(const struct view *view, int axis, double place, double reach)
{
	const struct touchstone_scene *scene = view->scene;
	if (axis >= scene->dimensions || !scene->periodic[axis] || view->upright) return 0;
	double half = scene->box[axis] / 2;
	return place + reach > half ? -scene->box[axis] : place - reach < -half ? scene->box[axis] : 0;
}

/* Adds a disc and its ghosts. */
static bool add(struct view *view, const double at[2], double radius, float warmth, float depth, double fade)
{
	double reach = depth > 0 ? halo * radius : radius;
	double shift[2] = {across(view, 0, at[0], reach), across(view, 1, at[1], reach)};
	for (int ghost = 0; ghost < 4; ghost++) {
		bool sideways = ghost & 1, upwards = ghost & 2;
		if ((sideways && shift[0] == 0) || (upwards && shift[1] == 0)) continue;
		if (!grow(view)) return false;
		const float disc[] = {(float)(at[0] + (sideways ? shift[0] : 0)),
							  (float)(at[1] + (upwards ? shift[1] : 0)),
							  (float)radius,
							  warmth,
							  depth,
							  (float)fade};
		memcpy(&view->disc[view->discs++ * VIEW_PER_DISC], disc, sizeof disc);
	}
	return true;
}

/* Widens the bounds by a point, and something around it. */
static void widen(double bounds[4], const double at[2], double around)
{
	for (int axis = 0; axis < 2; axis++) {
		if (!isfinite(at[axis])) continue;
		bounds[2 * axis] = fmin(bounds[2 * axis], at[axis] - around);
		bounds[2 * axis + 1] = fmax(bounds[2 * axis + 1], at[axis] + around);
	}
}

/* Widens them by a particle and by its feet on walls: the ground it falls to is to be seen. */
static void widen_by_all(struct view *view, const double at[2], double radius)
{
	double wall[4];
	widen(view->bounds, at, radius);
	for (size_t w = 0; w < view->scene->wall_count; w++) {
		if (!view_wall(view, w, wall)) continue;
		double above = (at[0] - wall[0]) * wall[2] + (at[1] - wall[1]) * wall[3];
		widen(view->bounds, (const double[]){at[0] - above * wall[2], at[1] - above * wall[3]}, 0);
	}
}

static int farther_first(const void *one, const void *other)
{
	float a = ((const struct view_place *)one)->height, b = ((const struct view_place *)other)->height;
	return (a > b) - (a < b);
}

/* The order of drawing. */
static void sort(struct view *view, const float *depth)
{
	const struct touchstone_scene *scene = view->scene;
	size_t count = 0;
	for (int inside = 0; inside < 2; inside++) {
		size_t first = count;
		for (uint32_t p = 0; p < scene->particle_count; p++)
			if ((depth[p] > 0) == inside)
				view->order[count++] = (struct view_place){(float)scene->particles[p].position[2], p};
		if (scene->dimensions == 3) qsort(view->order + first, count - first, sizeof *view->order, farther_first);
	}
}

/* How far a sphere fades: none at the near end of the box, most at the other. */
static double fade_of(const struct touchstone_scene *scene, const struct touchstone_particle *particle)
{
	if (scene->dimensions < 3 || !(scene->box[2] > 0)) return 0;
	return farthest_fade * fmin(1, fmax(0, 0.5 - particle->position[2] / scene->box[2]));
}

bool view_discs(struct view *view, const float *warmth, const float *depth)
{
	const struct touchstone_scene *scene = view->scene;
	bool spheres = scene->dimensions == 3, room = true;
	memcpy(view->bounds, (const double[]){INFINITY, -INFINITY, INFINITY, -INFINITY}, sizeof view->bounds);
	view->discs = 0;
	sort(view, depth);
	for (size_t k = 0; k < scene->particle_count && room; k++) {
		uint32_t p = view->order[k].particle;
		const struct touchstone_particle *particle = &scene->particles[p];
		double at[2], radius = scene->species[particle->species].diameter / 2;
		place(view, particle->position, at);
		if (view->open) widen_by_all(view, at, radius);
		bool marked = depth[p] > 0;
		if (spheres && !marked) room = add(view, at, radius, warmth[p], 0, 1);
		room = room && add(view, at, spheres && !marked ? face * radius : radius, warmth[p], depth[p],
						   marked ? 0 : fade_of(scene, particle));
	}
	return room;
}

/* ------------------------------------------------------------------ lines and walls */

static void join(struct view *view, const double from[2], const double by[2])
{
	const float line[] = {(float)from[0], (float)from[1], (float)(from[0] + by[0]), (float)(from[1] + by[1])};
	memcpy(&view->line[view->lines++ * VIEW_PER_LINE], line, sizeof line);
}

/* Joins two by the shortest way, which may lead across a seam: then from either side. */
static void join_pair(struct view *view, const double one[2], const double other[2])
{
	const struct touchstone_scene *scene = view->scene;
	double by[2] = {other[0] - one[0], other[1] - one[1]};
	bool seam = false;
	for (int axis = 0; axis < 2 && axis < scene->dimensions && !view->upright; axis++) {
		if (!scene->periodic[axis] || fabs(by[axis]) <= scene->box[axis] / 2) continue;
		by[axis] -= copysign(scene->box[axis], by[axis]);
		seam = true;
	}
	join(view, one, by);
	if (seam) join(view, other, (const double[]){-by[0], -by[1]});
}

bool view_lines(struct view *view, const struct touchstone_engine *engine)
{
	const struct touchstone_scene *scene = view->scene;
	struct touchstone_status status;
	touchstone_status(engine, &status);
	view->lines = 0;
	if (status.captured == 0 || status.captured > VIEW_MOST_JOINED) return true;
	struct touchstone_captured *list = malloc(2 * VIEW_MOST_JOINED * sizeof *list);
	if (!list) return false;
	for (uint32_t p = 0; p < scene->particle_count; p++) {
		size_t count = touchstone_captured(engine, p, list, (size_t)2 * VIEW_MOST_JOINED);
		for (size_t k = 0; k < count && k < (size_t)2 * VIEW_MOST_JOINED; k++) {
			double one[2], other[2];
			if (list[k].partner <= p) continue;
			place(view, scene->particles[p].position, one);
			place(view, scene->particles[list[k].partner].position, other);
			join_pair(view, one, other);
		}
	}
	free(list);
	return true;
}

bool view_wall(const struct view *view, size_t number, double wall[4])
{
	const struct touchstone_wall *stands = &view->scene->walls[number];
	if (stands->normal[2] != 0) return false;
	place(view, stands->point, wall);
	wall[2] = view->upright ? 0 : stands->normal[0];
	wall[3] = view->upright ? stands->normal[0] : stands->normal[1];
	return true;
}

double view_ring(const struct view *view)
{
	if (view->scene->potential_count == 0 || view->scene->potentials->step_count == 0) return 0;
	return view->scene->potentials->steps[view->scene->potentials->step_count - 1].distance / 2;
}
