#include "measure/call_time.h"

#include <gsl/gsl_statistics_double.h>
#include <time.h>

enum { REPETITIONS = 21, CALLEES = 64 };

/* Of this thread: what others do on the machine meanwhile does not count. */
static double clock_nanoseconds(void)
{
	struct timespec now;
	clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
	return 1e9 * (double)now.tv_sec + (double)now.tv_nsec;
}

static double measure_once(const struct call_time *callee, size_t count)
{
	double began = clock_nanoseconds();
	callee->call(callee->context, 0);
	double between = clock_nanoseconds();
	callee->call(callee->context, count);
	double ended = clock_nanoseconds();
	return ((ended - between) - (between - began)) / (double)count;
}

/* At most CALLEES of them. */
static void measure_some(struct call_time *callee, size_t callees, size_t count)
{
	double taken[CALLEES][REPETITIONS];
	for (size_t c = 0; c < callees; c++) callee[c].call(callee[c].context, count);
	for (int repetition = 0; repetition < REPETITIONS; repetition++)
		for (size_t c = 0; c < callees; c++) taken[c][repetition] = measure_once(&callee[c], count);
	for (size_t c = 0; c < callees; c++)
		callee[c].nanoseconds = gsl_stats_select(taken[c], 1, REPETITIONS, REPETITIONS / 2);
}

void call_time_measure(struct call_time *callee, size_t callees, size_t count)
{
	for (size_t done = 0; done < callees; done += CALLEES)
		measure_some(callee + done, callees - done < CALLEES ? callees - done : CALLEES, count);
}
