#include "store/yaml_text.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { LARGEST_TEXT = 4 << 20 }; /* bytes; lists longer than that belong into a file of their own */

bool yaml_text_blame(const struct yaml_text *text, size_t line, const char *path, char error[STORE_ERROR],
					 const char *format, va_list arguments)
{
	char shown[TEXT_SHOWN];
	int length = text->lined ? snprintf(error, STORE_ERROR, "%.200s:%zu: ", text->name, line)
							 : snprintf(error, STORE_ERROR, "%s: ", text_shown(shown, text->name));
	if (*path) length += snprintf(error + length, STORE_ERROR - (size_t)length, "%s: ", path);
	vsnprintf(error + length, STORE_ERROR - (size_t)length, format, arguments);
	text_one_line(error);
	return false;
}

bool yaml_text_refuse(const struct yaml_text *text, size_t line, const char *path, char error[STORE_ERROR],
					  const char *format, ...)
{
	va_list arguments;
	va_start(arguments, format);
	yaml_text_blame(text, line, path, error, format, arguments);
	va_end(arguments);
	return false;
}

/* The line on which parsing stopped. */
static size_t line_of_problem(const struct yaml_text *text, const yaml_parser_t *parser)
{
	if (parser->error != YAML_READER_ERROR) return parser->problem_mark.line + 1;
	size_t line = 1;
	for (size_t i = 0; i < parser->problem_offset && i < text->length; i++) line += text->bytes[i] == '\n';
	return line;
}

/* Parses the bytes; a second document is refused, because nobody would read it. */
static bool parse(struct yaml_text *text, char error[STORE_ERROR])
{
	yaml_parser_t parser;
	yaml_document_t second;
	if (!yaml_parser_initialize(&parser)) return yaml_text_refuse(text, 1, "", error, "out of memory");
	yaml_parser_set_input_string(&parser, (const unsigned char *)text->bytes, text->length);
	bool parsed = yaml_parser_load(&parser, &text->document);
	bool more = parsed && yaml_document_get_root_node(&text->document);
	bool alone = !more || yaml_parser_load(&parser, &second);
	if (!parsed || !alone) {
		char shown[TEXT_SHOWN];
		const char *problem = parser.problem ? parser.problem : "out of memory";
		yaml_text_refuse(text, line_of_problem(text, &parser), "", error, "not YAML: %s", text_shown(shown, problem));
	} else if (more) {
		yaml_node_t *root = yaml_document_get_root_node(&second);
		alone = !root;
		if (root) yaml_text_refuse(text, root->start_mark.line + 1, "", error, "a second document; accepted: one");
		yaml_document_delete(&second);
	}
	if (parsed && !alone) yaml_document_delete(&text->document);
	yaml_parser_delete(&parser);
	return parsed && alone;
}

/* Takes over name and bytes. */
static bool take(struct yaml_text *text, char *name, char *bytes, size_t length, char error[STORE_ERROR])
{
	text->name = name, text->bytes = bytes, text->length = length;
	if (name && bytes && parse(text, error)) return true;
	if (!name || !bytes) snprintf(error, STORE_ERROR, "out of memory");
	free(name);
	free(bytes);
	return false;
}

bool yaml_text_read(struct yaml_text *text, const char *path, char error[STORE_ERROR])
{
	*text = (struct yaml_text){.lined = true};
	char *bytes = malloc(LARGEST_TEXT + 1);
	FILE *stream = fopen(path, "r");
	size_t length = bytes && stream ? fread(bytes, 1, LARGEST_TEXT + 1, stream) : 0;
	int problem = errno;
	bool failed = !stream || ferror(stream);
	if (stream) fclose(stream);
	char shown[TEXT_SHOWN];
	if (failed)
		snprintf(error, STORE_ERROR, "%s: cannot be read: %s", text_shown(shown, path), strerror(problem));
	else if (length > LARGEST_TEXT)
		snprintf(error, STORE_ERROR, "%s: too large; accepted: up to %d bytes of YAML", text_shown(shown, path),
				 LARGEST_TEXT);
	else
		return take(text, strdup(path), bytes, length, error);
	free(bytes);
	return false;
}

bool yaml_text_setting(struct yaml_text *text, const char *setting, char error[STORE_ERROR])
{
	*text = (struct yaml_text){0};
	char shown[TEXT_SHOWN];
	size_t key = strspn(setting, "abcdefghijklmnopqrstuvwxyz_.");
	bool dotted = key > 0 && setting[0] != '.' && setting[key - 1] != '.' && !strstr(setting, "..");
	if (!dotted || setting[key] != '=' || strchr(setting, '\n')) {
		snprintf(error, STORE_ERROR,
				 "--set %s: accepted: KEY=VALUE on one line, such as density=0.5 or start.temperature=2",
				 text_shown(shown, setting));
		return false;
	}
	char *name = NULL, *bytes = NULL;
	size_t length = 0;
	FILE *stream = open_memstream(&bytes, &length);
	if (asprintf(&name, "--set %s", setting) < 0) name = NULL;
	for (size_t i = 0, depth = 0; stream && i < key;
		 i++) { /* a.b=c becomes a: on one line, b: c indented on the next */
		if (setting[i] != '.')
			fputc(setting[i], stream);
		else
			fprintf(stream, ":\n%*s", (int)++depth, "");
	}
	if (stream) fprintf(stream, ": %s\n", setting + key + 1);
	if (stream && fclose(stream) != 0) free(bytes), bytes = NULL;
	return take(text, name, bytes, length, error);
}

void yaml_text_close(struct yaml_text *text)
{
	yaml_document_delete(&text->document);
	free(text->name);
	free(text->bytes);
	*text = (struct yaml_text){0};
}

yaml_node_t *yaml_text_node(const struct yaml_text *text, int index)
{
	return yaml_document_get_node((yaml_document_t *)&text->document, index);
}

const char *yaml_text_word(const yaml_node_t *node)
{
	return (const char *)node->data.scalar.value;
}

size_t yaml_text_line(const yaml_node_t *node)
{
	return node->start_mark.line + 1;
}

/* The value of a key, or NULL; `line` becomes the key's. */
static yaml_node_t *member(const struct yaml_text *text, const yaml_node_t *node, const char *key, size_t length,
						   size_t *line)
{
	if (node->type != YAML_MAPPING_NODE) return NULL;
	for (yaml_node_pair_t *pair = node->data.mapping.pairs.start; pair < node->data.mapping.pairs.top; pair++) {
		yaml_node_t *name = yaml_text_node(text, pair->key);
		bool found = name->type == YAML_SCALAR_NODE && strlen(yaml_text_word(name)) == length &&
					 memcmp(yaml_text_word(name), key, length) == 0;
		if (!found) continue;
		*line = yaml_text_line(name);
		return yaml_text_node(text, pair->value);
	}
	return NULL;
}

bool yaml_text_locate(const struct yaml_text *text, const char *path, size_t *line)
{
	yaml_node_t *node = yaml_document_get_root_node((yaml_document_t *)&text->document);
	*line = 1;
	while (node && *path) {
		if (*path == '[') {
			char *end;
			size_t index = strtoul(path + 1, &end, 10);
			bool there = node->type == YAML_SEQUENCE_NODE &&
						 index < (size_t)(node->data.sequence.items.top - node->data.sequence.items.start);
			node = there ? yaml_text_node(text, node->data.sequence.items.start[index]) : NULL;
			if (node) *line = yaml_text_line(node);
			path = end + 1;
		} else {
			size_t length = strcspn(path, ".[");
			node = member(text, node, path, length, line);
			path += length;
		}
		path += *path == '.';
	}
	return node;
}
