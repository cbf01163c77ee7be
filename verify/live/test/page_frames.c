/* How many pictures a second the live page draws in a browser without a window, how long the page's script takes for
 * one, and how much time of processors the whole browser takes for it, by window, number of discs and way of drawing:
 * the best and the median of several rounds, for other work on the machine takes its share. Usage: page_frames PAGE
 * [ROUNDS]. Exit status 77 where there is no browser. */
#include <glob.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "browser.h"

enum { MOST_ROUNDS = 20, BEGIN = 2, WAIT = 4 /* seconds */, MOST_PROCESSES = 4096 };

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

struct process {
	int id, parent;
	double time; /* of processors, in milliseconds */
};

/* Reads /proc/ID/stat (proc(5)); false when the process has gone. */
static bool read_process(const char *path, struct process *process)
{
	char line[1000] = "";
	FILE *file = fopen(path, "r");
	if (!file) return false;
	bool read = fgets(line, sizeof line, file);
	fclose(file);
	unsigned long user, system;
	const char *after = strrchr(line, ')'); /* of the name, which may hold anything */
	if (!read || !after ||
		sscanf(after + 1, " %*c %d %*d %*d %*d %*d %*u %*u %*u %*u %*u %lu %lu", &process->parent, &user, &system) != 3)
		return false;
	process->id = atoi(path + strlen("/proc/"));
	process->time = 1000.0 * (double)(user + system) / (double)sysconf(_SC_CLK_TCK);
	return true;
}

/* Time that a process and all its descendants have taken. */
static double time_of(int id, const struct process *process, size_t count)
{
	double sum = 0;
	for (size_t p = 0; p < count; p++) {
		if (process[p].id == id) sum += process[p].time;
		if (process[p].parent == id) sum += time_of(process[p].id, process, count);
	}
	return sum;
}

static double browser_time(const struct browser *browser)
{
	static struct process process[MOST_PROCESSES];
	size_t count = 0;
	glob_t found;
	if (glob("/proc/[0-9]*/stat", GLOB_NOSORT, NULL, &found) != 0) return 0;
	for (size_t p = 0; p < found.gl_pathc && count < MOST_PROCESSES; p++)
		count += read_process(found.gl_pathv[p], &process[count]);
	globfree(&found);
	return time_of(browser->driver, process, count);
}

/* A number that the page tells of itself. */
static double told(const struct browser *browser, const char *script)
{
	char *text = browser_script(browser, script);
	double value = text ? atof(text) : 0;
	free(text);
	return value;
}

/* The numbers of all rounds, one row of the table. */
static void measure(const struct browser *browser, const char *page, int rounds, const char *query, const char *way)
{
	double rate[MOST_ROUNDS] = {0}, script[MOST_ROUNDS] = {0}, work[MOST_ROUNDS] = {0};
	char url[600];
	snprintf(url, sizeof url, "file://%s?aspect-ratio=1.6&%s&draw=%s", page, query, way);
	for (int r = 0; r < rounds; r++) {
		if (!browser_go(browser, url)) continue;
		sleep(BEGIN);
		double drawn = told(browser, "return String(pace.drawn())"), taken = browser_time(browser);
		sleep(WAIT);
		taken = browser_time(browser) - taken;
		drawn = told(browser, "return String(pace.drawn())") - drawn;
		rate[r] = drawn / WAIT, work[r] = drawn > 0 ? taken / drawn : 0;
		script[r] = told(browser, "return document.documentElement.dataset.script");
	}
	qsort(rate, (size_t)rounds, sizeof *rate, higher_first);
	qsort(script, (size_t)rounds, sizeof *script, higher_first);
	qsort(work, (size_t)rounds, sizeof *work, higher_first);
	printf(" %8.1f %8.1f %8.2f %8.2f %8.1f %8.1f", rate[0], rate[rounds / 2], script[rounds - 1], script[rounds / 2],
		   work[rounds - 1], work[rounds / 2]);
}

static void table(const struct browser *browser, const char *page, int rounds)
{
	double load[1] = {0};
	getloadavg(load, 1);
	char *size = browser_script(browser, "return `${innerWidth} x ${innerHeight}, density ${devicePixelRatio}`");
	printf("\nwindow %s, load %.1f\n%-21s %17s %17s %17s\n%-14s %-6s", size ? size : "?", load[0], "",
		   "pictures a second", "ms of script", "ms of processors", "", "drawn");
	for (int k = 0; k < 3; k++) printf(" %8s %8s", "best", "median");
	putchar('\n');
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
