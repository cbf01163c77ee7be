#include "template.h"

#include <stdbool.h>
#include <string.h>

struct scope {
	const json_t *value;
	const struct scope *outer;
};

struct writer {
	FILE *stream;
	const struct template *templates;
};

struct tag {
	const char *begin, *end; /* from the first brace to behind the last, and the line's end behind a tag of structure */
	char kind;               /* '#', '^', '/', '>' or 0 */
	const char *name;
	size_t length;
};

static bool next_tag(const char *text, const char *end, struct tag *tag)
{
	tag->begin = memmem(text, (size_t)(end - text), "{{", 2);
	if (!tag->begin) return false;
	const char *name = tag->begin + 2;
	const char *close = memmem(name, (size_t)(end - name), "}}", 2);
	if (!close) return false;
	tag->kind = strchr("#^/>", *name) ? *name++ : '\0';
	tag->name = name;
	tag->length = (size_t)(close - name);
	tag->end = close + 2;
	if (tag->kind && tag->end < end && *tag->end == '\n') tag->end++;
	return true;
}

/* The tag that closes the section `open`, which may hold sections of the same name. */
static struct tag closing(const struct tag *open, const char *end)
{
	struct tag tag = *open;
	for (int depth = 1; depth > 0;) {
		if (!next_tag(tag.end, end, &tag)) return (struct tag){.begin = end, .end = end};
		if (tag.length != open->length || memcmp(tag.name, open->name, tag.length) != 0) continue;
		depth += tag.kind == '/' ? -1 : tag.kind == '#' || tag.kind == '^';
	}
	return tag;
}

static const json_t *look_up(const struct scope *scope, const struct tag *tag)
{
	if (tag->length == 1 && *tag->name == '.') return scope->value;
	const json_t *value = NULL;
	for (; scope && !value; scope = scope->outer) value = json_object_getn(scope->value, tag->name, tag->length);
	return value;
}

static bool holds(const json_t *value)
{
	if (json_is_array(value)) return json_array_size(value) > 0;
	if (json_is_string(value)) return json_string_length(value) > 0;
	return value && !json_is_false(value) && !json_is_null(value);
}

static void escape(FILE *stream, const char *text)
{
	for (; *text; text++) switch (*text) {
		case '&':
			fputs("&amp;", stream);
			break;
		case '<':
			fputs("&lt;", stream);
			break;
		case '>':
			fputs("&gt;", stream);
			break;
		case '"':
			fputs("&quot;", stream);
			break;
		case '\'':
			fputs("&#39;", stream);
			break;
		default:
			/* Control characters have no place in HTML, not even as references. */
			fputc((unsigned char)*text < ' ' && !strchr("\t\n", *text) ? ' ' : *text, stream);
		}
}

static void write_value(FILE *stream, const json_t *value)
{
	if (json_is_string(value)) escape(stream, json_string_value(value));
	if (json_is_integer(value)) fprintf(stream, "%" JSON_INTEGER_FORMAT, json_integer_value(value));
	if (json_is_real(value)) fprintf(stream, "%g", json_real_value(value));
}

static void write_text(const struct writer *writer, const char *text, const char *end, const struct scope *scope);

static void write_section(const struct writer *writer, const struct tag *tag, const char *end,
						  const struct scope *scope)
{
	const json_t *value = look_up(scope, tag);
	if (holds(value) != (tag->kind == '#')) return;
	if (!json_is_array(value)) {
		struct scope inner = {json_is_object(value) ? value : scope->value, scope};
		write_text(writer, tag->end, end, &inner);
	} else if (tag->kind == '^')
		write_text(writer, tag->end, end, scope);
	for (size_t i = 0; i < json_array_size(value); i++) {
		struct scope inner = {json_array_get(value, i), scope};
		write_text(writer, tag->end, end, &inner);
	}
}

static void write_text(const struct writer *writer, const char *text, const char *end, const struct scope *scope)
{
	for (struct tag tag; text < end; text = tag.end) {
		if (!next_tag(text, end, &tag)) tag = (struct tag){.begin = end, .end = end, .kind = '/'};
		fwrite(text, 1, (size_t)(tag.begin - text), writer->stream);
		if (tag.kind == '#' || tag.kind == '^') {
			struct tag close = closing(&tag, end);
			write_section(writer, &tag, close.begin, scope);
			tag.end = close.end;
		}
		for (const struct template *part = writer->templates; tag.kind == '>' && part->name; part++)
			if (strlen(part->name) == tag.length && memcmp(part->name, tag.name, tag.length) == 0)
				write_text(writer, part->text, part->text + strlen(part->text), scope);
		if (!tag.kind) write_value(writer->stream, look_up(scope, &tag));
	}
}

void template_write(FILE *stream, const struct template *templates, const char *name, const json_t *context)
{
	struct writer writer = {stream, templates};
	struct scope scope = {context, NULL};
	while (templates->name && strcmp(templates->name, name) != 0) templates++;
	if (templates->name) write_text(&writer, templates->text, templates->text + strlen(templates->text), &scope);
}
