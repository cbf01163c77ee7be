/* The papers' figures: each is measured here and becomes one result (reports/result.h). */
#ifndef VERIFY_FIGURE_H
#define VERIFY_FIGURE_H

#include "result.h"
#include <stdbool.h>

struct figure_setup {
	bool full; /* the papers' own sizes; otherwise what takes minutes */
	uint64_t seed;
	int threads;              /* runs side by side; the numbers do not depend on it */
	const char *folder;       /* where finished pieces are kept until the figure is whole; NULL: nowhere */
	bool any_revision;        /* take finished pieces that another revision of the program has made as well */
	const volatile int *stop; /* non-zero: come to an end with what is done */
	/* Told how much of the whole is done, from one thread at a time; may be NULL. */
	void (*progress)(void *context, double part);
	void *context;
};

/* Each returns a finished result that the caller frees, or NULL with one line in `error`. */
struct result *figure_impact(const struct figure_setup *setup, char error[512]);     /* 2014, fig. 3 */
struct result *figure_three_body(const struct figure_setup *setup, char error[512]); /* 2014, fig. 5 */
struct result *figure_collapse(const struct figure_setup *setup, char error[512]);   /* 2014, section 5 and fig. 7 */
struct result *figure_ladder(const struct figure_setup *setup, char error[512]);     /* precision ladder */
struct result *figure_stepping(const struct figure_setup *setup, char error[512]);   /* 2014, figs. 4 and 6 */
struct result *figure_atlas(const struct figure_setup *setup, char error[512]);      /* where methods fail */
struct result *figure_horizon(const struct figure_setup *setup, char error[512]);    /* for how long a run is trusted */
struct result *figure_time_place(const struct figure_setup *setup, char error[512]); /* late times, far places */
struct result *figure_states(const struct figure_setup *setup, char error[512]);     /* 2016, section 5 */

#endif
