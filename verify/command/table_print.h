/* A table of a result as text, in columns as wide as their widest words. */
#ifndef VERIFY_TABLE_PRINT_H
#define VERIFY_TABLE_PRINT_H

#include "result.h"

/* Prints the table of this number, from 0, to standard output, if the result has so many. What semicolons part stands
 * on lines of its own. */
void table_print(const struct result *result, size_t number);

#endif
