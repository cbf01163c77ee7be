/* The ranks of an MPI program, so far as campaigns need them. The program itself knows nothing of MPI: when it was
 * launched by mpirun it loads touchstone-mpi.so (verify/mpi), so that all other starts are as quick as without. */
#ifndef VERIFY_RANKS_H
#define VERIFY_RANKS_H

#include <stdbool.h>
#include <stddef.h>

/* What touchstone-mpi.so exports as `touchstone_ranks`. All is called by the thread that called `begin`. */
struct ranks {
	void (*begin)(int *rank, int *size);
	void (*send)(int to, const char *text); /* returns when `text` may be used again */
	/* Whether a message has come; then from whom, and how long it is with the zero that ends it. */
	bool (*waiting)(int *from, size_t *length);
	void (*receive)(int from, char *text, size_t length);
	void (*end)(void); /* waits for all ranks */
};

/* Whether this program is one of several that mpirun launched. */
bool ranks_launched(void);

/* This program's number among them, from 0, as mpirun tells it, before anything is loaded. */
int ranks_number(void);

/* Loads the module, which is beside the program or in ../lib/touchstone. NULL with one line in `error`. */
const struct ranks *ranks_load(char error[512]);

#endif
