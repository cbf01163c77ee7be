#include "campaign/ranks.h"

#include <dlfcn.h>
#include <stdio.h>
#include <stdlib.h>

#include "command/beside.h"

/* What Open MPI's mpirun, and launchers that speak PMIx, tell the programs they launch. */
static const char *const numbers[] = {"OMPI_COMM_WORLD_RANK", "PMIX_RANK"};

static const char *number(void)
{
	const char *told = getenv(numbers[0]);
	return told ? told : getenv(numbers[1]);
}

bool ranks_launched(void)
{
	return number();
}

int ranks_number(void)
{
	return number() ? atoi(number()) : 0;
}

const struct ranks *ranks_load(char error[512])
{
	char *path = beside_program("touchstone-mpi.so");
	if (!path) path = beside_program("../lib/touchstone/touchstone-mpi.so");
	if (!path) {
		snprintf(error, 512,
				 "built without MPI, of which mpirun would have it be a rank; accepted: a build where mpicc "
				 "is found, or --shard I/N");
		return NULL;
	}
	void *module = dlopen(path, RTLD_NOW | RTLD_GLOBAL); /* Open MPI's own modules look for its names */
	const struct ranks *ranks = module ? dlsym(module, "touchstone_ranks") : NULL;
	if (!ranks) snprintf(error, 512, "MPI cannot be used: %.400s", dlerror());
	free(path);
	return ranks;
}
