/* Pages from templates: a small part of the Mustache language over JSON. Debian has no such library for C with a
 * licence and upkeep to rely on.
 *
 *	{{name}}                 the value, escaped for HTML text and attributes; there is no way to leave it unescaped
 *	{{#name}} ... {{/name}}  once for each item of a list, or once if the value is there and not false or empty
 *	{{^name}} ... {{/name}}  once if it is not
 *	{{>name}}                another template
 *
 * Names are looked up in the innermost item first, then outwards; {{.}} is the item itself. */
#ifndef REPORTS_TEMPLATE_H
#define REPORTS_TEMPLATE_H

#include <jansson.h>
#include <stdio.h>

struct template
{
	const char *name, *text;
};

/* Writes the template of this name with the values of `context`, an object. `templates` end with a NULL name. */
void template_write(FILE *stream, const struct template *templates, const char *name, const json_t *context);

#endif
