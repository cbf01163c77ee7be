/* What the live page shows of a result: links to it, with parameters, on the result's page. */
#ifndef VERIFY_LIVE_LINKS_H
#define VERIFY_LIVE_LINKS_H

#include "result.h"

/* Adds those there are for the result of that name; of grades, those of the scenes in which a bad finder shows. */
void live_links(struct result *result, const char *name);

#endif
