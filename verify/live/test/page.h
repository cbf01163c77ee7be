/* The live page under test: in a browser, beside the program whose numbers it is to compute. Every function fails the
 * test that calls it when the page does not answer. */
#ifndef VERIFY_PAGE_H
#define VERIFY_PAGE_H

#include <stdbool.h>

/* Opens a browser for PROGRAM PAGE, both from the folder worked in. 0, or the exit status to end with: 2 for other
 * arguments, 77 where there is no browser; one line says why. */
int page_open(int argc, char **argv);
void page_close(void);

/* Loads the page at an address's parameters ("?...") and waits until it has begun. */
void page_show(const char *query);

/* What a script returns; the caller frees it. */
char *page_script(const char *text);

/* Text of an element; the caller frees it. */
char *page_text(const char *id);

bool page_holds(const char *condition);
void page_wait_for(const char *condition);
void page_without_errors(void); /* on the console since the last call */

/* The digest that the program prints of `run` and these words. */
void page_native_digest(const char *words, char digest[17]);

#endif
