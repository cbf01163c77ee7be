/* How many pictures a second the live page draws in a browser without a window, and how long the page's script takes
 * for one, by window, number of discs and way of drawing: the best and the median of several rounds, for other work on
 * the machine takes its share. Usage: page_frames PAGE [ROUNDS]. Exit status 77 where there is no browser. */
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

#include "browser.h"

enum { MOST_ROUNDS = 20, WAIT = 4 /* seconds: 120 pictures are what the page tells of */ };

static const struct {
	const char *name, *query;
} sizes[] = {
	{"default size", "length=256"},
	{"10 000 discs", "length=256&nitems=10000"},
	{"100 000 discs", "length=980&nitems=100000"},
};
static const char *const ways[] = {"2d", "webgl"};

static int higher_first(const void *one, const void *other)
{
	double a = *(const double *)one, b = *(const double *)other;
	return (a < b) - (a > b);
}

/* One of the numbers that the page tells of itself. */
static double told(const struct browser *browser, const char *name)
{
	char script[100];
	snprintf(script, sizeof script, "return document.documentElement.dataset.%s || '0'", name);
	char *text = browser_script(browser, script);
	double value = text ? atof(text) : 0;
	free(text);
	return value;
}

/* The numbers of all rounds, one row of the table. */
static void measure(const struct browser *browser, const char *page, int rounds, const char *query, const char *way)
{
	double rate[MOST_ROUNDS], script[MOST_ROUNDS];
	char url[600];
	snprintf(url, sizeof url, "file://%s?aspect-ratio=1.6&%s&draw=%s", page, query, way);
	for (int r = 0; r < rounds; r++) {
		if (!browser_go(browser, url)) continue;
		sleep(WAIT);
		rate[r] = told(browser, "rate"), script[r] = told(browser, "script");
	}
	qsort(rate, (size_t)rounds, sizeof *rate, higher_first);
	qsort(script, (size_t)rounds, sizeof *script, higher_first);
	printf(" %8.1f %8.1f %8.2f %8.2f", rate[0], rate[rounds / 2], script[rounds - 1], script[rounds / 2]);
}

static void table(const struct browser *browser, const char *page, int rounds)
{
	double load[1] = {0};
	getloadavg(load, 1);
	char *size = browser_script(browser, "return `${innerWidth} x ${innerHeight}, density ${devicePixelRatio}`");
	printf("\nwindow %s, load %.1f\n%-14s %-6s %8s %8s %8s %8s\n%-14s %-6s %17s %17s\n", size ? size : "?", load[0], "",
		   "", "best", "median", "best", "median", "", "drawn", "pictures a second", "ms of script");
	free(size);
	for (size_t s = 0; s < sizeof sizes / sizeof *sizes; s++)
		for (size_t w = 0; w < sizeof ways / sizeof *ways; w++) {
			printf("%-14s %-6s", sizes[s].name, ways[w]);
			measure(browser, page, rounds, sizes[s].query, ways[w]);
			putchar('\n');
			fflush(stdout);
		}
}

int main(int argc, char **argv)
{
	static const int windows[][2] = {{1366, 768}, {1920, 1080}};
	int rounds = argc > 2 ? atoi(argv[2]) : 3;
	char *page = argc > 1 ? realpath(argv[1], NULL) : NULL, error[200];
	if (!page || argc > 3 || rounds < 1 || rounds > MOST_ROUNDS) {
		fprintf(stderr, "page_frames: accepted: PAGE [ROUNDS], 1 to %d rounds\n", MOST_ROUNDS);
		free(page);
		return 2;
	}
	for (size_t w = 0; w < sizeof windows / sizeof *windows; w++) {
		struct browser browser;
		if (!browser_open(&browser, windows[w][0], windows[w][1], error)) {
			fprintf(stderr, "page_frames: skipped: %s\n", error);
			free(page);
			return 77;
		}
		table(&browser, page, rounds);
		browser_close(&browser);
	}
	free(page);
	return 0;
}
