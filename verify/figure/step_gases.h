/* Wells and shoulders as pieces of a campaign: each is made once, side by side with others, and kept until the figure
 * is whole; a long one goes on from a checkpoint. */
#ifndef VERIFY_STEP_GASES_H
#define VERIFY_STEP_GASES_H

#include "figure/step_gas.h"

/* Measures all gases, as the campaign `name`, into `outcomes`, all zero where a stop left a gas unmade; `*finished`
 * tells how many are there. False, with one line in `error`, when that cannot be. */
bool step_gases_measure(const char *name, const struct figure_setup *setup, const struct step_gas *gases, size_t count,
						struct step_gas_outcome *outcomes, size_t *finished, char error[512]);

#endif
