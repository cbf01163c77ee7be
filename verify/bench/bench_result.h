/* A benchmark as a result for the report. */
#ifndef VERIFY_BENCH_RESULT_H
#define VERIFY_BENCH_RESULT_H

#include "bench/baseline.h"
#include "result.h"

/* Figures of the cost over size, density and precision, what was asked for, and all numbers with their quotients to a
 * stored run (or NULL). The caller frees it; NULL when there is no memory. */
struct result *bench_result(const struct findings *findings, const struct row rows[ROWS],
							const struct baseline *baseline);

#endif
