/* On which cores the program runs. */
#ifndef VERIFY_BENCH_CORES_H
#define VERIFY_BENCH_CORES_H

#include <sched.h>
#include <stdbool.h>

struct cores {
	int count;     /* the program may run on so many */
	int chosen[2]; /* two of them, of different cores where there are such; with one only, it twice */
	bool one;      /* the two are threads of one core, as far as the system knows */
	cpu_set_t all;
};

/* As it is when the program begins. */
struct cores cores_look(void);

/* Keeps the calling thread on one core, or gives it back all that the program may run on. */
void cores_stay(int core);
void cores_roam(const struct cores *cores);

#endif
