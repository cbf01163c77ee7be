#include "command/interrupt.h"

#include <math.h>
#include <signal.h>
#include <stddef.h>
#include <sys/time.h>

static volatile sig_atomic_t asked, late;

static void ask(int signal)
{
	(void)signal;
	asked = 1;
}

void interrupt_watch(void)
{
	/* SA_RESETHAND gives the signal its usual effect back, so that a second one ends the program. */
	struct sigaction action = {.sa_handler = ask, .sa_flags = (int)SA_RESETHAND | SA_RESTART};
	sigemptyset(&action.sa_mask);
	sigaction(SIGINT, &action, NULL);
	sigaction(SIGTERM, &action, NULL);
}

static void call_time(int signal)
{
	(void)signal;
	if (!asked) late = 1;
	asked = 1;
}

void interrupt_after(double seconds)
{
	struct sigaction action = {.sa_handler = call_time, .sa_flags = SA_RESTART};
	sigemptyset(&action.sa_mask);
	sigaction(SIGALRM, &action, NULL);
	seconds = fmin(fmax(seconds, 1e-3), 1e8);
	setitimer(ITIMER_REAL,
			  &(struct itimerval){
				  .it_value = {.tv_sec = (time_t)seconds, .tv_usec = (suseconds_t)(1e6 * (seconds - floor(seconds)))}},
			  NULL);
}

bool interrupted_by_time(void)
{
	return late != 0;
}

bool interrupted(void)
{
	return asked != 0;
}

const volatile int *interrupt_flag(void)
{
	return &asked;
}
