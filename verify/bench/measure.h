/* All measurements of a benchmark, interleaved, with progress shown on the way. */
#ifndef VERIFY_BENCH_MEASURE_H
#define VERIFY_BENCH_MEASURE_H

#include "bench/findings.h"

/* Measures everything, as far as it gets before Ctrl-C; `findings` come from findings_begin. What fails is said on
 * standard error, and counted. False with a message when the scenes cannot be read. */
bool measure_all(struct findings *findings, char error[STORE_ERROR]);

#endif
