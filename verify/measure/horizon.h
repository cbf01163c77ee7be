/* The horizon of trust (design, section 5.6): the same start state runs in two arithmetics until their sequences of
 * events, told by kind and particles, first differ. What came before can be trusted as far as the finer arithmetic can.
 *
 * Two events far apart in space but close in time may change places long before any particle meets another than it
 * would have: that too is a difference, so that the horizon falls, slowly, with the number of particles. Each engine
 * rounds the numbers of the start state into its own arithmetic, which is the first of the errors that grow. */
#ifndef VERIFY_HORIZON_H
#define VERIFY_HORIZON_H

#include "measure/course.h"

/* An event as sequences tell it. */
struct horizon_event {
	enum touchstone_kind kind;
	uint32_t first, second;
};

struct horizon {
	uint64_t events;     /* both sequences have these in common */
	double per_particle; /* of them, those that a mean particle takes part in: an event of a pair counts for two
							particles */
	double time;         /* of the last one */
	bool differ;         /* false: all events that the limits allow, so that the horizon lies further on */
	bool stopped;        /* by the watch, before a difference was found */
	struct horizon_event here, there; /* when they differ, the events that do, in the arithmetic and in the finer one */
	double here_time, there_time;     /* and when they happen */
	bool here_ends, there_ends;       /* or one of the two has none: its engine has come to its end */
};

/* Whether two arithmetics can be held against one another: the finer one must carry more bits, unless it is the same.
 * False with one line in `error`, also for names that there are not. */
bool horizon_possible(const char *arithmetic, const char *reference, char error[160]);

/* Runs both engines side by side. The watch is told of each event of the coarser one. False with one line in `error`
 * when one of the engines cannot be made, or the arithmetics are not possible. */
bool horizon_find(const struct touchstone_scene *scene, const char *method, const char *arithmetic,
				  const char *reference, const struct touchstone_limits *limits, const struct watch *watch,
				  struct horizon *horizon, char error[160]);

/* Significand bits of an arithmetic; 0 with one line in `error` when there is none of that name. */
int horizon_bits(const char *arithmetic, char error[160]);

/* Several horizons together: those of several start states. */
struct horizon_spread {
	size_t count;           /* of those that were not stopped */
	double mean, deviation; /* events per particle; NaN for none, or fewer than two */
	size_t open;            /* how many did not differ: then the mean is too low */
};
struct horizon_spread horizon_spread(const struct horizon *horizons, size_t count);

#endif
