#include "bench/cores.h"

#include <stdio.h>
#include <stdlib.h>

/* The first of the threads that share a core with this one, itself included: the same for all of them. */
static int core_of(int thread)
{
	char path[96];
	int first = thread;
	snprintf(path, sizeof path, "/sys/devices/system/cpu/cpu%d/topology/thread_siblings_list", thread);
	FILE *file = fopen(path, "r");
	if (!file) return thread;
	if (fscanf(file, "%d", &first) != 1) first = thread;
	fclose(file);
	return first;
}

struct cores cores_look(void)
{
	struct cores cores = {0};
	if (sched_getaffinity(0, sizeof cores.all, &cores.all) != 0) CPU_SET(0, &cores.all);
	for (int thread = 0; thread < CPU_SETSIZE; thread++) {
		if (!CPU_ISSET(thread, &cores.all)) continue;
		if (cores.count++ == 0) cores.chosen[0] = cores.chosen[1] = thread;
		bool shared = core_of(cores.chosen[1]) == core_of(cores.chosen[0]);
		if (cores.count == 2 || (shared && core_of(thread) != core_of(cores.chosen[0]))) cores.chosen[1] = thread;
	}
	cores.one = core_of(cores.chosen[1]) == core_of(cores.chosen[0]);
	return cores;
}

void cores_stay(int core)
{
	cpu_set_t set;
	CPU_ZERO(&set);
	CPU_SET(core, &set);
	sched_setaffinity(0, sizeof set, &set);
}

void cores_roam(const struct cores *cores)
{
	sched_setaffinity(0, sizeof cores->all, &cores->all);
}
