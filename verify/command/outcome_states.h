/* How `run --measure states` tells what was found out about the states of pairs. */
#ifndef VERIFY_OUTCOME_STATES_H
#define VERIFY_OUTCOME_STATES_H

#include "command/outcome.h"

/* On standard output. */
void states_print(const struct states_outcome *states);

/* In the form that outcome.h describes; the caller's. */
json_t *states_json(const struct states_outcome *states);

#endif
