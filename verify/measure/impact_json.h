/* A measurement of impacts as JSON that keeps every bit, for pieces of campaigns; and back. */
#ifndef VERIFY_IMPACT_JSON_H
#define VERIFY_IMPACT_JSON_H

#include <jansson.h>

#include "measure/impact.h"

/* The caller owns it. */
json_t *impact_to_json(const struct impact *impact);

/* All 0 for what is no object. */
struct impact impact_from_json(const json_t *json);

#endif
