#include "plugin/host.h"

#include <dlfcn.h>
#include <fcntl.h>
#include <limits.h>
#include <math.h>
#include <signal.h>
#include <stdio.h>
#include <string.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <unistd.h>

#include "measure/call_time.h"

/* A plug-in's functions, or stand-ins that do nothing. */
struct finders {
	touchstone_ball_ball_finder *ball_ball;
	touchstone_ball_leave_finder *ball_leave;
	touchstone_ball_plane_finder *ball_plane;
};

/* ---- calling */

/* The finder gets a copy of the numbers, so that it cannot change the question. */
static double call(const struct finders *finders, enum touchstone_shape shape,
				   const double number[TOUCHSTONE_MOST_NUMBERS])
{
	double copy[TOUCHSTONE_MOST_NUMBERS];
	memcpy(copy, number, sizeof copy);
	switch (shape) {
	case TOUCHSTONE_BALL_BALL:
		return finders->ball_ball(copy, copy + 3, copy[6]);
	case TOUCHSTONE_BALL_LEAVE:
		return finders->ball_leave(copy, copy + 3, copy[6]);
	case TOUCHSTONE_BALL_PLANE:
		return finders->ball_plane(copy[0], copy[1], copy[2], copy[3]);
	case TOUCHSTONE_HALF_SPACE:
		break;
	}
	return NAN;
}

/* Plug-ins are made for finite numbers, and asked nothing else. */
static bool all_finite(const double number[TOUCHSTONE_MOST_NUMBERS])
{
	bool all = true;
	for (int i = 0; i < TOUCHSTONE_MOST_NUMBERS; i++) all = all && isfinite(number[i]);
	return all;
}

static void answer(const struct finders *finders, struct plugin_exchange *exchange, size_t first, size_t count)
{
	for (size_t k = first; k < count; k++) {
		exchange->at = k;
		if (all_finite(exchange->number[k])) exchange->answer[k] = call(finders, exchange->shape, exchange->number[k]);
	}
}

/* ---- timing */

static double idle_balls(const double r[3], const double v[3], double contact_distance)
{
	(void)r, (void)v;
	return contact_distance;
}

static double idle_plane(double distance, double speed, double acceleration, double contact_distance)
{
	(void)speed, (void)acceleration, (void)contact_distance;
	return distance;
}

struct timed {
	const struct finders *finders;
	struct plugin_exchange *exchange;
};

static void call_often(void *context, size_t count)
{
	const struct timed *timed = context;
	answer(timed->finders, timed->exchange, 0, count);
}

static void take_time(const struct finders *finders, struct plugin_exchange *exchange)
{
	const struct finders idle = {idle_balls, idle_balls, idle_plane};
	struct timed timed[] = {{finders, exchange}, {&idle, exchange}};
	struct call_time callees[] = {{call_often, &timed[0], 0}, {call_often, &timed[1], 0}};
	call_time_measure(callees, 2, exchange->count);
	exchange->nanoseconds = callees[0].nanoseconds - callees[1].nanoseconds;
}

/* ---- the process */

const char *plugin_symbol(enum touchstone_shape shape)
{
	static const char *const symbols[TOUCHSTONE_SHAPES] = {
		[TOUCHSTONE_BALL_BALL] = "touchstone_ball_ball",
		[TOUCHSTONE_BALL_LEAVE] = "touchstone_ball_leave",
		[TOUCHSTONE_BALL_PLANE] = "touchstone_ball_plane",
	};
	return symbols[shape];
}

/* Signals do what they do in any program, standard output goes nowhere, and no other file is open. */
static void settle(int parent)
{
	prctl(PR_SET_PDEATHSIG, SIGKILL);
	setpgid(0, 0);
	for (int number = 1; number < NSIG; number++) signal(number, SIG_DFL);
	sigset_t none;
	sigemptyset(&none);
	sigprocmask(SIG_SETMASK, &none, NULL);
	const struct rlimit no_core = {0, 0};
	setrlimit(RLIMIT_CORE, &no_core);
	int nothing = open("/dev/null", O_RDWR);
	dup2(nothing, STDIN_FILENO);
	dup2(nothing, STDOUT_FILENO);
	if (parent > STDERR_FILENO + 1) close_range(STDERR_FILENO + 1, (unsigned)parent - 1, 0);
	close_range((unsigned)parent + 1, UINT_MAX, 0);
}

/* POSIX has it that a data pointer from dlsym can be made one to a function. */
static bool look_up(void *library, const char *symbol, void *function)
{
	void *found = symbol ? dlsym(library, symbol) : NULL;
	memcpy(function, &found, sizeof found);
	return found;
}

static void load(const char *path, const char *const symbols[TOUCHSTONE_SHAPES], struct finders *finders,
				 struct plugin_exchange *exchange)
{
	void *const functions[TOUCHSTONE_SHAPES] = {&finders->ball_ball, &finders->ball_leave, &finders->ball_plane};
	void *library = dlopen(path, RTLD_NOW | RTLD_LOCAL);
	if (!library) {
		snprintf(exchange->error, PLUGIN_ERROR, "%s", dlerror());
		return;
	}
	for (int shape = 0; shape < TOUCHSTONE_SHAPES; shape++)
		exchange->answers[shape] = functions[shape] && look_up(library, symbols[shape], functions[shape]);
}

_Noreturn void plugin_host(const char *path, const char *const symbols[TOUCHSTONE_SHAPES],
						   struct plugin_exchange *exchange, int parent)
{
	struct finders finders = {0};
	char byte = 0;
	settle(parent);
	load(path, symbols, &finders, exchange);
	while (send(parent, &byte, 1, MSG_NOSIGNAL) == 1 && recv(parent, &byte, 1, 0) == 1)
		if (exchange->task == PLUGIN_ANSWER)
			answer(&finders, exchange, exchange->first, exchange->count);
		else
			take_time(&finders, exchange);
	_exit(0);
}
