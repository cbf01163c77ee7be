#include "command/interrupt.h"

#include <signal.h>
#include <stddef.h>

static volatile sig_atomic_t asked;

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

bool interrupted(void)
{
	return asked != 0;
}

const volatile int *interrupt_flag(void)
{
	return &asked;
}
