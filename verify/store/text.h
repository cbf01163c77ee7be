/* What people write, taken strictly: numbers as doubles exactly, and other people's words made fit for one line. */
#ifndef TOUCHSTONE_TEXT_H
#define TOUCHSTONE_TEXT_H

#include <stdbool.h>
#include <stdint.h>

enum {
	STORE_ERROR = 512, /* room for a one-line message, its end included */
	TEXT_SHOWN = 64,   /* room for a shown word */
};

/* A finite number, decimal ("1e3") or hexadecimal ("0x1p-3"), and nothing around it. */
bool text_number(const char *text, double *value);

/* A whole number that is not negative, to 2^64 - 1 in decimal or hexadecimal digits; also as "1e6". */
bool text_count(const char *text, uint64_t *value);

/* The text, shortened where it is long, with what does not print replaced. Returns `shown`. */
const char *text_shown(char shown[TEXT_SHOWN], const char *text);

/* The name of a file without folder and ending, to be freed; NULL when out of memory. */
char *text_stem(const char *path);

/* Replaces what does not print, so that a message stays on one line. */
void text_one_line(char *message);

#endif
