/* The runs whose cost is measured: cases of the folder `cases`, varied as `touchstone run --set` would. */
#ifndef VERIFY_BENCH_POINTS_H
#define VERIFY_BENCH_POINTS_H

#include <stdbool.h>

#include "store/scene_file.h"

struct point {
	const char *scene; /* a case */
	size_t particles;
	double density;
	const char *arithmetic;
	const char *search;   /* cells, or unsieved */
	uint64_t events;      /* timed in one repetition */
	uint64_t counted;     /* whose instructions are counted */
	const char *boundary; /* of all axes; NULL: periodic */
};

extern const struct point points[];
enum { POINTS = 21, POINT_NAME = 80 };

/* How a quick and a full measurement differ. */
struct effort {
	bool full;
	double scale;         /* of all numbers of events and plates; 1 */
	unsigned repetitions; /* of everything that is timed: at least 5 */
};
struct effort effort_of(bool full);

/* So many events or plates, scaled; at least 1. */
uint64_t effort_events(const struct effort *effort, uint64_t events);

/* Elastic collisions per particle before anything is measured: 5, or 20 when full; for a million particles, where
 * each takes seconds, 2, or 5 when full. */
double point_melt(const struct point *point, const struct effort *effort);

/* Whether its instructions are counted: above 20 000 particles only when full. */
bool point_counted(const struct point *point, const struct effort *effort);

/* Scene, particles, density and arithmetic (and search, when it is not the usual one): "discs 13500 0.5 binary64".
 * Returns `name`. */
const char *point_name(const struct point *point, char name[POINT_NAME]);

/* The number of the point of this name, or of these figures among the elastic spheres; -1 when there is none. */
int point_named(const char *name);
int point_of(const char *scene, size_t particles, double density, const char *arithmetic, const char *search);

/* The scene file of a point, as `run` would have it. NULL with a message. The caller closes it. */
struct scene_file *point_open(const struct point *point, const struct effort *effort, char error[STORE_ERROR]);

#endif
