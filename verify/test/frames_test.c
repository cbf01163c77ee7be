/* Frames for viewers: one file, in which those at the beginning and on the way are those of shorter runs. */
#include "own_folder.h"
#include "program.h"
#include "store/extended_xyz.h"

#define WELLS "run square-well --set particles=200 --set density=0.05 --set equilibrate=1"

static char *contents(const char *name)
{
	char path[100];
	snprintf(path, sizeof path, "%s/%s", folder, name);
	FILE *stream = fopen(path, "r");
	assert_non_null(stream);
	char *text = calloc(1, 1 << 20);
	assert_non_null(text);
	assert_true(fread(text, 1, (1 << 20) - 1, stream) > 0);
	fclose(stream);
	return text;
}

static void run(const char *arguments, const char *name)
{
	struct said said = program_run(WELLS " %s --xyz %s/%s", arguments, folder, name);
	assert_int_equal(said.status, 0);
	said_free(&said);
}

static void frames_are_those_of_shorter_runs(void **state)
{
	(void)state;
	run("--events 1000 --every 400", "all.xyz");
	char *all = contents("all.xyz"), *at = all;
	static const char *const parts[] = {NULL, "--events 400", "--events 800", "--events 1000"};
	for (int frame = 0; frame < 4; frame++) {
		const char *next = strstr(at, "\n200\nLattice");
		size_t length = next ? (size_t)(next + 1 - at) : strlen(at);
		if (parts[frame]) {
			run(parts[frame], "one.xyz");
			char *one = contents("one.xyz");
			assert_true(strlen(one) == length && strncmp(at, one, length) == 0);
			free(one);
		}
		assert_true((next != NULL) == (frame < 3));
		at += length;
	}
	free(all);
}

/* Who reads the file as a start state takes the first frame. */
static void first_frame_is_the_beginning(void **state)
{
	(void)state;
	run("--events 500 --every 100", "frames.xyz");
	char path[100], error[STORE_ERROR];
	struct extended_xyz file;
	snprintf(path, sizeof path, "%s/frames.xyz", folder);
	assert_true(extended_xyz_read(&file, path, 3, 0, NULL, error));
	assert_true(file.particle_count == 200 && file.has_box && file.has_velocities);
	extended_xyz_free(&file);
}

static void what_every_needs(void **state)
{
	(void)state;
	program_refused(program_run(WELLS " --events 10 --every 5"), "--every: accepted: with --checkpoint or --xyz");
	program_refused(program_run(WELLS " --events 10 --every 5 --trace --xyz %s/a.xyz", folder), "without --trace");
	assert_int_equal(folder_count(folder, "a.xyz"), 0);
}

/* Checkpoints and frames on the way do not disturb each other, nor the run. */
static void both_at_once(void **state)
{
	(void)state;
	struct said plain = program_run(WELLS " --events 700 --json -");
	struct said both =
		program_run(WELLS " --events 700 --every 300 --checkpoint %s/k.h5 --xyz %s/k.xyz --json -", folder, folder);
	assert_true(plain.status == 0 && both.status == 0);
	json_t *one = json_loads(plain.out, 0, NULL), *other = json_loads(both.out, 0, NULL);
	assert_true(json_equal(json_object_get(one, "digest"), json_object_get(other, "digest")));
	json_decref(one);
	json_decref(other);
	char *text = contents("k.xyz"), *at = text;
	int frames = 0;
	for (; (at = strstr(at, "Lattice")); at++) frames++;
	assert_int_equal(frames, 4);
	free(text);
	said_free(&plain);
	said_free(&both);
}

int main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(frames_are_those_of_shorter_runs),
		cmocka_unit_test(first_frame_is_the_beginning),
		cmocka_unit_test(what_every_needs),
		cmocka_unit_test(both_at_once),
	};
	return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
