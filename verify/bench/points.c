#include "bench/points.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "command/cases.h"

const struct point points[] = {
	{"hard-spheres", 500, 0.5, "binary64", "cells", 300000, 10000, NULL},
	{"hard-spheres", 2916, 0.5, "binary64", "cells", 300000, 10000, NULL},
	{"hard-spheres", 13500, 0.5, "binary64", "cells", 300000, 10000, NULL},
	{"hard-spheres", 108000, 0.5, "binary64", "cells", 300000, 20000, NULL},
	{"hard-spheres", 1000188, 0.5, "binary64", "cells", 600000, 100000, NULL},
	{"hard-spheres", 13500, 0.01, "binary64", "cells", 60000, 10000, NULL},
	{"hard-spheres", 13500, 0.1, "binary64", "cells", 200000, 10000, NULL},
	{"hard-spheres", 13500, 0.3, "binary64", "cells", 300000, 10000, NULL},
	{"hard-spheres", 13500, 0.7, "binary64", "cells", 300000, 10000, NULL},
	{"hard-spheres", 13500, 0.9, "binary64", "cells", 300000, 10000, NULL},
	{"hard-spheres", 2916, 0.5, "binary32", "cells", 200000, 10000, NULL},
	{"hard-spheres", 2916, 0.5, "short:24", "cells", 200000, 10000, NULL},
	{"hard-spheres", 2916, 0.5, "extended", "cells", 100000, 10000, NULL},
	{"hard-spheres", 2916, 0.5, "twin", "cells", 100000, 10000, NULL},
	{"hard-spheres", 2916, 0.5, "binary128", "cells", 30000, 5000, NULL},
	{"hard-spheres", 2916, 0.5, "mpfr:53", "cells", 20000, 5000, NULL},
	{"hard-spheres", 2916, 0.5, "mpfr:113", "cells", 20000, 5000, NULL},
	{"hard-spheres", 2916, 0.5, "mpfr:256", "cells", 20000, 5000, NULL},
	{"hard-spheres", 2916, 0.5, "mpfr:113", "unsieved", 20000, 5000, NULL},
	{"inelastic-spheres", 13500, 0.5, "binary64", "cells", 200000, 10000, NULL},
	{"discs", 13500, 0.5, "binary64", "cells", 300000, 10000, "periodic"},
};
_Static_assert(sizeof points / sizeof *points == POINTS, "all points are counted");

static const size_t many = 20000, a_million = 500000; /* particles: from here on, a point is treated as such */

struct effort effort_of(bool full)
{
	return full ? (struct effort){true, 4, 11} : (struct effort){false, 1, 5};
}

uint64_t effort_events(const struct effort *effort, uint64_t events)
{
	return (uint64_t)fmax(1, rint(effort->scale * (double)events));
}

double point_melt(const struct point *point, const struct effort *effort)
{
	if (point->particles > a_million) return effort->full ? 5 : 2;
	return effort->full ? 20 : 5;
}

bool point_counted(const struct point *point, const struct effort *effort)
{
	return effort->full || point->particles < many;
}

const char *point_name(const struct point *point, char name[POINT_NAME])
{
	bool usual = strcmp(point->search, "cells") == 0;
	snprintf(name, POINT_NAME, "%s %zu %g %s%s%s", point->scene, point->particles, point->density, point->arithmetic,
			 usual ? "" : " ", usual ? "" : point->search);
	return name;
}

int point_named(const char *name)
{
	char own[POINT_NAME];
	for (int p = 0; p < POINTS; p++)
		if (strcmp(name, point_name(&points[p], own)) == 0) return p;
	return -1;
}

int point_of(const char *scene, size_t particles, double density, const char *arithmetic, const char *search)
{
	char name[POINT_NAME];
	return point_named(point_name(&(struct point){scene, particles, density, arithmetic, search, 0, 0, NULL}, name));
}

struct scene_file *point_open(const struct point *point, const struct effort *effort, char error[STORE_ERROR])
{
	enum { SETTINGS = 6, ROOM = 60 };
	char setting[SETTINGS][ROOM];
	const char *settings[SETTINGS];
	size_t count = 5;
	for (size_t s = 0; s < SETTINGS; s++) settings[s] = setting[s];
	snprintf(setting[0], ROOM, "particles=%zu", point->particles);
	snprintf(setting[1], ROOM, "density=%.17g", point->density);
	snprintf(setting[2], ROOM, "arithmetic=%s", point->arithmetic);
	snprintf(setting[3], ROOM, "search=%s", point->search);
	snprintf(setting[4], ROOM, "equilibrate=%.17g", point_melt(point, effort));
	if (point->boundary) snprintf(setting[count++], ROOM, "boundaries=[%s]", point->boundary);
	char *path = cases_find(cases_folder(NULL), point->scene);
	if (!path) {
		snprintf(error, STORE_ERROR, "%s: no such case", point->scene);
		return NULL;
	}
	struct scene_file *file = scene_file_open(path, count, settings, error);
	free(path);
	return file;
}
