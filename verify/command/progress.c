#include "command/progress.h"

#include <math.h>
#include <stdio.h>
#include <string.h>
#include <sys/ioctl.h>
#include <time.h>
#include <unistd.h>

static const double between_drawings = 0.2; /* seconds */

double progress_clock(void)
{
	struct timespec now;
	clock_gettime(CLOCK_MONOTONIC, &now);
	return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

const char *progress_duration(char text[32], double seconds)
{
	if (!(seconds < 1e9)) /* or not a number */
		snprintf(text, 32, "unknown");
	else if (seconds < 59.5)
		snprintf(text, 32, "%.0f s", seconds);
	else if (seconds < 3570)
		snprintf(text, 32, "%.0f min %02.0f s", floor(rint(seconds) / 60), fmod(rint(seconds), 60));
	else
		snprintf(text, 32, "%.0f h %02.0f min", floor(rint(seconds / 60) / 60), fmod(rint(seconds / 60), 60));
	return text;
}

struct progress progress_begin(const char *what, const char *unit)
{
	double now = progress_clock();
	return (struct progress){.what = what, .unit = unit, .began = now, .drawn = now, .shown = isatty(STDERR_FILENO)};
}

void progress_show(struct progress *progress, double done, double total)
{
	if (!progress->shown) return;
	double now = progress_clock(), elapsed = now - progress->began;
	if (now - progress->drawn < between_drawings) return;
	progress->drawn = now;

	char line[200], text[32];
	double rate = done / elapsed;
	const char *left = progress_duration(text, done > 0 ? fmax(0, total - done) / rate : NAN);
	if (!(total > 0 && total < INFINITY))
		snprintf(line, sizeof line, "%s: %.4g %s, %.3g per second, %s so far", progress->what, done, progress->unit,
				 rate, progress_duration(text, elapsed));
	else if (strcmp(progress->unit, "%") == 0)
		snprintf(line, sizeof line, "%s: %.1f %%, %s left", progress->what, 100 * done / total, left);
	else
		snprintf(line, sizeof line, "%s: %.4g / %.4g %s, %.1f %%, %.3g per second, %s left", progress->what, done,
				 total, progress->unit, 100 * done / total, rate, left);
	/* A line that wraps could not be drawn over. */
	struct winsize window;
	bool known = ioctl(STDERR_FILENO, TIOCGWINSZ, &window) == 0 && window.ws_col > 1;
	fprintf(stderr, "\r%.*s\033[K", known ? window.ws_col - 1 : 79, line);
	fflush(stderr);
}

void progress_end(struct progress *progress)
{
	if (!progress->shown) return;
	fprintf(stderr, "\r\033[K");
	fflush(stderr);
	progress->shown = false;
}
