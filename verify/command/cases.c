#include "command/cases.h"

#include <limits.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "command/beside.h"

const char *cases_folder(const char *wanted)
{
	struct stat there;
	if (wanted) return wanted;
	if (stat("cases", &there) == 0 && S_ISDIR(there.st_mode)) return "cases";
	static char installed[PATH_MAX];
	char *path = beside_program("../share/touchstone/cases");
	if (!path) return TOUCHSTONE_CASES;
	snprintf(installed, sizeof installed, "%s", path);
	free(path);
	return installed;
}

/* Whether there is something to read from; pipes will do. */
static bool readable(const char *path)
{
	struct stat there;
	return stat(path, &there) == 0 && !S_ISDIR(there.st_mode);
}

char *cases_find(const char *folder, const char *name)
{
	if (readable(name)) return strdup(name);
	const char *const endings[] = {"", ".yaml"};
	for (int e = 0; e < 2; e++) {
		char *path;
		if (asprintf(&path, "%s/%s%s", folder, name, endings[e]) < 0) return NULL;
		if (readable(path)) return path;
		free(path);
	}
	return NULL;
}
