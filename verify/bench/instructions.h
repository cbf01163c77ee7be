/* Instructions per event, counted by valgrind's callgrind: they do not depend on how busy a machine is. */
#ifndef VERIFY_BENCH_INSTRUCTIONS_H
#define VERIFY_BENCH_INSTRUCTIONS_H

#include "aside.h"
#include "bench/points.h"

/* Whether there is a valgrind that can be started. */
bool instructions_possible(void);

/* Runs this program again, under callgrind, for one point; counting is on within bench_run only, so that neither
 * start-up nor equilibration is in it. NaN with a message when that fails, and with none ("") when `stop` ended it. */
double instructions_count(const struct point *point, const struct effort *effort, const volatile int *stop,
						  char error[REPORT_ERROR]);

/* How many instructions a file by callgrind says were counted in all. NaN with a message when it does not say. */
double instructions_read(const char *path, char error[REPORT_ERROR]);

#endif
