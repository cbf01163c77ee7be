#include "provenance.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* What follows KEY and its separators on the first line of the file that begins with KEY; the caller owns it. */
static char *line_after(const char *path, const char *key)
{
	FILE *file = fopen(path, "r");
	if (!file) return NULL;
	char *line = NULL, *value = NULL;
	size_t room = 0;
	while (!value && getline(&line, &room, file) > 0) {
		if (strncmp(line, key, strlen(key)) != 0) continue;
		char *begin = line + strlen(key) + strspn(line + strlen(key), " \t:=\"");
		begin[strcspn(begin, "\"\n")] = '\0';
		value = strdup(begin);
	}
	free(line);
	fclose(file);
	return value;
}

static json_t *line_or_unknown(const char *path, const char *key)
{
	char *line = line_after(path, key);
	json_t *text = json_string(line ? line : "unknown");
	free(line);
	return text;
}

json_t *provenance(void)
{
#ifdef __clang__
	const char *compiler = "clang " __clang_version__;
#else
	const char *compiler = "gcc " __VERSION__;
#endif
	json_int_t cores = sysconf(_SC_NPROCESSORS_ONLN);
	json_int_t memory = (json_int_t)sysconf(_SC_PHYS_PAGES) * sysconf(_SC_PAGESIZE);
	return json_pack("{s: o, s: I, s: I, s: o, s: s}", "processor", line_or_unknown("/proc/cpuinfo", "model name"),
					 "cores", cores, "memory_bytes", memory, "system",
					 line_or_unknown("/etc/os-release", "PRETTY_NAME"), "compiler", compiler);
}
