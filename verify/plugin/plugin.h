/* Finders written by others: a shared object is loaded in a child process and asked there, so that whatever it does, it
 * does to itself. A crash, an end of the process, an endless loop are findings, each with the question that it
 * happened at; a new child goes on behind it.
 *
 * The child's standard output is thrown away, its standard error is ours; it has no other open file of ours, a process
 * group of its own, no core file, and dies with us. One thread at a time may use a plug-in. */
#ifndef VERIFY_PLUGIN_H
#define VERIFY_PLUGIN_H

#include <stdbool.h>
#include <stddef.h>

#include "touchstone.h"

enum { PLUGIN_ERROR = 400 }; /* room for a one-line message */

/* What became of a child at a question. */
struct plugin_fault {
	size_t question; /* which of those asked */
	int signal;      /* that ended the child, or 0 */
	int status;      /* with which it ended itself, where no signal did */
	bool endless;    /* it gave no answer, and was ended by us */
	bool alone;      /* the same happens when a new child is asked nothing but this question */
};

/* How much is borne. */
struct plugin_patience {
	double seconds;           /* without an answer until a loop is called endless */
	size_t crashes, loops;    /* in one plugin_find, until it is given up */
	bool once;                /* do not ask again whether a fault happens alone */
	const volatile int *stop; /* non-zero: give up now; may be NULL */
};

struct plugin;

/* Loads FILE with the functions of lib/touchstone.h, or FILE:SYMBOL with a function of that name for one shape. NULL
 * with one line in `error`, and `broken` when that is because it does not survive being loaded. */
struct plugin *plugin_open(const char *name, enum touchstone_shape shape, const struct plugin_patience *patience,
						   bool *broken, char error[PLUGIN_ERROR]);
void plugin_close(struct plugin *plugin); /* NULL is fine */

/* Whether it has a finder for the shape. */
bool plugin_answers(const struct plugin *plugin, enum touchstone_shape shape);

/* The file's name without its folder, with the symbol if one was named. */
const char *plugin_name(const struct plugin *plugin);

/* Asks `count` questions. `times` receives the answers, and NaN where there is none: because the numbers are not finite,
 * and nothing was asked, or because of a fault, of which `fault` is told. Returns how many questions were dealt with: fewer than `count` when it was given up. */
size_t plugin_find(struct plugin *plugin, enum touchstone_shape shape, const double (*numbers)[TOUCHSTONE_MOST_NUMBERS],
				   size_t count, double *times, void (*fault)(void *context, const struct plugin_fault *fault),
				   void *context);

/* Nanoseconds per call, without those of a call that does nothing; NaN when it does not live to tell. */
double plugin_nanoseconds(struct plugin *plugin, enum touchstone_shape shape,
						  const double (*numbers)[TOUCHSTONE_MOST_NUMBERS], size_t count);

/* What happened, in words: "is ended by SIGSEGV (Segmentation fault)". */
void plugin_fault_words(const struct plugin_fault *fault, char words[120]);

#endif
