/* touchstone-mpi.so: the ranks of campaign/ranks.h on MPI. The only file that knows it. */
#include <mpi.h>

#include "campaign/ranks.h"

static void begin(int *rank, int *size)
{
	int provided;
	MPI_Init_thread(NULL, NULL, MPI_THREAD_FUNNELED, &provided);
	MPI_Comm_rank(MPI_COMM_WORLD, rank);
	MPI_Comm_size(MPI_COMM_WORLD, size);
}

static void send(int to, const char *text)
{
	int length = 1;
	for (const char *end = text; *end; end++) length++;
	MPI_Send(text, length, MPI_CHAR, to, 0, MPI_COMM_WORLD);
}

static bool waiting(int *from, size_t *length)
{
	int there, count;
	MPI_Status status;
	MPI_Iprobe(MPI_ANY_SOURCE, 0, MPI_COMM_WORLD, &there, &status);
	if (!there) return false;
	MPI_Get_count(&status, MPI_CHAR, &count);
	*from = status.MPI_SOURCE;
	*length = (size_t)count;
	return true;
}

static void receive(int from, char *text, size_t length)
{
	MPI_Recv(text, (int)length, MPI_CHAR, from, 0, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
}

static void end(void)
{
	MPI_Finalize();
}

extern const struct ranks touchstone_ranks;
const struct ranks touchstone_ranks = {begin, send, waiting, receive, end};
