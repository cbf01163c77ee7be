/* Findings on a terminal. */
#ifndef VERIFY_BENCH_TABLE_H
#define VERIFY_BENCH_TABLE_H

#include <stdio.h>

#include "bench/baseline.h"

/* Rows with quotients to the stored ones; without a baseline (NULL) the quotients are dashes. */
void table_rows(FILE *stream, const struct row *rows, size_t count, const struct baseline *baseline);

/* What was asked for beside what was found; those not measured are left out. */
void table_demands(FILE *stream, const struct demand *demands, size_t count);

#endif
