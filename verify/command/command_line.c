/* The words of a command line. */
#include "command/command.h"

#include <stdio.h>

char *command_line(int argc, char **argv)
{
	char *text = NULL;
	size_t size;
	FILE *stream = open_memstream(&text, &size);
	for (int a = 0; stream && a < argc; a++) fprintf(stream, "%s%s", a == 0 ? "" : " ", argv[a]);
	if (stream) fclose(stream);
	return text;
}
