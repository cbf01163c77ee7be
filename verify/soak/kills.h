/* Runs of the program with checkpoints that are killed at random moments and resumed, until they reach their end. */
#ifndef VERIFY_SOAK_KILLS_H
#define VERIFY_SOAK_KILLS_H

#include <glob.h>
#include <jansson.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#include "command/progress.h"
#include "scene/random.h"
#include "store/checkpoint.h"

struct kills {
	const char *program, *folder; /* the folder is empty, or was used for the same */
	const char *scene;            /* with settings and events */
	uint64_t every;               /* events between checkpoints */
};

struct kills_tally {
	unsigned killed;  /* runs that were */
	unsigned writing; /* of them, those that were just writing a checkpoint */
	unsigned resumed; /* parts of runs that began from a checkpoint */
	unsigned unwhole; /* checkpoints that could not be read after a kill */
	char error[STORE_ERROR];
};

/* Starts a command, in words for a shell, with nothing to read and nobody to tell. Ctrl-C reaches it, also where this
 * program was started to ignore it, as in the background of a script. */
static inline pid_t kills_start(const char *command)
{
	fflush(NULL);
	pid_t process = fork();
	if (process != 0) return process;
	signal(SIGINT, SIG_DFL);
	if (freopen("/dev/null", "r", stdin) && freopen("/dev/null", "w", stdout) && freopen("/dev/null", "w", stderr))
		execl("/bin/sh", "sh", "-c", command, (char *)NULL);
	_exit(99);
}

/* Takes away what a writer that was killed left beside the checkpoint; returns how many such files there were. */
static inline unsigned kills_clean(const struct kills *kills)
{
	char pattern[400];
	glob_t found;
	unsigned count = 0;
	snprintf(pattern, sizeof pattern, "%s/kept.h5.*.part", kills->folder);
	if (glob(pattern, 0, NULL, &found) != 0) return 0;
	for (; count < found.gl_pathc; count++) unlink(found.gl_pathv[count]);
	globfree(&found);
	return count;
}

/* The digest that a run has written down; false when there is none. */
static inline bool kills_digest(const struct kills *kills, char digest[17])
{
	char path[400];
	snprintf(path, sizeof path, "%s/told.json", kills->folder);
	json_t *json = json_load_file(path, 0, NULL);
	const char *text = json_string_value(json_object_get(json, "digest"));
	if (text) snprintf(digest, 17, "%s", text);
	bool found = text;
	json_decref(json);
	unlink(path);
	return found;
}

/* Runs once, from the checkpoint if there is one, for so many seconds at most. True when it came to its end. */
static inline bool kills_part(const struct kills *kills, double seconds, struct kills_tally *tally)
{
	char checkpoint[400], command[2000];
	snprintf(checkpoint, sizeof checkpoint, "%s/kept.h5", kills->folder);
	bool resumes = access(checkpoint, F_OK) == 0;
	snprintf(command, sizeof command, "exec %s run %s --checkpoint %s --every %llu --json %s/told.json%s%s",
			 kills->program, kills->scene, checkpoint, (unsigned long long)kills->every, kills->folder,
			 resumes ? " --resume " : "", resumes ? checkpoint : "");
	double deadline = progress_clock() + seconds;
	pid_t process = kills_start(command);
	int status;
	while (waitpid(process, &status, WNOHANG) == 0) {
		if (progress_clock() > deadline) kill(process, SIGKILL);
		usleep(200);
	}
	tally->resumed += resumes;
	if (!WIFSIGNALED(status)) return true;
	tally->killed++;
	tally->writing += kills_clean(kills) > 0;
	struct checkpoint kept;
	if (access(checkpoint, F_OK) != 0) return false;
	if (checkpoint_read(checkpoint, &kept, tally->error))
		checkpoint_free(&kept);
	else
		tally->unwhole++;
	return false;
}

/* Runs to the end, killed at most so many times on the way, each time after up to `seconds`. The digest is the last
 * part's; false when it has none. */
static inline bool kills_run(const struct kills *kills, unsigned most, double seconds, struct random_state *random,
							 struct kills_tally *tally, char digest[17])
{
	char checkpoint[400];
	snprintf(checkpoint, sizeof checkpoint, "%s/kept.h5", kills->folder);
	unlink(checkpoint);
	bool ended = false;
	for (unsigned kill = 0; !ended && kill < most; kill++)
		ended = kills_part(kills, seconds * random_uniform(random), tally);
	if (!ended) kills_part(kills, 1e9, tally);
	unlink(checkpoint);
	return kills_digest(kills, digest);
}

#endif
