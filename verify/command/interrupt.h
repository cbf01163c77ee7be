/* Ctrl-C keeps what is done: the first SIGINT or SIGTERM asks for an end, a second one ends the program at once. */
#ifndef VERIFY_INTERRUPT_H
#define VERIFY_INTERRUPT_H

#include <stdbool.h>

/* From here on signals are counted instead of ending the program. Commands that can stop halfway call it first. */
void interrupt_watch(void);

/* Asks for an end also when so many seconds have gone by, and does so once. */
void interrupt_after(double seconds);

/* Whether it was time, and no signal from outside, that asked for an end. */
bool interrupted_by_time(void);

/* Whether an end has been asked for. May be called by any thread. */
bool interrupted(void);

/* Non-zero once an end has been asked for: for measures that take a pointer to look at. */
const volatile int *interrupt_flag(void);

#endif
