/* Runs the built program as a user would, and keeps what it says. */
#ifndef VERIFY_TEST_PROGRAM_H
#define VERIFY_TEST_PROGRAM_H

#include <jansson.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmocka.h>

#include "test/folder.h"

enum { PROGRAM_WORDS = 40 };

struct said {
	int status;      /* of exit; 128 + the signal that ended it */
	char *out, *err; /* freed by said_free */
};

static inline void said_free(struct said *said)
{
	free(said->out);
	free(said->err);
}

/* The words after the program's name, split at blanks, as in a shell without quotes. The text stays in use. */
static inline void program_words(char *text, char *words[PROGRAM_WORDS])
{
	int count = 0;
	char *rest;
	words[count++] = TOUCHSTONE_PROGRAM;
	for (char *word = strtok_r(text, " ", &rest); word; word = strtok_r(NULL, " ", &rest)) {
		if (count == PROGRAM_WORDS - 1) abort();
		words[count++] = word;
	}
	words[count] = NULL;
}

static inline int program_status(pid_t process)
{
	int status;
	if (waitpid(process, &status, 0) != process) abort();
	return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

/* Runs it with nothing on standard input, standard output going to a path (NULL: is kept; "": is closed). */
static inline struct said program_run_to(const char *output, const char *format, ...)
{
	char *folder = folder_new(), *arguments, *out, *err, *words[PROGRAM_WORDS];
	va_list list;
	va_start(list, format);
	bool enough = vasprintf(&arguments, format, list) >= 0 && asprintf(&out, "%s/out", folder) >= 0 &&
				  asprintf(&err, "%s/err", folder) >= 0;
	va_end(list);
	if (!enough) abort();
	program_words(arguments, words);
	pid_t process = fork();
	if (process == 0) {
		if (!freopen("/dev/null", "r", stdin) || !freopen(err, "w", stderr)) _exit(99);
		if (output && !*output)
			close(STDOUT_FILENO);
		else if (!freopen(output ? output : out, "w", stdout))
			_exit(99);
		execv(words[0], words);
		_exit(99);
	}
	struct said said = {.status = program_status(process)};
	said.out = folder_text(folder, "out");
	said.err = folder_text(folder, "err");
	folder_remove(folder);
	free(arguments);
	free(out);
	free(err);
	return said;
}

#define program_run(...) program_run_to(NULL, __VA_ARGS__)

static inline size_t program_lines(const char *text)
{
	size_t lines = 0;
	for (; *text; text++) lines += *text == '\n';
	return lines;
}

/* Said on one line of standard error, with these words in it; nothing on standard output; exit status 2. */
static inline void program_refused(struct said said, const char *words)
{
	if (said.status != 2) fail_msg("status %d, not 2: %s%s", said.status, said.out, said.err);
	if (strncmp(said.err, "touchstone: ", 12) != 0 || program_lines(said.err) != 1 || !strstr(said.err, words))
		fail_msg("not one line 'touchstone: ... %s ...': %s", words, said.err);
	if (said.out) assert_string_equal(said.out, "");
	said_free(&said);
}

/* The JSON on standard output, with nothing around it. */
static inline json_t *program_json(struct said said, int status)
{
	json_error_t error;
	json_t *json = json_loads(said.out, 0, &error);
	if (said.status != status || !json) fail_msg("status %d, %s: %s%s", said.status, error.text, said.out, said.err);
	said_free(&said);
	return json;
}

static inline const char *json_text(const json_t *json, const char *key)
{
	const char *text = json_string_value(json_object_get(json, key));
	if (!text) fail_msg("no text '%s'", key);
	return text;
}

static inline double json_number(const json_t *json, const char *key)
{
	const json_t *number = json_object_get(json, key);
	if (!json_is_number(number)) fail_msg("no number '%s'", key);
	return json_number_value(number);
}

#endif
