#include "campaign/piece_store.h"

#include <errno.h>
#include <fcntl.h>
#include <inttypes.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

enum { VERSION = 1, CHECKSUM = 16 };

struct piece_store {
	char *path;
	int file;      /* -1: for reading */
	off_t length;  /* of the file: all whole lines */
	time_t synced; /* when what was added was last sent to the disk */
	json_t *head, *lines, *notes;
};

__attribute__((format(printf, 3, 4))) static bool refuse(const struct piece_store *store, char *error,
														 const char *format, ...)
{
	va_list arguments;
	va_start(arguments, format);
	int length = snprintf(error, 512, "%.200s: ", store->path);
	vsnprintf(error + length, 512 - (size_t)length, format, arguments);
	va_end(arguments);
	return false;
}

__attribute__((format(printf, 2, 3))) static void note(struct piece_store *store, const char *format, ...)
{
	char text[512];
	va_list arguments;
	va_start(arguments, format);
	int length = snprintf(text, sizeof text, "%.200s: ", store->path);
	vsnprintf(text + length, sizeof text - (size_t)length, format, arguments);
	va_end(arguments);
	json_array_append_new(store->notes, json_string(text));
}

uint64_t piece_store_checksum(const char *bytes, size_t length)
{
	uint64_t sum = UINT64_C(0xcbf29ce484222325);
	for (size_t b = 0; b < length; b++) sum = (sum ^ (unsigned char)bytes[b]) * UINT64_C(0x100000001b3);
	return sum;
}

char *piece_store_line(const json_t *line)
{
	char *text = json_dumps(line, JSON_COMPACT), *whole = NULL;
	if (text && asprintf(&whole, "%016" PRIx64 " %s\n", piece_store_checksum(text, strlen(text)), text) < 0)
		whole = NULL;
	free(text);
	return whole;
}

json_t *piece_store_head(const char *campaign)
{
	return json_pack("{s:s, s:i}", "campaign", campaign, "store", VERSION);
}

bool piece_store_same(const json_t *one, const json_t *other)
{
	json_t *bare[2] = {json_copy((json_t *)one), json_copy((json_t *)other)};
	for (int b = 0; b < 2; b++) json_object_del(bare[b], "made");
	bool same = json_equal(bare[0], bare[1]);
	for (int b = 0; b < 2; b++) json_decref(bare[b]);
	return same;
}

/* What a line says, without its end; NULL when it is damaged. */
static json_t *understand(const char *text, size_t length)
{
	char sum[CHECKSUM + 1];
	if (length <= CHECKSUM + 1 || text[CHECKSUM] != ' ') return NULL;
	text += CHECKSUM + 1, length -= CHECKSUM + 1;
	snprintf(sum, sizeof sum, "%016" PRIx64, piece_store_checksum(text, length));
	if (memcmp(sum, text - CHECKSUM - 1, CHECKSUM) != 0) return NULL;
	return json_loadb(text, length, 0, NULL);
}

/* Takes one line in. False with a message when it contradicts another. */
static bool enter(struct piece_store *store, json_t *line, size_t number, char *error)
{
	const char *key = json_string_value(json_object_get(line, "key"));
	json_t *result = json_object_get(line, "result"), *before = key ? json_object_get(store->lines, key) : NULL;
	if (!key || !json_is_object(result)) {
		note(store, "line %zu is no finished piece and is left out", number);
		return true;
	}
	bool changed = before && !json_equal(json_object_get(before, "revision"), json_object_get(line, "revision"));
	if (before && !changed && !piece_store_same(json_object_get(before, "result"), result))
		return refuse(store, error, "line %zu contradicts what was told of the same piece before: '%.200s'", number,
					  key);
	json_object_set(store->lines, key, line); /* a later revision has the last word */
	return true;
}

/* Whether the first line is that of a store of this campaign. */
static bool check_head(struct piece_store *store, const char *campaign, char *error)
{
	const char *name = json_string_value(json_object_get(store->head, "campaign"));
	json_int_t version = json_integer_value(json_object_get(store->head, "store"));
	if (!name || version < 1) return refuse(store, error, "line 1 is not that of a store of pieces");
	if (version > VERSION)
		return refuse(store, error, "of version %lld, by a newer program; accepted: up to %d", (long long)version,
					  VERSION);
	return !campaign || strcmp(name, campaign) == 0 ||
		   refuse(store, error, "the store of campaign '%.80s'; accepted: of '%.80s'", name, campaign);
}

static bool enter_all(struct piece_store *store, const char *campaign, const char *text, size_t length, char *error)
{
	const char *end;
	size_t number = 0, at = 0;
	for (; (end = memchr(text + at, '\n', length - at)); at = (size_t)(end - text) + 1) {
		json_t *line = understand(text + at, (size_t)(end - text) - at);
		bool good = true;
		if (++number == 1)
			store->head = json_incref(line), good = check_head(store, campaign, error);
		else if (line)
			good = enter(store, line, number, error);
		else
			note(store, "line %zu is damaged (its checksum does not fit) and is left out", number);
		json_decref(line);
		if (!good) return false;
	}
	store->length = (off_t)at;
	if (at == length) return true;
	if (number == 0 && length > 200) return refuse(store, error, "line 1 is not that of a store of pieces");
	note(store, "the last line was cut off while it was written, and is left out");
	return true;
}

static bool read_all(struct piece_store *store, const char *campaign, int file, char *error)
{
	struct stat there;
	if (fstat(file, &there) != 0 || !S_ISREG(there.st_mode))
		return refuse(store, error, "not a file; accepted: a store of pieces");
	size_t length = 0, size = (size_t)there.st_size;
	char *text = malloc(size + 1);
	if (!text) return refuse(store, error, "no memory for %zu bytes", size);
	for (ssize_t more = 1; length < size && more > 0; length += more > 0 ? (size_t)more : 0)
		more = pread(file, text + length, size - length, (off_t)length);
	bool good = length == size ? enter_all(store, campaign, text, length, error)
							   : refuse(store, error, "cannot be read: %s", strerror(errno));
	free(text);
	return good;
}

/* Writes a line at the end, all of it or nothing. */
static bool append(struct piece_store *store, const json_t *line, char *error)
{
	char *text = piece_store_line(line);
	if (!text) return refuse(store, error, "out of memory");
	size_t length = strlen(text), written = 0;
	for (ssize_t more = 1; written < length && more > 0; written += more > 0 ? (size_t)more : 0) do
			more = pwrite(store->file, text + written, length - written, store->length + (off_t)written);
		while (more < 0 && errno == EINTR);
	free(text);
	if (written == length) {
		store->length += (off_t)length;
		return true;
	}
	refuse(store, error, "cannot be written: %s", strerror(errno));
	if (ftruncate(store->file, store->length) != 0) return false; /* the next opening drops what is cut off */
	return false;
}

static struct piece_store *begin(const char *path)
{
	struct piece_store *store = calloc(1, sizeof *store);
	if (!store) return NULL;
	*store = (struct piece_store){.path = strdup(path), .file = -1, .lines = json_object(), .notes = json_array()};
	if (store->path && store->lines && store->notes) return store;
	piece_store_close(store, NULL);
	return NULL;
}

struct piece_store *piece_store_read(const char *path, const char *campaign, char error[512])
{
	struct piece_store *store = begin(path);
	int file = open(path, O_RDONLY | O_CLOEXEC);
	bool good = store && file >= 0 && read_all(store, campaign, file, error);
	if (!store)
		snprintf(error, 512, "out of memory");
	else if (file < 0)
		refuse(store, error, "cannot be read: %s", strerror(errno));
	else if (good && !store->head && store->length == 0 && json_array_size(store->notes) == 0)
		note(store, "empty: who began it was stopped before the first line");
	if (file >= 0) close(file);
	if (good) return store;
	piece_store_close(store, NULL);
	return NULL;
}

static bool open_to_write(struct piece_store *store, const char *campaign, char *error)
{
	store->file = open(store->path, O_RDWR | O_CREAT | O_CLOEXEC, 0666);
	if (store->file < 0) return refuse(store, error, "cannot be written: %s", strerror(errno));
	if (flock(store->file, LOCK_EX | LOCK_NB) != 0)
		return refuse(store, error, "%s",
					  errno == EWOULDBLOCK ? "another program is at this campaign" : strerror(errno));
	if (!read_all(store, campaign, store->file, error)) return false;
	if (ftruncate(store->file, store->length) != 0)
		return refuse(store, error, "cannot be written: %s", strerror(errno));
	if (store->head) return true;
	store->head = piece_store_head(campaign);
	return append(store, store->head, error);
}

struct piece_store *piece_store_open(const char *path, const char *campaign, char error[512])
{
	struct piece_store *store = begin(path);
	if (!store) snprintf(error, 512, "out of memory");
	if (!store || open_to_write(store, campaign, error)) return store;
	piece_store_close(store, NULL);
	return NULL;
}

size_t piece_store_note_count(const struct piece_store *store)
{
	return json_array_size(store->notes);
}

const char *piece_store_note(const struct piece_store *store, size_t number)
{
	return json_string_value(json_array_get(store->notes, number));
}

const char *piece_store_campaign(const struct piece_store *store)
{
	return json_string_value(json_object_get(store->head, "campaign"));
}

json_t *piece_store_lines(const struct piece_store *store)
{
	return store->lines;
}

json_t *piece_store_find(const struct piece_store *store, const char *key)
{
	return json_object_get(json_object_get(store->lines, key), "result");
}

const char *piece_store_revision(void)
{
	return TOUCHSTONE_REVISION;
}

bool piece_store_take(struct piece_store *store, json_t *line, char error[512])
{
	if (!append(store, line, error)) return false;
	json_object_set(store->lines, json_string_value(json_object_get(line, "key")), line);
	time_t now = time(NULL);
	if (now != store->synced) fdatasync(store->file);
	store->synced = now;
	return true;
}

bool piece_store_add(struct piece_store *store, const char *key, json_t *result, char error[512])
{
	json_t *line = json_pack("{s:s, s:s, s:O}", "key", key, "revision", piece_store_revision(), "result", result);
	if (!line) return refuse(store, error, "out of memory, or not UTF-8: '%.200s'", key);
	bool good = piece_store_take(store, line, error);
	json_decref(line);
	return good;
}

bool piece_store_close(struct piece_store *store, char *error)
{
	if (!store) return true;
	bool good = store->file < 0 || fdatasync(store->file) == 0;
	if (store->file >= 0) good = close(store->file) == 0 && good;
	if (!good && error) refuse(store, error, "cannot be written: %s", strerror(errno));
	json_decref(store->head);
	json_decref(store->lines);
	json_decref(store->notes);
	free(store->path);
	free(store);
	return good;
}
