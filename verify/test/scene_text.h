/* Scene files written and read by tests. */
#ifndef VERIFY_TEST_SCENE_TEXT_H
#define VERIFY_TEST_SCENE_TEXT_H

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

#include "store/scene_file.h"

static char folder[] = "/tmp/scene_text.XXXXXX"; /* for the files of a test program */
static char path[64];

/* A sound scene to be spoilt. */
#define GAS "dimensions: 3\nparticles: 100\ndensity: 0.5\n"
#define PAIR "dimensions: 1\nboundaries: [open]\nbodies:\n  - position: [0]\n  - position: [2]\n"

static inline void write_file(const char *name, const char *bytes, size_t length)
{
	snprintf(path, sizeof path, "%s/%s", folder, name);
	FILE *stream = fopen(path, "w");
	assert_non_null(stream);
	assert_int_equal(fwrite(bytes, 1, length, stream), length);
	assert_int_equal(fclose(stream), 0);
}

static inline struct scene_file *open_text(const char *text, const char *setting, char error[STORE_ERROR])
{
	write_file("scene.yaml", text, strlen(text));
	return scene_file_open(path, setting != NULL, &setting, error);
}

static inline void assert_one_line(const char *error)
{
	assert_true(strlen(error) > 10);
	assert_null(strchr(error, '\n'));
}

/* Opened, or else built, the text is refused, with the place and the words given. */
static inline void assert_refused(const char *text, const char *setting, const char *place, const char *words)
{
	char error[STORE_ERROR] = "";
	struct scene_file *file = open_text(text, setting, error);
	struct touchstone_scene scene;
	if (file && scene_file_build(file, &scene, error)) {
		scene_free(&scene);
		fail_msg("accepted: %s%s", text, setting ? setting : "");
	}
	scene_file_close(file);
	assert_one_line(error);
	if (!strstr(error, place)) fail_msg("'%s' does not say '%s'", error, place);
	if (!strstr(error, words)) fail_msg("'%s' does not say '%s'", error, words);
}

static inline void assert_accepted(const char *text, const char *setting)
{
	char error[STORE_ERROR] = "";
	struct scene_file *file = open_text(text, setting, error);
	struct touchstone_scene scene;
	if (!file || !scene_file_build(file, &scene, error)) fail_msg("%s%s: %s", text, setting ? setting : "", error);
	scene_free(&scene);
	scene_file_close(file);
}

static inline int make_folder(void **state)
{
	(void)state;
	return mkdtemp(folder) ? 0 : -1;
}

static inline int remove_folder(void **state)
{
	(void)state;
	const char *names[] = {"scene.yaml", "binary.yaml", "locked.yaml", "damaged.yaml"};
	for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
		snprintf(path, sizeof path, "%s/%s", folder, names[i]);
		unlink(path);
	}
	return rmdir(folder);
}

#endif
