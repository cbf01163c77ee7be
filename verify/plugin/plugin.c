#include "plugin/plugin.h"

#include <errno.h>
#include <math.h>
#include <poll.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include "plugin/host.h"

struct plugin {
	char *name, *path;
	const char *symbols[TOUCHSTONE_SHAPES]; /* into `name`, or constants */
	struct plugin_patience patience;
	struct plugin_exchange *exchange;
	pid_t child; /* 0: none */
	int socket;  /* to the child */
	int status;  /* of the child that ended last, as waitpid has it */
};

enum reply { REPLIED, ENDED, ENDLESS, STOPPED };

static const int glance = 50;        /* milliseconds between two looks at a child that is at work */
static const double time_to_die = 1; /* seconds from the end of the connection to that of the process */

static double now(void)
{
	struct timespec time;
	clock_gettime(CLOCK_MONOTONIC, &time);
	return (double)time.tv_sec + 1e-9 * (double)time.tv_nsec;
}

/* ---- the child */

/* Waits for the child's end; ends it, with all that it has started, if it has not come by then. */
static void bury(struct plugin *plugin, double patience)
{
	if (!plugin->child) return;
	double until = now() + patience;
	pid_t ended = 0;
	while (now() < until && (ended = waitpid(plugin->child, &plugin->status, WNOHANG)) == 0) poll(NULL, 0, 1);
	kill(-plugin->child, SIGKILL);
	if (ended == 0) {
		kill(plugin->child, SIGKILL);
		while (waitpid(plugin->child, &plugin->status, 0) < 0 && errno == EINTR) continue;
	}
	close(plugin->socket);
	plugin->child = 0;
}

/* Waits until the child is done with what it has been asked; one that does not reply has been buried. */
static enum reply listen_to(struct plugin *plugin)
{
	double since = now();
	size_t at = plugin->exchange->at;
	struct pollfd reply = {.fd = plugin->socket, .events = POLLIN};
	for (;;) {
		char byte;
		if (poll(&reply, 1, glance) > 0) {
			if (recv(plugin->socket, &byte, 1, MSG_DONTWAIT) == 1) return REPLIED;
			bury(plugin, time_to_die);
			return ENDED;
		}
		if (plugin->exchange->at != at) {
			at = plugin->exchange->at;
			since = now();
		}
		bool stopped = plugin->patience.stop && *plugin->patience.stop;
		if (!stopped && now() - since < plugin->patience.seconds) continue;
		bury(plugin, 0);
		return stopped ? STOPPED : ENDLESS;
	}
}

/* Starts a child and waits until it has loaded the file. */
static enum reply start(struct plugin *plugin)
{
	int ends[2];
	if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) != 0) return STOPPED;
	fflush(NULL); /* what is not yet written would be written twice if the child ends as programs do */
	pid_t child = fork();
	if (child == 0) plugin_host(plugin->path, plugin->symbols, plugin->exchange, ends[1]);
	close(ends[1]);
	if (child < 0) {
		close(ends[0]);
		return STOPPED;
	}
	setpgid(child, child);
	plugin->child = child;
	plugin->socket = ends[0];
	return listen_to(plugin);
}

/* Has the questions first .. count - 1 dealt with that are in the exchange. */
static enum reply ask(struct plugin *plugin, enum plugin_task task, size_t first, size_t count)
{
	struct plugin_exchange *exchange = plugin->exchange;
	enum reply begun = plugin->child ? REPLIED : start(plugin);
	if (begun != REPLIED) return begun == ENDED ? STOPPED : begun;
	exchange->task = task;
	exchange->first = exchange->at = first;
	exchange->count = count;
	send(plugin->socket, "", 1, MSG_NOSIGNAL); /* to one that has ended: then there is no reply */
	return listen_to(plugin);
}

/* ---- faults */

static struct plugin_fault fault_of(const struct plugin *plugin, enum reply reply)
{
	bool ended = reply == ENDED, signalled = ended && WIFSIGNALED(plugin->status);
	return (struct plugin_fault){
		.signal = signalled ? WTERMSIG(plugin->status) : 0,
		.status = ended && !signalled ? WEXITSTATUS(plugin->status) : 0,
		.endless = reply == ENDLESS,
	};
}

static bool same_fault(const struct plugin_fault *one, const struct plugin_fault *other)
{
	return one->signal == other->signal && one->status == other->status && one->endless == other->endless;
}

/* Whether the fault comes again when a new child is asked that question alone. */
static bool happens_alone(struct plugin *plugin, size_t at, const struct plugin_fault *fault)
{
	enum reply reply = ask(plugin, PLUGIN_ANSWER, at, at + 1);
	struct plugin_fault again = fault_of(plugin, reply);
	return (reply == ENDED || reply == ENDLESS) && same_fault(&again, fault);
}

void plugin_fault_words(const struct plugin_fault *fault, char words[120])
{
	const char *name = fault->signal ? sigabbrev_np(fault->signal) : NULL;
	if (fault->endless)
		snprintf(words, 120, "does not come to an end");
	else if (fault->signal)
		snprintf(words, 120, "is ended by SIG%.10s (%.60s)", name ? name : "?", strsignal(fault->signal));
	else
		snprintf(words, 120, "ends the process with status %d", fault->status);
}

/* ---- opening */

/* One line on why the file is not a plug-in, from a child that has loaded it or died of it. */
static bool check(const struct plugin *plugin, enum reply reply, const char *symbol, bool *broken,
				  char error[PLUGIN_ERROR])
{
	struct plugin_fault fault = fault_of(plugin, reply);
	char words[120];
	*broken = reply == ENDED || reply == ENDLESS;
	plugin_fault_words(&fault, words);
	if (*broken)
		snprintf(error, PLUGIN_ERROR, "%.200s: %s while it is loaded", plugin->name, words);
	else if (reply == STOPPED)
		snprintf(error, PLUGIN_ERROR, "%.200s: no process could be started for it: %s", plugin->name, strerror(errno));
	else if (*plugin->exchange->error)
		snprintf(error, PLUGIN_ERROR, "%.380s", plugin->exchange->error);
	for (int shape = 0; shape < TOUCHSTONE_SHAPES; shape++)
		if (plugin->exchange->answers[shape]) return true;
	if (reply == REPLIED && !*plugin->exchange->error)
		snprintf(error, PLUGIN_ERROR, "%.200s: has no function %.80s%s", plugin->path,
				 symbol ? symbol : plugin_symbol(TOUCHSTONE_BALL_BALL),
				 symbol ? "" : ", touchstone_ball_leave or touchstone_ball_plane; accepted also: FILE.so:SYMBOL");
	return false;
}

struct plugin *plugin_open(const char *name, enum touchstone_shape shape, const struct plugin_patience *patience,
						   bool *broken, char error[PLUGIN_ERROR])
{
	*broken = false;
	struct plugin *plugin = calloc(1, sizeof *plugin);
	if (!plugin) {
		snprintf(error, PLUGIN_ERROR, "out of memory");
		return NULL;
	}
	const char *symbol, *slash = strrchr(name, '/');
	plugin->patience = *patience;
	plugin->exchange = mmap(NULL, sizeof *plugin->exchange, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
	if (plugin->exchange == MAP_FAILED) plugin->exchange = NULL;
	plugin->name = strdup(slash ? slash + 1 : name);
	bool good = plugin->exchange && plugin->name;
	if (!good) snprintf(error, PLUGIN_ERROR, "out of memory");
	good = good && plugin_file(name, &plugin->path, &symbol, error);
	if (good) {
		for (int s = 0; s < TOUCHSTONE_SHAPES; s++)
			plugin->symbols[s] = !symbol ? plugin_symbol(s) : s == (int)shape ? strrchr(plugin->name, ':') + 1 : NULL;
		good = check(plugin, start(plugin), symbol, broken, error);
	}
	if (good) return plugin;
	plugin_close(plugin);
	return NULL;
}

void plugin_close(struct plugin *plugin)
{
	if (!plugin) return;
	bury(plugin, 0);
	if (plugin->exchange) munmap(plugin->exchange, sizeof *plugin->exchange);
	free(plugin->name);
	free(plugin->path);
	free(plugin);
}

bool plugin_answers(const struct plugin *plugin, enum touchstone_shape shape)
{
	return plugin->exchange->answers[shape];
}

const char *plugin_name(const struct plugin *plugin)
{
	return plugin->name;
}

/* ---- asking */

static void hand_over(struct plugin *plugin, enum touchstone_shape shape,
					  const double (*numbers)[TOUCHSTONE_MOST_NUMBERS], size_t count)
{
	struct plugin_exchange *exchange = plugin->exchange;
	exchange->shape = shape;
	memcpy(exchange->number, numbers, count * sizeof *numbers);
	for (size_t k = 0; k < count; k++) exchange->answer[k] = NAN;
}

/* What one plug-in has done to those who asked. */
struct trial {
	size_t crashes, loops;
	void (*tell)(void *context, const struct plugin_fault *fault);
	void *context;
};

/* A fault at one of the questions first .. count - 1 of the exchange, which are number `done` on; returns which. */
static size_t add_fault(struct plugin *plugin, struct trial *trial, enum reply reply, size_t done, size_t first,
						size_t count)
{
	size_t at = plugin->exchange->at;
	if (at < first || at >= count) at = first; /* it has overwritten what it should not */
	struct plugin_fault fault = fault_of(plugin, reply);
	fault.question = done + at;
	fault.alone = !plugin->patience.once && happens_alone(plugin, at, &fault);
	plugin->exchange->answer[at] = NAN;
	trial->loops += fault.endless;
	trial->crashes += !fault.endless;
	if (trial->tell) trial->tell(trial->context, &fault);
	return at;
}

/* Answers the `count` questions in the exchange; returns how many were dealt with. */
static size_t answer_batch(struct plugin *plugin, struct trial *trial, size_t done, size_t count)
{
	const struct plugin_patience *patience = &plugin->patience;
	for (size_t first = 0; first < count;) {
		enum reply reply = ask(plugin, PLUGIN_ANSWER, first, count);
		if (reply == REPLIED) return count;
		if (reply == STOPPED) return first;
		first = add_fault(plugin, trial, reply, done, first, count) + 1;
		if (trial->crashes >= patience->crashes || trial->loops >= patience->loops) return first;
	}
	return count;
}

size_t plugin_find(struct plugin *plugin, enum touchstone_shape shape, const double (*numbers)[TOUCHSTONE_MOST_NUMBERS],
				   size_t count, double *times, void (*fault)(void *context, const struct plugin_fault *fault),
				   void *context)
{
	struct trial trial = {.tell = fault, .context = context};
	size_t done = 0;
	while (done < count) {
		size_t batch = count - done < PLUGIN_BATCH ? count - done : PLUGIN_BATCH;
		hand_over(plugin, shape, numbers + done, batch);
		size_t dealt = answer_batch(plugin, &trial, done, batch);
		memcpy(times + done, plugin->exchange->answer, dealt * sizeof *times);
		done += dealt;
		if (dealt < batch) break;
	}
	return done;
}

double plugin_nanoseconds(struct plugin *plugin, enum touchstone_shape shape,
						  const double (*numbers)[TOUCHSTONE_MOST_NUMBERS], size_t count)
{
	if (count > PLUGIN_BATCH) count = PLUGIN_BATCH;
	hand_over(plugin, shape, numbers, count);
	if (count == 0 || ask(plugin, PLUGIN_TIME, 0, count) != REPLIED) return NAN;
	return fmax(0, plugin->exchange->nanoseconds);
}
