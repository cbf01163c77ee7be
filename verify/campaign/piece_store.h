/* Where the finished pieces of a campaign are kept: a file to which one line is added for each.
 *
 *	CHECKSUM {"campaign": "fig5", "store": 1}
 *	CHECKSUM {"key": "density=0.5 seed=3", "revision": "1a2b3c", "result": {...}}
 *
 * The checksum is 16 hexadecimal digits: FNV-1a, 64 bits, of what follows the blank. A line is written in one go, so
 * a program killed at any moment leaves at most its last line cut off; that one is dropped when the file is next
 * opened. A line damaged later is left out, and its piece is made again. Both are told in a note. Only one program at a
 * time may hold a store open for writing. Strings with hex floats, and numbers as jansson writes them (17 digits), come
 * back bit for bit. */
#ifndef VERIFY_PIECE_STORE_H
#define VERIFY_PIECE_STORE_H

#include <jansson.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

struct piece_store;

/* Opens a store for writing, made if need be; or for reading what there is, and then `path` must be there and may be
 * in use. `campaign` is its name; NULL, for reading: any. NULL with one line in `error` when it is no store, or that of
 * another campaign, or of a newer version, or contradicts itself, or another program is writing to it. One whose first
 * line is not there yet, for its writer was killed, is read as a store of no pieces, and of no campaign. */
struct piece_store *piece_store_open(const char *path, const char *campaign, char error[512]);
struct piece_store *piece_store_read(const char *path, const char *campaign, char error[512]);

/* What was found wrong with it, one line each. */
size_t piece_store_note_count(const struct piece_store *store);
const char *piece_store_note(const struct piece_store *store, size_t number);

const char *piece_store_campaign(const struct piece_store *store); /* NULL: not written yet */

/* All of its lines, an object of key and line ("key", "revision", "result"); and one result, NULL when it is not there.
 * Both belong to the store. */
json_t *piece_store_lines(const struct piece_store *store);
json_t *piece_store_find(const struct piece_store *store, const char *key);

/* The revision of this program, which is told of each piece that it adds. */
const char *piece_store_revision(void);

/* Adds a finished piece; the result stays the caller's. False with a message, and the file as it was, when it cannot be
 * written. */
bool piece_store_add(struct piece_store *store, const char *key, json_t *result, char error[512]);

/* Closes it; NULL is fine. False, with a message unless `error` is NULL, when what was added may not have arrived. */
bool piece_store_close(struct piece_store *store, char *error);

/* FNV-1a of 64 bits (Fowler, Noll and Vo), as the lines have it. */
uint64_t piece_store_checksum(const char *bytes, size_t length);

/* Adds a line of another store as it is. */
bool piece_store_take(struct piece_store *store, json_t *line, char error[512]);

/* Whether two results of a piece tell the same numbers: all but their member "made" is equal. */
bool piece_store_same(const json_t *one, const json_t *other);

/* One line of a store, its checksum and its end included, which the caller frees; NULL when out of memory. */
char *piece_store_line(const json_t *line);
json_t *piece_store_head(const char *campaign); /* what the first line says; the caller owns it */

#endif
