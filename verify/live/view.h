/* What the live page draws of a scene: discs and lines in a plane.
 *
 * Two dimensions are drawn as they are. One is a line across, or, where gravity pulls along it, an upright one. Three
 * are seen along the third axis from its far end: what is nearer to the eye comes later and covers what is behind it,
 * and the farther a sphere is the more it fades; each stands before a disc of the paper's colour, its rim. Particles
 * inside one another come last of all, so that nothing hides them. Who reaches across the seam of a periodic axis is
 * drawn on either side. */
#ifndef VERIFY_VIEW_H
#define VERIFY_VIEW_H

#include "touchstone.h"

/* A disc: x, y, radius, warmth (0 to 1), how deep it is inside another over their contact distance, and how far it
 * fades into the paper (0 to 1). A line: x and y of either end. Places are relative to the view's origin. */
enum { VIEW_PER_DISC = 6, VIEW_PER_LINE = 4, VIEW_MOST_JOINED = 1000 };

struct view {
	const struct touchstone_scene *scene; /* its particles are where they are to be drawn */
	bool upright, open;                   /* open: there is no box to be looked into */
	double origin[3]; /* where the particles are at first, on axes without a box; else the box's middle */
	double bounds[4]; /* where it is open: least and largest x, least and largest y of all that is finite, and of walls
						 near it */
	size_t discs, room; /* how many are to be drawn, and for how many there is room */
	float *disc;
	size_t lines;
	float *line;
	struct view_place *order; /* in which particles are drawn */
};

/* Begins the view of a scene, on whose axes `open` there is no box. The scene must outlive it; end it
 * with view_end. False when there is no memory. */
bool view_begin(struct view *view, const struct touchstone_scene *scene, const bool open[3]);
void view_end(struct view *view);

/* Fills discs and bounds; warmth and depth of each particle come from the caller. False when there is no memory. */
bool view_discs(struct view *view, const float *warmth, const float *depth);

/* Fills lines between captured pairs, none when there are more than VIEW_MOST_JOINED; false when there is no memory. */
bool view_lines(struct view *view, const struct touchstone_engine *engine);

/* A wall in the plane: point x and y, normal x and y; false when it does not stand upright in it. */
bool view_wall(const struct view *view, size_t number, double wall[4]);

/* Half the distance of the outermost step of the scene's first potential: rings so large touch where the step is. 0:
 * there is none. */
double view_ring(const struct view *view);

#endif
