/* From YAML to structures by a libcyaml schema. libcyaml names no line that one could rely on, so a text is held
 * against the schema here first, and refused with its line and with what the schema accepts there. */
#ifndef TOUCHSTONE_YAML_SCHEMA_H
#define TOUCHSTONE_YAML_SCHEMA_H

#include <cyaml/cyaml.h>

#include "store/yaml_text.h"

/* Makes the structure that the schema (pointer to a mapping of strings, enums, lists and mappings, all of them
 * pointers, NULL when absent) describes. False with a message for an unknown or repeated key, or a value of another
 * kind. NULL for an empty text. */
bool yaml_schema_load(const struct yaml_text *text, const cyaml_schema_value_t *schema, cyaml_data_t **data,
					  char error[STORE_ERROR]);

/* Lets the keys of `other` take the place of those of `data`, mapping within mapping; what is replaced goes the other
 * way, so that both are still to be freed. */
void yaml_schema_override(const cyaml_schema_value_t *schema, cyaml_data_t *data, cyaml_data_t *other);

void yaml_schema_free(const cyaml_schema_value_t *schema, cyaml_data_t *data);

#endif
