/* A browser without a window, driven by chromedriver (WebDriver, https://www.w3.org/TR/webdriver2/). */
#ifndef VERIFY_BROWSER_H
#define VERIFY_BROWSER_H

#include <stdbool.h>
#include <sys/types.h>

struct browser {
	pid_t driver;
	char address[128]; /* of the session */
};

/* Starts one with a window of that size. False, with one line in `error`, when there is none to be had. */
bool browser_open(struct browser *browser, int width, int height, char error[200]);
void browser_close(struct browser *browser);

/* Goes to a page, which has then been loaded. */
bool browser_go(const struct browser *browser, const char *url);

/* What a script returns, as text; NULL when it fails. The caller frees it. */
char *browser_script(const struct browser *browser, const char *script);

/* The errors on the console since the last call, or ""; the caller frees it. */
char *browser_errors(const struct browser *browser);

#endif
