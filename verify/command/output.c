#include "command/output.h"

#include <string.h>

enum { FORMAT = JSON_INDENT(2) | JSON_PRESERVE_ORDER };

bool output_possible(const char *path, char error[REPORT_ERROR])
{
	if (strcmp(path, "-") == 0) return true;
	struct aside file;
	if (!aside_open(&file, error, "%s", path)) return false;
	aside_drop(&file);
	return true;
}

bool output_json(const char *path, const json_t *json, char error[REPORT_ERROR])
{
	if (strcmp(path, "-") == 0) { /* trouble is noticed when the program ends */
		json_dumpf(json, stdout, FORMAT);
		putchar('\n');
		return true;
	}
	struct aside file;
	if (!aside_open(&file, error, "%s", path)) return false;
	json_dumpf(json, file.stream, FORMAT);
	putc('\n', file.stream);
	return aside_keep(&file, error);
}
