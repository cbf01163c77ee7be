#include "campaign/yaml_flow.h"

#include <ctype.h>
#include <stdlib.h>
#include <string.h>

enum { DEEPEST = 8 };

/* Whether a word means the same without quotes, on one line. */
static bool is_plain(const char *word)
{
	static const char safe[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789_.:/+-";
	size_t length = strlen(word);
	return isalnum((unsigned char)word[0]) && !word[strspn(word, safe)] && word[length - 1] != ':';
}

/* Plain words stay as they are, for they mean the same on one line; others are quoted where they need it. */
static bool write_word(FILE *stream, const yaml_node_t *node)
{
	const char *word = yaml_text_word(node);
	if (node->data.scalar.style == YAML_PLAIN_SCALAR_STYLE || is_plain(word)) {
		fputs(word, stream);
		return true;
	}
	putc('\'', stream);
	for (; *word; word++) {
		if (*word == '\n') return false; /* a folded line would come back as a blank */
		if (*word == '\'') putc('\'', stream);
		putc(*word, stream);
	}
	putc('\'', stream);
	return true;
}

static bool write_node(FILE *stream, const struct yaml_text *text, const yaml_node_t *node, int depth)
{
	bool good = depth < DEEPEST;
	if (!good || node->type == YAML_SCALAR_NODE) return good && write_word(stream, node);
	bool list = node->type == YAML_SEQUENCE_NODE;
	putc(list ? '[' : '{', stream);
	if (list)
		for (yaml_node_item_t *item = node->data.sequence.items.start; good && item < node->data.sequence.items.top;) {
			good = write_node(stream, text, yaml_text_node(text, *item), depth + 1);
			if (++item < node->data.sequence.items.top) fputs(", ", stream);
		}
	else
		for (yaml_node_pair_t *pair = node->data.mapping.pairs.start; good && pair < node->data.mapping.pairs.top;) {
			good = write_node(stream, text, yaml_text_node(text, pair->key), depth + 1);
			fputs(": ", stream);
			good = good && write_node(stream, text, yaml_text_node(text, pair->value), depth + 1);
			if (++pair < node->data.mapping.pairs.top) fputs(", ", stream);
		}
	putc(list ? ']' : '}', stream);
	return good;
}

char *yaml_flow(const struct yaml_text *text, const yaml_node_t *node)
{
	char *flow = NULL;
	size_t size;
	FILE *stream = open_memstream(&flow, &size);
	if (!stream) return NULL;
	bool good = write_node(stream, text, node, 0);
	if (fclose(stream) == 0 && good) return flow;
	free(flow);
	return NULL;
}
