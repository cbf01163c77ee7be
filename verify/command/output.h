/* Where the output of a command goes: to a file that appears whole or not at all, or to standard output. */
#ifndef VERIFY_OUTPUT_H
#define VERIFY_OUTPUT_H

#include <jansson.h>
#include <stdbool.h>

#include "aside.h"

/* Whether a file could be written there, found out before anything long begins; nothing is left behind. "-" always
 * can. False with a message. */
bool output_possible(const char *path, char error[REPORT_ERROR]);

/* Writes JSON, indented, to a file or, for "-", to standard output. False with a message. */
bool output_json(const char *path, const json_t *json, char error[REPORT_ERROR]);

#endif
