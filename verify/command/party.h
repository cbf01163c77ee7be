/* Who is asked: the methods, arithmetics and plug-ins that a command line names, as finders. */
#ifndef VERIFY_PARTY_H
#define VERIFY_PARTY_H

#include "plugin/finder.h"

/* Words given with one option or as arguments, each once. */
struct words {
	char **word;
	size_t count;
};
bool words_room(struct words *words, int arguments); /* for all of a command line; false when out of memory */
void words_add(struct words *words, char *word);

struct guests {
	struct words methods, arithmetics, plugins;
	unsigned shapes;             /* bit 1 << enum touchstone_shape for each shape wanted */
	enum touchstone_shape shape; /* of a plug-in's symbol: the one named last */
};
bool guests_room(struct guests *guests, int arguments);
void guests_add_shape(struct guests *guests, const char *name); /* or refuse_option */
void guests_free(struct guests *guests);

/* Once all is read: somebody must have been named, or refuse_usage; binary64 and all shapes are what is usual. */
void guests_complete(struct guests *guests, const char *command);

struct party {
	struct finder *finders;
	size_t count;
};

/* Finds everybody. Anything but STATUS_WELL has been explained; party_dismiss either way. The words and the patience
 * must outlive the party. */
int party_gather(struct party *party, const char *command, const struct guests *guests,
				 const struct plugin_patience *patience);
void party_dismiss(struct party *party);

#endif
