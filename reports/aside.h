/* Files that appear whole or not at all: written beside their place under another name, then renamed. */
#ifndef REPORTS_ASIDE_H
#define REPORTS_ASIDE_H

#include <stdbool.h>
#include <stdio.h>

enum { REPORT_ERROR = 512 }; /* room for a one-line message, its end included */

struct aside {
	FILE *stream; /* write here */
	char *path, *temporary;
};

/* Opens a file that is to appear at the path given by format. False with a message when it cannot be written;
 * otherwise end with aside_keep or aside_drop. */
__attribute__((format(printf, 3, 4))) bool aside_open(struct aside *file, char error[REPORT_ERROR], const char *format,
													  ...);

/* Closes the file and puts it in its place. False with a message, and nothing left behind, when something of it
 * could not be written. */
bool aside_keep(struct aside *file, char error[REPORT_ERROR]);

/* The same, and it is there even if the machine fails now: file and folder have reached the disk. */
bool aside_keep_for_good(struct aside *file, char error[REPORT_ERROR]);

/* Closes the file and removes it; whatever was at the path before stays. */
void aside_drop(struct aside *file);

/* Makes a folder, with those above it, unless it is there already. */
bool aside_folder(const char *path, char error[REPORT_ERROR]);

#endif
