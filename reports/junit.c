#include "junit.h"

#include "embed.h"
#include "template.h"

#include <string.h>

EMBED(template_junit, "templates/junit.xml");

static const struct template templates[] = {{"junit", template_junit}, {NULL, NULL}};

/* Seconds as a plain decimal number, the only kind that all readers take. */
static void set_time(json_t *object)
{
	json_object_set_new(object, "time", json_sprintf("%.3f", json_number_value(json_object_get(object, "seconds"))));
}

/* The audit as the template names its parts; the caller owns it. */
static json_t *view_of(const json_t *audit)
{
	json_t *view = json_deep_copy(audit), *check, *measure;
	const char *date = json_string_value(json_object_get(audit, "date"));
	size_t c, m;
	set_time(view);
	json_object_set_new(view, "timestamp", json_stringn(date ? date : "", date ? strcspn(date, "Z") : 0));
	json_array_foreach(json_object_get(view, "checks"), c, check)
		json_array_foreach(json_object_get(check, "measures"), m, measure) set_time(measure);
	return view;
}

bool junit_write(const char *path, const json_t *audit, char error[REPORT_ERROR])
{
	struct aside file = {.stream = stdout};
	bool aside = strcmp(path, "-") != 0;
	if (aside && !aside_open(&file, error, "%s", path)) return false;
	json_t *view = view_of(audit);
	template_write(file.stream, templates, "junit", view);
	json_decref(view);
	return !aside || aside_keep(&file, error);
}
