/* YAML that remembers its lines, so that everything that is wrong with a value can be said with its place. */
#ifndef TOUCHSTONE_YAML_TEXT_H
#define TOUCHSTONE_YAML_TEXT_H

#include <stdarg.h>
#include <yaml.h>

#include "store/text.h"

/* Keys are named by their path from the top: "density", "start.temperature", "species[1].diameter". */
enum { YAML_PATH = 128 };

struct yaml_text {
	char *name; /* path of the file, or "--set KEY=VALUE" */
	bool lined; /* whether it has lines worth naming */
	char *bytes;
	size_t length;
	yaml_document_t document;
};

/* Reads a file, or what follows `--set`: KEY=VALUE, where KEY may be dotted and VALUE is YAML on one line. False
 * with a message, and nothing to close, when it cannot be read or is not YAML. */
bool yaml_text_read(struct yaml_text *text, const char *path, char error[STORE_ERROR]);
bool yaml_text_setting(struct yaml_text *text, const char *setting, char error[STORE_ERROR]);
void yaml_text_close(struct yaml_text *text);

/* Whether the text has that key; `line` becomes its line, or that of as much of the path as there is. */
bool yaml_text_locate(const struct yaml_text *text, const char *path, size_t *line);

/* Fill `error` with "place: path: message" on one line (no path when it is empty) and return false. */
bool yaml_text_blame(const struct yaml_text *text, size_t line, const char *path, char error[STORE_ERROR],
					 const char *format, va_list arguments);
__attribute__((format(printf, 5, 6))) bool yaml_text_refuse(const struct yaml_text *text, size_t line, const char *path,
															char error[STORE_ERROR], const char *format, ...);

/* A node of the document, the word of a scalar node, the line a node begins on. */
yaml_node_t *yaml_text_node(const struct yaml_text *text, int index);
const char *yaml_text_word(const yaml_node_t *node);
size_t yaml_text_line(const yaml_node_t *node);

#endif
