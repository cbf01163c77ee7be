/* The reader of stores of pieces. A store that can be read can also be opened for writing, and is then, lines that were
 * damaged apart, read as the same. */
#include "fuzz/target/target.h"

#include "campaign/piece_store.h"

static void open_again(const char *path, const struct piece_store *before)
{
	char error[512];
	json_t *result = json_pack("{s:f}", "third", 1.0 / 3);
	const char *campaign = piece_store_campaign(before);
	struct piece_store *store = piece_store_open(path, campaign ? campaign : "begun here", error);
	if (!store || !json_equal(piece_store_lines(store), piece_store_lines(before))) abort();
	if (!piece_store_add(store, "a new piece", result, error) || !piece_store_close(store, error)) abort();
	store = piece_store_read(path, NULL, error);
	if (!store || !json_equal(piece_store_find(store, "a new piece"), result)) abort();
	piece_store_close(store, NULL);
	json_decref(result);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
	char path[40], error[512];
	int file = target_file(data, size, path);
	struct piece_store *store = piece_store_read(path, NULL, error);
	if (store && !piece_store_find(store, "a new piece")) open_again(path, store);
	piece_store_close(store, NULL);
	close(file);
	return 0;
}
