/* A line on standard error that says how far a long computation is, redrawn in place; nothing at all when standard
 * error is no terminal.
 *
 *	struct progress progress = progress_begin("fig3, elastic", "collisions");
 *	while (...) progress_show(&progress, done, total);
 *	progress_end(&progress);
 *
 * One thread at a time may use it, on behalf of all. Only one line may be shown at a time. */
#ifndef VERIFY_PROGRESS_H
#define VERIFY_PROGRESS_H

#include <stdbool.h>

struct progress {
	const char *what, *unit; /* belong to the caller, and must last until progress_end */
	double began, drawn;     /* seconds of the steady clock */
	bool shown;              /* whether standard error is a terminal */
};

/* Starts the clock. `what` is being computed, `unit` is what is counted; with "%" only the percentage is shown. */
struct progress progress_begin(const char *what, const char *unit);

/* Redraws the line, at most five times a second, so that it may be called often. `total` may be a guess that changes
 * from call to call; 0 or infinity where it is not known. */
void progress_show(struct progress *progress, double done, double total);

/* Erases the line. */
void progress_end(struct progress *progress);

/* Seconds of a clock that never jumps. */
double progress_clock(void);

/* Writes a length of time for people, such as "3 min 20 s". Returns `text`. */
const char *progress_duration(char text[32], double seconds);

#endif
