/* Questions to finders as text: one a line, `#` begins a comment, numbers decimal or hexadecimal.
 *
 *     ball-ball rx ry rz vx vy vz contact      ball-plane distance speed acceleration contact
 *     ball-leave rx ry rz vx vy vz contact     half-space distance speed
 */
#ifndef VERIFY_QUERY_FILE_H
#define VERIFY_QUERY_FILE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>

#include "touchstone.h"

struct query {
	enum touchstone_shape shape;
	double number[TOUCHSTONE_MOST_NUMBERS]; /* infinity and NaN may be asked about: finders must say something */
	long line;                              /* where it stands in its file */
	const char *comment;                    /* what follows `#` on its line, trimmed; NULL when there is none */
};

struct query_file {
	struct query *query;
	size_t count;
	char *text; /* what the comments point into */
};

/* The words for shapes, and how many numbers each takes. */
const char *shape_name(enum touchstone_shape shape);
size_t shape_numbers(enum touchstone_shape shape);
bool shape_named(const char *name, enum touchstone_shape *shape);

/* Reads a file ("-": standard input), or one query given as a line of text. False with "file:line: what is wrong, what
 * is accepted" in `error`. The caller frees the file with query_file_free(). */
bool query_file_read(const char *path, struct query_file *file, char error[400]);
bool query_parse(const char *text, struct query *query, char error[400]);
void query_file_free(struct query_file *file);

/* Writes a query as one line without a newline: hex floats by "%a". */
void query_write(FILE *stream, const struct query *query);

/* The same as a text, to be freed. NULL when out of memory. */
char *query_text(enum touchstone_shape shape, const double number[TOUCHSTONE_MOST_NUMBERS]);

#endif
