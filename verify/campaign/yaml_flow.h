/* A YAML value written on one line, so that it can follow KEY= in a setting. */
#ifndef VERIFY_YAML_FLOW_H
#define VERIFY_YAML_FLOW_H

#include "store/yaml_text.h"

/* Writes a node in flow style, as it was written where it was plain. The caller frees it. NULL when it is nested more
 * than 8 deep (as an alias to itself would be), or memory ran out. */
char *yaml_flow(const struct yaml_text *text, const yaml_node_t *node);

#endif
