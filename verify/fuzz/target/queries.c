/* The reader of questions to finders; what it has read and writes again, it reads as the same. */
#include "fuzz/target/target.h"

#include <string.h>

#include "store/query_file.h"

static void read_again(const struct query *query)
{
	char *text = NULL, error[400];
	size_t length;
	struct query again;
	FILE *stream = open_memstream(&text, &length);
	if (!stream) abort();
	query_write(stream, query);
	fclose(stream);
	if (!query_parse(text, &again, error) || again.shape != query->shape) abort();
	for (int n = 0; n < TOUCHSTONE_MOST_NUMBERS; n++) {
		bool same = again.number[n] == query->number[n];
		if (!same && (again.number[n] == again.number[n] || query->number[n] == query->number[n])) abort();
	}
	free(text);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
	char path[40], error[400];
	struct query_file queries;
	int file = target_file(data, size, path);
	if (query_file_read(path, &queries, error)) {
		for (size_t q = 0; q < queries.count; q++) read_again(&queries.query[q]);
		query_file_free(&queries);
	}
	close(file);
	return 0;
}
