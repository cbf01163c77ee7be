#include "store/yaml_schema.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

/* Where a check has come to. */
struct spot {
	const struct yaml_text *text;
	const yaml_node_t *node;
	size_t line;
	char path[YAML_PATH];
	char *error;
};

__attribute__((format(printf, 2, 3))) static bool refuse(const struct spot *spot, const char *format, ...)
{
	va_list arguments;
	va_start(arguments, format);
	yaml_text_blame(spot->text, spot->line, spot->path, spot->error, format, arguments);
	va_end(arguments);
	return false;
}

static bool check(const struct spot *spot, const cyaml_schema_value_t *schema);

/* libcyaml would refuse an alias too, but could not say where. It shows by pointing back, before what it belongs to. */
static bool check_alias(const struct spot *spot, const yaml_node_t *before)
{
	if (spot->node->start_mark.index > before->start_mark.index) return true;
	return refuse(spot, "an alias; accepted: the value itself");
}

static const char *kind_of(const yaml_node_t *node)
{
	return node->type == YAML_SCALAR_NODE ? "one value" : node->type == YAML_SEQUENCE_NODE ? "a list" : "a mapping";
}

static bool expect(const struct spot *spot, yaml_node_type_t type, const char *expected)
{
	if (spot->node->type == type) return true;
	return refuse(spot, "%s; accepted: %s", kind_of(spot->node), expected);
}

static bool check_word(const struct spot *spot, const cyaml_schema_value_t *schema)
{
	if (!expect(spot, YAML_SCALAR_NODE, "one value")) return false;
	char shown[TEXT_SHOWN], accepted[YAML_PATH] = "";
	const char *word = yaml_text_word(spot->node);
	if (strlen(word) != spot->node->data.scalar.length) return refuse(spot, "a character 0; accepted: text without");
	if (schema->type != CYAML_ENUM) return true;
	for (uint32_t i = 0; i < schema->enumeration.count; i++) {
		const char *choice = schema->enumeration.strings[i].str;
		if (strcmp(word, choice) == 0) return true;
		size_t length = strlen(accepted);
		snprintf(accepted + length, sizeof accepted - length, "%s%s", i ? ", " : "", choice);
	}
	return refuse(spot, "'%s' is unknown; accepted: %s", text_shown(shown, word), accepted);
}

static bool check_list(const struct spot *spot, const cyaml_schema_value_t *schema)
{
	if (!expect(spot, YAML_SEQUENCE_NODE, "a list, such as [1, 2]")) return false;
	yaml_node_item_t *items = spot->node->data.sequence.items.start;
	size_t count = (size_t)(spot->node->data.sequence.items.top - items);
	if (count < schema->sequence.min || count > schema->sequence.max)
		return refuse(spot, "%zu entries; accepted: %u to %u", count, schema->sequence.min, schema->sequence.max);
	const yaml_node_t *before = spot->node;
	for (size_t i = 0; i < count; i++) {
		struct spot entry = {.text = spot->text, .error = spot->error, .line = yaml_text_line(before)};
		snprintf(entry.path, sizeof entry.path, "%.90s[%zu]", spot->path, i);
		entry.node = yaml_text_node(spot->text, items[i]);
		if (!check_alias(&entry, before)) return false;
		entry.line = yaml_text_line(entry.node);
		if (!check(&entry, schema->sequence.entry)) return false;
		before = entry.node;
	}
	return true;
}

static bool refuse_key(const struct spot *spot, const char *key, const cyaml_schema_field_t *fields)
{
	char shown[TEXT_SHOWN], accepted[STORE_ERROR / 2] = "";
	for (const cyaml_schema_field_t *field = fields; field->key; field++) {
		size_t length = strlen(accepted);
		snprintf(accepted + length, sizeof accepted - length, "%s%s", length ? ", " : "", field->key);
	}
	return refuse(spot, "unknown key '%s'; accepted: %s", text_shown(shown, key), accepted);
}

static bool check_mapping(const struct spot *spot, const cyaml_schema_value_t *schema)
{
	if (!expect(spot, YAML_MAPPING_NODE, "a mapping, KEY: VALUE")) return false;
	yaml_node_pair_t *first = spot->node->data.mapping.pairs.start, *end = spot->node->data.mapping.pairs.top;
	for (yaml_node_pair_t *pair = first; pair < end; pair++) {
		const yaml_node_t *key = yaml_text_node(spot->text, pair->key);
		struct spot value = *spot;
		value.node = yaml_text_node(spot->text, pair->value);
		value.line = yaml_text_line(key);
		if (key->type != YAML_SCALAR_NODE) return refuse(&value, "a key that is %s; accepted: words", kind_of(key));
		const cyaml_schema_field_t *field = schema->mapping.fields;
		while (field->key && strcmp(field->key, yaml_text_word(key)) != 0) field++;
		if (!field->key) return refuse_key(&value, yaml_text_word(key), schema->mapping.fields);
		for (yaml_node_pair_t *before = first; before < pair; before++)
			if (strcmp(yaml_text_word(yaml_text_node(spot->text, before->key)), field->key) == 0)
				return refuse(&value, "key '%s' is given twice; accepted: once", field->key);
		snprintf(value.path, sizeof value.path, "%.90s%s%s", spot->path, *spot->path ? "." : "", field->key);
		if (!check_alias(&value, key) || !check(&value, &field->value)) return false;
	}
	return true;
}

static bool check(const struct spot *spot, const cyaml_schema_value_t *schema)
{
	if (schema->type == CYAML_MAPPING) return check_mapping(spot, schema);
	if (schema->type == CYAML_SEQUENCE) return check_list(spot, schema);
	if (schema->type == CYAML_IGNORE) return true; /* read from the document by whoever asks for it */
	return check_word(spot, schema);
}

static const cyaml_config_t configuration = {
	.mem_fn = cyaml_mem, .log_level = CYAML_LOG_ERROR, .flags = CYAML_CFG_NO_ALIAS};

bool yaml_schema_load(const struct yaml_text *text, const cyaml_schema_value_t *schema, cyaml_data_t **data,
					  char error[STORE_ERROR])
{
	*data = NULL;
	yaml_node_t *root = yaml_document_get_root_node((yaml_document_t *)&text->document);
	if (!root) return true;
	struct spot top = {.text = text, .node = root, .line = yaml_text_line(root), .error = error};
	if (!check(&top, schema)) return false;
	cyaml_err_t result =
		cyaml_load_data((const uint8_t *)text->bytes, text->length, &configuration, schema, data, NULL);
	return result == CYAML_OK || refuse(&top, "%s", cyaml_strerror(result));
}

/* The counter beside a list, whose width libcyaml lets a structure choose. */
static void swap_bytes(unsigned char *first, unsigned char *second, size_t size)
{
	for (size_t i = 0; i < size; i++) {
		unsigned char byte = first[i];
		first[i] = second[i];
		second[i] = byte;
	}
}

void yaml_schema_override(const cyaml_schema_value_t *schema, cyaml_data_t *data, cyaml_data_t *other)
{
	for (const cyaml_schema_field_t *field = schema->mapping.fields; field->key; field++) {
		void **ours = (void **)((unsigned char *)data + field->data_offset);
		void **theirs = (void **)((unsigned char *)other + field->data_offset);
		if (!*theirs) continue;
		if (field->value.type == CYAML_MAPPING && *ours) {
			yaml_schema_override(&field->value, *ours, *theirs);
			continue;
		}
		swap_bytes((unsigned char *)ours, (unsigned char *)theirs, sizeof *ours);
		swap_bytes((unsigned char *)data + field->count_offset, (unsigned char *)other + field->count_offset,
				   field->count_size);
	}
}

void yaml_schema_free(const cyaml_schema_value_t *schema, cyaml_data_t *data)
{
	cyaml_free(&configuration, schema, data, 0);
}
