#include "command/beside.h"

#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

char *beside_program(const char *path)
{
	char program[PATH_MAX], *whole;
	ssize_t length = readlink("/proc/self/exe", program, sizeof program - 1);
	program[length > 0 ? length : 0] = '\0';
	char *slash = strrchr(program, '/');
	if (!slash || asprintf(&whole, "%.*s/%s", (int)(slash - program), program, path) < 0) return NULL;
	if (access(whole, F_OK) == 0) return whole;
	free(whole);
	return NULL;
}
