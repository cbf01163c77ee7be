/* The reader of histories, and what is said of the nights in them. SQLite wants a file with a name. */
#include "fuzz/target/target.h"

#include "store/history.h"

static void see(void *context, const struct history_row *row)
{
	*(const char **)context = row->date;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
	static const char *const suffix[] = {"", "-wal", "-shm"}; /* one that is only read leaves them */
	char path[] = "/tmp/touchstone-history-XXXXXX", error[STORE_ERROR];
	int file = mkstemp(path);
	if (file < 0 || write(file, data, size) != (ssize_t)size) abort();
	close(file);
	struct history *history = history_open(path, false, error);
	struct night *nights = NULL;
	size_t count;
	const char *date = NULL;
	const struct history_key key = {"check", "as it is", "below 7", "a machine"};
	if (history) history_read(history, see, &date, error);
	if (history && history_nights(history, &key, &nights, &count, error) && count > 0)
		verdict_of(nights, count, WORSE_EITHER);
	free(nights);
	history_close(history);
	for (size_t s = 0; s < sizeof suffix / sizeof *suffix; s++) {
		char beside[sizeof path + 8];
		snprintf(beside, sizeof beside, "%s%s", path, suffix[s]);
		unlink(beside);
	}
	return 0;
}
