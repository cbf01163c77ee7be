/* The child's side: the process in which a plug-in lives, and what it shares with its parent. */
#ifndef VERIFY_PLUGIN_HOST_H
#define VERIFY_PLUGIN_HOST_H

#include "plugin/plugin.h"

enum { PLUGIN_BATCH = 1024 }; /* questions handed over at a time */

enum plugin_task { PLUGIN_ANSWER, PLUGIN_TIME };

/* Memory of both processes. The child gets a byte when there is a task, and sends one when it is done. */
struct plugin_exchange {
	enum plugin_task task;
	enum touchstone_shape shape;
	size_t first, count; /* questions to answer: from the first, up to the count */
	volatile size_t at;  /* the question that is being answered */
	double number[PLUGIN_BATCH][TOUCHSTONE_MOST_NUMBERS];
	double answer[PLUGIN_BATCH];
	double nanoseconds;
	bool answers[TOUCHSTONE_SHAPES]; /* what was found in the file */
	char error[PLUGIN_ERROR];        /* why it could not be loaded, or "" */
};

/* The name of the function for a shape in lib/touchstone.h; NULL for a shape that has none. */
const char *plugin_symbol(enum touchstone_shape shape);

/* In the child: loads the file, and its own function for each shape for which a symbol is given; says so with a first
 * byte to the socket `parent`; does what it is asked, until there is nobody left to ask. */
_Noreturn void plugin_host(const char *path, const char *const symbols[TOUCHSTONE_SHAPES],
						   struct plugin_exchange *exchange, int parent);

/* ---- file.c */

/* The file that a plug-in's name stands for, to be freed by the caller, and where the symbol begins in the name, or
 * NULL. False with one line in `error` when it is not a shared object for this machine. */
bool plugin_file(const char *name, char **path, const char **symbol, char error[PLUGIN_ERROR]);

#endif
