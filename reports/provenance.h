/* Where a result comes from. */
#ifndef REPORTS_PROVENANCE_H
#define REPORTS_PROVENANCE_H

#include <jansson.h>

/* The machine this program runs on and the compiler that made it, as `machine` in schema.h. The caller owns it. */
json_t *provenance(void);

#endif
