#include "page.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "browser.h"

static struct browser browser;
static const char *program, *page;

char *page_script(const char *text)
{
	char *value = browser_script(&browser, text);
	if (value) return value;
	fail_msg("no answer to: %s", text);
	abort(); /* not reached, which compilers do not know */
}

char *page_text(const char *id)
{
	char text[200];
	snprintf(text, sizeof text, "return document.getElementById('%s').textContent", id);
	return page_script(text);
}

bool page_holds(const char *condition)
{
	char text[800];
	snprintf(text, sizeof text, "return String(Boolean(%s))", condition);
	char *value = page_script(text);
	bool yes = strcmp(value, "true") == 0;
	free(value);
	return yes;
}

/* Waits a minute at most, which a loaded machine may need. */
void page_wait_for(const char *condition)
{
	for (int wait = 0; wait < 3000; wait++) {
		if (page_holds(condition)) return;
		usleep(20000);
	}
	fail_msg("never came true: %s", condition);
}

void page_show(const char *query)
{
	char url[600], *folder = realpath(page, NULL);
	snprintf(url, sizeof url, "file://%s%s", folder, query);
	free(folder);
	assert_true(browser_go(&browser, url));
	page_wait_for("document.documentElement.dataset.run");
}

void page_without_errors(void)
{
	char *errors = browser_errors(&browser);
	if (*errors) fail_msg("on the console: %s", errors);
	free(errors);
}

void page_native_digest(const char *words, char digest[17])
{
	char line[400];
	snprintf(line, sizeof line, "%s run %s --json - | sed -n 's/^ *\"digest\": \"\\([0-9a-f]*\\)\".*/\\1/p'", program,
			 words);
	FILE *pipe = popen(line, "r");
	assert_non_null(pipe);
	assert_int_equal(fread(digest, 1, 16, pipe), 16);
	digest[16] = 0;
	pclose(pipe);
}

int page_open(int argc, char **argv)
{
	char error[200];
	if (argc != 3) {
		fprintf(stderr, "%s: accepted: PROGRAM PAGE\n", argv[0]);
		return 2;
	}
	program = argv[1], page = argv[2];
	if (browser_open(&browser, 900, 800, error)) return 0;
	fprintf(stderr, "%s: skipped: %s\n", argv[0], error);
	return 77;
}

void page_close(void)
{
	browser_close(&browser);
}
