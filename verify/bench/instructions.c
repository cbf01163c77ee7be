#include "bench/instructions.h"

#include <errno.h>
#include <fcntl.h>
#include <inttypes.h>
#include <math.h>
#include <signal.h>
#include <spawn.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

/* Starts valgrind with these arguments, its own messages going to a file; 0 or an error number. */
static int start(char *const arguments[], const char *messages, pid_t *child)
{
	posix_spawn_file_actions_t actions;
	posix_spawn_file_actions_init(&actions);
	posix_spawn_file_actions_addopen(&actions, 0, "/dev/null", O_RDONLY, 0);
	posix_spawn_file_actions_addopen(&actions, 1, messages, O_WRONLY | O_CREAT | O_TRUNC, 0666);
	posix_spawn_file_actions_adddup2(&actions, 1, 2);
	int failed = posix_spawnp(child, "valgrind", &actions, NULL, arguments, environ);
	posix_spawn_file_actions_destroy(&actions);
	return failed;
}

/* Waits for a program to end; once `stop` is set, ends it. Whether it ended well. */
static bool wait_for(pid_t child, const volatile int *stop)
{
	const struct timespec pause = {0, 20000000};
	bool ended = false;
	int status = 0;
	for (;;) {
		pid_t found = waitpid(child, &status, WNOHANG);
		if (found == child) return WIFEXITED(status) && WEXITSTATUS(status) == 0;
		if (found < 0 && errno != EINTR) return false;
		if (stop && *stop && !ended) ended = kill(child, SIGKILL) == 0;
		nanosleep(&pause, NULL);
	}
}

bool instructions_possible(void)
{
	pid_t child;
	return start((char *[]){"valgrind", "--version", NULL}, "/dev/null", &child) == 0 && wait_for(child, NULL);
}

double instructions_read(const char *path, char error[REPORT_ERROR])
{
	static const char key[] = "totals: ";
	FILE *file = fopen(path, "r");
	double count = NAN;
	for (char line[256]; file && fgets(line, sizeof line, file);) {
		if (strncmp(line, key, strlen(key)) != 0) continue;
		line[strcspn(line, "\n")] = '\0';
		if (!text_number(line + strlen(key), &count) || !(count > 0)) count = NAN;
	}
	if (isnan(count))
		snprintf(error, REPORT_ERROR, "%.200s: %s", path,
				 file ? "no line 'totals: NUMBER' as callgrind writes it" : strerror(errno));
	if (file) fclose(file);
	return count;
}

/* The last line a program said before it failed. */
static void last_words(const char *path, char words[200])
{
	FILE *file = fopen(path, "r");
	strcpy(words, "without a message");
	for (char line[200]; file && fgets(line, sizeof line, file);)
		if (line[strspn(line, "=0123456789 \n")]) strcpy(words, line);
	words[strcspn(words, "\n")] = '\0';
	if (file) fclose(file);
}

double instructions_count(const struct point *point, const struct effort *effort, const volatile int *stop,
						  char error[REPORT_ERROR])
{
	char folder[] = "/tmp/touchstone-bench-XXXXXX", out[60], messages[60], option[100], self[4096] = "";
	char name[POINT_NAME], events[24], words[200];
	uint64_t counted = effort_events(effort, point->counted);
	double instructions = NAN;
	pid_t child;
	*error = '\0';
	if (readlink("/proc/self/exe", self, sizeof self - 1) < 0 || !mkdtemp(folder)) {
		snprintf(error, REPORT_ERROR, "%s: %s", *self ? folder : "/proc/self/exe", strerror(errno));
		return NAN;
	}
	snprintf(out, sizeof out, "%s/counts", folder);
	snprintf(messages, sizeof messages, "%s/messages", folder);
	snprintf(option, sizeof option, "--callgrind-out-file=%s", out);
	snprintf(events, sizeof events, "%" PRIu64, counted);
	char *arguments[] = {"valgrind",
						 "--tool=callgrind",
						 option,
						 "--toggle-collect=bench_run",
						 self,
						 "--count",
						 (char *)point_name(point, name),
						 "--events",
						 events,
						 effort->full ? "--full" : NULL,
						 NULL};
	int failed = start(arguments, messages, &child);
	if (failed) {
		snprintf(error, REPORT_ERROR, "valgrind cannot be started: %s", strerror(failed));
	} else if (wait_for(child, stop)) {
		instructions = instructions_read(out, error) / (double)counted;
	} else if (!(stop && *stop)) {
		last_words(messages, words);
		snprintf(error, REPORT_ERROR, "%s: cannot be counted by valgrind: %s", name, words);
	}
	unlink(out);
	unlink(messages);
	rmdir(folder);
	return instructions;
}
